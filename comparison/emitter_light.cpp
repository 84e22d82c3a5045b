#include "comparison/emitter_light.h"

#include "core/parallel.h"
#include "core/random.h"
#include "core/sample_points.h"
#include "formfactors/closed_form.h"
#include "formfactors/patch_sampling.h"
#include "meshing/patch_offset.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

constexpr std::size_t kMostEmitters = 64; ///< patches; where there are more, rays meet enough of them

bool isTextured(const Scene& scene, const PatchMesh& mesh, std::size_t patch) {
    const Material& material = scene.materials[mesh.material[patch]];
    return material.emissionTexture || material.hasHoles();
}

/// Of one patch; `kind` tells these apart.
std::uint64_t seedOf(std::size_t patch, std::uint32_t kind, std::uint64_t seed) {
    const auto key = philox({static_cast<std::uint32_t>(patch), 0, 0, kind}, seed);
    return std::uint64_t{key[0]} << 32 | key[1];
}

std::vector<glm::vec3> pointsOf(const PatchMesh& mesh, std::size_t patch, std::uint32_t count, std::uint64_t seed) {
    const SamplePoints samples(Sampler::Sobol, count, 2, seed);
    const PatchPoints surface(mesh, patch);
    std::vector<glm::vec3> points;
    for (std::uint32_t k = 0; k < count; ++k) points.push_back(surface.at({samples.at(k, 0), samples.at(k, 1)}));
    return points;
}

} // namespace

EmitterLight::EmitterLight(const RayCaster& rays, const PatchMesh& mesh, std::uint32_t points, std::uint64_t seed)
    : rays_(rays) {
    std::vector<std::uint32_t> patches;
    for (std::uint32_t i = 0; i < mesh.size(); ++i) {
        if (mesh.emittedRadiosity[i] == Rgb(0.0F)) continue;
        known_ = known_ && !isTextured(rays.scene(), mesh, i);
        patches.push_back(i);
    }
    known_ = known_ && patches.size() <= kMostEmitters;
    if (!known_) return;
    constexpr std::uint32_t kPacket = ShadowPacket::kSize;
    for (const std::uint32_t i : patches) {
        Emitter emitter;
        for (int k = 0; k < mesh.cornerCount(i); ++k) emitter.corners.emplace_back(mesh.position(i, k));
        emitter.normal = glm::dvec3(mesh.normal[i]);
        emitter.radiosity = RgbSum(mesh.emittedRadiosity[i]);
        const auto wanted = std::max(points / static_cast<std::uint32_t>(patches.size()), 1U);
        emitter.points = pointsOf(mesh, i, (wanted + kPacket - 1) / kPacket * kPacket, seedOf(i, 0x454D4954, seed));
        for (glm::vec3& point : emitter.points) point += patchOriginOffset(rays, mesh, i) * mesh.normal[i];
        emitters_.push_back(std::move(emitter));
    }
}

RgbSum EmitterLight::irradiance(const Receiver& receiver) const {
    RgbSum sum(0.0);
    for (const Emitter& emitter : emitters_) {
        const double factor =
            pointToPolygon(glm::dvec3(receiver.position), glm::dvec3(receiver.normal), emitter.corners);
        if (factor > 0.0) sum += factor * visibleShare(receiver, emitter) * emitter.radiosity;
    }
    return sum;
}

std::vector<RgbSum> EmitterLight::irradiance(const PatchMesh& mesh, std::uint32_t points, std::uint64_t seed) const {
    std::vector<RgbSum> result(mesh.size(), RgbSum(0.0));
    parallelFor(mesh.size(), 16, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t i = begin; i < end; ++i) {
            const float lift = patchOriginOffset(rays_, mesh, i);
            for (const glm::vec3& point : pointsOf(mesh, i, points, seedOf(i, 0x52454356, seed)))
                result[i] += irradiance({point, mesh.normal[i], lift}) / static_cast<double>(points);
        }
    });
    return result;
}

double EmitterLight::visibleShare(const Receiver& receiver, const Emitter& emitter) const {
    constexpr std::size_t kLanes = ShadowPacket::kSize;
    const glm::vec3 origin = receiver.position + receiver.lift * receiver.normal;
    ShadowPacket packet;
    std::fill_n(packet.originX, kLanes, origin.x);
    std::fill_n(packet.originY, kLanes, origin.y);
    std::fill_n(packet.originZ, kLanes, origin.z);
    std::fill_n(packet.maxDistance, kLanes, 1.0F);
    double visible = 0.0;
    double all = 0.0;
    for (std::size_t first = 0; first < emitter.points.size(); first += kLanes) {
        double weight[kLanes];
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const glm::vec3 way = emitter.points[first + lane] - origin;
            weight[lane] = geometricTerm(receiver, emitter, glm::dvec3(way));
            packet.directionX[lane] = way.x;
            packet.directionY[lane] = way.y;
            packet.directionZ[lane] = way.z;
            packet.active[lane] = weight[lane] > 0.0 ? -1 : 0;
        }
        rays_.occluded(packet);
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            all += weight[lane];
            if (!packet.occluded[lane]) visible += weight[lane];
        }
    }
    return all > 0.0 ? visible / all : 0.0;
}

double EmitterLight::geometricTerm(const Receiver& receiver, const Emitter& emitter, const glm::dvec3& way) {
    const double squared = glm::dot(way, way);
    const double here = glm::dot(way, glm::dvec3(receiver.normal));
    const double there = -glm::dot(way, emitter.normal);
    return here > 0.0 && there > 0.0 ? here * there / (squared * squared) : 0.0;
}

} // namespace lambert
