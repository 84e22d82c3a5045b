#include "cli/targets.h"

#include "baking/write_baked.h"
#include "core/error.h"
#include "core/whole_file.h"
#include "scene/input_file.h"
#include "scene/obj_lines.h"
#include "scene/obj_mtl.h"
#include "scene/scene_reader.h"

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace lambert {

namespace fs = std::filesystem;

namespace {

bool sameFile(const fs::path& a, const fs::path& b) {
    std::error_code error;
    if (fs::equivalent(a, b, error)) return true;
    const fs::path wholeA = fs::weakly_canonical(fs::absolute(a), error);
    if (error) return false;
    const fs::path wholeB = fs::weakly_canonical(fs::absolute(b), error);
    return !error && wholeA == wholeB;
}

/// The names of the images of a material library, as written; what cannot be read has none.
std::vector<std::string> imagesOfMtl(const fs::path& path) {
    std::vector<std::string> images;
    try {
        ObjLines lines(path);
        for (const MtlMaterial& material : readMtl(lines).materials)
            for (const auto* map : {&material.diffuseMap, &material.emissionMap, &material.opacityMap})
                if (*map) images.push_back((*map)->file);
    } catch (const InputError&) {
        // Reading the scene tells what is wrong.
    }
    return images;
}

} // namespace

std::vector<fs::path> filesOfScene(const fs::path& scene) {
    std::vector<fs::path> files{scene};
    if (formatOf(scene) != BakedFormat::Obj) return files;
    const auto named = [&](std::string_view name) {
        return namedFile(scene.parent_path(), std::string(name), {.allowOutsideFiles = true});
    };
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
    return files;
}

void checkTargets(std::span<const fs::path> targets, std::span<const fs::path> inputs) {
    for (std::size_t i = 0; i < targets.size(); ++i) {
        if (targets[i].empty()) continue;
        for (const fs::path& input : inputs)
            if (sameFile(targets[i], input))
                throw UsageError(fmt::format("{}: would overwrite {}", targets[i].string(),
                                             sameFile(input, inputs.front()) ? "the scene" : "what is read"));
        for (std::size_t j = 0; j < i; ++j)
            if (sameFile(targets[i], targets[j]))
                throw UsageError(fmt::format("{}: named twice as a target", targets[i].string()));
        requireWritable(targets[i]);
        std::error_code ignored;
        if (fs::exists(targets[i], ignored) && !fs::is_regular_file(targets[i], ignored))
            throw SystemError(
                fmt::format("{}: cannot write: a device or pipe cannot be replaced by a file", targets[i].string()));
    }
}

} // namespace lambert
