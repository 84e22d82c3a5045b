#include "scene/gltf/document.h"

#include "core/error.h"
#include "core/input_file.h"
#include "core/text.h"
#include "scene/gltf/buffers.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace lambert {

namespace {

using nlohmann::json;

constexpr int kDeepestNesting = 64; // nlohmann::json writes what an error shows by recursion

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
        return document;
    } catch (const json::exception& error) {
        // What stands before "] " is the library's own name for the error.
        std::string_view message = error.what();
        message.remove_prefix(std::min(message.find("] ") + 2, message.size()));
        throw InputError(fmt::format("{}: not JSON: {}", file, oneLine(message)));
    }
}

/// Before all else: the members of glTF 1.0 have other types, which are not what is wrong with such a file.
void requireVersion2(const std::string& file, const json& document) {
    const json::json_pointer member("/asset/version");
    if (!document.is_object() || !document.contains(member)) return; // modelOf says so
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

std::filesystem::path gltfFolder(const std::filesystem::path& path) {
    return path.has_parent_path() ? path.parent_path() : ".";
}

gltf::Model loadGltfModel(const std::filesystem::path& path, const ReadOptions& options, json* extras) {
    const std::string file = path.string();
    const std::string content = readInputFile(path);
    const GltfContainer container = unpackGltf(file, content);
    const json document = parseJson(file, container.jsonText, extras);
    requireVersion2(file, document);
    gltf::Model model = gltf::modelOf(file, document);
    model.buffers = readGltfBuffers(file, gltfFolder(path), container, model.bufferSources, options);
    return model;
}

} // namespace lambert
