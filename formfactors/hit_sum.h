#pragma once

#include "formfactors/form_factor_method.h"
#include "meshing/patch_lookup.h"
#include "scene/rays/ray_caster.h"

namespace lambert {

/// What each ray of a packet ends on: the patch whose front it meets, or `back` for a black back and `out` for nothing. Without
/// meaning for inactive rays.
void findTargets(const PatchLookup& lookup, const RayPacket& packet, std::uint32_t back, std::uint32_t out,
                 std::uint32_t (&target)[RayPacket::kSize]);

/// Adds what rays carry to the patches that they hit: to the front that is met, to the second side where a two-sided polygon
/// is met from behind, to the row's remainders for black backs and for rays that leave the scene. Runs of neighbouring rays
/// that meet the same patch are added up first.
class HitSum {
public:
    HitSum(const PatchLookup& lookup, RowAccumulator& accumulator)
        : lookup_(lookup), accumulator_(accumulator), target_(accumulator.out()) {}
    ~HitSum() { accumulator_.add(target_, sum_); }
    HitSum(const HitSum&) = delete;
    HitSum& operator=(const HitSum&) = delete;

    /// Traced rays with a weight each; those of inactive rays must be 0. `weightSum` is the sum of all.
    void add(const RayPacket& packet, const float (&weight)[RayPacket::kSize], double weightSum);
    /// Traced rays that carry `weight` each, the first `count` of the packet.
    void add(const RayPacket& packet, int count, double weight);

private:
    using Targets = std::uint32_t[RayPacket::kSize];

    void start(std::uint32_t target) {
        if (target == target_) return;
        accumulator_.add(target_, sum_);
        target_ = target;
        sum_ = 0.0;
    }

    const PatchLookup& lookup_;
    RowAccumulator& accumulator_;
    std::uint32_t target_;
    double sum_ = 0.0;
};

} // namespace lambert
