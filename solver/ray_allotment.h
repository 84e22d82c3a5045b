#pragma once

#include "core/parallel.h"
#include "meshing/patch_mesh.h"
#include "solver/exchange.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// How many rays each patch gets, given the means n_i A_i: N_i = ⌊C_i + ξ⌋ − ⌊C_{i−1} + ξ⌋ with C their cumulative sum and one ξ for
/// all, so that every N_i has its mean and neighbours make up for each other's rounding. The rays stand in a row, patch by patch.
class RayAllotment {
public:
    /// `xi` in [0, 1). `senders`: #patches, with the densities n; must outlive it, and so must `mesh`.
    RayAllotment(const PatchMesh& mesh, std::span<const Sender> senders, double xi);

    std::uint64_t rays() const { return rays_; } //!< in all

    /// Calls use(patch, first ray, number of rays) for the patches among the rays [first, last), in order, with rays of theirs that lie
    /// before or after these too.
    template <typename Use>
    void visit(std::uint64_t first, std::uint64_t last, Use&& use) const {
        for (std::size_t block = blockOf(first); block + 1 < start_.size(); ++block) {
            if (static_cast<std::uint64_t>(start_[block]) >= last) return;
            visitBlock(block, [&](std::size_t patch, std::uint64_t ray, std::uint64_t count) {
                if (ray < last && ray + count > first) use(patch, ray, count);
            });
        }
    }
    /// The same for all patches, in parallel.
    template <typename Use>
    void visitAll(Use&& use) const {
        parallelFor(start_.size() - 1, 16, [&](std::size_t begin, std::size_t end, int) {
            for (std::size_t block = begin; block < end; ++block) visitBlock(block, use);
        });
    }

private:
    static constexpr std::size_t kBlock = 512; ///< patches

    double mean(std::size_t i) const {
        return static_cast<double>(senders_[i].density) * static_cast<double>(mesh_.area[i]);
    }
    std::size_t blockOf(std::uint64_t ray) const;
    template <typename Use>
    void visitBlock(std::size_t block, Use&& use) const {
        const double start = start_[block];
        double sum = 0.0; // from the block's start, so that the sum at its end is the one that start_ has
        auto ray = static_cast<std::uint64_t>(start);
        for (std::size_t i = block * kBlock; i < std::min((block + 1) * kBlock, mesh_.size()); ++i) {
            sum += mean(i);
            const auto end = static_cast<std::uint64_t>(start + sum);
            if (end > ray) use(i, ray, end - ray);
            ray = end;
        }
    }

    const PatchMesh& mesh_;
    std::span<const Sender> senders_;
    std::vector<double> start_; ///< by block: ξ plus the means of all patches before it
    std::uint64_t rays_ = 0;
};

} // namespace lambert
