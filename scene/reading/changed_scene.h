#pragma once

#include "scene/overrides.h"
#include "scene/reading.h"

#include <filesystem>
#include <optional>

namespace lambert {

/// What is to be changed of a scene as it is read; it wins over the file beside the scene.
struct SceneChanges {
    std::filesystem::path overrides{}; //!< file of further changes; empty: the one beside the scene, if there is one
    bool noOverrides = false;          //!< not even that
    std::optional<double> metresPerUnit{};
    bool twoSided = false; //!< every material
    SceneOverrides changes{};
};

/// The file of changes that counts for a scene; empty if there is none.
std::filesystem::path overridesFileFor(const std::filesystem::path& scene, const SceneChanges& changes);

/// Reads a scene and makes the changes, which then stand in the report. Of `options`, `metresPerUnit`, `twoSided` and `origin`
/// are not used. Throws InputError, UsageError, Cancelled.
ReadResult readChangedScene(const std::filesystem::path& path, const SceneChanges& changes, ReadOptions options = {});

/// Whether files of this name are in metres in any case.
bool isInMetres(const std::filesystem::path& scene);

} // namespace lambert
