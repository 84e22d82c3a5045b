#include "meshing/light_fate.h"

#include "core/orthonormal_basis.h"
#include "core/random.h"
#include "core/warps.h"
#include "meshing/side_points.h"
#include "scene/punctual_light.h"
#include "scene/surface.h"

#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace lambert {

namespace {

constexpr std::uint32_t kRays = 16384, kRaysOfLight = 4096, kLines = 65536;

/// Four numbers in [0, 1) for ray `k`.
std::array<double, 4> randomNumbers(std::uint32_t k) {
    const auto bits = philox({k, 0, 0, 0x46415445}, 0);
    std::array<double, 4> result{};
    for (std::size_t i = 0; i < 4; ++i) result[i] = static_cast<double>(uniformFloat(bits[i]));
    return result;
}

/// Counts what rays meet.
class FateCount {
public:
    explicit FateCount(const RayCaster& rays) : rays_(rays) {}

    /// Whether the ray meets anything.
    bool trace(const glm::vec3& origin, const glm::vec3& direction) {
        const auto hit = rays_.closest(Ray{origin, direction});
        if (!hit) return false;
        const Scene& scene = rays_.scene();
        const Polygon& polygon = scene.polygons[hit->polygon];
        if (isOccluder(scene, polygon)) {
            ++occluders_;
        } else if (const SurfaceSide side = sideOf(scene, polygon, hit->front)) {
            ++(scene.materials[side.material].emittedRadiance != Rgb(0.0F) ? emitters_ : fronts_);
        } else {
            ++backs_;
            ++ofNode_[polygon.node];
            ++ofMaterial_[{polygon.node, polygon.material}];
        }
        return true;
    }
    void countNothing() { ++nothing_; }
    bool isEmpty() const { return all() == 0.0; }

    LightFate fate() const {
        if (isEmpty()) return {};
        LightFate result{fronts_ / all(), emitters_ / all(), backs_ / all(), occluders_ / all(), nothing_ / all()};
        result.arrives = fronts_ > 0.0;
        int most = 0;
        for (const auto& [node, count] : ofNode_)
            if (count > most) std::tie(most, result.node) = std::pair(count, node);
        most = 0;
        for (const auto& [key, count] : ofMaterial_)
            if (key.first == result.node && count > most)
                std::tie(most, result.material) = std::pair(count, key.second);
        return result;
    }

private:
    double all() const { return fronts_ + emitters_ + backs_ + occluders_ + nothing_; }

    const RayCaster& rays_;
    double fronts_ = 0.0, emitters_ = 0.0, backs_ = 0.0, occluders_ = 0.0, nothing_ = 0.0;
    std::map<std::uint32_t, int> ofNode_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> ofMaterial_;
};

/// Where a ray along `direction` begins that crosses the scene's bounding sphere from outside, at a point of its disk.
glm::vec3 outside(const Bounds& bounds, const glm::dvec3& direction, const glm::dvec2& u) {
    const OrthonormalBasis frame{glm::vec3(direction)};
    const double radius = 0.5 * static_cast<double>(bounds.diagonal());
    const glm::dvec2 disk = radius * concentricDisk(u);
    const glm::dvec3 centre = 0.5 * (glm::dvec3(bounds.lower) + glm::dvec3(bounds.upper));
    return glm::vec3(centre - 1.01 * radius * direction + disk.x * glm::dvec3(frame.x) + disk.y * glm::dvec3(frame.y));
}

SidePoints darkSides(const Scene& scene) {
    return {scene,
            [](double area, const Material& material) { return material.emittedRadiance == Rgb(0.0F) ? area : 0.0; }};
}

} // namespace

LightFate fateOfEmission(const RayCaster& rays) {
    const SidePoints emitters = emittingSides(rays.scene());
    if (emitters.empty()) return {};
    FateCount count(rays);
    for (std::uint32_t k = 0; k < kRays; ++k) {
        const auto [one, two, three, four] = randomNumbers(k);
        const SidePoint from = emitters.at((k + 0.5) / kRays, {one, two});
        const OrthonormalBasis frame(from.normal);
        const glm::vec3 local(cosineHemisphere({three, four}));
        const glm::vec3 direction = local.x * frame.x + local.y * frame.y + local.z * frame.z;
        if (!count.trace(from.above(rays), direction)) count.countNothing();
    }
    LightFate fate = count.fate();
    fate.arrives = fate.arrives || emissionArrives(rays);
    return fate;
}

LightFate fateOfLight(const RayCaster& rays, const PunctualLight& light) {
    FateCount count(rays);
    const auto follow = [&](const glm::vec3& direction) {
        if (!count.trace(light.position, direction)) count.countNothing();
    };
    const SidePoints targets(rays.scene(), [](double area, const Material&) { return area; });
    for (std::uint32_t k = 0; k < kRaysOfLight && !targets.empty(); ++k) {
        const auto [one, two, three, four] = randomNumbers(k);
        if (light.kind == PunctualLight::Kind::Directional) {
            count.trace(outside(rays.bounds(), glm::dvec3(light.direction), {one, two}), light.direction);
            continue;
        }
        const glm::vec3 toTarget = targets.at((k + 0.5) / kRaysOfLight, {one, two}).point - light.position;
        const glm::vec3 direction = toTarget / glm::length(toTarget);
        if (std::isfinite(direction.x) && intensityToward(light, direction) != Rgb(0.0F)) follow(direction);
    }
    if (count.isEmpty() && light.kind != PunctualLight::Kind::Directional)
        for (std::uint32_t k = 0; k < kRaysOfLight; ++k) {
            const auto [one, two, three, four] = randomNumbers(k);
            follow(glm::vec3(sampleDirection(light, {one, two})));
        }
    return count.fate();
}

LightFate fateOfEnvironment(const RayCaster& rays) {
    FateCount count(rays);
    for (std::uint32_t k = 0; k < kRays; ++k) {
        const auto [one, two, three, four] = randomNumbers(k);
        const glm::dvec3 direction = uniformSphere({one, two});
        count.trace(outside(rays.bounds(), direction, {three, four}), glm::vec3(direction));
    }
    return count.fate();
}

bool emissionArrives(const RayCaster& rays) {
    const SidePoints emitters = emittingSides(rays.scene()), receivers = darkSides(rays.scene());
    if (emitters.empty() || receivers.empty()) return false;
    for (std::uint32_t k = 0; k < kLines; ++k) {
        const auto [one, two, three, four] = randomNumbers(k);
        const double share = static_cast<double>(uniformFloat(philox({k, 1, 0, 0x46415445}, 0)[0]));
        const SidePoint from = emitters.at((k + 0.5) / kLines, {one, two}), to = receivers.at(share, {three, four});
        const glm::vec3 line = to.point - from.point;
        if (!(glm::dot(line, from.normal) > 0.0F) || !(glm::dot(line, to.normal) < 0.0F)) continue;
        const glm::vec3 begin = from.above(rays), end = to.above(rays);
        if (!rays.occluded(Ray{begin, end - begin, 1.0F})) return true;
    }
    return false;
}

} // namespace lambert
