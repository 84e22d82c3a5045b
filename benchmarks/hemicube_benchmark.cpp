/// Hemicube rows against bare Embree on the same rays in packets of the processor's own width, in turns, on one thread.
///
/// "Bare" gets its directions from memory and throws the hits away; a hemicube row also makes the directions, finds the
/// patches and sums the delta form factors.
///
/// "hits" leaves it at the hits. "widths" traces the bare rays in packets of 16, 8 and 4: LAMBERT_EMBREE=isa=avx2 lambert_benchmarks --benchmark_filter=widths

#include "benchmarks/bare_embree.h"
#include "benchmarks/comparison.h"
#include "core/process.h"
#include "core/stopwatch.h"
#include "formfactors/hemicube.h"
#include "scene/rays/packet_width.h"
#include "solver/jacobi.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>

namespace lambert {
namespace {

constexpr int kResolution = 128;

/// Traces the rays of the packets as RayHits; returns how many hit.
template <typename RayHits>
std::size_t traceAs(RTCScene scene, const glm::vec3& origin, const std::vector<RayPacket>& packets) {
    constexpr int kLanes = sizeof(RayHits::hit.geomID) / sizeof(unsigned);
    QueryContext context;
    beginQuery(context);
    alignas(64) RayHits rays;
    std::size_t hits = 0;
    for (const RayPacket& packet : packets) {
        for (int first = 0; first < 16; first += kLanes) {
            std::fill_n(rays.ray.org_x, kLanes, origin.x);
            std::fill_n(rays.ray.org_y, kLanes, origin.y);
            std::fill_n(rays.ray.org_z, kLanes, origin.z);
            std::copy_n(packet.directionX + first, kLanes, rays.ray.dir_x);
            std::copy_n(packet.directionY + first, kLanes, rays.ray.dir_y);
            std::copy_n(packet.directionZ + first, kLanes, rays.ray.dir_z);
            for (int lane = 0; lane < kLanes; ++lane)
                rays.ray.tnear[lane] = packet.active[first + lane] != 0 ? 0.0F : std::numeric_limits<float>::infinity();
            std::fill_n(rays.ray.tfar, kLanes, 1e30F);
            std::fill_n(rays.ray.time, kLanes, 0.0F);
            std::fill_n(rays.ray.mask, kLanes, ~0U);
            std::fill_n(rays.ray.flags, kLanes, 0U);
            std::fill_n(rays.hit.geomID, kLanes, RTC_INVALID_GEOMETRY_ID);
            intersect(packet.active + first, scene, context, Likeness::Coherent, rays);
            for (const unsigned geometry : rays.hit.geomID) hits += geometry != RTC_INVALID_GEOMETRY_ID ? 1 : 0;
        }
    }
    return hits;
}

std::size_t trace(const BareEmbree& bare, const glm::vec3& origin, const std::vector<RayPacket>& packets,
                  PacketWidth width) {
    return withPacketOf(width,
                        [&]<typename RayHits>(RayHits*) { return traceAs<RayHits>(bare.handle(), origin, packets); });
}

std::vector<RayPacket> packetsOf(const Hemicube& hemicube, const PatchMesh& mesh, std::uint32_t patch) {
    std::vector<RayPacket> packets;
    for (const HemicubeFace& face : hemicubeFaces(mesh.normal[patch], hemicube.viewpoint(patch).angle, kResolution))
        for (int row = 0; row < face.rows; row += 4)
            for (int column = 0; column < face.columns; column += 4)
                tileDirections(face, column, row, kResolution, packets.emplace_back());
    return packets;
}

void compareHemicube(benchmark::State& state, const BenchmarkScene& scene) {
    const BareEmbree bare(scene.scene);
    const Hemicube hemicube(scene.mesh, scene.rays, {.resolution = kResolution});
    std::size_t hits = 0;
    std::size_t traced = 0;
    compareRows(
        state, hemicube, [&](std::uint32_t patch) { return packetsOf(hemicube, scene.mesh, patch); },
        [&](std::uint32_t patch, const std::vector<RayPacket>& packets) {
            hits += trace(bare, hemicube.viewpoint(patch).origin, packets, bare.width());
            traced += hemicube.raysPerRow();
        });
    state.counters["hit"] = static_cast<double>(hits) / static_cast<double>(traced);
    state.counters["bare_width"] = static_cast<int>(bare.width());
}

/// The same rays by the caster alone.
void compareHits(benchmark::State& state, const BenchmarkScene& scene) {
    const BareEmbree bare(scene.scene);
    const Hemicube hemicube(scene.mesh, scene.rays, {.resolution = kResolution});
    Comparison comparison;
    for (auto _ : state) {
        constexpr std::uint32_t kRows = 24;
        double bareSeconds = 0.0, ourSeconds = 0.0;
        for (std::uint32_t k = 0; k < kRows; ++k) {
            const auto patch = static_cast<std::uint32_t>(k * scene.mesh.size() / kRows);
            std::vector<RayPacket> packets = packetsOf(hemicube, scene.mesh, patch);
            const glm::vec3 origin = hemicube.viewpoint(patch).origin;
            CpuStopwatch watch;
            benchmark::DoNotOptimize(trace(bare, origin, packets, bare.width()));
            bareSeconds += watch.lap();
            for (RayPacket& packet : packets) scene.rays.closest(origin, packet);
            ourSeconds += watch.lap();
        }
        comparison.add(static_cast<double>(kRows * hemicube.raysPerRow()), bareSeconds, ourSeconds);
    }
    state.counters["bare_width"] = static_cast<int>(bare.width());
    comparison.report(state);
}

/// Millions of rays a second for each width, the median of nine turns.
void compareWidths(benchmark::State& state, const BenchmarkScene& scene) {
    const BareEmbree bare(scene.scene);
    const Hemicube hemicube(scene.mesh, scene.rays, {.resolution = kResolution});
    constexpr std::array kWidths{PacketWidth::Sixteen, PacketWidth::Eight, PacketWidth::Four};
    std::array<std::vector<double>, kWidths.size()> rates;
    for (auto _ : state) {
        std::array<double, kWidths.size()> seconds{};
        constexpr std::uint32_t kRows = 24;
        for (std::uint32_t k = 0; k < kRows; ++k) {
            const auto patch = static_cast<std::uint32_t>(k * scene.mesh.size() / kRows);
            const std::vector<RayPacket> packets = packetsOf(hemicube, scene.mesh, patch);
            for (std::size_t w = 0; w < kWidths.size(); ++w) {
                CpuStopwatch watch;
                benchmark::DoNotOptimize(trace(bare, hemicube.viewpoint(patch).origin, packets, kWidths[w]));
                seconds[w] += watch.lap();
            }
        }
        for (std::size_t w = 0; w < kWidths.size(); ++w)
            rates[w].push_back(1e-6 * static_cast<double>(kRows * hemicube.raysPerRow()) / seconds[w]);
    }
    for (std::size_t w = 0; w < kWidths.size(); ++w) {
        std::sort(rates[w].begin(), rates[w].end());
        state.counters[std::to_string(static_cast<int>(kWidths[w]))] = rates[w][rates[w].size() / 2];
    }
}

/// 50,000 patches: the whole matrix and Jacobi to 1e-4, and bare Embree tracing the same rays, on all threads.
void largeMatrix(benchmark::State& state) {
    const BenchmarkScene scene(readScene(LAMBERT_DATA "/cornell_box.obj").scene, 50'000);
    const Hemicube hemicube(scene.mesh, scene.rays, {.resolution = kResolution});
    Progress progress;
    for (auto _ : state) {
        Stopwatch watch;
        const FormFactorMatrix matrix = computeMatrix(hemicube, MatrixStorage::Compact, progress);
        state.counters["form_factors_s"] = watch.lap();
        StoredRows rows(matrix);
        const RadiositySolution solution = solveJacobi(SolverProblem({scene.mesh, scene.optics}), rows, {}, progress);
        state.counters["jacobi_s"] = watch.lap();
        state.counters["residual"] = solution.residual;
    }
    const BareEmbree bare(scene.scene);
    std::vector<double> seconds(static_cast<std::size_t>(threadCount()), 0.0);
    std::atomic<std::size_t> hits = 0;
    parallelFor(scene.mesh.size(), 16, [&](std::size_t begin, std::size_t end, int worker) {
        for (std::size_t k = begin; k < end; ++k) {
            const auto patch = static_cast<std::uint32_t>(k);
            const std::vector<RayPacket> packets = packetsOf(hemicube, scene.mesh, patch);
            CpuStopwatch watch;
            hits += trace(bare, hemicube.viewpoint(patch).origin, packets, bare.width());
            seconds[static_cast<std::size_t>(worker)] += watch.lap();
        }
    });
    benchmark::DoNotOptimize(hits.load());
    state.counters["bare_s"] = std::accumulate(seconds.begin(), seconds.end(), 0.0) / threadCount();
    state.counters["rays"] = static_cast<double>(scene.mesh.size() * hemicube.raysPerRow());
    state.counters["patches"] = static_cast<double>(scene.mesh.size());
    state.counters["peak_GB"] = 1e-9 * static_cast<double>(peakMemoryBytes());
}

const bool registered = [] {
    benchmark::RegisterBenchmark("large_matrix", largeMatrix)->Iterations(1)->Unit(benchmark::kSecond)->UseRealTime();
    registerComparison("hemicube", 9, compareHemicube);
    registerComparison("hits", 9, compareHits);
    registerComparison("widths", 9, compareWidths);
    return true;
}();

} // namespace
} // namespace lambert
