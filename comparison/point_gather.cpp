#include "comparison/point_gather.h"

#include "core/orthonormal_basis.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/warps.h"
#include "scene/surface.h"
#include "solver/direct_light.h"
#include "solver/emitter_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lambert {

namespace {

constexpr int kTile = 4; ///< cells along an edge; a packet has a ray in each
static_assert(kTile * kTile == RayPacket::kSize);

class PointGather {
public:
    PointGather(const RayCaster& rays, std::span<const PatchLight> lights, const PointGatherOptions& options)
        : rays_(rays),
          lights_(lights),
          options_(options),
          direct_(rays, {.skyRays = options.skyRays, .seed = options.seed}),
          emitters_(rays, *lights.front().mesh, *lights.front().optics, options.seed) {}

    /// The light of each of the divisions at a point.
    void at(const Receiver& receiver, std::uint32_t index, std::span<RgbSum> sums) const {
        std::fill(sums.begin(), sums.end(), RgbSum(0.0));
        gatherReflected(receiver, index, sums);
        RgbSum same = direct_.irradiance(receiver.position, receiver.normal, index, lightsOf(rays_.scene()));
        same += emitters_.irradiance(receiver.position, receiver.normal, receiver.lift, index, options_.emitterRays)
                    .irradiance;
        for (RgbSum& sum : sums) sum += same;
    }

private:
    void gatherReflected(const Receiver& receiver, std::uint32_t index, std::span<RgbSum> sums) const {
        const auto turn = philox({index, 0, 0, 0x5455524E}, options_.seed);
        const OrthonormalBasis frame(receiver.normal, 2.0F * std::numbers::pi_v<float> * uniformFloat(turn[0]));
        const glm::vec3 origin = receiver.position + receiver.lift * receiver.normal;
        RayPacket packet;
        std::fill_n(packet.active, RayPacket::kSize, -1);
        for (int top = 0; top < options_.cells; top += kTile) {
            for (int left = 0; left < options_.cells; left += kTile) {
                aim(left, top, index, frame, packet);
                rays_.closest(origin, packet);
                for (int lane = 0; lane < RayPacket::kSize; ++lane)
                    if (packet.polygon[lane] != kNone) addHit(packet, lane, sums);
            }
        }
        const double share = 1.0 / (static_cast<double>(options_.cells) * options_.cells);
        for (RgbSum& sum : sums) sum *= share;
    }

    /// A ray in each cell of a tile, anywhere in it.
    void aim(int left, int top, std::uint32_t index, const OrthonormalBasis& frame, RayPacket& packet) const {
        for (int lane = 0; lane < RayPacket::kSize; ++lane) {
            const int column = left + lane % kTile;
            const int row = top + lane / kTile;
            const auto bits = philox({index, static_cast<std::uint32_t>(row * options_.cells + column), 0, 0x50474154},
                                     options_.seed);
            const glm::dvec2 place(column + static_cast<double>(uniformFloat(bits[0])),
                                   row + static_cast<double>(uniformFloat(bits[1])));
            const glm::vec3 local(cosineHemisphere(place / static_cast<double>(options_.cells)));
            const glm::vec3 direction = local.x * frame.x + local.y * frame.y + local.z * frame.z;
            packet.directionX[lane] = direction.x;
            packet.directionY[lane] = direction.y;
            packet.directionZ[lane] = direction.z;
        }
    }

    /// A cosine-distributed ray is worth the radiosity of what it meets.
    void addHit(const RayPacket& packet, int lane, std::span<RgbSum> sums) const {
        const Scene& scene = rays_.scene();
        const std::uint32_t hit = packet.polygon[lane];
        const float u = packet.u[lane];
        const float v = packet.v[lane];
        const bool front = packet.facing[lane] < 0.0F;
        const Polygon& polygon = scene.polygons[hit];
        const SurfaceSide side = sideOf(scene, polygon, front);
        if (!side) return;
        const RgbSum reflectance(reflectanceAt(scene, polygon, side, u, v));
        for (std::size_t k = 0; k < lights_.size(); ++k) {
            const PatchLookup& lookup = lights_[k].mesh->lookup;
            std::uint32_t patch = lookup.patchAt(hit, u, v);
            if (!front) patch = lookup.backPatch(hit, patch);
            if (patch != kNone) sums[k] += reflectance * lights_[k].irradiance[patch];
        }
    }

    const RayCaster& rays_;
    std::span<const PatchLight> lights_;
    const PointGatherOptions options_;
    DirectLight direct_;
    EmitterLight emitters_;
};

} // namespace

std::vector<std::vector<RgbSum>> gatherAtPoints(const RayCaster& rays, std::span<const PatchLight> lights,
                                                std::span<const Receiver> receivers, const PointGatherOptions& options,
                                                Progress& progress) {
    const PointGather gather(rays, lights, options);
    std::vector<std::vector<RgbSum>> result(lights.size(), std::vector<RgbSum>(receivers.size()));
    progress.begin("gather reference", receivers.size());
    parallelFor(receivers.size(), 16, [&](std::size_t begin, std::size_t end, int) {
        std::vector<RgbSum> sums(lights.size());
        for (std::size_t i = begin; i < end; ++i) {
            gather.at(receivers[i], static_cast<std::uint32_t>(i), sums);
            for (std::size_t k = 0; k < lights.size(); ++k) result[k][i] = sums[k];
        }
        progress.advance(end - begin);
    });
    progress.end();
    return result;
}

} // namespace lambert
