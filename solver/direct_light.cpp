#include "solver/direct_light.h"

#include "core/error.h"
#include "core/orthonormal_basis.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/warps.h"
#include "formfactors/cell_sorter.h"
#include "formfactors/patch_sampling.h"
#include "meshing/patch_offset.h"
#include "scene/environment.h"
#include "scene/punctual_light.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

namespace lambert {

namespace {

constexpr std::uint32_t kMostPoints = 65536;
constexpr std::uint32_t kMostSkyRays = 1U << 24;

/// A patch or a point that looks for light.
struct Receiver {
    glm::vec3 normal;
    glm::vec3 offset; ///< from a point to the origin of its rays
    const PatchPoints* surface = nullptr;
    glm::vec3 point{0.0F}; ///< without a surface

    glm::vec3 at(const glm::dvec2& u) const { return surface != nullptr ? surface->at(u) : point; }
};

/// A ray that finds out whether light arrives.
struct ShadowRay : Ray {
    RgbSum irradiance{0.0}; ///< what arrives if nothing stands between, where that is known beforehand
};

/// Collects rays into packets, and adds up `gain(ray)` of those that get through.
template <typename Gain>
class ShadowSum {
public:
    ShadowSum(const RayCaster& rays, Gain gain) : rays_(rays), gain_(std::move(gain)) {}

    void add(const ShadowRay& ray) {
        pending_[count_] = ray;
        if (++count_ == ShadowPacket::kSize) trace();
    }

    void flush() {
        if (count_ > 0) trace();
    }
    /// Of all rays that are traced; see flush.
    const RgbSum& value() const { return sum_; }

private:
    void trace() {
        ShadowPacket packet;
        for (int lane = 0; lane < ShadowPacket::kSize; ++lane) {
            // Lanes past the end repeat the last ray, inactive.
            packet.set(lane, pending_[std::min(lane, count_ - 1)], lane < count_);
        }
        rays_.occluded(packet);
        for (int lane = 0; lane < count_; ++lane)
            if (!packet.occluded[lane]) sum_ += gain_(pending_[lane]);
        count_ = 0;
    }

    const RayCaster& rays_;
    Gain gain_;
    ShadowRay pending_[ShadowPacket::kSize];
    int count_ = 0;
    RgbSum sum_{0.0};
};

/// The ray from a point to a light, if light could come along it. It ends `endGap` (metres) before the light: one in a
/// ceiling's plane is not behind it, nor does it graze it.
std::optional<ShadowRay> rayTo(const PunctualLight& light, const Receiver& receiver, const glm::vec3& point,
                               float endGap) {
    const glm::vec3 origin = point + receiver.offset;
    if (light.kind == PunctualLight::Kind::Directional) {
        const float cosine = glm::dot(receiver.normal, -light.direction);
        if (!(cosine > 0.0F)) return std::nullopt;
        return ShadowRay{{origin, -light.direction}, static_cast<double>(cosine) * RgbSum(light.intensity)};
    }
    const glm::vec3 toLight = light.position - point;
    const float height = glm::dot(receiver.normal, toLight);
    const float distance = glm::length(toLight);
    if (!(height > endGap)) return std::nullopt;
    const RgbSum intensity(intensityToward(light, -toLight / distance));
    if (intensity == RgbSum(0.0)) return std::nullopt;
    const auto d = static_cast<double>(distance);
    return ShadowRay{{origin, toLight - receiver.offset, 1.0F - endGap / distance},
                     intensity * (static_cast<double>(height) / (d * d * d))};
}

RgbSum fromPunctual(const RayCaster& rays, const Receiver& receiver, const SamplePoints& samples,
                    std::span<const PunctualLight> lights) {
    const float endGap = rays.originOffset(0.0F);
    std::vector<glm::vec3> points(samples.count());
    for (std::uint32_t k = 0; k < samples.count(); ++k) points[k] = receiver.at({samples.at(k, 0), samples.at(k, 1)});
    ShadowSum sum(rays, [](const ShadowRay& ray) { return ray.irradiance; });
    for (const PunctualLight& light : lights) {
        for (const glm::vec3& point : points)
            if (const auto ray = rayTo(light, receiver, point, endGap)) sum.add(*ray);
        sum.flush(); // no packet for two lights: each alone gets the same bits as among others
    }
    return sum.value() / static_cast<double>(points.size());
}

/// Points of four dimensions; those that are close in the first two follow each other, so that their rays make good packets.
class OrderedPoints {
public:
    void fill(Sampler sampler, std::uint32_t count, std::uint64_t seed) {
        const SamplePoints points(sampler, count, 4, seed);
        count_ = count;
        coordinates_.resize(std::size_t{4} * count);
        for (std::uint32_t d = 0; d < 4; ++d)
            points.fill(0, d, std::span(coordinates_).subspan(std::size_t{d} * count, count));
        all_.resize(count);
        std::iota(all_.begin(), all_.end(), 0U);
        // About four points per cell: a packet spans four cells.
        const int cellBits = std::min((static_cast<int>(std::bit_width(count / 4)) + 1) / 2, 8);
        order_ = sorter_.order(coordinates_, count, 2, cellBits, all_);
    }
    std::span<const std::uint32_t> order() const { return order_; }
    /// Coordinates 2 · `pair` and 2 · `pair` + 1.
    glm::dvec2 at(std::uint32_t index, std::size_t pair) const {
        const float* first = coordinates_.data() + 2 * pair * count_ + index;
        return {static_cast<double>(first[0]), static_cast<double>(first[count_])};
    }

private:
    std::size_t count_ = 0;
    std::vector<float> coordinates_; ///< dimension by dimension
    std::vector<std::uint32_t> all_;
    CellSorter sorter_;
    std::span<const std::uint32_t> order_;
};

/// Both sets of rays count by the balance heuristic (E. Veach, L. Guibas, SIGGRAPH 1995): whichever set a direction ω comes
/// from, it is worth L cosθ / (N_cos cosθ/π + N_map p(ω)).
class EnvironmentRays {
public:
    EnvironmentRays(const Environment& environment, std::uint32_t count)
        : environment_(environment),
          byMap_(environment.distribution() != nullptr ? count / 2 : 0),
          byCosine_(count - byMap_) {}

    RgbSum gather(const RayCaster& rays, const Receiver& receiver, Sampler sampler, std::uint64_t seed) const {
        const OrthonormalBasis frame(receiver.normal);
        ShadowSum sum(rays, [&](const ShadowRay& ray) { return worth(ray.direction, receiver.normal); });
        const auto add = [&](const glm::vec3& direction, const glm::dvec2& place) {
            sum.add({{receiver.at(place) + receiver.offset, direction}});
        };
        thread_local OrderedPoints points; // keeps its memory from patch to patch
        points.fill(sampler, byCosine_, seed);
        for (const std::uint32_t k : points.order()) {
            const glm::vec3 local(cosineHemisphere(points.at(k, 0)));
            add(local.x * frame.x + local.y * frame.y + local.z * frame.z, points.at(k, 1));
        }
        sum.flush();
        if (byMap_ == 0) return sum.value();
        points.fill(sampler, byMap_, ~seed);
        for (const std::uint32_t k : points.order()) {
            const glm::vec3 direction(environment_.distribution()->sample(points.at(k, 0)).direction);
            if (glm::dot(direction, receiver.normal) > 0.0F) add(direction, points.at(k, 1));
        }
        sum.flush();
        return sum.value();
    }

private:
    RgbSum worth(const glm::vec3& direction, const glm::vec3& normal) const {
        const glm::dvec3 d = glm::normalize(glm::dvec3(direction));
        const double cosine = std::max(0.0, glm::dot(d, glm::dvec3(normal)));
        const double density = byCosine_ * cosine / std::numbers::pi +
                               (byMap_ > 0 ? byMap_ * environment_.distribution()->density(d) : 0.0);
        return density > 0.0 ? RgbSum(environment_.radiance(d)) * (cosine / density) : RgbSum(0.0);
    }

    const Environment& environment_;
    std::uint32_t byMap_, byCosine_;
};

RgbSum gather(const RayCaster& rays, const DirectLightOptions& options, const Receiver& receiver, std::uint32_t points,
              std::uint64_t seed, const LightSources& sources) {
    RgbSum sum(0.0);
    if (!sources.lights.empty())
        sum += fromPunctual(rays, receiver, {options.sampler, points, 2, seed}, sources.lights);
    if (sources.environment != nullptr)
        sum += EnvironmentRays(*sources.environment, options.skyRays).gather(rays, receiver, options.sampler, seed + 1);
    return sum;
}

/// Of one patch or point; `kind` tells these apart.
std::uint64_t seedOf(std::uint32_t index, std::uint32_t kind, std::uint64_t seed) {
    return randomKey({index, 0, 0, kind}, seed);
}

} // namespace

LightSources lightsOf(const Scene& scene) { return {scene.lights, scene.environment.get()}; }

DirectLight::DirectLight(const RayCaster& rays, const DirectLightOptions& options) : rays_(rays), options_(options) {
    checkDirectLight(options);
}

std::vector<RgbSum> DirectLight::irradiance(const PatchMesh& mesh, const LightSources& sources,
                                            Progress& progress) const {
    std::vector<RgbSum> result(mesh.size(), RgbSum(0.0));
    if (sources.empty()) return result;
    progress.begin("direct light", mesh.size());
    parallelFor(mesh.size(), 64, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t patch = begin; patch < end; ++patch) {
            if (mesh.isHidden(patch)) continue;
            const PatchPoints surface(mesh, patch);
            const glm::vec3 offset = patchOriginOffset(rays_, mesh, patch) * mesh.normal[patch];
            result[patch] = gather(rays_, options_, {mesh.normal[patch], offset, &surface}, options_.points,
                                   seedOf(static_cast<std::uint32_t>(patch), 0x4C494748, options_.seed), sources);
        }
        progress.advance(end - begin);
    });
    progress.end();
    return result;
}

RgbSum DirectLight::irradiance(const glm::vec3& point, const glm::vec3& normal, std::uint32_t index,
                               const LightSources& sources) const {
    return gather(rays_, options_, {normal, rays_.originOffset(0.0F) * normal, nullptr, point}, 1,
                  seedOf(index, 0x50544C54, options_.seed), sources);
}

void checkDirectLight(const DirectLightOptions& o) {
    if (o.points < 1 || o.points > kMostPoints)
        throw UsageError(fmt::format("--light-points: found {}, allowed are 1 to {}", o.points, kMostPoints));
    if (o.skyRays < 2 || o.skyRays > kMostSkyRays)
        throw UsageError(fmt::format("--sky-rays: found {}, allowed are 2 to {}", o.skyRays, kMostSkyRays));
}

} // namespace lambert
