#include "solver/patch_rays.h"

#include "core/error.h"
#include "core/low_discrepancy.h"
#include "core/orthonormal_basis.h"
#include "core/random.h"
#include "core/vector_clones.h"
#include "core/vector_warps.h"
#include "formfactors/hit_sum.h"
#include "formfactors/patch_sampling.h"
#include "meshing/patch_offset.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace lambert {

namespace {

constexpr std::size_t kSmallScene = 100; ///< polygons; packets meet most of them, whatever their directions
constexpr std::uint32_t kPatchStream = 0x50415443;

/// Scrambles Sobol points, `keys` being seeds, and turns them into floats.
LAMBERT_VECTOR_CLONES
void scramble(const std::uint32_t* bits, const std::uint32_t* keys, std::size_t count, float* unit) {
#pragma GCC ivdep
    for (std::size_t i = 0; i < count; ++i) unit[i] = uniformFloat(owenScrambled(bits[i], keys[i]));
}

/// From the unit square to cosine-distributed directions about z.
LAMBERT_VECTOR_CLONES
void localDirections(const float* unit, std::size_t count, float* local) {
#pragma GCC ivdep
    for (std::size_t i = 0; i < count; ++i) {
        const DiskPoint p(unit[i], unit[i + count]);
        const float squared = 1.0F - p.squaredRadius;
        local[i] = p.x;
        local[i + count] = p.y;
        local[i + 2 * count] = std::sqrt(squared > 0.0F ? squared : 0.0F);
    }
}

/// Directions to the unit square: the octahedron, unfolded. Neighbours stay neighbours but at the seams.
/// Z. H. Cigolle et al., "A survey of efficient representations for independent unit vectors", JCGT 3(2), 2014.
LAMBERT_VECTOR_CLONES
void unfold(const float* direction, std::size_t count, float* cell) {
    constexpr float kBelowOne = 0.9999999F;
#pragma GCC ivdep
    for (std::size_t i = 0; i < count; ++i) {
        const float x = direction[i];
        const float y = direction[i + count];
        const float z = direction[i + 2 * count];
        const float inverse = 1.0F / (std::abs(x) + std::abs(y) + std::abs(z));
        const float px = x * inverse;
        const float py = y * inverse;
        const float qx = z >= 0.0F ? px : std::copysign(1.0F - std::abs(py), px);
        const float qy = z >= 0.0F ? py : std::copysign(1.0F - std::abs(px), py);
        const float u = 0.5F + 0.5F * qx;
        const float v = 0.5F + 0.5F * qy;
        cell[i] = u < kBelowOne ? (u > 0.0F ? u : 0.0F) : kBelowOne;
        cell[i + count] = v < kBelowOne ? (v > 0.0F ? v : 0.0F) : kBelowOne;
    }
}

/// Few cells: rays of a packet should also start near each other. (On a staircase of a million patches 3 bits beat 2 and 4.)
int directionBits(std::size_t count) { return count >= 512 ? 3 : 2; }

} // namespace

PatchRays::PatchRays(const PatchMesh& mesh, const RayCaster& rays, Sampler sampler)
    : mesh_(mesh),
      rays_(rays),
      sampler_(sampler),
      coherence_(rays.scene().polygons.size() < kSmallScene ? Coherence::High : Coherence::Low) {
    if (sampler != Sampler::Random && sampler != Sampler::Sobol)
        throw UsageError("the sampler of stochastic solvers: allowed are random and sobol");
}

std::size_t PatchRays::make(std::uint64_t seed, Batch& batch) const {
    const std::size_t count = std::accumulate(batch.runs.begin(), batch.runs.end(), std::size_t{0},
                                              [](std::size_t sum, const RayRun& run) { return sum + run.count; });
    batch.bits.resize(4 * count);
    batch.keys.resize(4 * count);
    batch.unit.resize(4 * count);
    batch.runOf.resize(count);
    std::size_t ray = 0;
    for (std::uint32_t r = 0; r < batch.runs.size(); ++r) {
        const RayRun& run = batch.runs[r];
        std::array<std::uint32_t, 4> key{};
        for (std::uint32_t k = 0; k < run.count; ++k, ++ray) {
            const auto index = static_cast<std::uint32_t>(run.first + k);
            if (k == 0 || index == 0)
                key = philox({run.patch, static_cast<std::uint32_t>((run.first + k) >> 32), 0, kPatchStream}, seed);
            const std::uint64_t own = (std::uint64_t{key[0]} << 32) | key[1];
            const auto point = sampler_ == Sampler::Sobol ? sobol4(index) : philox({index, 0, 0, kPatchStream}, own);
            batch.runOf[ray] = r;
            for (std::size_t d = 0; d < 4; ++d) {
                batch.bits[ray + d * count] = point[d];
                batch.keys[ray + d * count] = key[d];
            }
        }
    }
    if (sampler_ == Sampler::Sobol)
        scramble(batch.bits.data(), batch.keys.data(), 4 * count, batch.unit.data());
    else
        std::transform(batch.bits.begin(), batch.bits.end(), batch.unit.begin(), uniformFloat);

    batch.direction.resize(3 * count);
    batch.origin.resize(3 * count);
    localDirections(batch.unit.data(), count, batch.direction.data());
    const float* u = batch.unit.data() + 2 * count;
    ray = 0;
    for (const RayRun& run : batch.runs) {
        const OrthonormalBasis frame(mesh_.normal[run.patch]);
        PatchPoints(mesh_, run.patch)
            .fill(u + ray, count, run.count, patchOriginOffset(rays_, mesh_, run.patch) * frame.z,
                  batch.origin.data() + ray, batch.origin.data() + ray + count, batch.origin.data() + ray + 2 * count);
        for (std::uint32_t k = 0; k < run.count; ++k, ++ray) {
            const float lx = batch.direction[ray];
            const float ly = batch.direction[ray + count];
            const float lz = batch.direction[ray + 2 * count];
            batch.direction[ray] = lx * frame.x.x + ly * frame.y.x + lz * frame.z.x;
            batch.direction[ray + count] = lx * frame.x.y + ly * frame.y.y + lz * frame.z.y;
            batch.direction[ray + 2 * count] = lx * frame.x.z + ly * frame.y.z + lz * frame.z.z;
        }
    }
    return count;
}

void PatchRays::trace(std::uint64_t seed, Batch& batch) const {
    const std::size_t count = make(seed, batch);
    batch.cell.resize(2 * count);
    unfold(batch.direction.data(), count, batch.cell.data());
    batch.all.resize(count);
    std::iota(batch.all.begin(), batch.all.end(), 0U);
    const auto order = batch.sorter.order(batch.cell, count, 2, directionBits(count), batch.all);
    batch.run.resize(count);
    batch.target.resize(count);
    RayPacket packet;
    RayOrigins origins;
    alignas(64) std::uint32_t target[RayPacket::kSize];
    for (std::size_t first = 0; first < count; first += RayPacket::kSize) {
        const std::size_t lanes = std::min<std::size_t>(RayPacket::kSize, count - first);
        for (std::size_t lane = 0; lane < RayPacket::kSize; ++lane) {
            // Past the end the last one again, inactive.
            const Ray ray = batch.ray(order[first + std::min(lane, lanes - 1)]);
            origins.set(static_cast<int>(lane), ray.origin);
            packet.aim(static_cast<int>(lane), ray.direction, lane < lanes);
        }
        rays_.closest(origins, packet, coherence_);
        findTargets(mesh_.lookup, packet, back(), out(), target);
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            batch.run[first + lane] = batch.runOf[order[first + lane]];
            batch.target[first + lane] = target[lane];
        }
    }
}

} // namespace lambert
