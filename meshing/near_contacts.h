#pragma once

#include "meshing/face_lines.h"
#include "meshing/hovering_edges.h"
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

/// Finds what hovers over polygons of a prepared scene nearer to them than patches of `length` metres are long: a lamp below a
/// ceiling, a cupboard before a wall, a rug, the legs of a table. Where light is shut up between two faces, a patch that reaches
/// beyond the outline of one would carry it out, and so would a patch as long as the gap is narrow times many at its rim.
class NearContactFinder {
public:
    /// The scene outlives it.
    NearContactFinder(const Scene& scene, double length);

    /// About `budget` patches more result at most: emitters come first, those along which most light leaves before others, then
    /// long outlines, with strips if there are patches left.
    NearContacts find(double budget) const;

private:
    const Scene& scene_;
    double length_;
    HoveringOutlines found_;
};

} // namespace lambert
