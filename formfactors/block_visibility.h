#pragma once

#include "formfactors/blocking.h"
#include "formfactors/extents.h"
#include "formfactors/occluders.h"
#include "formfactors/patch_blocks.h"
#include "meshing/patch_mesh.h"
#include "scene/rays/ray_caster.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// What can be said without rays of the lines between two blocks of patches, or between a patch and a block: that the scene
/// hides none of them, or one of its polygons all of them.
///
/// E. A. Haines, J. R. Wallace, "Shaft culling for efficient ray-traced radiosity", Eurographics Workshop on Rendering 1991.
class BlockVisibility {
public:
    /// Points within `tolerance` (metres) of a plane count as in it. `scene` is that of `mesh`.
    BlockVisibility(const Scene& scene, const PatchMesh& mesh, const PatchBlocks& blocks, double tolerance);

    /// Of all lines from patches of one block to patches of the other.
    Blocking between(std::uint32_t a, std::uint32_t b) const;

    /// Of all lines from a patch of block `a` to patches of block `b`: as above, or found out where few polygons stand between.
    Blocking between(const ConvexPolygon& patch, const Plane& plane, std::uint32_t a, std::uint32_t b) const;

private:
    /// A block; of a flat one the rectangle around its patches.
    struct Hull {
        ConvexPolygon polygon; ///< empty: not flat
        Plane plane;
        Extents extents; ///< of the patches
    };
    /// Of a binary tree over blocks, or over occluders.
    struct Node {
        Extents extents;
        std::uint32_t item;                ///< of a leaf; else the highest below
        std::uint32_t left = 0, right = 0; ///< children; 0: a leaf
    };
    using Tree = std::vector<Node>; ///< the root first
    struct Leaf {
        Extents extents;
        std::uint32_t item;
    };
    /// What block `a` has with blocks of a higher number: for each the first of its candidates, and how many.
    struct Row {
        std::vector<std::uint32_t> first;
        std::vector<std::uint8_t> count; ///< kHidden, kMany, or how many there are in the list; 0: all is clear
        std::vector<std::uint32_t> candidates;
    };
    static constexpr std::uint8_t kHidden = 255, kMany = 254;
    static constexpr std::size_t kMostCandidates = 8;

    class Search;

    static Tree treeOver(std::vector<Leaf> leaves);
    static std::uint32_t addNode(Tree& tree, std::span<Leaf> leaves);
    Blocking between(const ConvexPolygon& a, const Plane& planeA, const ConvexPolygon& b, const Plane& planeB,
                     const Occluder& occluder) const;

    double tolerance_;
    Directions directions_;
    Occluders occluders_;
    std::vector<Hull> hulls_; ///< by block
    Tree blockTree_;
    Tree smallTree_;                   ///< of occluders smaller than most blocks
    std::vector<std::uint32_t> large_; ///< the other occluders
    std::vector<Row> rows_;            ///< by block
};

} // namespace lambert
