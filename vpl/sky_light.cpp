#include "vpl/sky_light.h"

#include "core/low_discrepancy.h"
#include "core/orthonormal_basis.h"
#include "core/parallel.h"
#include "core/random.h"
#include "scene/environment.h"
#include "solver/direct_light.h"
#include "vpl/glossy_sum.h"

#include <glm/geometric.hpp>

namespace lambert {

namespace {

/// ρ_s / cosθ_eye times the mean of L cosθ over directions that are distributed as the lobe.
glm::dvec3 reflectedSky(const RayCaster& rays, const Receiver& receiver, std::uint32_t index, std::uint32_t count,
                        std::uint64_t seed) {
    const glm::dvec3 scale = glossyScale(receiver);
    if (scale == glm::dvec3(0.0)) return scale;
    const auto key = philox({index, 0, 0, 0x474C534B}, seed);
    const OrthonormalBasis frame(mirrored(-receiver.gloss.toEye, receiver.normal));
    const glm::vec3 origin = receiver.position + receiver.lift * receiver.normal;
    glm::dvec3 sum(0.0);
    for (std::uint32_t k = 0; k < count; ++k) {
        const glm::dvec2 u(scrambledSobol(k, 0, key[0]), scrambledSobol(k, 1, key[1]));
        const glm::vec3 local(phongDirection(u, static_cast<double>(receiver.gloss.lobe.exponent)));
        const glm::vec3 direction = local.x * frame.x + local.y * frame.y + local.z * frame.z;
        const float cosine = glm::dot(direction, receiver.normal);
        if (!(cosine > 0.0F) || rays.occluded({origin, direction})) continue;
        sum += static_cast<double>(cosine) *
               glm::dvec3(rays.scene().environment->radiance(glm::normalize(glm::dvec3(direction))));
    }
    return scale * sum / static_cast<double>(count);
}

template <typename Light>
std::vector<glm::dvec3> atEach(std::span<const Receiver> receivers, const char* title, Progress& progress,
                               const Light& light) {
    std::vector<glm::dvec3> result(receivers.size());
    progress.begin(title, receivers.size());
    parallelFor(receivers.size(), 64, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t i = begin; i < end; ++i) result[i] = light(receivers[i], static_cast<std::uint32_t>(i));
        progress.advance(end - begin);
    });
    progress.end();
    return result;
}

} // namespace

std::vector<glm::dvec3> skyLight(const RayCaster& rays, std::span<const Receiver> receivers, std::uint32_t skyRays,
                                 std::uint64_t seed, Progress& progress) {
    const LightSources sky{{}, rays.scene().environment.get()};
    if (sky.empty()) return {};
    const DirectLight light(rays, {.skyRays = skyRays, .seed = seed});
    return atEach(receivers, "sky light", progress, [&](const Receiver& receiver, std::uint32_t index) {
        return light.irradiance(receiver.position, receiver.normal, index, sky);
    });
}

std::vector<glm::dvec3> glossySkyLight(const RayCaster& rays, std::span<const Receiver> receivers,
                                       std::uint32_t skyRays, std::uint64_t seed, Progress& progress) {
    const Environment* const sky = rays.scene().environment.get();
    if (sky == nullptr || sky->isDark() || !anyGlossy(receivers)) return {};
    return atEach(receivers, "reflected sky", progress, [&](const Receiver& receiver, std::uint32_t index) {
        return reflectedSky(rays, receiver, index, skyRays, seed);
    });
}

} // namespace lambert
