// Spot: https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos/KHR_lights_punctual#inner-and-outer-cone-angles

#include "solver/direct_light.h"

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "formfactors/patch_sampling.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

constexpr std::uint32_t kMostPoints = 65536;
constexpr float kNoEnd = 1e30F;

/// Points of a surface that look for light, and where their rays start.
struct Receiver {
    glm::vec3 normal;
    glm::vec3 offset; ///< from a point to the origin of its rays
    std::vector<glm::vec3> points;
};

/// What a point receives if nothing stands between, and the ray that finds out.
struct Candidate {
    RgbSum irradiance{0.0};
    glm::vec3 direction{0.0F};
    float maxDistance = 0.0F; ///< in lengths of the direction
};

Candidate candidateOf(const PunctualLight& light, const Receiver& receiver, const glm::vec3& point, float endGap) {
    const glm::vec3 n = receiver.normal;
    if (light.kind == PunctualLight::Kind::Directional) {
        const float cosine = glm::dot(n, -light.direction);
        if (!(cosine > 0.0F)) return {};
        return {static_cast<double>(cosine) * RgbSum(light.intensity), -light.direction, kNoEnd};
    }
    const glm::vec3 toLight = light.position - point;
    const auto squared = static_cast<double>(glm::dot(toLight, toLight));
    const auto distance = static_cast<float>(std::sqrt(squared));
    const float height = glm::dot(n, toLight);
    if (!(height > 0.0F) || !(distance > endGap)) return {};
    const glm::vec3 direction = toLight / distance;
    const RgbSum intensity(intensityToward(light, -direction));
    return {intensity * (static_cast<double>(height / distance) / squared), toLight - receiver.offset,
            1.0F - endGap / distance};
}

/// Collects shadow rays into packets and adds up what gets through.
class ShadowSum {
public:
    explicit ShadowSum(const RayCaster& rays) : rays_(rays) {}

    void add(const glm::vec3& origin, const Candidate& candidate) {
        if (candidate.irradiance == RgbSum(0.0)) return;
        packet_.originX[count_] = origin.x;
        packet_.originY[count_] = origin.y;
        packet_.originZ[count_] = origin.z;
        packet_.directionX[count_] = candidate.direction.x;
        packet_.directionY[count_] = candidate.direction.y;
        packet_.directionZ[count_] = candidate.direction.z;
        packet_.maxDistance[count_] = candidate.maxDistance;
        irradiance_[count_] = candidate.irradiance;
        if (++count_ == ShadowPacket::kSize) trace();
    }

    RgbSum finish() {
        trace();
        return sum_;
    }

private:
    void trace() {
        if (count_ == 0) return;
        for (int lane = 0; lane < ShadowPacket::kSize; ++lane) packet_.active[lane] = lane < count_ ? -1 : 0;
        for (int lane = count_; lane < ShadowPacket::kSize; ++lane) {
            packet_.originX[lane] = packet_.originY[lane] = packet_.originZ[lane] = 0.0F;
            packet_.directionX[lane] = packet_.directionY[lane] = packet_.directionZ[lane] = 1.0F;
            packet_.maxDistance[lane] = 0.0F;
        }
        rays_.occluded(packet_);
        for (int lane = 0; lane < count_; ++lane)
            if (!packet_.occluded[lane]) sum_ += irradiance_[lane];
        count_ = 0;
    }

    const RayCaster& rays_;
    ShadowPacket packet_;
    RgbSum irradiance_[ShadowPacket::kSize];
    int count_ = 0;
    RgbSum sum_{0.0};
};

RgbSum gather(const RayCaster& rays, const Receiver& receiver, std::span<const PunctualLight> lights) {
    const float endGap = rays.originOffset(0.0F); // a light in a ceiling's plane is not behind it
    ShadowSum sum(rays);
    for (const PunctualLight& light : lights)
        for (const glm::vec3& point : receiver.points)
            sum.add(point + receiver.offset, candidateOf(light, receiver, point, endGap));
    return sum.finish() / static_cast<double>(receiver.points.size());
}

} // namespace

Rgb intensityToward(const PunctualLight& light, const glm::vec3& direction) {
    if (light.kind != PunctualLight::Kind::Spot) return light.intensity;
    const float inner = std::cos(light.innerConeAngle);
    const float outer = std::cos(light.outerConeAngle);
    const float share =
        std::clamp((glm::dot(light.direction, direction) - outer) / std::max(0.001F, inner - outer), 0.0F, 1.0F);
    return share * share * light.intensity;
}

DirectLight::DirectLight(const RayCaster& rays, const DirectLightOptions& options) : rays_(rays), options_(options) {
    if (options.points < 1 || options.points > kMostPoints)
        throw UsageError(fmt::format("light points: found {}, allowed are 1 to {}", options.points, kMostPoints));
}

std::vector<RgbSum> DirectLight::irradiance(const PatchMesh& mesh, std::span<const PunctualLight> lights,
                                            Progress& progress) const {
    std::vector<RgbSum> result(mesh.size(), RgbSum(0.0));
    if (lights.empty()) return result;
    progress.begin("direct light", mesh.size());
    parallelFor(mesh.size(), 64, [&](std::size_t begin, std::size_t end, int) {
        Receiver receiver;
        for (std::size_t patch = begin; patch < end; ++patch) {
            const auto key = philox({static_cast<std::uint32_t>(patch), 0, 0, 0x4C494748}, options_.seed);
            const SamplePoints samples(options_.sampler, options_.points, 2, (std::uint64_t{key[0]} << 32) | key[1]);
            const PatchPoints surface(mesh, patch);
            receiver.normal = mesh.normal[patch];
            receiver.offset = rays_.originOffset(std::sqrt(mesh.area[patch])) * receiver.normal;
            receiver.points.clear();
            for (std::uint32_t k = 0; k < options_.points; ++k)
                receiver.points.push_back(surface.at({samples.at(k, 0), samples.at(k, 1)}));
            result[patch] = gather(rays_, receiver, lights);
        }
        progress.advance(end - begin);
    });
    progress.end();
    return result;
}

RgbSum DirectLight::irradiance(const glm::vec3& point, const glm::vec3& normal,
                               std::span<const PunctualLight> lights) const {
    return gather(rays_, {normal, rays_.originOffset(0.0F) * normal, {point}}, lights);
}

std::uint64_t DirectLight::rayCount(std::size_t patches, std::size_t lights) const {
    return std::uint64_t{patches} * lights * options_.points;
}

} // namespace lambert
