#include "cli/targets.h"

#include "baking/write_baked.h"
#include "core/error.h"
#include "core/whole_file.h"
#include "scene/input_file.h"
#include "scene/mgf_file.h"
#include "scene/obj_lines.h"
#include "scene/overrides_file.h"

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

} // namespace

std::vector<fs::path> filesOfScene(const fs::path& scene) {
    std::vector<fs::path> files{scene};
    if (isMgf(scene)) return filesOfMgf(scene);
    if (formatOf(scene) != BakedFormat::Obj) return files;
    const std::string text = readInputFile(scene);
    ObjLines lines(text);
    while (const auto line = lines.next()) {
        if (line->keyword != "mtllib") continue;
        files.push_back(scene.parent_path() / line->rest); // one name with spaces in it, or several names
        std::string_view rest = line->rest;
        for (std::string_view word = nextWord(rest); !word.empty(); word = nextWord(rest))
            files.push_back(scene.parent_path() / word);
    }
    return files;
}

std::vector<fs::path> inputFiles(const SceneArguments& arguments) {
    std::vector<fs::path> files = filesOfScene(arguments.path);
    files.push_back(arguments.overrides.empty() ? overridesFileBeside(arguments.path) : arguments.overrides);
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
