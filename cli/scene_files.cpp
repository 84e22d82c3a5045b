#include "cli/scene_files.h"

#include "baking/write_baked.h"
#include "core/error.h"
#include "scene/gltf_uri.h"
#include "scene/input_file.h"
#include "scene/mgf_file.h"
#include "scene/obj_lines.h"
#include "scene/overrides_file.h"

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
    try {
        ObjLines lines(library);
        while (const auto line = lines.next())
            if (line->keyword.starts_with("map_")) addNames(files, library.parent_path(), line->rest);
    } catch (const InputError&) { // the reader will say what is wrong
    }
}

void addFilesOfObj(std::vector<fs::path>& files, const fs::path& scene) {
    ObjLines lines(scene);
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
            if (!isDataUri(name)) files.push_back(scene.parent_path() / pathOfUri(name));
        }
    }
}

} // namespace

std::vector<fs::path> filesOfScene(const fs::path& scene) {
    if (isMgf(scene)) return filesOfMgf(scene);
    std::vector<fs::path> files{scene};
    const auto format = formatOf(scene);
    if (format == BakedFormat::Obj) addFilesOfObj(files, scene);
    if (format == BakedFormat::Gltf) addFilesOfGltf(files, scene);
    return files;
}

std::vector<fs::path> inputFiles(const SceneArguments& arguments) {
    std::vector<fs::path> files = filesOfScene(arguments.path);
    files.push_back(arguments.overrides.empty() ? overridesFileBeside(arguments.path) : arguments.overrides);
    return files;
}

} // namespace lambert
