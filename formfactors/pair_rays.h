#pragma once

#include "formfactors/patch_shape.h"
#include "scene/rays/ray_caster.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// What rays between a patch (or a point) and another patch have found so far.
struct PairSample {
    std::uint32_t patch = 0;              ///< the other one
    float factor = 0.0F;                  ///< its form factor if nothing stood between
    bool weighted = false;                ///< rays count by the kernel cos cos / r²: the two are close; else all alike
    bool mixed = false;                   ///< near it some rays are blocked and some are not
    std::array<std::uint32_t, 4> shift{}; ///< random, of its points
    std::uint32_t wanted = 0;             ///< rays that there are to be
    std::uint32_t rays = 0;               ///< traced
    std::uint32_t visible = 0;
    float weight[2] = {}, visibleWeight[2] = {}; ///< of even and of odd rays

    double visibleShare() const {
        const float all = weight[0] + weight[1];
        return all > 0.0F ? static_cast<double>((visibleWeight[0] + visibleWeight[1]) / all) : 0.0;
    }
    /// The share that one half of the rays finds; of a single ray what that finds.
    double half(int which) const {
        return weight[which] > 0.0F ? static_cast<double>(visibleWeight[which] / weight[which]) : visibleShare();
    }
    /// Takes, instead of what rays found, a factor with this standard error.
    void setCounted(double counted, double standardError);
    /// Forgets the rays.
    void restart(const std::array<std::uint32_t, 4>& newShift);
};

/// Traces rays between points of one patch (or a point) and points of others. The points of a pair are an additive recurrence in
/// four dimensions, shifted at random: every ray is uniform on both, and however many there are, they are spread evenly.
///
/// M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018: powers of the generalised golden ratio; shifts:
/// R. Cranley, T. N. L. Patterson, SIAM J. Numer. Anal. 13(6), 1976.
class PairRays {
public:
    /// `from` and `shapes`, by patch, must outlive it.
    PairRays(const RayCaster& rays, const PatchShape& from, const std::vector<PatchShape>& shapes)
        : rays_(rays), from_(from), shapes_(shapes) {}

    /// All rays of the pairs that are wanted and not traced yet.
    void trace(std::span<PairSample> pairs);
    std::uint64_t traced() const { return traced_; }

private:
    void add(PairSample& pair, std::uint32_t k);
    void flush();

    static constexpr int kLanes = ShadowPacket::kSize;
    static constexpr std::size_t kMembers = sizeof(PatchShape) / sizeof(float);
    /// Rays to be traced together.
    struct alignas(64) Lanes {
        std::uint32_t place[4][kLanes]; ///< in the unit cube, times 2^32
        std::uint32_t weighted[kLanes];
        float shape[kMembers][kLanes]; ///< of the other patch, member by member
        float weight[kLanes];          ///< by the kernel, or 1; 0: neither point sees the other
    };
    static void makeRays(const PatchShape& from, int count, Lanes& lanes, ShadowPacket& packet);

    const RayCaster& rays_;
    const PatchShape& from_;
    const std::vector<PatchShape>& shapes_;
    Lanes lanes_{};
    ShadowPacket packet_;
    PairSample* pair_[ShadowPacket::kSize] = {};
    std::uint32_t half_[ShadowPacket::kSize] = {};
    int count_ = 0;
    std::uint64_t traced_ = 0;
};

} // namespace lambert
