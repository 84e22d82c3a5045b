#pragma once

#include "core/sample_points.h"
#include "formfactors/cell_sorter.h"
#include "meshing/patch_mesh.h"
#include "scene/rays/ray_caster.h"

#include <cstdint>
#include <vector>

namespace lambert {

/// A run of a patch's sequence of rays.
struct RayRun {
    std::uint32_t patch;
    std::uint64_t first; //!< index of the run's first ray in the patch's sequence
    std::uint32_t count;
};

/// Rays that start uniformly on patches with cosine-distributed directions: a sequence for each patch and seed, of which any run can
/// be had; Sobol points begin anew, scrambled otherwise, after 2^32. For many patches with few rays each; rays of all runs together are sorted by direction and traced in packets.
class PatchRays {
public:
    /// Rays of one batch of runs; one per thread, keeps its memory.
    class Batch {
    public:
        std::vector<RayRun> runs; //!< in, of neighbouring patches; at most 2^16 rays in all

        /// Out: one per ray, in the order in which they were traced.
        std::vector<std::uint32_t> run;    //!< into `runs`
        std::vector<std::uint32_t> target; //!< patch whose front is met, or back(), out()

        /// The i-th, run by run.
        Ray ray(std::size_t i) const {
            const std::size_t count = runOf.size();
            return {{origin[i], origin[i + count], origin[i + 2 * count]},
                    {direction[i], direction[i + count], direction[i + 2 * count]}};
        }

    private:
        friend class PatchRays;
        std::vector<std::uint32_t> bits, keys, runOf, all;
        std::vector<float> unit, origin, direction, cell;
        CellSorter sorter;
    };

    /// `mesh` and `rays` (of the same scene) must outlive it. `sampler`: Random or Sobol, else throws UsageError.
    PatchRays(const PatchMesh& mesh, const RayCaster& rays, Sampler sampler);

    std::uint32_t back() const { return static_cast<std::uint32_t>(mesh_.size()); }    //!< target: a black back
    std::uint32_t out() const { return static_cast<std::uint32_t>(mesh_.size()) + 1; } //!< target: outside of the scene

    void trace(std::uint64_t seed, Batch& batch) const;
    /// Makes the rays of a batch, see Batch::ray, and returns how many; for who does not want them traced.
    std::size_t make(std::uint64_t seed, Batch& batch) const;

private:
    const PatchMesh& mesh_;
    const RayCaster& rays_;
    Sampler sampler_;
    Coherence coherence_;
};

} // namespace lambert
