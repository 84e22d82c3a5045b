#include "vpl/gather.h"

#include "core/error.h"
#include "solver/direct_light.h"
#include "vpl/glossy_sum.h"
#include "vpl/recovery.h"
#include "vpl/shadowed_sum.h"
#include "vpl/sky_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lambert {

namespace {

constexpr std::uint32_t kMostRecoveryRays = 65536;

glm::dvec3 meanOf(const std::vector<glm::dvec3>& values) {
    if (values.empty()) return glm::dvec3(0.0);
    return std::accumulate(values.begin(), values.end(), glm::dvec3(0.0)) / static_cast<double>(values.size());
}

} // namespace

void checkGather(const GatherOptions& options) {
    if (!(options.bound > 0.0))
        throw UsageError(
            fmt::format("bound of the geometric term: found {}, allowed is what is above 0", options.bound));
    if (options.recoveryRays > kMostRecoveryRays)
        throw UsageError(fmt::format("rays that recover light: found {}, allowed are 0 to {}", options.recoveryRays,
                                     kMostRecoveryRays));
    checkDirectLight({.skyRays = options.skyRays});
}

double largestGeometricTerm(const Scene& scene, double bound) {
    if (!std::isfinite(bound)) return bound;
    double area = 0.0;
    for (const Polygon& polygon : scene.polygons) area += polygonArea(scene, polygon);
    return bound / (area / 6.0);
}

Gathered gatherIrradiance(const RayCaster& rays, std::span<const VirtualPointLight> lights,
                          std::span<const Receiver> receivers, const GatherOptions& options, Progress& progress) {
    checkGather(options);
    const bool recovers = options.recoveryRays > 0 && std::isfinite(options.bound);
    const auto glossy = [](const VirtualPointLight& light) { return static_cast<bool>(light.lobe); };
    if (recovers && (anyGlossy(receivers) || std::any_of(lights.begin(), lights.end(), glossy)))
        throw UsageError("what the bound takes away from gloss cannot be recovered");
    const double largestTerm = largestGeometricTerm(rays.scene(), options.bound);
    Gathered result;
    progress.begin("gather light", receivers.size() * lights.size());
    const std::span<const PunctualLight> punctual(rays.scene().lights);
    ShadowedSum sum =
        sumLights(rays, {lights, options.direct ? punctual : punctual.first(0)}, receivers, largestTerm, progress);
    progress.end();
    result.irradiance = std::move(sum.irradiance);
    result.cut = meanOf(sum.cut);
    result.cutAt = std::move(sum.cut);
    result.glossyRadiance = std::move(sum.glossyRadiance);
    result.shadowRays = sum.rays;
    if (options.direct) {
        const std::vector<glm::dvec3> sky = skyLight(rays, receivers, options.skyRays, options.seed, progress);
        for (std::size_t i = 0; i < sky.size(); ++i) result.irradiance[i] += sky[i];
        result.shadowRays += sky.size() * options.skyRays;
        const std::vector<glm::dvec3> shine = glossySkyLight(rays, receivers, options.skyRays, options.seed, progress);
        for (std::size_t i = 0; i < shine.size(); ++i) result.glossyRadiance[i] += shine[i];
        result.shadowRays += shine.size() * options.skyRays;
    }
    if (!recovers) return result;

    Recovered recovered = recoverLight(rays, lights, receivers, largestTerm, options, progress);
    for (std::size_t i = 0; i < receivers.size(); ++i) result.irradiance[i] += recovered.irradiance[i];
    result.recovered = meanOf(recovered.irradiance);
    result.recoveredAt = std::move(recovered.irradiance);
    result.shadowRays += recovered.shadowRays;
    result.recoveryRays = recovered.rays;
    return result;
}

} // namespace lambert
