#pragma once

#include "formfactors/form_factor_method.h"
#include "formfactors/viewpoints.h"
#include "meshing/patch_mesh.h"
#include "scene/rays/ray_caster.h"

#include <vector>

namespace lambert {

/// Form factors from points of each patch through cells of equal weight: the disk of Nusselt's analogue, divided by the
/// concentric map, lifted to the hemisphere. Each of the R² directions is worth 1 / R².
///
/// W. Nusselt, "Graphische Bestimmung des Winkelverhältnisses bei der Wärmestrahlung", VDI-Zeitschrift 72, 1928; P. Shirley,
/// K. Chiu 1997 (core/warps.h).
class Hemisphere : public FormFactorMethod {
public:
    /// `mesh` and `rays` (of the same scene) must outlive the method. The resolution is in cells along an
    /// edge of the square that is mapped to the disk: a multiple of 4, 4 to 4096. Throws UsageError for options out of range.
    Hemisphere(const PatchMesh& mesh, const RayCaster& rays, const ViewOptions& options);

    void row(std::uint32_t patch, RowAccumulator& accumulator) const override;
    void pointRow(const glm::vec3& origin, const glm::vec3& normal, std::uint32_t index,
                  RowAccumulator& accumulator) const override;
    std::size_t patchCount() const override { return mesh_.size(); }
    std::uint64_t raysPerRow() const override;

private:
    void addHemisphere(const Viewpoint& view, const glm::vec3& normal, RowAccumulator& accumulator) const;

    const PatchMesh& mesh_;
    const RayCaster& rays_;
    ViewOptions options_;
    std::vector<glm::vec3> directions_; ///< #R², about +z, in tiles of 4 × 4 cells
};

} // namespace lambert
