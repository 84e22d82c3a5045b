#include "cli/scene_files.h"

#include "baking/write_baked.h"
#include "core/error.h"
#include "core/input_file.h"
#include "scene/gltf/container.h"
#include "scene/gltf/uri.h"
#include "scene/mgf/file.h"
#include "scene/named_file.h"
#include "scene/obj/lines.h"
#include "scene/obj/mtl.h"
#include "scene/reading.h"
#include "scene/reading/overrides_file.h"
#include "scene/words.h"

#include <nlohmann/json.hpp>

#include <functional>
#include <string>
#include <string_view>

namespace lambert {

namespace fs = std::filesystem;

namespace {

/// Finds a file that the scene names as its reader does.
using NamedFile = std::function<fs::path(std::string_view)>;

/// The names of the images of a material library, as written; what cannot be read has none.
std::vector<std::string> imagesOfMtl(const fs::path& path) {
    std::vector<std::string> images;
    try {
        ObjLines lines(path);
        for (const MtlMaterial& material : readMtl(lines).materials)
            for (const auto* map : {&material.diffuseMap, &material.emissionMap, &material.opacityMap})
                if (*map) images.push_back((*map)->file);
    } catch (const InputError&) { // reading the scene tells what is wrong
    }
    return images;
}

void addFilesOfObj(std::vector<fs::path>& files, const fs::path& scene, const NamedFile& named) {
    ObjLines lines(scene);
    while (const auto line = lines.next()) {
        if (line->keyword != "mtllib") continue;
        files.push_back(named(line->rest)); // one name with spaces in it, or several names
        std::string_view rest = line->rest;
        for (std::string_view word = nextWord(rest); !word.empty(); word = nextWord(rest)) files.push_back(named(word));
    }
    const std::vector<fs::path> libraries(files.begin() + 1, files.end());
    for (const fs::path& library : libraries)
        for (const std::string& image : imagesOfMtl(library)) files.push_back(named(image));
}

void addFilesOfGltf(std::vector<fs::path>& files, const fs::path& scene, const NamedFile& named) {
    const std::string content = readInputFile(scene);
    const auto document = nlohmann::json::parse(unpackGltf(scene.string(), content).jsonText, nullptr, false);
    if (!document.is_object()) return;
    for (const char* list : {"buffers", "images"}) {
        const auto found = document.find(list);
        if (found == document.end() || !found->is_array()) continue;
        for (const auto& entry : *found) {
            const auto uri = entry.is_object() ? entry.find("uri") : entry.end();
            if (!entry.is_object() || uri == entry.end() || !uri->is_string()) continue;
            const std::string name = uri->get<std::string>();
            if (!isDataUri(name)) files.push_back(named(pathOfUri(name)));
        }
    }
}

void addFilesOfPly(std::vector<fs::path>& files, const fs::path& scene, const NamedFile& named) {
    constexpr std::string_view kTexture = "TextureFile ";
    ObjLines lines(scene);
    for (auto line = lines.next(); line && line->keyword != "end_header"; line = lines.next())
        if (line->keyword == "comment" && line->rest.starts_with(kTexture))
            files.push_back(named(line->rest.substr(kTexture.size())));
}

} // namespace

std::vector<fs::path> filesOfScene(const fs::path& scene) {
    if (isMgf(scene)) return filesOfMgf(scene);
    std::vector<fs::path> files{scene};
    const auto named = [&](std::string_view name) {
        ReadOptions anywhere;
        anywhere.allowOutsideFiles = true; // reading decides about that; here every file counts
        return namedFile(scene.parent_path(), std::string(name), anywhere);
    };
    const auto format = formatOf(scene);
    if (format == BakedFormat::Obj) addFilesOfObj(files, scene, named);
    if (format == BakedFormat::Ply) addFilesOfPly(files, scene, named);
    if (format == BakedFormat::Gltf || format == BakedFormat::Glb) addFilesOfGltf(files, scene, named);
    return files;
}

std::vector<fs::path> inputFiles(const SceneArguments& arguments) {
    std::vector<fs::path> files = filesOfScene(arguments.path);
    files.push_back(arguments.overrides.empty() ? overridesFileBeside(arguments.path) : arguments.overrides);
    return files;
}

} // namespace lambert
