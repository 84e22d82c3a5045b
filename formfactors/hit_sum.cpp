#include "formfactors/hit_sum.h"

#include "core/vector_clones.h"

namespace lambert {

namespace {

LAMBERT_VECTOR_CLONES
bool allEqual(const std::uint32_t (&values)[RayPacket::kSize]) {
    std::uint32_t difference = 0;
    for (int lane = 0; lane < RayPacket::kSize; ++lane) difference |= values[lane] ^ values[0];
    return difference == 0;
}

/// Whether every ray met a front or nothing.
LAMBERT_VECTOR_CLONES
bool allFront(const RayPacket& packet) {
    std::uint32_t backs = 0;
    for (int lane = 0; lane < RayPacket::kSize; ++lane)
        backs |= packet.polygon[lane] != kNone && !(packet.facing[lane] < 0.0F) ? 1U : 0U;
    return backs == 0;
}

} // namespace

void findTargets(const PatchLookup& lookup, const RayPacket& packet, std::uint32_t back, std::uint32_t out,
                 std::uint32_t (&target)[RayPacket::kSize]) {
    for (std::uint32_t& t : target) t = out;
    lookup.patchesAt(packet.polygon, packet.u, packet.v, target);
    if (allFront(packet)) return;
    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
        if (packet.polygon[lane] == kNone || packet.facing[lane] < 0.0F) continue;
        const std::uint32_t second = lookup.backPatch(packet.polygon[lane], target[lane]);
        target[lane] = second == kNone ? back : second;
    }
}

void HitSum::add(const RayPacket& packet, const float (&weight)[RayPacket::kSize], double weightSum) {
    alignas(64) Targets target;
    findTargets(lookup_, packet, accumulator_.back(), accumulator_.out(), target);
    if (allEqual(target)) {
        start(target[0]);
        sum_ += weightSum;
        return;
    }
    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
        start(target[lane]);
        sum_ += static_cast<double>(weight[lane]);
    }
}

void HitSum::add(const RayPacket& packet, int count, double weight) {
    alignas(64) Targets target;
    findTargets(lookup_, packet, accumulator_.back(), accumulator_.out(), target);
    for (int lane = 0; lane < count; ++lane) {
        start(target[lane]);
        sum_ += weight;
    }
}

} // namespace lambert
