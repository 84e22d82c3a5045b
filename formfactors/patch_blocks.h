#pragma once

#include "meshing/patch_mesh.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// The patches of a mesh in blocks of up to 16 neighbours, laid out for vector code. Where a polygon has many patches, its blocks hold
/// no others.
class PatchBlocks {
public:
    static constexpr int kLanes = 16;
    static constexpr int kPoints = 4; ///< Gauss points per patch, 2 × 2

    struct alignas(64) Block {
        float centreX[kLanes], centreY[kLanes], centreZ[kLanes]; ///< metres
        float normalX[kLanes], normalY[kLanes], normalZ[kLanes];
        float radius[kLanes]; ///< of the corners around the centre
        float area[kLanes];   ///< m², holes included; 0 in lanes past the last patch
        float pointX[kPoints][kLanes], pointY[kPoints][kLanes], pointZ[kPoints][kLanes];
        float weight[kPoints][kLanes]; ///< m²
        glm::vec3 centre;              ///< of a sphere around all corners
        float reach;                   ///< its radius
        std::uint32_t patch[kLanes];   ///< the last one is repeated in lanes without
        std::uint32_t count;           ///< lanes with a patch
        bool flat;                     ///< all lie in the plane of the first, and face the same way
    };

    /// What looks at the blocks: a patch, or a point of radius 0.
    struct Viewer {
        glm::vec3 centre, normal;
        float radius = 0.0F;
        std::array<glm::vec3, kPoints> points; ///< a point repeats itself
        std::array<float, kPoints> weights;    ///< of the points, 1 in all

        Viewer(const PatchMesh& mesh, std::size_t patch);
        Viewer(const glm::vec3& point, const glm::vec3& unitNormal);
    };

    /// How a pair is to be integrated.
    enum Kind : std::uint32_t {
        kUnseen, ///< one lies behind the other's plane, or in it
        kDone,   ///< `factor` holds the form factor, to about 1e-3
        kNear    ///< close, or cut by the other's plane: by itself
    };
    /// Form factors if nothing stood between.
    struct alignas(64) Factors {
        float factor[kLanes];
        std::uint32_t kind[kLanes];
    };

    explicit PatchBlocks(const PatchMesh& mesh);

    const std::vector<Block>& blocks() const { return blocks_; }
    std::uint32_t blockOf(std::uint32_t patch) const { return blockOf_[patch]; } ///< into blocks()
    /// Form factors from the viewer to a block's patches; false if the viewer sees none of them. What is nearer to a plane than
    /// `tolerance` (metres) counts as in it.
    static bool factors(const Viewer& viewer, const Block& block, float tolerance, Factors& result);

private:
    void addBlock(const PatchMesh& mesh, std::span<const std::uint32_t> patches);

    std::vector<Block> blocks_;
    std::vector<std::uint32_t> blockOf_;
};

} // namespace lambert
