#pragma once

#include "scene/overrides.h"

#include <filesystem>
#include <optional>

namespace lambert {

/// What a file beside a scene says about reading and changing it; docs/overrides.md describes its keys.
struct OverridesFile {
    std::optional<double> metresPerUnit; //!< > 0
    std::optional<bool> twoSided;        //!< of every material
    SceneOverrides overrides;            //!< in the file's order
};

/// Reads such a file. Throws InputError with the file, the JSON path, what was found and what is allowed: for a key that is
/// not known, a value of the wrong type, a number out of range.
OverridesFile readOverridesFile(const std::filesystem::path& path);

/// Where the file of a scene is looked for: ROOM.lambert.json beside ROOM.obj.
std::filesystem::path overridesFileBeside(const std::filesystem::path& scene);

} // namespace lambert
