#pragma once

#include "core/sample_points.h"
#include "formfactors/cell_sorter.h"
#include "formfactors/form_factor_method.h"
#include "meshing/patch_mesh.h"
#include "scene/rays/ray_caster.h"

#include <span>
#include <vector>

namespace lambert {

struct LocalLinesOptions {
    std::uint32_t lines = 4096;       //!< per patch, 1 to 2^24
    Sampler sampler = Sampler::Sobol; //!< of directions and starting points
    std::uint64_t seed = 1;
};

/// Form factors by counting: lines start uniformly on the patch with cosine-distributed directions, and F_ij is the fraction
/// that meets j's front first. Unbiased; the variance of independent lines is F (1 − F) / N.
/// P. Dutré, K. Bala, P. Bekaert, Advanced Global Illumination, section 6.2.
///
/// The lines of a patch are traced in packets of neighbouring directions.
class LocalLines : public FormFactorMethod {
public:
    /// `mesh` and `rays` (of the same scene) must outlive the method. Throws UsageError for options out of range.
    LocalLines(const PatchMesh& mesh, const RayCaster& rays, const LocalLinesOptions& options);

    void row(std::uint32_t patch, RowAccumulator& accumulator) const override;
    void pointRow(const glm::vec3& origin, const glm::vec3& normal, std::uint32_t index,
                  RowAccumulator& accumulator) const override;
    std::size_t patchCount() const override { return mesh_.size(); }
    std::uint64_t raysPerRow() const override { return options_.lines; }

    /// The lines of a patch in the order in which they are traced: neighbours have neighbouring directions.
    std::vector<Ray> lines(std::uint32_t patch) const;
    /// The same of a point, as pointRow takes it.
    std::vector<Ray> lines(const glm::vec3& origin, const glm::vec3& normal, std::uint32_t index) const;

private:
    struct Lines {
        std::vector<float> points;      ///< of the unit cube, dimension by dimension
        std::vector<float> coordinates; ///< of origins and directions, axis by axis
        std::vector<std::uint32_t> all; ///< all indices
        CellSorter sorter;
        std::span<const std::uint32_t> order; ///< in which to trace them
    };
    /// Directions and order of the lines of one seed.
    void makeDirections(std::uint64_t seed, const glm::vec3& normal, Lines& lines) const;
    void makeLines(std::uint32_t patch, Lines& lines) const;
    void makeLines(const glm::vec3& origin, const glm::vec3& normal, std::uint32_t index, Lines& lines) const;
    std::vector<Ray> inOrder(Lines& lines) const;
    void trace(Lines& lines, RowAccumulator& accumulator) const;

    const PatchMesh& mesh_;
    const RayCaster& rays_;
    LocalLinesOptions options_;
    int cellBits_; ///< lines are sorted into 2^cellBits_ squared cells of directions
};

} // namespace lambert
