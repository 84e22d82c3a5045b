#pragma once

#include "meshing/edge_division.h"
#include "scene/box_index.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace lambert {

/// A polygon on which others stand: vertices of the scene that lie inside it, in its plane.
struct PlanarContact {
    std::uint32_t polygon = 0;
    std::vector<std::uint32_t> vertices; //!< strictly inside, ascending; may be empty
    float tolerance = 0.0F;              //!< metres; what is nearer to the border lies on it
};

/// Polygons that have vertices of others inside them, or edges of others across them; in order. `vertices`: those of the scene.
///
/// Light changes abruptly where an object stands on a surface. A patch that lies half under the object would spread the
/// darkness below it to the outside, and the light outside to below it.
std::vector<PlanarContact> findContacts(const Scene& scene, const BoxIndex& vertices);

/// The edges of other polygons that lie inside this one, as divided by `division`: pairs of consecutive vertices.
/// An edge that leaves the polygon is not among them.
std::vector<std::pair<std::uint32_t, std::uint32_t>> contactLines(const PlanarContact& contact, const Scene& scene,
                                                                  const EdgeDivision& division);

} // namespace lambert
