#pragma once

#include "meshing/contact_strips.h"
#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace lambert {

/// A polygon over which something hovers, or which hovers itself, and the lines that resolve the light in the gap.
struct NearContact {
    std::uint32_t polygon = 0;
    FaceLines lines; //!< in its planeFrame
};

struct NearContacts {
    std::vector<glm::vec3> vertices;   //!< where lines end on edges: to be added behind the scene's positions
    std::vector<NearContact> contacts; //!< in the polygons' order
};

/// What hovers over polygons nearer to them than patches of `length` metres are long: a lamp below a ceiling, a cupboard before a
/// wall, a rug, the legs of a table. Where light is shut up between two faces, a patch that reaches beyond the outline of one
/// would carry it out, and so would a patch as long as the gap is narrow times many at its rim.
///
/// About `budget` patches more result at most: emitters come first, then long outlines, with strips if there are patches left.
NearContacts findNearContacts(const Scene& scene, double length, double budget);

} // namespace lambert
