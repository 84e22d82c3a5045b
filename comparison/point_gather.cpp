#include "comparison/point_gather.h"

#include "core/orthonormal_basis.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/sample_points.h"
#include "core/warps.h"
#include "formfactors/closed_form.h"
#include "formfactors/patch_sampling.h"
#include "scene/surface.h"
#include "solver/direct_light.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lambert {

namespace {

constexpr std::size_t kMostEmitters = 512; ///< patches that are looked at one by one
constexpr int kTile = 4;                   ///< cells along an edge; a packet has a ray in each
static_assert(kTile * kTile == RayPacket::kSize);

/// A patch that emits.
struct Emitter {
    std::vector<glm::dvec3> corners;
    RgbSum radiosity;              ///< B_e
    std::vector<glm::vec3> points; ///< spread over it, somewhat above
    glm::dvec3 normal;
};

bool isTextured(const Scene& scene, const PatchMesh& mesh, std::size_t patch) {
    return static_cast<bool>(scene.materials[mesh.material[patch]].emissionTexture) ||
           scene.materials[mesh.material[patch]].hasHoles();
}

/// Empty where rays shall find the emitters.
std::vector<Emitter> emittersOf(const PatchMesh& mesh, const RayCaster& rays, const PointGatherOptions& options) {
    std::vector<std::uint32_t> patches;
    for (std::uint32_t i = 0; i < mesh.size(); ++i) {
        if (mesh.emittedRadiosity[i] == Rgb(0.0F)) continue;
        if (isTextured(rays.scene(), mesh, i)) return {};
        patches.push_back(i);
    }
    if (patches.size() > kMostEmitters) return {};
    std::vector<Emitter> emitters;
    for (const std::uint32_t i : patches) {
        Emitter emitter;
        for (int k = 0; k < mesh.cornerCount(i); ++k) emitter.corners.emplace_back(mesh.position(i, k));
        emitter.radiosity = RgbSum(mesh.emittedRadiosity[i]);
        emitter.normal = glm::dvec3(mesh.normal[i]);
        const auto wanted = options.emitterPoints / static_cast<std::uint32_t>(patches.size());
        const std::uint32_t count = (std::max(wanted, 1U) + RayPacket::kSize - 1) / RayPacket::kSize * RayPacket::kSize;
        const SamplePoints samples(Sampler::Sobol, count, 2, options.seed + i);
        const PatchPoints surface(mesh, i);
        const glm::vec3 above = rays.originOffset(std::sqrt(mesh.area[i])) * mesh.normal[i];
        for (std::uint32_t k = 0; k < count; ++k)
            emitter.points.push_back(surface.at({samples.at(k, 0), samples.at(k, 1)}) + above);
        emitters.push_back(std::move(emitter));
    }
    return emitters;
}

class PointGather {
public:
    PointGather(const RayCaster& rays, std::span<const PatchLight> lights, const PointGatherOptions& options)
        : rays_(rays),
          lights_(lights),
          options_(options),
          direct_(rays, {.skyRays = options.skyRays, .seed = options.seed}),
          emitters_(emittersOf(*lights.front().mesh, rays, options)) {}

    /// The light of each of the divisions at a point.
    void at(const Receiver& receiver, std::uint32_t index, std::span<RgbSum> sums) const {
        std::fill(sums.begin(), sums.end(), RgbSum(0.0));
        gatherReflected(receiver, index, sums);
        RgbSum same = direct_.irradiance(receiver.position, receiver.normal, index, lightsOf(rays_.scene()));
        for (const Emitter& emitter : emitters_) same += fromEmitter(receiver, emitter);
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
        const RgbSum emitted =
            emitters_.empty() ? std::numbers::pi * RgbSum(emittedRadianceAt(scene, polygon, side, u, v)) : RgbSum(0.0);
        for (std::size_t k = 0; k < lights_.size(); ++k) {
            const PatchLookup& lookup = lights_[k].mesh->lookup;
            std::uint32_t patch = lookup.patchAt(hit, u, v);
            if (!front) patch = lookup.backPatch(hit, patch);
            if (patch != kNone) sums[k] += emitted + reflectance * lights_[k].irradiance[patch];
        }
    }

    RgbSum fromEmitter(const Receiver& receiver, const Emitter& emitter) const {
        const glm::dvec3 point(receiver.position);
        const glm::dvec3 normal(receiver.normal);
        const double factor = pointToPolygon(point, normal, emitter.corners);
        return factor > 0.0 ? factor * visibleShare(receiver, emitter) * emitter.radiosity : RgbSum(0.0);
    }

    /// Of what an emitter sends to the point, by shadow rays to its points, each with the weight cosθ cosθ' / d².
    double visibleShare(const Receiver& receiver, const Emitter& emitter) const {
        const glm::vec3 origin = receiver.position + receiver.lift * receiver.normal;
        ShadowPacket packet;
        std::fill_n(packet.originX, ShadowPacket::kSize, origin.x);
        std::fill_n(packet.originY, ShadowPacket::kSize, origin.y);
        std::fill_n(packet.originZ, ShadowPacket::kSize, origin.z);
        std::fill_n(packet.maxDistance, ShadowPacket::kSize, 1.0F);
        double visible = 0.0;
        double all = 0.0;
        for (std::size_t first = 0; first < emitter.points.size(); first += ShadowPacket::kSize) {
            double weight[ShadowPacket::kSize];
            for (std::size_t lane = 0; lane < ShadowPacket::kSize; ++lane) {
                const glm::vec3 way = emitter.points[first + lane] - origin;
                weight[lane] = geometricTerm(receiver, emitter, glm::dvec3(way));
                packet.directionX[lane] = way.x;
                packet.directionY[lane] = way.y;
                packet.directionZ[lane] = way.z;
                packet.active[lane] = weight[lane] > 0.0 ? -1 : 0;
            }
            rays_.occluded(packet);
            for (std::size_t lane = 0; lane < ShadowPacket::kSize; ++lane) {
                all += weight[lane];
                if (!packet.occluded[lane]) visible += weight[lane];
            }
        }
        return all > 0.0 ? visible / all : 0.0;
    }

    static double geometricTerm(const Receiver& receiver, const Emitter& emitter, const glm::dvec3& way) {
        const double squared = glm::dot(way, way);
        const double here = glm::dot(way, glm::dvec3(receiver.normal));
        const double there = -glm::dot(way, emitter.normal);
        return here > 0.0 && there > 0.0 ? here * there / (squared * squared) : 0.0;
    }

    const RayCaster& rays_;
    std::span<const PatchLight> lights_;
    const PointGatherOptions options_;
    DirectLight direct_;
    std::vector<Emitter> emitters_;
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
