#pragma once

#include "core/progress.h"
#include "scene/overrides.h"
#include "scene/scene.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lambert {

struct ReadOptions {
    double metresPerUnit = 1.0;     //!< > 0; must be 1 for glTF, which is always in metres
    bool twoSided = false;          //!< makes every material two-sided
    bool strict = false;            //!< what would be replaced with a warning (a missing image) is an InputError
    bool allowOutsideFiles = false; //!< a scene may name files outside its own folder
    Progress* progress = nullptr;   //!< of huge files
    int curveSegments = 24;         //!< of MGF: straight pieces of a full circle, even, 4 to 1024
    /// A scene with more is an InputError, so that a small file in which much is shown many times cannot fill the memory;
    /// 0: 2^20 and one for each byte of its files, more than any file has that says each polygon once.
    std::size_t mostPolygons = 0;
    /// Metres, the scene's: see Scene::origin. None: readScene finds it, the readers behind it take 0 0 0.
    std::optional<glm::dvec3> origin{};
};

/// What a user changed of a scene, and how.
struct AppliedOverrides {
    std::filesystem::path file; //!< that was used, empty if none
    double metresPerUnit = 1.0;
    bool twoSided = false;
    SceneOverrides changes; //!< in the order in which they were made
};

/// What a reader had to leave out or change.
struct ReadReport {
    std::size_t inputPolygons = 0;      //!< polygons in the file, before any of the below
    std::size_t nonFinitePolygons = 0;  //!< dropped: a coordinate is NaN or infinite
    std::size_t degeneratePolygons = 0; //!< dropped: no area in single precision
    std::size_t splitPolygons = 0;      //!< non-planar or concave quads and larger polygons, split into triangles
    std::size_t missingImages = 0;      //!< could not be read, see the warnings
    /// Metres. Where ReadOptions::origin was none, the origin that the scene needs; if it is not 0 0 0, the scene is not as
    /// good as it can be, and may be empty.
    glm::dvec3 neededOrigin{0.0};
    std::vector<std::string> warnings; //!< one line each, with the file's name
    AppliedOverrides overrides;        //!< made after reading
};

struct ReadResult {
    Scene scene;
    ReadReport report;
};

} // namespace lambert
