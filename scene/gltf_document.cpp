#include "scene/gltf_document.h"

#include "core/error.h"
#include "scene/gltf_buffers.h"
#include "scene/gltf_schema.h"
#include "scene/input_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lambert {

namespace {

using nlohmann::json;

constexpr int kDeepestNesting = 64; // tinygltf descends into `extras` and extensions by recursion

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

json parseJson(const std::string& file, std::string_view text, json* extras) {
    refuseDeepNesting(file, text);
    try {
        json document = json::parse(text.begin(), text.end());
        if (!document.is_object()) throw InputError(file + ": found JSON that is not an object");
        if (extras != nullptr && document.contains("extras")) *extras = std::move(document["extras"]);
        for (const char* unused : {"animations", "extras", "skins"}) document.erase(unused);
        if (document.contains("extensions") && document["extensions"].is_object())
            for (auto item = document["extensions"].begin(); item != document["extensions"].end();)
                item = item.key() == "KHR_lights_punctual" ? std::next(item) : document["extensions"].erase(item);
        return document;
    } catch (const json::exception& error) {
        // What stands before "] " is the library's own name for the error.
        std::string_view message = error.what();
        message.remove_prefix(std::min(message.find("] ") + 2, message.size()));
        throw InputError(fmt::format("{}: not JSON: {}", file, oneLine(message)));
    }
}

/// tinygltf keeps whole numbers of extensions as 32-bit integers.
void makeLargeNumbersReal(json& value, bool inExtension) {
    if (inExtension && value.is_number_integer()) {
        const auto number = value.get<double>();
        if (std::abs(number) > std::numeric_limits<std::int32_t>::max()) value = number;
    } else if (value.is_structured()) {
        for (const auto& item : value.items())
            makeLargeNumbersReal(item.value(), inExtension || (value.is_object() && item.key() == "extensions"));
    }
}

/// Takes out of the document what tinygltf would read in a way of its own: it opens files, also in the current folder,
/// and refuses indices without a buffer view, which are compressed or sparse.
class TakenOut {
public:
    explicit TakenOut(json& document) {
        document.erase("buffers"); // read by readGltfBuffers
        images_ = take(document, "images");
        if (!document.contains("meshes")) return;
        for (json& mesh : document["meshes"])
            for (json& primitive : mesh["primitives"]) {
                indices_.push_back(primitive.value("indices", -1));
                primitive.erase("indices");
            }
    }

    void putInto(tinygltf::Model& model) const {
        for (const json& source : images_) {
            tinygltf::Image& image = model.images.emplace_back();
            image.name = source.value("name", "");
            image.uri = source.value("uri", "");
            image.bufferView = source.value("bufferView", -1);
        }
        auto index = indices_.begin();
        for (tinygltf::Mesh& mesh : model.meshes)
            for (tinygltf::Primitive& primitive : mesh.primitives) primitive.indices = *index++;
    }

private:
    static json take(json& document, const char* name) {
        if (!document.contains(name)) return json::array();
        json result = std::move(document[name]);
        document.erase(name);
        return result;
    }

    json images_;
    std::vector<int> indices_; //!< of each primitive
};

tinygltf::Model parseModel(const std::string& file, const std::string& text) {
    if (text.size() > std::numeric_limits<std::uint32_t>::max())
        throw InputError(fmt::format("{}: found {} bytes of JSON, allowed at most 4 GB", file, text.size()));
    tinygltf::Model model;
    std::string warnings, errors;
    try {
        tinygltf::TinyGLTF loader;
        if (!loader.LoadASCIIFromString(&model, &errors, &warnings, text.data(), static_cast<unsigned>(text.size()),
                                        ""))
            throw InputError(fmt::format("{}: {}", file, oneLine(errors)));
    } catch (const std::length_error& error) { // thrown by containers inside the library
        throw InputError(fmt::format("{}: {}", file, error.what()));
    } catch (const std::out_of_range& error) {
        throw InputError(fmt::format("{}: {}", file, error.what()));
    }
    return model;
}

/// Before all else: the members of glTF 1.0 have other types, which are not what is wrong with such a file.
void requireVersion2(const std::string& file, const json& document) {
    const json::json_pointer member("/asset/version");
    if (!document.is_object() || !document.contains(member)) return; // checkGltfMembers says so
    const json& version = document.at(member);
    const std::string text = version.is_string() ? version.get<std::string>() : version.dump();
    if ((version.is_string() || version.is_number()) && !text.starts_with("2."))
        failAtMember(file, "/asset/version", inQuotes(text), "2.x: this is another version of glTF");
}

} // namespace

void failAtMember(const std::string& file, const std::string& member, const std::string& found,
                  const std::string& allowed) {
    throw InputError(fmt::format("{}: {}: found {}, allowed {}", file, member, found, allowed));
}

float checkedGltfNumber(const std::string& file, const std::string& member, double number, double largest) {
    if (!(number >= 0.0 && number <= largest))
        failAtMember(file, member, fmt::format("{:g}", number), fmt::format("0 to {:g}", largest));
    return static_cast<float>(number);
}

double gltfNumber(const tinygltf::Value& extension, const char* member, double missing) {
    return extension.Has(member) ? extension.Get(member).GetNumberAsDouble() : missing;
}

std::size_t gltfSize(const tinygltf::Value& extension, const char* member, std::size_t missing) {
    constexpr double kLargest = 9007199254740992.0; // above it doubles leave out whole numbers
    if (!extension.Has(member)) return missing;
    return static_cast<std::size_t>(std::clamp(extension.Get(member).GetNumberAsDouble(), 0.0, kLargest));
}

std::filesystem::path gltfFolder(const std::filesystem::path& path) {
    return path.has_parent_path() ? path.parent_path() : ".";
}

tinygltf::Model loadGltfModel(const std::filesystem::path& path, const ReadOptions& options, json* extras) {
    const std::string file = path.string();
    const std::string content = readInputFile(path);
    const GltfContainer container = unpackGltf(file, content);
    json document = parseJson(file, container.jsonText, extras);
    requireVersion2(file, document);
    checkGltfMembers(file, document);

    std::vector<tinygltf::Buffer> buffers = readGltfBuffers(file, gltfFolder(path), container, document, options);
    const TakenOut rest(document);
    makeLargeNumbersReal(document, false);
    tinygltf::Model model = parseModel(file, document.dump());
    rest.putInto(model);
    model.buffers = std::move(buffers);
    return model;
}

} // namespace lambert
