#pragma once

#include "scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lambert {

/// Where faces of one plane were found to overlap, of all faces with these nodes and materials.
struct CoplanarOverlap {
    std::uint32_t upperNode = 0, upperMaterial = 0; //!< what is seen there
    std::uint32_t lowerNode = 0, lowerMaterial = 0; //!< what it covers
    double area = 0.0;                              //!< m²
};

struct CoverReport {
    std::vector<CoplanarOverlap> overlaps; //!< the largest first
    std::size_t coveredPolygons = 0;       //!< of which nothing is seen from the front: dropped
    std::size_t cutPolygons = 0;           //!< of which a part is seen: replaced by that
    bool takenAway = true;                 //!< what is covered; else the polygons are as they were
    std::size_t undecidedPolygons = 0;     //!< whose edges could not be untangled: left as they are
};

/// Takes away of polygons what others in the same plane cover (see CoplanarOrder), so that every place shows one thing on each of its
/// sides. What is left of a polygon takes its place in the order; where a back is seen of another polygon than the front, it becomes
/// the back of that one. Points within `tolerance` (metres) of each other, of a line or of a plane count as the same, as in it. Changes nothing
/// where no polygons overlap. Occluders give way to all others, and polygons with holes to those without.
CoverReport coverCoplanar(Scene& scene, float tolerance);

/// Says where polygons overlap, and changes nothing.
CoverReport findCoplanarOverlaps(const Scene& scene, float tolerance);

} // namespace lambert
