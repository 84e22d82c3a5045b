#include "solver/ray_allotment.h"

namespace lambert {

RayAllotment::RayAllotment(const PatchMesh& mesh, std::span<const Sender> senders, double xi)
    : mesh_(mesh), senders_(senders), start_((mesh.size() + kBlock - 1) / kBlock + 1, 0.0) {
    parallelFor(start_.size() - 1, 16, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t block = begin; block < end; ++block)
            for (std::size_t i = block * kBlock; i < std::min((block + 1) * kBlock, mesh_.size()); ++i)
                start_[block + 1] += mean(i);
    });
    start_[0] = xi;
    for (std::size_t block = 1; block < start_.size(); ++block) start_[block] += start_[block - 1];
    rays_ = static_cast<std::uint64_t>(start_.back());
}

/// The first block that may hold the ray.
std::size_t RayAllotment::blockOf(std::uint64_t ray) const {
    const auto after = std::upper_bound(start_.begin(), start_.end(), static_cast<double>(ray));
    return after == start_.begin() ? 0 : static_cast<std::size_t>(after - start_.begin()) - 1;
}

} // namespace lambert
