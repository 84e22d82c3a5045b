/// Rows of local lines, which are traced in packets of neighbouring directions, against bare rtcIntersect1 of the same lines in
/// the order of the sampler, incoherent; in turns, on one thread.
///
/// "Bare" gets its rays from memory and throws the hits away; a row also makes the lines, sorts them, finds the patches and
/// counts.

#include "benchmarks/comparison.h"
#include "benchmarks/incoherent_rays.h"
#include "formfactors/local_lines.h"

namespace lambert {
namespace {

constexpr std::uint32_t kLines = 1U << 14;

void compareLocalLines(benchmark::State& state, const BenchmarkScene& scene) {
    const BareEmbree bare(scene.scene);
    const LocalLines lines(scene.mesh, scene.rays, {.lines = kLines});
    compareRows(
        state, lines, [&](std::uint32_t patch) { return shuffled(lines.lines(patch)); },
        [&](std::uint32_t, const std::vector<Ray>& rays) { benchmark::DoNotOptimize(countHits(bare, rays)); });
}

const bool registered = [] {
    registerComparison("local_lines", 9, compareLocalLines);
    return true;
}();

} // namespace
} // namespace lambert
