#include "baking/probe.h"

#include "baking/interpolation.h"
#include "core/parallel.h"
#include "formfactors/hemicube.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <optional>

namespace lambert {

namespace {

constexpr float kOnSurface = 1e-4F; ///< of the scene's diagonal

struct SurfacePoint {
    std::uint32_t patch;
    glm::vec3 position;
};

/// The front nearest to the point along its normal, within `reach` on either side.
std::optional<SurfacePoint> nearestFront(const BakedScene& scene, const glm::vec3& position, const glm::vec3& normal,
                                         float reach) {
    std::optional<SurfacePoint> best;
    float bestDistance = reach;
    float passed = 0.0F;
    while (passed < 2.0F * reach) {
        const Ray ray{position + (reach - passed) * normal, -normal, 2.0F * reach - passed};
        const auto hit = scene.rays->closest(ray);
        if (!hit) break;
        const float height = reach - passed - hit->distance; // of the surface above the point
        std::uint32_t patch = scene.mesh.lookup.patchAt(hit->polygon, hit->u, hit->v);
        if (!hit->front) patch = scene.mesh.lookup.backPatch(hit->polygon, patch);
        if (patch != kNone && std::abs(height) <= bestDistance && glm::dot(scene.mesh.normal[patch], normal) > 0.5F) {
            best = SurfacePoint{patch, position + height * normal};
            bestDistance = std::abs(height);
        }
        passed += hit->distance + 1e-3F * reach;
    }
    return best;
}

RgbSum interpolate(const BakedScene& scene, const SurfacePoint& point) {
    const InterpolationWeights weights = interpolationWeights(scene.mesh, point.patch, point.position);
    const auto& corners = scene.baked.faces[point.patch];
    RgbSum sum(0.0);
    for (std::size_t k = 0; k < 4; ++k)
        if (corners[k] != kNone) sum += weights[k] * RgbSum(scene.baked.irradiance[corners[k]]);
    return sum;
}

/// What the patches and the lights without area send to a point in space.
RgbSum gather(const BakedScene& scene, const DirectLight& lights, const Hemicube& hemicube, const ProbePoint& point,
              std::uint32_t index, const glm::vec3& normal, RowAccumulator& accumulator) {
    const glm::vec3 origin = point.position + scene.rays->originOffset(0.0F) * normal;
    hemicube.addHemicube(origin, normal, 0.0F, accumulator);
    FormFactorRow row;
    accumulator.take(row);
    RgbSum sum = lights.irradiance(point.position, normal, index, lightsOf(*scene.scene));
    for (const FormFactor& entry : row.entries)
        sum += static_cast<double>(entry.value) * scene.solution.radiosity[entry.patch];
    return sum;
}

} // namespace

std::vector<ProbeReading> probeIrradiance(const BakedScene& scene, std::span<const ProbePoint> points) {
    const float reach = kOnSurface * scene.rays->bounds().diagonal();
    const Hemicube hemicube(scene.mesh, *scene.rays, {});
    const DirectLight lights(*scene.rays, {});
    std::vector<RowAccumulator> accumulators(static_cast<std::size_t>(threadCount()),
                                             RowAccumulator(scene.mesh.size()));
    std::vector<ProbeReading> readings(points.size());
    parallelFor(points.size(), 16, [&](std::size_t begin, std::size_t end, int worker) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::vec3 normal = glm::normalize(points[i].normal);
            const auto surface = nearestFront(scene, points[i].position, normal, reach);
            readings[i].onSurface = surface.has_value();
            if (surface && scene.stochastic)
                readings[i].standardError = RgbSum(scene.stochastic->standardError[surface->patch]);
            readings[i].irradiance = surface ? interpolate(scene, *surface)
                                             : gather(scene, lights, hemicube, points[i], static_cast<std::uint32_t>(i),
                                                      normal, accumulators[static_cast<std::size_t>(worker)]);
        }
    });
    return readings;
}

} // namespace lambert
