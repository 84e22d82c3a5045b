#include "baking/probe.h"

#include "baking/interpolation.h"
#include "core/parallel.h"
#include "formfactors/matrix_quality.h"
#include "meshing/patch_offset.h"
#include "solver/emitter_light.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace lambert {

namespace {

constexpr float kOnSurface = 1e-4F;         ///< of the scene's diagonal
constexpr std::uint32_t kShadowRays = 1024; ///< of a point, to emitters
constexpr int kRows = 4;                    ///< of a point in space: one for its value, all for its error
constexpr double kOnlyBacks =
    1e-3;                        ///< of its rays: a point of which no more meet anything but backs is inside something
constexpr double kLeaked = 0.99; ///< of the light: an error as large leaves nothing
constexpr float kFromBorder =
    1e-3F; ///< of the way to its centre: a point of a patch's border belongs to that patch alone

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

/// The whole light, in parts that can be had at a point, and the rest.
class Probe {
public:
    Probe(const SolvedScene& scene, const SolveOptions& options, const ReconstructionOptions& reconstruction,
          Progress& progress)
        : scene_(scene),
          lights_(*scene.rays, options.directLight),
          emitters_(*scene.rays, scene.mesh, scene.optics, options.directLight.seed),
          plan_(planOf(scene, options, progress)),
          method_(makeMethod(plan_, scene.mesh, *scene.rays)),
          accumulators_(static_cast<std::size_t>(threadCount()), RowAccumulator(scene.mesh.size())) {
        const std::vector<RgbSum> direct =
            scene.emittersIrradiance.empty() ? emitters_.irradiance(scene.mesh, progress) : scene.emittersIrradiance;
        RadiositySolution reflected;
        reflected.covered = scene.solution.covered;
        reflected.irradiance = scene.solution.irradiance;
        for (std::size_t i = 0; i < direct.size(); ++i) reflected.irradiance[i] -= direct[i];
        for (std::size_t i = 0; i < scene.lightsIrradiance.size(); ++i)
            reflected.irradiance[i] -= scene.lightsIrradiance[i];
        reflected_ = reconstructAverage(scene.mesh, scene.optics, *scene.scene, reflected, reconstruction);
        patchIrradiance_ = std::move(reflected.irradiance);
    }

    ProbeReading onSurface(const SurfacePoint& point, std::uint32_t index) const {
        const PatchMesh& mesh = scene_.mesh;
        if (static_cast<double>(scene_.solution.covered[point.patch]) > kCovered) return unknown(true);
        // A point of a wall's foot is neither before nor behind the wall.
        const float lift = patchOriginOffset(*scene_.rays, mesh, point.patch);
        const glm::vec3 inward = mesh.centroid[point.patch] - point.position;
        const float length = glm::length(inward);
        const float step = std::min(length, kFromBorder * length + 4.0F * lift);
        const glm::vec3 inside = length > 0.0F ? point.position + step / length * inward : point.position;
        ProbeReading reading = direct(inside, mesh.normal[point.patch], lift, index);
        reading.onSurface = true;
        reading.irradiance = glm::max(reading.irradiance + interpolated(point.patch, point.position), 0.0);
        RgbSum error = interpolated(point.patch, mesh.centroid[point.patch]) - patchIrradiance_[point.patch];
        RgbSum squares = reading.standardError * reading.standardError + error * error;
        if (const StochasticSolution* lines = scene_.stochastic()) {
            error = RgbSum(lines->standardError[point.patch]);
            squares += error * error;
        }
        reading.standardError = glm::sqrt(squares);
        return reading;
    }

    ProbeReading inSpace(const glm::vec3& point, const glm::vec3& normal, std::uint32_t index, int worker) {
        RowAccumulator& accumulator = accumulators_[static_cast<std::size_t>(worker)];
        const float lift = scene_.rays->originOffset(0.0F);
        const auto count = static_cast<std::uint32_t>(plan_.options.method == TransportMethod::ClosedForm ? 1 : kRows);
        RgbSum total(0.0), squares(0.0);
        double back = 0.0;
        FormFactorRow row;
        for (std::uint32_t k = 0; k < count; ++k) {
            method_->pointRow(point + lift * normal, normal, count * index + k, accumulator);
            accumulator.take(row);
            RgbSum gathered(0.0);
            for (const auto& [patch, factor] : row.entries)
                gathered += factor * (scene_.solution.radiosity[patch] - RgbSum(scene_.optics.emittedRadiosity[patch]));
            total += gathered;
            squares += gathered * gathered;
            back += row.back / count;
        }
        if (back > 1.0 - kOnlyBacks) return unknown(false);
        ProbeReading reading = direct(point, normal, lift, index);
        const double n = count;
        const RgbSum mean = total / n;
        reading.irradiance += mean;
        if (count > 1) {
            const RgbSum variance = glm::max(squares / n - mean * mean, RgbSum(0.0)) / (n - 1.0);
            reading.standardError = glm::sqrt(reading.standardError * reading.standardError + variance);
        }
        const double light = sumOf(reading.irradiance);
        return light > 0.0 && sumOf(reading.standardError) >= kLeaked * light ? unknown(false) : reading;
    }

private:
    static ProbeReading unknown(bool onSurface) {
        const RgbSum nan(std::numeric_limits<double>::quiet_NaN());
        return {nan, nan, onSurface};
    }

    /// As fine as the options allow, now that there are few rows; where they have none for points, by local lines.
    static TransportPlan planOf(const SolvedScene& scene, const SolveOptions& options, Progress& progress) {
        const auto* const factors = std::get_if<FormFactorLight>(&options.method);
        TransportOptions transport = factors != nullptr ? factors->formFactors.transport : TransportOptions{};
        transport.stored = false;
        transport.mostRays = std::numeric_limits<double>::max();
        transport.randomRotation = true; // or all rows of a point are one
        if (!hasPointRows(transport.method)) {
            transport.method = TransportMethod::LocalLines;
            transport.lines.reset();
        }
        return planTransport(transport, scene.mesh, *scene.rays, progress);
    }

    RgbSum interpolated(std::uint32_t patch, const glm::vec3& position) const {
        const InterpolationWeights weights = interpolationWeights(scene_.mesh, patch, position);
        const auto& corners = reflected_.faces[patch];
        RgbSum result(0.0);
        for (std::size_t k = 0; k < 4; ++k)
            if (corners[k] != kNone) result += weights[k] * RgbSum(reflected_.irradiance[corners[k]]);
        return result;
    }

    /// Of emitters and of lights without area. Of the latter two sets of points and rays tell the error.
    ProbeReading direct(const glm::vec3& point, const glm::vec3& normal, float lift, std::uint32_t index) const {
        const EstimatedLight emitted = emitters_.irradiance(point, normal, lift, index, kShadowRays);
        ProbeReading reading{emitted.irradiance, emitted.standardError};
        const LightSources sources = lightsOf(*scene_.scene);
        if (sources.empty()) return reading;
        const std::array lit{lights_.irradiance(point, normal, 2 * index, sources),
                             lights_.irradiance(point, normal, 2 * index + 1, sources)};
        const RgbSum half = 0.5 * (lit[0] - lit[1]);
        reading.irradiance += 0.5 * (lit[0] + lit[1]);
        reading.standardError = glm::sqrt(reading.standardError * reading.standardError + half * half);
        return reading;
    }

    const SolvedScene& scene_;
    DirectLight lights_;
    EmitterLight emitters_;
    TransportPlan plan_;
    std::unique_ptr<FormFactorMethod> method_;
    std::vector<RowAccumulator> accumulators_;
    std::vector<RgbSum> patchIrradiance_; ///< #patches, without direct light
    BakedMesh reflected_;                 ///< the same at vertices
};

} // namespace

std::vector<ProbeReading> probeIrradiance(const SolvedScene& scene, const SolveOptions& options,
                                          const ReconstructionOptions& reconstruction,
                                          std::span<const ProbePoint> points, Progress& progress) {
    const float reach = kOnSurface * scene.rays->bounds().diagonal();
    Probe probe(scene, options, reconstruction, progress);
    std::vector<ProbeReading> readings(points.size());
    progress.begin("probe", points.size());
    parallelFor(points.size(), 4, [&](std::size_t begin, std::size_t end, int worker) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto index = static_cast<std::uint32_t>(i);
            const glm::vec3 normal = glm::normalize(points[i].normal);
            const auto surface = nearestFront(scene, points[i].position, normal, reach);
            readings[i] =
                surface ? probe.onSurface(*surface, index) : probe.inSpace(points[i].position, normal, index, worker);
        }
        progress.advance(end - begin);
    });
    progress.end();
    return readings;
}

} // namespace lambert
