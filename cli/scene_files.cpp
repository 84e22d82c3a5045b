#include "cli/scene_files.h"

#include "baking/write_baked.h"
#include "core/error.h"
#include "scene/gltf_document.h"
#include "scene/input_file.h"
#include "scene/obj_lines.h"

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace lambert {

namespace fs = std::filesystem;

namespace {

/// One name with spaces in it, or several names: what is no file does no harm.
void addNames(std::vector<fs::path>& files, const fs::path& folder, std::string_view names) {
    files.push_back(folder / names);
    for (std::string_view word = nextWord(names); !word.empty(); word = nextWord(names)) files.push_back(folder / word);
}

void addTexturesOfMtl(std::vector<fs::path>& files, const fs::path& library) {
    std::string text;
    try {
        text = readInputFile(library);
    } catch (const InputError&) {
        return; // the reader will say what is wrong
    }
    ObjLines lines(text);
    while (const auto line = lines.next())
        if (line->keyword.starts_with("map_")) addNames(files, library.parent_path(), line->rest);
}

void addFilesOfObj(std::vector<fs::path>& files, const fs::path& scene) {
    const std::string text = readInputFile(scene);
    ObjLines lines(text);
    while (const auto line = lines.next())
        if (line->keyword == "mtllib") addNames(files, scene.parent_path(), line->rest);
    for (std::size_t i = 1, libraries = files.size(); i < libraries; ++i) addTexturesOfMtl(files, fs::path(files[i]));
}

void addFilesOfGltf(std::vector<fs::path>& files, const fs::path& scene) {
    const auto document = nlohmann::json::parse(readInputFile(scene), nullptr, false);
    if (!document.is_object()) return;
    for (const char* list : {"buffers", "images"}) {
        const auto found = document.find(list);
        if (found == document.end() || !found->is_array()) continue;
        for (const auto& entry : *found) {
            const auto uri = entry.is_object() ? entry.find("uri") : entry.end();
            if (!entry.is_object() || uri == entry.end() || !uri->is_string()) continue;
            const std::string name = uri->get<std::string>();
            if (!name.starts_with("data:")) files.push_back(scene.parent_path() / decodedUri(name));
        }
    }
}

} // namespace

std::vector<fs::path> filesOfScene(const fs::path& scene) {
    std::vector<fs::path> files{scene};
    const auto format = formatOf(scene);
    if (format == BakedFormat::Obj) addFilesOfObj(files, scene);
    if (format == BakedFormat::Gltf) addFilesOfGltf(files, scene);
    return files;
}

} // namespace lambert
