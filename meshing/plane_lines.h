#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace lambert {

/// Straight lines between points of a plane.
struct PlaneLines {
    std::vector<glm::dvec2> points;                  //!< in the plane, metres
    std::vector<glm::dvec3> places;                  //!< #points, the same in space
    std::vector<std::array<std::uint32_t, 2>> lines; //!< pairs of points
};

/// Cuts lines where they meet: points are added where two cross. Returns per line the points on it, from its first end to its last, so
/// that no two of these pieces cross; or nothing at all if that cannot be had. Points within `tolerance` (metres) of a line lie on it.
/// In space an added point is the middle of the places that both lines give it.
std::vector<std::vector<std::uint32_t>> cutLines(PlaneLines& drawing, double tolerance);

} // namespace lambert
