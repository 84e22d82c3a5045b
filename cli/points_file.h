#pragma once

#include "baking/probe.h"

#include <glm/vec3.hpp>

#include <filesystem>
#include <vector>

namespace lambert {

/// A point of a file.
struct SensorPoint {
    glm::dvec3 place; //!< metres, where the scene's file has it
    glm::vec3 normal; //!< need not have unit length, not 0
};

/// Points from a CSV: x,y,z,nx,ny,nz in metres; # starts a comment, one header line is allowed, further columns are not read.
/// Throws InputError with file and line; a file without points is one too.
std::vector<SensorPoint> readPoints(const std::filesystem::path& path);

/// The points in a scene.
std::vector<ProbePoint> pointsInScene(const std::vector<SensorPoint>& points, const Scene& scene);

} // namespace lambert
