#pragma once

#include "core/hierarchical_warp.h"
#include "scene/surface.h"
#include "scene/texel_average.h"

#include <glm/vec2.hpp>

#include <array>
#include <optional>

namespace lambert {

/// A side of a polygon that emits by a texture: its mean, and points where it is bright. The chart is divided into cells, each of
/// which gets points in proportion to what it emits, so that black parts get none. Holes are left to the caller.
class TexturedEmitter {
public:
    /// `texels` averages the emission texture of `side`; `mostCells` along an axis, a power of two.
    TexturedEmitter(const Scene& scene, const Polygon& polygon, const SurfaceSide& side, const TexelAverage& texels,
                    int mostCells);

    /// By area over the polygon, holes included.
    const glm::dvec3& meanRadiance() const { return mean_; }

    struct Point {
        glm::vec2 chart;     //!< see polygonPoint
        double weight = 1.0; //!< the area's share that its cell has, over the probability of the cell
    };
    /// For a point of the unit square. Only if meanRadiance() is not black.
    Point at(const glm::dvec2& u) const;

private:
    double shareOfCell(int triangle) const;

    bool isQuad_;
    std::array<double, 2> shares_; ///< of the area, in the triangles whose charts have u + v <= 1 and above
    int cells_ = 1;                ///< along an axis
    glm::dvec3 mean_{0.0};
    std::optional<HierarchicalWarp> warp_;
};

} // namespace lambert
