/// Rows of local lines, which are traced in packets of neighbouring directions, against bare rtcIntersect1 of the same lines in
/// the order of the sampler, incoherent; in turns, on one thread.
///
/// "Bare" gets its rays from memory and throws the hits away; a row also makes the lines, sorts them, finds the patches and
/// counts.

#include "benchmarks/bare_embree.h"
#include "benchmarks/comparison.h"
#include "core/random.h"
#include "formfactors/local_lines.h"

#include <numeric>

namespace lambert {
namespace {

constexpr std::uint32_t kLines = 1U << 14;

std::size_t trace(RTCScene scene, const std::vector<Ray>& rays) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    std::size_t hits = 0;
    for (const Ray& ray : rays) {
        RTCRayHit query{};
        query.ray.org_x = ray.origin.x;
        query.ray.org_y = ray.origin.y;
        query.ray.org_z = ray.origin.z;
        query.ray.dir_x = ray.direction.x;
        query.ray.dir_y = ray.direction.y;
        query.ray.dir_z = ray.direction.z;
        query.ray.tfar = 1e30F;
        query.ray.mask = ~0U;
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene, &context, &query);
        hits += query.hit.geomID != RTC_INVALID_GEOMETRY_ID ? 1 : 0;
    }
    return hits;
}

/// Puts the rays into an order without coherence.
std::vector<Ray> shuffled(const std::vector<Ray>& rays) {
    std::vector<std::uint32_t> order(rays.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [](std::uint32_t a, std::uint32_t b) {
        return philox({a, 0, 0, 0}, 1) < philox({b, 0, 0, 0}, 1);
    });
    std::vector<Ray> result;
    for (const std::uint32_t i : order) result.push_back(rays[i]);
    return result;
}

void compareLocalLines(benchmark::State& state, const BenchmarkScene& scene) {
    const BareEmbree bare(scene.scene);
    const LocalLines lines(scene.mesh, scene.rays, {.lines = kLines});
    compareRows(
        state, lines, [&](std::uint32_t patch) { return shuffled(lines.lines(patch)); },
        [&](std::uint32_t, const std::vector<Ray>& rays) { benchmark::DoNotOptimize(trace(bare.handle(), rays)); });
}

const bool registered = [] {
    registerComparison("local_lines", 9, compareLocalLines);
    return true;
}();

} // namespace
} // namespace lambert
