/// One exchange of the stochastic relaxation by local lines, against bare rtcIntersect1 of the same rays in an order without
/// coherence; in turns, on one thread.
///
/// "Bare" gets its rays from memory and throws the hits away; an exchange also draws the rays, sorts them, finds the patches and brings
/// power to both ends of every ray. Eight rays per patch.

#include "benchmarks/comparison.h"
#include "benchmarks/incoherent_rays.h"
#include "solver/local_exchange.h"

namespace lambert {
namespace {

constexpr std::uint32_t kRaysPerPatch = 8;
constexpr std::size_t kBareRays = 400'000;

/// The rays of patches spread over the mesh.
std::vector<Ray> someRays(const BenchmarkScene& scene, std::uint64_t seed) {
    const PatchRays patchRays(scene.mesh, scene.rays, Sampler::Sobol);
    PatchRays::Batch batch;
    std::vector<Ray> rays;
    const std::size_t step = std::max<std::size_t>(1, scene.mesh.size() * kRaysPerPatch / kBareRays);
    for (std::size_t i = 0; i < scene.mesh.size(); i += step) {
        batch.runs = {{static_cast<std::uint32_t>(i), 0, kRaysPerPatch}};
        const std::size_t count = patchRays.make(seed, batch);
        for (std::size_t k = 0; k < count; ++k) rays.push_back(batch.ray(k));
    }
    return shuffled(rays);
}

void compareExchange(benchmark::State& state, const BenchmarkScene& scene) {
    const BareEmbree bare(scene.scene);
    const PatchMesh& mesh = scene.mesh;
    std::vector<Sender> senders(mesh.size());
    for (std::size_t i = 0; i < mesh.size(); ++i)
        senders[i] = {Rgb(1.0F) + scene.optics.reflectance[i], static_cast<float>(kRaysPerPatch) / mesh.area[i]};
    LocalExchange exchange(mesh, scene.rays, Sampler::Sobol);
    FixedPointSums received(mesh.size());
    LineCounts counts(mesh.size());
    Losses losses;
    Progress progress;
    Comparison comparison;
    std::uint64_t seed = 0;
    for (auto _ : state) {
        const std::vector<Ray> rays = someRays(scene, ++seed);
        CpuStopwatch watch;
        benchmark::DoNotOptimize(countHits(bare, rays));
        const double bareSeconds = watch.lap();
        const ExchangeInput input{.senders = senders, .control = Rgb(0.5F), .seed = seed};
        const auto count = static_cast<double>(exchange.exchange(input, received, losses, counts, progress));
        const double ourSeconds = watch.lap();
        for (std::size_t i = 0; i < mesh.size(); ++i) benchmark::DoNotOptimize(received.take(i));
        comparison.add(count, bareSeconds * count / static_cast<double>(rays.size()), ourSeconds);
    }
    comparison.report(state);
}

const bool registered = [] {
    registerComparison("stochastic_exchange", 9, compareExchange);
    return true;
}();

} // namespace
} // namespace lambert
