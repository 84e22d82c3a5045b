#pragma once

#include "scene/scene.h"

#include <utility>
#include <vector>

namespace lambert {

/// Every edge of a polygon once, as its two vertices, the smaller first; ascending.
std::vector<std::pair<std::uint32_t, std::uint32_t>> uniqueEdges(const Scene& scene);

/// Points where edges cross without having a vertex there, for instance where the base of a cupboard crosses the seam
/// between two tiles of the floor. Two edges cross if they come closer than `tolerance` (metres) away from their ends.
/// Points closer to each other, or to a vertex of the scene, than that are one.
std::vector<glm::vec3> edgeCrossings(const Scene& scene, float tolerance);

} // namespace lambert
