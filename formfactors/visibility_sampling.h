#pragma once

#include "formfactors/block_visibility.h"
#include "formfactors/form_factor_method.h"
#include "formfactors/local_lines.h"
#include "formfactors/patch_blocks.h"
#include "formfactors/patch_shape.h"
#include "meshing/patch_mesh.h"
#include "scene/rays/ray_caster.h"

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

namespace lambert {

struct VisibilitySamplingOptions {
    double error = 0.01;                  //!< of a row, Σ_j |ΔF_ij|, aimed at; 1e-5 to 0.5
    std::uint32_t mostRaysPerRow = 65536; //!< where the error would take more, it is stated instead; 1024 to 2^24
    std::uint64_t seed = 1;
};

/// Form factors as closed form × visibility: what a patch would see of each other one if nothing stood between is computed (to
/// about 1e-3, for neighbours to 1e-4), and rays between points of both find the share that is visible. Unlike what one viewpoint
/// sees, neither needs patches that are small against their distances, nor pixels that are small against the patches.
///
/// Of blocks of patches that the scene hides wholly or not at all from each other this is found without rays, see BlockVisibility.
///
/// Every row knows its error. A first few rays per pair tell where some are blocked and some are not among neighbouring
/// pairs; there, and in proportion to what is at stake, as many more are traced as bring Σ_j |ΔF_ij| below the error asked for. The
/// first rays only decide and do not count, so that every factor is unbiased before closure. F_back and F_out come from lines
/// through the hemisphere; where these and the pairs disagree, more of them count what near patches see of each other. Within its
/// error the row is then closed, Σ_j F_ij + F_back + F_out = 1.
///
/// J. R. Wallace, K. A. Elmquist, E. A. Haines, "A ray tracing algorithm for progressive radiosity", SIGGRAPH 1989, has the sum of
/// closed forms times visibility from a point.
class VisibilitySampling : public FormFactorMethod {
public:
    /// `mesh` and `rays` (of the same scene) must outlive the method. Throws UsageError for options out of range.
    VisibilitySampling(const PatchMesh& mesh, const RayCaster& rays, const VisibilitySamplingOptions& options);

    void row(std::uint32_t patch, RowAccumulator& accumulator) const override;
    void pointRow(const glm::vec3& origin, const glm::vec3& normal, std::uint32_t index,
                  RowAccumulator& accumulator) const override;
    std::size_t patchCount() const override { return mesh_.size(); }
    /// The mean of all rows so far; a guess before the first.
    std::uint64_t raysPerRow() const override;
    std::uint64_t raysTraced() const override { return raysTraced_; }

    static constexpr std::uint32_t kRemainderLines = 1024; ///< per row, for F_back and F_out
    static constexpr std::uint32_t kMoreLines = 32768;     ///< for rows that are in doubt

private:
    class Row;

    const PatchMesh& mesh_;
    const RayCaster& rays_;
    VisibilitySamplingOptions options_;
    float tolerance_; ///< metres; what is nearer to a plane counts as in it
    LocalLines lines_, moreLines_;
    PatchBlocks blocks_;
    std::optional<BlockVisibility> known_; ///< where it does not take too long
    std::vector<PatchShape> shapes_;
    mutable std::atomic<std::uint64_t> raysTraced_{0}, rowsDone_{0};
};

} // namespace lambert
