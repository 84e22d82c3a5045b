#pragma once

#include "formfactors/hemicube_face.h"
#include "scene/rays/ray_caster.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace lambert {

/// Finds the blocks of a hemicube face's pixels that show nothing but the inside of one polygon: their rays need not be traced.
///
/// Polygons are cones of directions from the origin, bounded by planes through their edges. A block is a polygon's if it lies in that
/// polygon's cone and all others that it may touch are farther away, both with a margin of a quarter pixel, which is much more than
/// rays round. In doubt it is nobody's. Costs time in proportion to the scene's polygons.
class BlockCover {
public:
    static constexpr int kSize = 8; ///< pixels along a block's edge

    /// `scene`, prepared, must outlive it.
    BlockCover(const Scene& scene, const glm::vec3& origin);

    /// Turns to a face of the hemicube.
    void face(const HemicubeFace& face, int resolution);

    /// The polygon that the block with the pixel (column, row) shows; kNone if its rays have to be traced.
    std::uint32_t polygonAt(int column, int row) const {
        return polygon_[static_cast<std::size_t>(row / kSize * blockColumns_ + column / kSize)];
    }

    /// What RayCaster::closest finds for the tile of 4 × 4 pixels that begins at (column, row), in a block of `polygon`.
    void hits(std::uint32_t polygon, int column, int row, RayPacket& packet) const;

private:
    using Corners = std::array<glm::dvec3, 4>;

    /// What is known of a row of blocks, as parallel arrays. Depths are 1/t: larger is nearer.
    struct Blocks {
        std::vector<float> coverDepth; ///< least depth of the nearest polygon that covers the block; 0: none
        std::vector<std::uint32_t> coverPolygon;
        std::vector<float> depth, nextDepth;     ///< greatest depths of the two nearest that may touch it
        std::vector<std::uint32_t> depthPolygon; ///< whose the first is
        void reset(std::size_t count);
    };
    struct BlockTest;

    void place(std::uint32_t polygon);
    static void testRow(const BlockTest& test, std::size_t first, std::size_t count, Blocks& blocks);

    const Scene& scene_;
    std::vector<Corners> corners_;     ///< per polygon, relative to the origin; a triangle repeats its last
    std::vector<Corners> faceCorners_; ///< along the face's axes
    int columns_ = 0, rows_ = 0, blockColumns_ = 0, blockRows_ = 0;
    double step_ = 0.0, firstU_ = 0.0, firstV_ = 0.0; ///< of pixel centres
    Blocks blocks_;
    std::vector<std::uint32_t> polygon_;
};

} // namespace lambert
