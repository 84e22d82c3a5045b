#include "scene/reading/changed_scene.h"

#include "core/error.h"
#include "core/text.h"
#include "scene/distant_origin.h"
#include "scene/reading/overrides_file.h"
#include "scene/reading/scene_reader.h"

#include <fmt/format.h>

#include <iterator>
#include <utility>

namespace lambert {

namespace {

/// `later` after `earlier`, so that it wins.
SceneOverrides joined(SceneOverrides earlier, const SceneOverrides& later) {
    earlier.materials.insert(earlier.materials.end(), later.materials.begin(), later.materials.end());
    earlier.nodes.insert(earlier.nodes.end(), later.nodes.begin(), later.nodes.end());
    return earlier;
}

/// The file's settings and the caller's as one.
AppliedOverrides gatherOverrides(const std::filesystem::path& scene, const SceneChanges& c) {
    AppliedOverrides result;
    result.file = overridesFileFor(scene, c);
    OverridesFile file;
    if (!result.file.empty()) file = readOverridesFile(result.file);
    if (!c.metresPerUnit && file.metresPerUnit.value_or(1.0) != 1.0 && isInMetres(scene))
        throw InputError(fmt::format("{}: /unit: found {:g}, allowed is 1: glTF is in metres", result.file.string(),
                                     *file.metresPerUnit));
    result.metresPerUnit = c.metresPerUnit ? *c.metresPerUnit : file.metresPerUnit.value_or(1.0);
    result.twoSided = c.twoSided || file.twoSided.value_or(false);
    if (c.twoSided)
        for (MaterialOverride& change : file.overrides.materials) change.twoSided.reset();
    result.changes = joined(std::move(file.overrides), c.changes);
    return result;
}

/// How much farther from the file's origin that of the scene should be, as its polygons are now.
glm::dvec3 neededShift(const Scene& scene) {
    const Bounds bounds = boundsOf(scene);
    return distantOrigin({glm::dvec3(bounds.lower), glm::dvec3(bounds.upper)});
}

} // namespace

bool isInMetres(const std::filesystem::path& scene) {
    const std::string extension = lowerCase(scene.extension().string());
    return extension == ".gltf" || extension == ".glb";
}

std::filesystem::path overridesFileFor(const std::filesystem::path& scene, const SceneChanges& changes) {
    if (!changes.overrides.empty()) return changes.overrides;
    std::error_code ignored;
    const std::filesystem::path beside = overridesFileBeside(scene);
    return !changes.noOverrides && std::filesystem::exists(beside, ignored) ? beside : std::filesystem::path();
}

ReadResult readChangedScene(const std::filesystem::path& path, const SceneChanges& changes, ReadOptions options) {
    AppliedOverrides overrides = gatherOverrides(path, changes);
    options.metresPerUnit = overrides.metresPerUnit;
    options.twoSided = overrides.twoSided;
    options.origin.reset();
    ReadResult result = readScene(path, options);
    applyOverrides(result.scene, overrides.changes);
    // What is excluded may be all that kept the scene near the file's origin.
    if (const glm::dvec3 shift = neededShift(result.scene); shift != glm::dvec3(0.0)) {
        options.origin = result.scene.origin + shift;
        result = readScene(path, options);
        applyOverrides(result.scene, overrides.changes);
    }
    result.report.overrides = std::move(overrides);
    return result;
}

} // namespace lambert
