#include "lighting/stray_light.h"

#include "core/orthonormal_basis.h"
#include "core/sample_points.h"
#include "core/warps.h"
#include "meshing/light_fate.h"
#include "scene/environment.h"
#include "scene/punctual_light.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace lambert {

namespace {

constexpr double kFewRays = 10.0;
constexpr double kStrayShare = 1e-7;      ///< of all rays toward a source
constexpr std::uint32_t kFewestRays = 64; ///< of a patch: among fewer, one that gets through may well be light
constexpr double kStrayPower = 1e-6;      ///< of what is emitted

/// What falls on an unshaded point of a patch from a light without area.
RgbSum unshaded(const PatchMesh& mesh, std::size_t patch, const PunctualLight& light) {
    const glm::dvec3 normal(mesh.normal[patch]);
    if (light.kind == PunctualLight::Kind::Directional)
        return std::max(0.0, -glm::dot(normal, glm::dvec3(light.direction))) * RgbSum(light.intensity);
    const glm::dvec3 toLight = glm::dvec3(light.position) - glm::dvec3(mesh.centroid[patch]);
    const double distance = glm::length(toLight);
    if (!(distance > 0.0)) return RgbSum(0.0);
    const glm::dvec3 direction = toLight / distance;
    return std::max(0.0, glm::dot(normal, direction)) / (distance * distance) *
           RgbSum(intensityToward(light, glm::vec3(-direction)));
}

/// The same from the environment.
RgbSum unshaded(const PatchMesh& mesh, std::size_t patch, const Environment& environment) {
    constexpr std::uint32_t kDirections = 256;
    const SamplePoints points(Sampler::Sobol, kDirections, 2, 0);
    const OrthonormalBasis frame(mesh.normal[patch]);
    RgbSum sum(0.0);
    for (std::uint32_t k = 0; k < kDirections; ++k) {
        const glm::dvec3 local = cosineHemisphere({points.at(k, 0), points.at(k, 1)});
        sum += RgbSum(environment.radiance(glm::normalize(
            local.x * glm::dvec3(frame.x) + local.y * glm::dvec3(frame.y) + local.z * glm::dvec3(frame.z))));
    }
    return sum * (std::numbers::pi / kDirections);
}

std::vector<std::size_t> litPatches(const std::vector<RgbSum>& values) {
    std::vector<std::size_t> lit;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (values[i] != RgbSum(0.0)) lit.push_back(i);
    return lit;
}

/// How many rays of one source may stray.
double mostStrays(std::size_t patches, std::uint32_t raysPerPatch) {
    return std::max(kFewRays, kStrayShare * static_cast<double>(patches) * raysPerPatch);
}

/// Takes the light of one source away if it is that of stray rays, and returns their number.
std::size_t dropStrays(std::vector<RgbSum>& values, std::uint32_t raysPerPatch,
                       const std::function<RgbSum(std::size_t patch)>& unshadedAt) {
    const std::vector<std::size_t> lit = litPatches(values);
    const double most = mostStrays(values.size(), raysPerPatch);
    if (raysPerPatch < kFewestRays || lit.empty() || static_cast<double>(lit.size()) > most) return 0;
    double count = 0.0;
    for (const std::size_t patch : lit) {
        const double whole = sumOf(unshadedAt(patch));
        count += whole > 0.0 ? raysPerPatch * sumOf(values[patch]) / whole : std::numeric_limits<double>::infinity();
    }
    if (!(count <= most)) return 0;
    for (const std::size_t patch : lit) values[patch] = RgbSum(0.0);
    return std::max(lit.size(), static_cast<std::size_t>(std::lround(count)));
}

} // namespace

DirectIrradiance directIrradiance(const PatchMesh& mesh, const RayCaster& rays, const DirectLightOptions& options,
                                  const LightSources& sources, Progress& progress) {
    const DirectLight light(rays, options);
    DirectIrradiance result{light.irradiance(mesh, {sources.lights}, progress)};
    const std::vector<std::size_t> lit = litPatches(result.values);
    if (!lit.empty() && static_cast<double>(lit.size()) <= mostStrays(mesh.size(), options.points)) {
        std::fill(result.values.begin(), result.values.end(), RgbSum(0.0));
        for (const PunctualLight& one : sources.lights) {
            std::vector<RgbSum> values = light.irradiance(mesh, {std::span(&one, 1)}, progress);
            result.strayRays +=
                dropStrays(values, options.points, [&](std::size_t patch) { return unshaded(mesh, patch, one); });
            for (const std::size_t patch : litPatches(values)) result.values[patch] += values[patch];
        }
    }
    if (sources.environment == nullptr) return result;
    std::vector<RgbSum> sky = light.irradiance(mesh, {{}, sources.environment}, progress);
    result.strayRays += dropStrays(sky, options.skyRays,
                                   [&](std::size_t patch) { return unshaded(mesh, patch, *sources.environment); });
    for (std::size_t i = 0; i < sky.size(); ++i) result.values[i] += sky[i];
    return result;
}

void dropStrayLight(const MeshedScene& scene, RadiositySolution& solution) {
    const PatchMesh& mesh = scene.mesh;
    EnergyBalance& energy = solution.energy;
    if (energy.received != RgbSum(0.0)) return;
    const auto isDark = [&](std::size_t patch) { return scene.optics.emittedRadiosity[patch] == Rgb(0.0F); };
    double arrived = 0.0;
    for (std::size_t i = 0; i < mesh.size(); ++i)
        if (isDark(i)) arrived += static_cast<double>(mesh.area[i]) * sumOf(solution.irradiance[i]);
    if (arrived == 0.0 || arrived > kStrayPower * sumOf(energy.emitted) || emissionArrives(*scene.rays)) return;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        if (!isDark(i)) continue;
        energy.absorbed -=
            static_cast<double>(mesh.area[i]) * (1.0 - RgbSum(scene.optics.reflectance[i])) * solution.irradiance[i];
        solution.irradiance[i] = solution.radiosity[i] = RgbSum(0.0);
        for (std::vector<Rgb>& bounce : solution.bounces) bounce[i] = Rgb(0.0F);
    }
}

} // namespace lambert
