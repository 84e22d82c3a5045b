#include "baking/probe.h"

#include "baking/reconstruction.h"
#include "core/parallel.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace lambert {

namespace {

constexpr float kOnSurface = 1e-4F; ///< of the scene's diagonal
constexpr double kOnlyBacks =
    1e-3;                        ///< of its rays: a point of which no more meet anything but backs is inside something
constexpr double kLeaked = 0.99; ///< of the light: an error as large leaves nothing

struct SurfacePoint {
    std::uint32_t patch;
    glm::vec3 position;
};

/// The front nearest to the point along its normal, within `reach` on either side.
std::optional<SurfacePoint> nearestFront(const SolvedScene& scene, const glm::vec3& position, const glm::vec3& normal,
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

ProbeReading unknown(bool onSurface) {
    const RgbSum nan(std::numeric_limits<double>::quiet_NaN());
    return {nan, nan, onSurface};
}

} // namespace

std::vector<ProbeReading> probeIrradiance(const SolvedScene& scene, const FinalGatherOptions& options,
                                          std::span<const ProbePoint> points, Progress& progress) {
    const float reach = kOnSurface * scene.rays->bounds().diagonal();
    const float lift = scene.rays->originOffset(0.0F);
    const LitPatches lit = litPatches(scene);
    const FinalGather gather(*scene.rays, lit, lightsOf(*scene.scene), varianceWithin(lit, reconstructAverage(lit, {})),
                             options);
    std::vector<ProbeReading> readings(points.size());
    progress.begin("probe", points.size());
    parallelFor(points.size(), 4, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::vec3 normal = glm::normalize(points[i].normal);
            const auto surface = nearestFront(scene, points[i].position, normal, reach);
            const GatherPoint place = surface ? pointInside(*scene.rays, scene.mesh, surface->patch, surface->position)
                                              : GatherPoint{points[i].position, normal, lift};
            const GatheredLight light = gather.at(place, static_cast<std::uint32_t>(i));
            const RgbSum irradiance = light.irradiance();
            const RgbSum error = light.standardError();
            const bool leaked = sumOf(irradiance) > 0.0 && sumOf(error) >= kLeaked * sumOf(irradiance);
            readings[i] = light.covered > 1.0 - kOnlyBacks || (leaked && !surface)
                              ? unknown(surface.has_value())
                              : ProbeReading{irradiance, error, surface.has_value()};
        }
        progress.advance(end - begin);
    });
    progress.end();
    return readings;
}

} // namespace lambert
