#pragma once

#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace lambert {

/// Two polygons that lie in one plane and overlap there.
struct CoplanarPair {
    std::uint32_t one = 0, two = 0; //!< into Scene::polygons, the smaller first
    bool sameFacing = true;         //!< their fronts are on the same side of the plane
};

/// All pairs of polygons that overlap in one plane, ascending. Where they overlap their planes are within `tolerance` (metres) of each
/// other, and each reaches over every edge of the other by more than that: what only touches is no pair.
std::vector<CoplanarPair> coplanarPairs(const Scene& scene, float tolerance);

} // namespace lambert
