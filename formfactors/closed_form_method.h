#pragma once

#include "formfactors/form_factor_method.h"
#include "formfactors/occluders.h"
#include "formfactors/patch_clusters.h"
#include "meshing/patch_mesh.h"
#include "scene/rays/ray_caster.h"

#include <vector>

namespace lambert {

struct ClosedFormOptions {
    double error = 1e-4; //!< aimed at in partly hidden factors, relative; 1e-8 to 0.1
};

/// Form factors by integration, without rays and without chance: fully visible pairs to about 1e-6 of their value, partly
/// hidden ones to `error`. Each factor is computed on its own: the rows are not made to close, nor the matrix to be
/// reciprocal, so that both show the error. Takes time that grows with the square of the number of patches, and with the
/// number of polygons that stand between them.
///
/// What an occluder with holes lets through is found with 4096 rays per pair; the holes of a patch are taken as spread evenly
/// over it.
/// Polygons that touch face to face do not see each other.
class ClosedForm : public FormFactorMethod {
public:
    /// `mesh` and `rays` (of the same scene) must outlive the method. Throws UsageError for options out of range.
    ClosedForm(const PatchMesh& mesh, const RayCaster& rays, const ClosedFormOptions& options);

    void row(std::uint32_t patch, RowAccumulator& accumulator) const override;
    /// Exact, as what a point sees of a polygon is a polygon.
    void pointRow(const glm::vec3& origin, const glm::vec3& normal, std::uint32_t index,
                  RowAccumulator& accumulator) const override;
    std::size_t patchCount() const override { return patchCount_; }
    std::uint64_t raysPerRow() const override { return 0; }

private:
    class Row;
    class PointRow;

    const RayCaster& rays_;
    ClosedFormOptions options_;
    std::size_t patchCount_;
    double tolerance_; ///< metres; what is nearer to a plane counts as in it
    Directions directions_;
    Occluders occluders_;
    PatchClusters clusters_;
};

} // namespace lambert
