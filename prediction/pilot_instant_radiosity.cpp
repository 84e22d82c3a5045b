#include "core/parallel.h"
#include "core/stopwatch.h"
#include "prediction/measured_costs.h"
#include "prediction/pilots.h"

#include <algorithm>

namespace lambert {

namespace {

constexpr std::uint32_t kPilotParticles = 1024;
constexpr std::size_t kPilotReceivers = 4096; ///< at a time: few would be far from each other

} // namespace

void pilot(const MeshedScene& scene, const InstantRadiosityOptions& method, BakePrediction& result,
           Progress& progress) {
    InstantRadiosityOptions options = method;
    const std::uint32_t points = pointsPerPatch(options, scene.mesh.size());
    const double wanted = options.trace.particles;
    options.trace.particles = std::min(options.trace.particles, kPilotParticles);
    options.gather.direct = false;
    Stopwatch watch;
    const VirtualPointLights some = traceLights(*scene.rays, options.trace, progress);
    const double more = wanted / options.trace.particles;
    const double traceSeconds = more * watch.lap();

    const std::vector<Receiver> all = patchReceivers(scene.mesh, *scene.rays, points, options.trace.seed);
    std::size_t done = 0;
    double rays = 0.0;
    const Stopwatch gathering;
    do {
        std::vector<Receiver> receivers;
        for (std::size_t k = done; k < std::min(done + kPilotReceivers, all.size()); ++k)
            receivers.push_back(all[spreadIndex(k, all.size())]);
        const Gathered gathered = gatherIrradiance(*scene.rays, some.lights, receivers, options.gather, progress);
        rays += static_cast<double>(gathered.shadowRays + gathered.recoveryRays);
        done += receivers.size();
    } while (gathering.seconds() < kPilotSeconds && done < all.size());
    const double scale = more * static_cast<double>(all.size()) / static_cast<double>(done);

    result.rays = static_cast<std::uint64_t>(more * static_cast<double>(some.rays) + scale * rays);
    result.secondsPerRay = rays > 0.0 ? gathering.seconds() / rays : kUnknownSecondsPerRay / threadCount();
    result.seconds.solve = traceSeconds + scale * gathering.seconds();
    result.lightBytes = static_cast<std::uint64_t>(kReceiverBytes * static_cast<double>(all.size()) +
                                                   kLightBytes * more * static_cast<double>(some.lights.size()));
}

} // namespace lambert
