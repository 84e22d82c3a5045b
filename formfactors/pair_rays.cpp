#include "formfactors/pair_rays.h"

#include "core/vector_clones.h"

#include <array>
#include <bit>
#include <cmath>

namespace lambert {

namespace {

/// 2^32 φ^−k for k = 1 ... 4, φ the positive root of φ⁵ = φ + 1.
constexpr std::array<std::uint32_t, 4> kSteps{0xDB4F0B91U, 0xBBE05633U, 0xA0F2EC76U, 0x89E18285U};

} // namespace

void PairSample::restart(const std::array<std::uint32_t, 4>& newShift) {
    shift = newShift;
    rays = visible = 0;
    weight[0] = weight[1] = visibleWeight[0] = visibleWeight[1] = 0.0F;
}

void PairSample::setCounted(double counted, double standardError) {
    const double share = counted / static_cast<double>(factor);
    const double spread = standardError / static_cast<double>(factor);
    weight[0] = weight[1] = 1.0F;
    visibleWeight[0] = static_cast<float>(share + spread);
    visibleWeight[1] = static_cast<float>(share - spread);
}

void PairRays::trace(std::span<PairSample> pairs) {
    for (PairSample& pair : pairs)
        for (std::uint32_t k = pair.rays; k < pair.wanted; ++k) add(pair, k);
    if (count_ > 0) flush();
}

void PairRays::add(PairSample& pair, std::uint32_t k) {
    for (std::size_t d = 0; d < 4; ++d) lanes_.place[d][count_] = pair.shift[d] + k * kSteps[d];
    lanes_.weighted[count_] = pair.weighted ? 1 : 0;
    const auto members = std::bit_cast<std::array<float, kMembers>>(shapes_[pair.patch]);
    for (std::size_t m = 0; m < kMembers; ++m) lanes_.shape[m][count_] = members[m];
    pair_[count_] = &pair;
    half_[count_] = k & 1U;
    ++pair.rays;
    if (++count_ == kLanes) flush();
}

/// As PatchShape::at, on both sides, for all lanes at once.
LAMBERT_VECTOR_CLONES
void PairRays::makeRays(const PatchShape& from, int count, Lanes& lanes, ShadowPacket& packet) {
    const auto& s = lanes.shape;
    const PatchShape f = from;
    for (int lane = 0; lane < kLanes; ++lane) {
        float u[4];
        for (int d = 0; d < 4; ++d) u[d] = static_cast<float>(lanes.place[d][lane] >> 8U) * 0x1p-24F;
        const bool fromFirst = u[0] < f.firstShare;
        const float fromPart = fromFirst ? u[0] * f.perFirst : (u[0] - f.firstShare) * f.perRest;
        const float fromRoot = std::sqrt(fromPart < 1.0F ? fromPart : 1.0F);
        const float a = fromRoot * (1.0F - u[1]);
        const float b = fromRoot * u[1];
        const float xx =
            f.corner.x + a * (fromFirst ? f.edge.x : f.diagonal.x) + b * (fromFirst ? f.diagonal.x : f.across.x);
        const float xy =
            f.corner.y + a * (fromFirst ? f.edge.y : f.diagonal.y) + b * (fromFirst ? f.diagonal.y : f.across.y);
        const float xz =
            f.corner.z + a * (fromFirst ? f.edge.z : f.diagonal.z) + b * (fromFirst ? f.diagonal.z : f.across.z);

        const float share = s[15][lane];
        const bool toFirst = u[2] < share;
        const float toPart = toFirst ? u[2] * s[16][lane] : (u[2] - share) * s[17][lane];
        const float toRoot = std::sqrt(toPart < 1.0F ? toPart : 1.0F);
        const float c = toRoot * (1.0F - u[3]);
        const float d = toRoot * u[3];
        const float dx =
            s[0][lane] + c * (toFirst ? s[3][lane] : s[6][lane]) + d * (toFirst ? s[6][lane] : s[9][lane]) - xx;
        const float dy =
            s[1][lane] + c * (toFirst ? s[4][lane] : s[7][lane]) + d * (toFirst ? s[7][lane] : s[10][lane]) - xy;
        const float dz =
            s[2][lane] + c * (toFirst ? s[5][lane] : s[8][lane]) + d * (toFirst ? s[8][lane] : s[11][lane]) - xz;

        const float squared = dx * dx + dy * dy + dz * dz;
        const float inverse = squared > 0.0F ? 1.0F / squared : 0.0F;
        const float here = f.normal.x * dx + f.normal.y * dy + f.normal.z * dz;
        const float there = -(s[12][lane] * dx + s[13][lane] * dy + s[14][lane] * dz);
        const float kernel = here > 0.0F && there > 0.0F ? (here * inverse) * (there * inverse) : 0.0F;
        const float weight = lanes.weighted[lane] != 0 ? kernel : 1.0F;
        lanes.weight[lane] = lane < count ? weight : 0.0F;

        const float lift = s[18][lane];
        packet.originX[lane] = xx + f.lift * f.normal.x;
        packet.originY[lane] = xy + f.lift * f.normal.y;
        packet.originZ[lane] = xz + f.lift * f.normal.z;
        packet.directionX[lane] = dx + lift * s[12][lane] - f.lift * f.normal.x;
        packet.directionY[lane] = dy + lift * s[13][lane] - f.lift * f.normal.y;
        packet.directionZ[lane] = dz + lift * s[14][lane] - f.lift * f.normal.z;
        packet.maxDistance[lane] = 1.0F;
        packet.active[lane] = lanes.weight[lane] > 0.0F ? -1 : 0;
    }
}

void PairRays::flush() {
    makeRays(from_, count_, lanes_, packet_);
    rays_.occluded(packet_);
    for (int lane = 0; lane < count_; ++lane) {
        PairSample& pair = *pair_[lane];
        const float weight = lanes_.weight[lane];
        pair.weight[half_[lane]] += weight;
        if (packet_.occluded[lane]) continue;
        pair.visibleWeight[half_[lane]] += weight;
        ++pair.visible; // where neither sees the other this says nothing
    }
    traced_ += static_cast<std::uint64_t>(count_);
    count_ = 0;
}

} // namespace lambert
