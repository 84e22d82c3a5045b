#include "cli/batch_plan.h"
#include "cli/scene_files.h"
#include "cli/targets.h"

#include "core/error.h"
#include "scene/reading/scene_reader.h"

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

namespace lambert {

namespace fs = std::filesystem;

namespace {

/// Absolute, without "." and "..", and without a slash at the end.
fs::path absolutePath(const fs::path& path) {
    const fs::path whole = fs::absolute(path).lexically_normal();
    return whole.has_filename() ? whole : whole.parent_path();
}

bool isFolder(const fs::path& path) {
    std::error_code ignored;
    return fs::is_directory(path, ignored);
}

/// The longest path that both begin with.
fs::path commonFolder(const fs::path& a, const fs::path& b) {
    fs::path common;
    for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end() && *i == *j; ++i, ++j) common /= *i;
    return common;
}

/// The scene files under a folder, by path.
std::vector<fs::path> scenesUnder(const fs::path& folder, const fs::path& outputDir) {
    std::vector<fs::path> scenes;
    std::error_code error;
    fs::path path = folder; // after an error, what was to be opened
    fs::recursive_directory_iterator it(folder, error);
    for (; !error && it != fs::recursive_directory_iterator(); it.increment(error)) {
        path = it->path();
        const bool hidden = path.filename().string().starts_with('.');
        std::error_code vanished;
        if (it->is_directory(vanished)) {
            if (hidden || (!outputDir.empty() && absolutePath(path) == absolutePath(outputDir)))
                it.disable_recursion_pending();
        } else if (!hidden && hasSceneExtension(path) && it->is_regular_file(vanished)) {
            scenes.push_back(path);
        }
    }
    if (error) throw InputError(fmt::format("{}: cannot be searched: {}", path.string(), error.message()));
    if (scenes.empty())
        throw InputError(
            fmt::format("{}: found no scene in this folder, expected {}", folder.string(), sceneExtensions()));
    std::sort(scenes.begin(), scenes.end());
    return scenes;
}

struct FoundScenes {
    std::vector<fs::path> paths;
    fs::path common; //!< absolute folder that all arguments are in
};

FoundScenes findScenes(const BakeArguments& a) {
    FoundScenes found;
    for (const fs::path& argument : a.scenes) {
        const bool folder = isFolder(argument);
        const fs::path whole = absolutePath(argument);
        const fs::path place = folder ? whole : whole.parent_path();
        found.common = found.common.empty() ? place : commonFolder(found.common, place);
        if (!folder) {
            found.paths.push_back(argument);
            continue;
        }
        if (!a.outputDir.empty() && whole == absolutePath(a.outputDir))
            throw UsageError(fmt::format("--output-dir: {} is searched for scenes itself; name another folder, or the "
                                         "scenes in it one by one",
                                         a.outputDir.string()));
        std::ranges::move(scenesUnder(argument, a.outputDir), std::back_inserter(found.paths));
    }
    return found;
}

BakeJob jobOf(const BakeArguments& a, const fs::path& scene, const fs::path& common) {
    const fs::path name = absolutePath(scene).lexically_relative(common).replace_extension();
    const std::string format = a.format.empty() ? "glb" : a.format;
    BakeJob job;
    job.scene = scene;
    if (!a.picture.path.empty()) job.image = boost::replace_all_copy(a.picture.path.string(), "{}", name.string());
    if (!a.solution.empty()) job.solution = boost::replace_all_copy(a.solution.string(), "{}", name.string());
    if (a.outputDir.empty()) return job;
    const auto target = [&](const std::string& extension) {
        return a.outputDir / fs::path(name.string() + "." + extension);
    };
    job.outputs.push_back({target(format), *formatOf(target(format))});
    job.log = target("log");
    return job;
}

fs::path canonicalPath(const fs::path& path) {
    std::error_code error;
    const fs::path whole = fs::weakly_canonical(fs::absolute(path), error);
    return error ? absolutePath(path) : whole;
}

std::vector<fs::path> allTargets(const BakeJob& job) {
    std::vector<fs::path> files = resultFiles(job);
    if (!job.log.empty()) files.push_back(job.log);
    return files;
}

/// Throws UsageError if two of the files to be written are one.
void refuseClashes(const std::vector<BakeJob>& jobs, const fs::path& json) {
    std::map<fs::path, std::string> writers;
    if (!json.empty()) writers.emplace(canonicalPath(json), "--json");
    for (const BakeJob& job : jobs)
        for (const fs::path& target : allTargets(job)) {
            const auto [other, isNew] = writers.emplace(canonicalPath(target), job.scene.string());
            if (!isNew)
                throw UsageError(fmt::format("{} and {} would both be written to {}", other->second, job.scene.string(),
                                             target.string()));
        }
}

/// Throws UsageError if a file to be written is one that some scene is read from.
void refuseOverwriting(const BakeArguments& a, const std::vector<BakeJob>& jobs) {
    const fs::path& json = a.run.json;
    std::vector<fs::path> existing;
    std::error_code ignored;
    for (const BakeJob& job : jobs)
        std::ranges::copy_if(allTargets(job), std::back_inserter(existing),
                             [&](const fs::path& target) { return fs::exists(target, ignored); });
    if (!json.empty() && fs::exists(json, ignored)) existing.push_back(json);
    if (existing.empty()) return; // spares looking into the scenes

    std::set<fs::path> inputs;
    for (const BakeJob& job : jobs) {
        try {
            for (const fs::path& input : filesRead(a, job)) inputs.insert(canonicalPath(input));
        } catch (const InputError&) { // the job itself will say so
            inputs.insert(canonicalPath(job.scene));
        }
    }
    for (const fs::path& target : existing)
        if (inputs.contains(canonicalPath(target)))
            throw UsageError(fmt::format("{}: would overwrite what is read", target.string()));
}

} // namespace

std::vector<BakeJob> planBatch(const BakeArguments& a) {
    const FoundScenes found = findScenes(a);
    std::vector<BakeJob> jobs;
    for (const fs::path& scene : found.paths) jobs.push_back(jobOf(a, scene, found.common));
    if (jobs.size() > 1 && !a.picture.path.empty() && jobs[0].image == jobs[1].image)
        throw UsageError("--image: one picture for several scenes; write {} where the scene's name belongs, as in " +
                         (a.picture.path.parent_path() / "{}").string() + a.picture.path.extension().string());
    refuseClashes(jobs, a.run.json);
    refuseOverwriting(a, jobs);
    return jobs;
}

} // namespace lambert
