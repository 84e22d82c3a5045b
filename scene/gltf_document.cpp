#include "scene/gltf_document.h"

#include "core/error.h"
#include "scene/gltf_schema.h"
#include "scene/input_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <limits>
#include <utility>

namespace lambert {

namespace {

using nlohmann::json;

constexpr int kDeepestNesting = 64; // tinygltf descends into `extras` and extensions by recursion
constexpr std::uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

struct Container {
    std::string_view jsonText;
    std::string_view binary; //!< of a .glb; may be empty
    bool isBinary = false;
};

std::uint32_t word(std::string_view bytes, std::size_t offset) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value); // glTF is little-endian, as are our machines
    return value;
}

/// Takes the two chunks out of a .glb. tinygltf's own check lets the binary chunk end 8 bytes past the file.
Container unpack(const std::string& file, std::string_view bytes) {
    if (!bytes.starts_with("glTF")) return {bytes, {}, false};
    const auto fail = [&](const std::string& what) { throw InputError(fmt::format("{}: {}", file, what)); };
    if (bytes.size() < 20) fail(fmt::format("found {} bytes, a .glb has at least 20", bytes.size()));
    if (word(bytes, 4) != 2) fail(fmt::format("found glTF binary version {}, allowed is 2", word(bytes, 4)));
    const std::size_t length = word(bytes, 8);
    if (length > bytes.size())
        fail(fmt::format("found {} bytes, but its header announces {}: is the file cut?", bytes.size(), length));
    if (length < 20) fail(fmt::format("its header announces {} bytes, a .glb has at least 20", length));
    bytes = bytes.substr(0, length);

    Container container{{}, {}, true};
    for (std::size_t offset = 12; offset + 8 <= bytes.size();) {
        const std::size_t size = word(bytes, offset);
        const std::uint32_t type = word(bytes, offset + 4);
        const std::size_t left = bytes.size() - offset - 8;
        if (size > left)
            fail(fmt::format("the chunk at byte {} has length {}, allowed at most {}", offset, size, left));
        if (offset == 12) {
            if (type != kJsonChunk) fail("its first chunk is not JSON");
            container.jsonText = bytes.substr(offset + 8, size);
        } else if (type == kBinaryChunk && container.binary.empty()) {
            container.binary = bytes.substr(offset + 8, size);
        }
        offset += 8 + size;
    }
    return container;
}

/// Before parsing: afterwards a hostile file would only wait for the first recursive function.
void refuseDeepNesting(const std::string& file, std::string_view text) {
    int depth = 0;
    bool inString = false;
    for (std::size_t k = 0; k < text.size(); ++k) {
        const char c = text[k];
        if (inString) {
            if (c == '\\') ++k;
            if (c == '"') inString = false;
        } else if (c == '"') {
            inString = true;
        } else if (c == '[' || c == '{') {
            if (++depth > kDeepestNesting)
                throw InputError(fmt::format("{}: found JSON nested deeper than {} levels", file, kDeepestNesting));
        } else if (c == ']' || c == '}') {
            --depth;
        }
    }
}

json parseJson(const std::string& file, std::string_view text) {
    refuseDeepNesting(file, text);
    try {
        json document = json::parse(text.begin(), text.end());
        if (!document.is_object()) throw InputError(file + ": found JSON that is not an object");
        for (const char* unused : {"animations", "extensions", "extras", "images", "samplers", "skins", "textures"})
            document.erase(unused);
        return document;
    } catch (const json::exception& error) {
        // What stands before "] " is the library's own name for the error.
        std::string_view message = error.what();
        message.remove_prefix(std::min(message.find("] ") + 2, message.size()));
        throw InputError(fmt::format("{}: not JSON: {}", file, oneLine(message)));
    }
}

} // namespace

std::string decodedUri(std::string_view uri) {
    std::string result;
    for (std::size_t k = 0; k < uri.size(); ++k) {
        unsigned code = 0;
        const bool escape = uri[k] == '%' && k + 2 < uri.size();
        if (escape && std::from_chars(uri.data() + k + 1, uri.data() + k + 3, code, 16).ptr == uri.data() + k + 3) {
            result += static_cast<char>(code);
            k += 2;
        } else {
            result += uri[k];
        }
    }
    return result;
}

namespace {

void replaceAll(std::string& text, std::string_view from, std::string_view to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
}

/// Bytes in a data URI, whose header becomes the one form that tinygltf knows.
std::size_t prepareDataUri(const std::string& file, const std::string& member, std::string& uri) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos || !std::string_view(uri).substr(0, comma).ends_with(";base64"))
        failAtMember(file, member, inQuotes(uri), "a data URI in base64");
    uri.replace(0, comma, "data:application/octet-stream;base64");
    const std::size_t begin = uri.find(',') + 1;
    std::size_t characters = uri.size() - begin;
    while (characters > 0 && uri[begin + characters - 1] == '=') --characters;
    return characters * 3 / 4;
}

/// The size of a buffer's file, which must lie where the glTF file says: tinygltf would also look for it in
/// the current folder, and reads `+` as a space.
std::size_t prepareExternalUri(const std::string& file, const std::string& member, const std::filesystem::path& folder,
                               std::string& uri) {
    const std::filesystem::path target = folder / decodedUri(uri);
    std::error_code error;
    if (uri.empty() || !std::filesystem::is_regular_file(target, error))
        failAtMember(file, member, inQuotes(uri), "the name of a file that exists");
    const std::uintmax_t size = std::filesystem::file_size(target, error);
    if (error) failAtMember(file, member, inQuotes(uri), "a readable file");
    replaceAll(uri, "+", "%2B");
    return size;
}

/// tinygltf wants `byteLength` to be exactly what is there, where the format allows more to be there.
void prepareBuffers(const std::string& file, const std::filesystem::path& folder, const Container& container,
                    json& document) {
    if (!document.contains("buffers")) return;
    json& buffers = document["buffers"];
    for (std::size_t k = 0; k < buffers.size(); ++k) {
        const std::string place = fmt::format("/buffers/{}", k);
        std::size_t available = container.binary.size();
        if (buffers[k].contains("uri")) {
            auto& uri = buffers[k]["uri"].get_ref<std::string&>();
            available = uri.starts_with("data:") ? prepareDataUri(file, place + "/uri", uri)
                                                 : prepareExternalUri(file, place + "/uri", folder, uri);
        } else if (!container.isBinary || k > 0) {
            failAtMember(file, place + "/uri", "nothing", "a file or data URI");
        }
        const auto length = buffers[k]["byteLength"].get<std::uint64_t>();
        if (length < 1 || length > available)
            failAtMember(file, place + "/byteLength", std::to_string(length),
                         fmt::format("1 to {}, the bytes that are there", available));
        buffers[k]["byteLength"] = available;
    }
}

/// tinygltf keeps numbers of extensions without a decimal point as 32-bit integers.
void makeStrengthsReal(json& document) {
    const json::json_pointer strength("/extensions/KHR_materials_emissive_strength/emissiveStrength");
    if (!document.contains("materials")) return;
    for (json& material : document["materials"])
        if (material.contains(strength)) material[strength] = material[strength].get<double>();
}

void appendChunk(std::string& bytes, std::uint32_t type, std::string_view content, char padding) {
    const std::size_t padded = (content.size() + 3) / 4 * 4;
    for (const std::uint32_t value : {static_cast<std::uint32_t>(padded), type})
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    bytes.append(content).append(padded - content.size(), padding);
}

std::string packed(std::string_view jsonText, std::string_view binary) {
    std::string bytes = "glTF";
    bytes.append({2, 0, 0, 0, 0, 0, 0, 0});
    appendChunk(bytes, kJsonChunk, jsonText, ' ');
    if (!binary.empty()) appendChunk(bytes, kBinaryChunk, binary, '\0');
    const auto length = static_cast<std::uint32_t>(bytes.size());
    std::memcpy(bytes.data() + 8, &length, sizeof length);
    return bytes;
}

} // namespace

void failAtMember(const std::string& file, const std::string& member, const std::string& found,
                  const std::string& allowed) {
    throw InputError(fmt::format("{}: {}: found {}, allowed {}", file, member, found, allowed));
}

tinygltf::Model loadGltfModel(const std::filesystem::path& path) {
    const std::string file = path.string();
    std::string content = readInputFile(path);
    const Container container = unpack(file, content);
    json document = parseJson(file, container.jsonText);
    checkGltfMembers(file, document);
    const auto version = document["asset"]["version"].get<std::string>();
    if (!version.starts_with("2.")) failAtMember(file, "/asset/version", inQuotes(version), "2.x");

    std::filesystem::path folder = path.parent_path();
    if (folder.empty()) folder = ".";
    prepareBuffers(file, folder, container, document);
    makeStrengthsReal(document);

    const bool isBinary = container.isBinary;
    std::string text = document.dump();
    document = nullptr;
    if (isBinary) text = packed(text, container.binary);
    if (text.size() > std::numeric_limits<std::uint32_t>::max())
        throw InputError(fmt::format("{}: found {} bytes, allowed at most 4 GB", file, text.size()));
    content = {};

    tinygltf::Model model;
    std::string warnings, errors;
    try {
        tinygltf::TinyGLTF loader;
        const auto length = static_cast<unsigned>(text.size());
        const bool loaded =
            isBinary ? loader.LoadBinaryFromMemory(&model, &errors, &warnings,
                                                   reinterpret_cast<const unsigned char*>(text.data()), length,
                                                   folder.string())
                     : loader.LoadASCIIFromString(&model, &errors, &warnings, text.data(), length, folder.string());
        if (!loaded) throw InputError(fmt::format("{}: {}", file, oneLine(errors)));
    } catch (const std::length_error& error) { // thrown by containers inside the library
        throw InputError(fmt::format("{}: {}", file, error.what()));
    } catch (const std::out_of_range& error) {
        throw InputError(fmt::format("{}: {}", file, error.what()));
    }
    return model;
}

} // namespace lambert
