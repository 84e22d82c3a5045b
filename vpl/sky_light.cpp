#include "vpl/sky_light.h"

#include "core/parallel.h"
#include "solver/direct_light.h"

namespace lambert {

std::vector<glm::dvec3> skyLight(const RayCaster& rays, std::span<const Receiver> receivers, std::uint32_t skyRays,
                                 std::uint64_t seed, Progress& progress) {
    const LightSources sky{{}, rays.scene().environment.get()};
    if (sky.empty()) return {};
    const DirectLight light(rays, {.skyRays = skyRays, .seed = seed});
    std::vector<glm::dvec3> irradiance(receivers.size());
    progress.begin("sky light", receivers.size());
    parallelFor(receivers.size(), 64, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t i = begin; i < end; ++i)
            irradiance[i] =
                light.irradiance(receivers[i].position, receivers[i].normal, static_cast<std::uint32_t>(i), sky);
        progress.advance(end - begin);
    });
    progress.end();
    return irradiance;
}

} // namespace lambert
