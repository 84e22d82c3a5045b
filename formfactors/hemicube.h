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

/// Form factors from the centre of each patch (or several points of it) through the pixels of a half cube, traced as packets of 4 × 4
/// pixels. In scenes of few polygons most pixels need no ray: see BlockCover.
///
/// M. F. Cohen, D. P. Greenberg, "The hemi-cube: a radiosity solution for complex environments", SIGGRAPH 1985.
class Hemicube : public FormFactorMethod {
public:
    /// `mesh` and `rays` (of the same scene) must outlive the method. The resolution is in pixels along an
    /// edge of the top face: even, 4 to 4096. Throws UsageError for options out of range.
    Hemicube(const PatchMesh& mesh, const RayCaster& rays, const ViewOptions& options);

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
    ViewOptions options_;

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
