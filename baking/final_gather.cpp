#include "baking/final_gather.h"

#include "core/error.h"
#include "core/orthonormal_basis.h"
#include "core/random.h"
#include "core/warps.h"
#include "meshing/patch_offset.h"
#include "scene/surface.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace lambert {

namespace {

constexpr int kTile = 4; ///< cells along an edge; a packet has a ray in each
static_assert(kTile * kTile == RayPacket::kSize);
constexpr int kFirstCells = 8; ///< along an edge of the square that is mapped to the directions
constexpr int kMostCells = 64;
constexpr std::uint32_t kFirstShadowRays = 64;
constexpr std::uint32_t kMostShadowRays = 4096;
constexpr std::uint32_t kFirstSkyRays = 64; ///< of each of kSkyBatches
constexpr std::uint32_t kMostSkyRays = 4096;
constexpr int kSkyBatches = 4;
/// What few equal answers may hide: an error of so much per ray.
constexpr double kUnseen = 0.25;
constexpr double kDark = 0.1; ///< of the light of most of the scene

/// Larger than the spread of so few values tells, so that two of them hold 95 % of all errors (Student's distribution).
double studentFactor(int batches) { return batches >= 8 ? 1.18 : 1.59; }

/// What half of the lit area receives no more than, over the channels.
double medianLight(const PatchMesh& mesh, std::span<const RgbSum> irradiance) {
    std::vector<std::uint32_t> order;
    double area = 0.0;
    for (std::uint32_t i = 0; i < irradiance.size(); ++i) {
        if (!(sumOf(irradiance[i]) > 0.0)) continue;
        order.push_back(i);
        area += static_cast<double>(mesh.area[i]);
    }
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return sumOf(irradiance[a]) < sumOf(irradiance[b]); });
    double below = 0.0;
    for (const std::uint32_t i : order) {
        below += static_cast<double>(mesh.area[i]);
        if (below >= 0.5 * area) return sumOf(irradiance[i]);
    }
    return 0.0;
}

/// A ray in each cell of a tile, anywhere in it.
void aim(int left, int top, int cells, std::uint32_t index, const OrthonormalBasis& frame, std::uint64_t seed,
         RayPacket& packet) {
    for (int lane = 0; lane < RayPacket::kSize; lane += 2) {
        const auto cell = static_cast<std::uint32_t>((top + lane / kTile) * cells + left + lane % kTile);
        const auto bits = philox({index, cell, static_cast<std::uint32_t>(cells), 0x47415448}, seed);
        for (int k = 0; k < 2; ++k) {
            const int column = left + (lane + k) % kTile;
            const int row = top + lane / kTile;
            const glm::dvec2 place(column + static_cast<double>(uniformFloat(bits[static_cast<std::size_t>(2 * k)])),
                                   row + static_cast<double>(uniformFloat(bits[static_cast<std::size_t>(2 * k + 1)])));
            const glm::vec3 local(cosineHemisphere(place / static_cast<double>(cells)));
            packet.aim(lane + k, local.x * frame.x + local.y * frame.y + local.z * frame.z);
        }
    }
}

} // namespace

void checkFinalGather(const FinalGatherOptions& options) {
    if (!(options.error >= 1e-4 && options.error <= 1.0))
        throw UsageError(fmt::format("gather error: found {}, allowed are 1e-4 to 1", options.error));
}

LitPatches litPatches(const SolvedScene& scene) {
    LitPatches lit{scene.mesh, scene.optics, *scene.scene, scene.solution};
    if (const StochasticSolution* lines = scene.stochastic()) lit.standardError = lines->standardError;
    return lit;
}

GatherPoint pointInside(const RayCaster& rays, const PatchMesh& mesh, std::uint32_t patch, const glm::vec3& position,
                        float share) {
    const float lift = patchOriginOffset(rays, mesh, patch);
    const glm::vec3 inward = mesh.centroid[patch] - position;
    const float length = glm::length(inward);
    const float step = std::min(length, share * length + 4.0F * lift);
    const glm::vec3 inside = length > 0.0F ? position + step / length * inward : position;
    return {inside, mesh.normal[patch], lift};
}

void GatheredLight::Part::add(const RgbSum& value, const RgbSum& itsVariance, double count) {
    const double all = rays + count;
    const double share = count / all;
    mean += share * (value - mean);
    variance = (1.0 - share) * (1.0 - share) * variance + share * share * itsVariance;
    rays = all;
    ++round;
}

RgbSum GatheredLight::standardError() const {
    return glm::sqrt(reflected.variance + directVariance() + patchError * patchError);
}

FinalGather::FinalGather(const RayCaster& rays, const LitPatches& lit, const LightSources& sources,
                         std::vector<Rgb> variance, const FinalGatherOptions& options)
    : rays_(rays),
      mesh_(lit.mesh),
      irradiance_(lit.solution.irradiance),
      sources_(sources),
      options_(options),
      emitters_(rays, lit.mesh, lit.optics, options.seed),
      variance_(std::move(variance)),
      least_(kDark * medianLight(lit.mesh, lit.solution.irradiance)) {
    checkFinalGather(options);
    reflected_.reserve(mesh_.size());
    for (std::size_t i = 0; i < mesh_.size(); ++i)
        reflected_.emplace_back(RgbSum(lit.optics.reflectance[i]) * glm::max(irradiance_[i], RgbSum(0.0)));
    const Scene& scene = rays.scene();
    varied_.reserve(scene.polygons.size());
    for (const Polygon& polygon : scene.polygons)
        varied_.push_back(polygon.surface != kNone || polygon.backSurface != kNone);
}

GatheredLight FinalGather::begin(const GatherPoint& point, std::uint32_t index) const {
    GatheredLight light;
    refineReflected(point, index, light);
    light.emitted.exact = emitters_.empty();
    if (!light.emitted.exact) emitted(point, index, light.emitted);
    light.sky.exact = sources_.environment == nullptr;
    if (!light.sky.exact) fromSky(point, index, light.sky);
    if (!sources_.lights.empty())
        light.exact = DirectLight(rays_, {.seed = options_.seed})
                          .irradiance(point.position, point.normal, index, {sources_.lights, nullptr});
    return light;
}

void FinalGather::refineDirect(const GatherPoint& point, std::uint32_t index, double share,
                               GatheredLight& light) const {
    for (;;) {
        const double allowed = allowedError(light.irradiance());
        if (sumOf(glm::sqrt(light.directVariance())) <= std::sqrt(1.0 - share) * allowed) return;
        const bool bySky =
            light.emitted.exact || (!light.sky.exact && sumOf(light.sky.variance) > sumOf(light.emitted.variance));
        if (bySky && light.sky.exact) return;
        if (bySky)
            fromSky(point, index, light.sky);
        else
            emitted(point, index, light.emitted);
    }
}

GatheredLight FinalGather::at(const GatherPoint& point, std::uint32_t index) const {
    GatheredLight light = begin(point, index);
    refineDirect(point, index, 0.5, light);
    while (!light.reflected.exact &&
           sumOf(glm::sqrt(light.reflected.variance + light.directVariance())) > allowedError(light.irradiance()))
        refineReflected(point, index, light);
    return light;
}

void FinalGather::refineReflected(const GatherPoint& point, std::uint32_t index, GatheredLight& result) const {
    Part& part = result.reflected;
    const int cells = kFirstCells << part.round;
    part.exact = cells >= kMostCells;
    const auto turn = philox({index, 0, 0, 0x5455524E}, options_.seed);
    const OrthonormalBasis frame(point.normal, 2.0F * std::numbers::pi_v<float> * uniformFloat(turn[0]));
    const glm::vec3 origin = point.position + point.lift * point.normal;
    const Scene& scene = rays_.scene();
    RayPacket packet;
    Rgb light[RayPacket::kSize];
    std::uint32_t met[kMostCells * kMostCells];
    std::size_t metCount = 0;
    RgbSum sum(0.0), squares(0.0);
    int onBacks = 0;
    for (int top = 0; top < cells; top += kTile) {
        for (int left = 0; left < cells; left += kTile) {
            aim(left, top, cells, index, frame, options_.seed, packet);
            rays_.closest(origin, packet);
            const std::span patch(met + metCount, RayPacket::kSize);
            metCount += RayPacket::kSize;
            std::ranges::fill(patch, kNone);
            mesh_.lookup.patchesAt(packet.polygon, packet.u, packet.v, patch);
            for (int lane = 0; lane < RayPacket::kSize; ++lane) {
                light[lane] = Rgb(0.0F);
                const std::uint32_t hit = packet.polygon[lane];
                if (hit == kNone) continue;
                const bool front = packet.facing[lane] < 0.0F;
                const Polygon& polygon = scene.polygons[hit];
                const SurfaceSide side = sideOf(scene, polygon, front);
                std::uint32_t& of = patch[static_cast<std::size_t>(lane)];
                if (!side)
                    of = kNone;
                else if (!front)
                    of = mesh_.lookup.backPatch(hit, of);
                if (of == kNone) {
                    ++onBacks;
                    continue;
                }
                light[lane] = varied_[hit]
                                  ? Rgb(RgbSum(reflectanceAt(scene, polygon, side, packet.u[lane], packet.v[lane])) *
                                        irradiance_[of])
                                  : reflected_[of];
            }
            for (int block = 0; block < 4; ++block) {
                const int lane = block / 2 * 2 * kTile + block % 2 * 2;
                const Rgb twist = light[lane] - light[lane + 1] - light[lane + kTile] + light[lane + kTile + 1];
                sum += RgbSum(light[lane] + light[lane + 1] + light[lane + kTile] + light[lane + kTile + 1]);
                squares += RgbSum(twist * twist);
            }
        }
    }
    const double count = static_cast<double>(cells) * cells;
    result.covered = (result.covered * part.rays + onBacks) / (part.rays + count);
    result.patchError = errorOfPatches(std::span(met, metCount));
    part.add(sum / count, squares / (count * count), count);
}

/// Patches of which much is seen from near weigh most: n of N rays that meet one have in common what it is off by.
RgbSum FinalGather::errorOfPatches(std::span<std::uint32_t> met) const {
    RgbSum squares(0.0);
    if (variance_.empty()) return squares;
    std::ranges::sort(met);
    for (std::size_t k = 0; k < met.size() && met[k] != kNone;) {
        const std::size_t first = k;
        while (k < met.size() && met[k] == met[first]) ++k;
        const double share = static_cast<double>(k - first) / static_cast<double>(met.size());
        squares += share * share * RgbSum(variance_[met[first]]);
    }
    return glm::sqrt(squares);
}

void FinalGather::emitted(const GatherPoint& point, std::uint32_t index, Part& part) const {
    const std::uint32_t count = kFirstShadowRays << part.round;
    const EstimatedLight light =
        emitters_.irradiance(point.position, point.normal, point.lift, index, count, part.round);
    const RgbSum error = studentFactor(8) * light.standardError + kUnseen / count * light.irradiance;
    part.add(light.irradiance, error * error, count);
    part.exact = count >= kMostShadowRays;
}

void FinalGather::fromSky(const GatherPoint& point, std::uint32_t index, Part& part) const {
    const std::uint32_t count = kFirstSkyRays << (2 * part.round);
    RgbSum sum(0.0), squares(0.0);
    for (std::uint32_t k = 0; k < kSkyBatches; ++k) {
        const std::uint64_t seed = randomKey({part.round, k, 0, 0x534B5920}, options_.seed);
        const RgbSum light = DirectLight(rays_, {.skyRays = count, .seed = seed})
                                 .irradiance(point.position, point.normal, index, {{}, sources_.environment});
        sum += light;
        squares += light * light;
    }
    const RgbSum mean = sum / static_cast<double>(kSkyBatches);
    const RgbSum spread =
        glm::max(squares / static_cast<double>(kSkyBatches) - mean * mean, RgbSum(0.0)) / (kSkyBatches - 1.0);
    const double all = static_cast<double>(kSkyBatches) * count;
    const RgbSum error = studentFactor(kSkyBatches) * glm::sqrt(spread) + kUnseen / all * mean;
    part.add(mean, error * error, all);
    part.exact = count >= kMostSkyRays;
}

} // namespace lambert
