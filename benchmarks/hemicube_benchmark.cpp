/// Hemicube rows against bare rtcIntersect16 on the same rays, in turns, on one thread.
///
/// "Bare" gets its directions from memory and throws the hits away; a hemicube row also makes the directions, finds the
/// patches and sums the delta form factors.

#include "benchmarks/bare_embree.h"
#include "benchmarks/comparison.h"
#include "formfactors/hemicube.h"

namespace lambert {
namespace {

constexpr int kResolution = 128;
constexpr std::size_t kRows = 24;

/// Traces the packets; returns how many rays hit.
std::size_t trace(RTCScene scene, const glm::vec3& origin, const std::vector<RayPacket>& packets) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    alignas(64) RTCRayHit16 rays;
    std::size_t hits = 0;
    for (const RayPacket& packet : packets) {
        for (int lane = 0; lane < 16; ++lane) {
            rays.ray.org_x[lane] = origin.x;
            rays.ray.org_y[lane] = origin.y;
            rays.ray.org_z[lane] = origin.z;
            rays.ray.tnear[lane] = 0.0F;
            rays.ray.tfar[lane] = 1e30F;
            rays.ray.time[lane] = 0.0F;
            rays.ray.mask[lane] = ~0U;
            rays.ray.flags[lane] = 0;
            rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        }
        std::copy_n(packet.directionX, 16, rays.ray.dir_x);
        std::copy_n(packet.directionY, 16, rays.ray.dir_y);
        std::copy_n(packet.directionZ, 16, rays.ray.dir_z);
        rtcIntersect16(packet.active, scene, &context, &rays);
        for (int lane = 0; lane < 16; ++lane) hits += rays.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID ? 1 : 0;
    }
    return hits;
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
    const PatchMesh& mesh = scene.mesh;
    const Hemicube hemicube(mesh, scene.rays, {.resolution = kResolution});
    RowAccumulator accumulator(mesh.size());
    FormFactorRow row;
    Comparison comparison;
    std::size_t hits = 0;
    std::size_t traced = 0;
    for (auto _ : state) {
        double bareSeconds = 0.0;
        double rowSeconds = 0.0;
        for (std::size_t k = 0; k < kRows; ++k) {
            const auto patch = static_cast<std::uint32_t>(k * mesh.size() / kRows);
            const std::vector<RayPacket> packets = packetsOf(hemicube, mesh, patch);
            CpuStopwatch watch;
            hits += trace(bare.handle(), hemicube.viewpoint(patch).origin, packets);
            bareSeconds += watch.lap();
            hemicube.row(patch, accumulator);
            accumulator.take(row);
            rowSeconds += watch.lap();
            traced += hemicube.raysPerRow();
        }
        comparison.add(static_cast<double>(kRows * hemicube.raysPerRow()), bareSeconds, rowSeconds);
    }
    comparison.report(state);
    state.counters["hit"] = static_cast<double>(hits) / static_cast<double>(traced);
}

const bool registered = [] {
    registerComparison("hemicube", 9, compareHemicube);
    return true;
}();

} // namespace
} // namespace lambert
