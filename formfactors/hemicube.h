#pragma once

#include "formfactors/form_factor_method.h"
#include "formfactors/hemicube_face.h"
#include "formfactors/viewpoints.h"
#include "meshing/patch_mesh.h"
#include "scene/rays/ray_caster.h"

#include <array>
#include <vector>

namespace lambert {

class BlockCover;
class HitSum;

struct HemicubeOptions {
    int resolution = 128;       //!< pixels along an edge of the top face; even, 4 to 4096
    int perPatch = 1;           //!< hemicubes spread over a patch, 1 to 1024; more for patches with near neighbours
    bool randomRotation = true; //!< turns each hemicube about its normal by an angle of its own
    std::uint64_t seed = 1;     //!< of the angles and places
};

/// Form factors from the centre of each patch (or several points of it) through the pixels of a half cube, traced as packets of 4 × 4
/// pixels. In scenes of few polygons most pixels need no ray: see BlockCover.
///
/// M. F. Cohen, D. P. Greenberg, "The hemi-cube: a radiosity solution for complex environments", SIGGRAPH 1985.
class Hemicube : public FormFactorMethod {
public:
    /// `mesh` and `rays` (of the same scene) must outlive the method. Throws UsageError for a resolution out of range.
    Hemicube(const PatchMesh& mesh, const RayCaster& rays, const HemicubeOptions& options);

    void row(std::uint32_t patch, RowAccumulator& accumulator) const override;
    std::size_t patchCount() const override { return mesh_.size(); }
    std::uint64_t raysPerRow() const override;

    void pointRow(const glm::vec3& origin, const glm::vec3& normal, std::uint32_t index,
                  RowAccumulator& accumulator) const override;

    /// One hemicube of a row: `origin` as is, unit `normal`, turned by `angle` (radians).
    void addHemicube(const glm::vec3& origin, const glm::vec3& normal, float angle, RowAccumulator& accumulator) const;

    /// Where the `index`-th hemicube of a patch stands. For whoever traces the same rays.
    Viewpoint viewpoint(std::uint32_t patch, int index = 0) const;

private:
    const PatchMesh& mesh_;
    const RayCaster& rays_;
    bool fewPolygons_;
    HemicubeOptions options_;

    /// 4 × 4 pixels: their delta form factors, the whole hemicube's normalised to the sum 1.
    struct Tile {
        alignas(64) float weight[RayPacket::kSize];
        double sum;
    };
    void addFace(const HemicubeFace& face, const glm::vec3& origin, HitSum& sum) const;
    void addCoveredFace(const HemicubeFace& face, const glm::vec3& origin, BlockCover& cover, HitSum& sum) const;
    static std::vector<Tile> makeTiles(int resolution, bool top);
    std::vector<Tile> topTiles_, sideTiles_; ///< row by row; the four sides are alike
};

} // namespace lambert
