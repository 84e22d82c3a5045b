/// Global lines against bare Embree that finds all hits of the same lines in the same order, with a filter that notes and
/// rejects them; in turns, on one thread.
///
/// `ratio_as_drawn` is that to the same without the order, 16 lines at a time as their points are drawn, and `ratio_singly` that to
/// these one by one (rtcOccluded1).
///
/// "Bare" traces all lines; what share of its time those take that meet the scene's box, which global lines restrict themselves
/// to, is `bare_meeting`. It gets its lines from memory and forgets the hits of a packet with the next; global lines are also made, put into
/// order, their crossings sorted, their patches found, and the spans counted.

#include "benchmarks/bare_embree.h"
#include "benchmarks/comparison.h"
#include "formfactors/global_lines.h"
#include "scene/rays/packet_width.h"

namespace lambert {
namespace {

constexpr std::uint32_t kLines = 1U << 20;

struct HitList {
    QueryContext context;
    std::array<std::vector<Crossing>, LinePacket::kSize> crossings;
};

void noteHit(const RTCFilterFunctionNArguments* arguments) {
    auto& list = *reinterpret_cast<HitList*>(arguments->context);
    RTCHitN* hit = arguments->hit;
    RTCRayN* ray = arguments->ray;
    const unsigned n = arguments->N;
    for (unsigned lane = 0; lane < n; ++lane) {
        if (arguments->valid[lane] == 0) continue;
        arguments->valid[lane] = 0;
        const float facing = RTCHitN_Ng_x(hit, n, lane) * RTCRayN_dir_x(ray, n, lane) +
                             RTCHitN_Ng_y(hit, n, lane) * RTCRayN_dir_y(ray, n, lane) +
                             RTCHitN_Ng_z(hit, n, lane) * RTCRayN_dir_z(ray, n, lane);
        list.crossings[RTCRayN_id(ray, n, lane)].push_back({RTCRayN_tfar(ray, n, lane), RTCHitN_u(hit, n, lane),
                                                            RTCHitN_v(hit, n, lane), RTCHitN_primID(hit, n, lane),
                                                            facing < 0.0F});
    }
}

std::size_t trace(RTCScene scene, const std::vector<LinePacket>& packets) {
    HitList list;
    beginQuery(list.context);
    alignas(64) RTCRay16 rays;
    std::size_t hits = 0;
    for (const LinePacket& packet : packets) {
        beginRays(packet.active, 1.0F, rays);
        std::copy_n(packet.originX, 16, rays.org_x);
        std::copy_n(packet.originY, 16, rays.org_y);
        std::copy_n(packet.originZ, 16, rays.org_z);
        std::copy_n(packet.directionX, 16, rays.dir_x);
        std::copy_n(packet.directionY, 16, rays.dir_y);
        std::copy_n(packet.directionZ, 16, rays.dir_z);
        occluded(packet.active, scene, list.context, Likeness::None, rays);
        for (std::vector<Crossing>& crossings : list.crossings) {
            hits += crossings.size();
            crossings.clear();
        }
    }
    return hits;
}

void traceSingly(RTCScene scene, const std::vector<LinePacket>& packets) {
    HitList list;
    beginQuery(list.context);
    for (const LinePacket& packet : packets) {
        for (unsigned lane = 0; lane < 16; ++lane) {
            RTCRay ray{};
            ray.org_x = packet.originX[lane];
            ray.org_y = packet.originY[lane];
            ray.org_z = packet.originZ[lane];
            ray.dir_x = packet.directionX[lane];
            ray.dir_y = packet.directionY[lane];
            ray.dir_z = packet.directionZ[lane];
            ray.tfar = 1.0F;
            ray.mask = ~0U;
            occluded(scene, list.context, ray);
            list.crossings[0].clear();
        }
    }
}

void compareGlobalLines(benchmark::State& state, const BenchmarkScene& scene, LineSet set) {
    const BareEmbree bare(scene.scene, noteHit);
    const LineCaster caster(scene.scene);
    Comparison comparison;
    Progress progress;
    std::size_t hits = 0;
    std::uint64_t seed = 0;
    double allSeconds = 0.0;
    double meetingSeconds = 0.0;
    double drawnSeconds = 0.0;
    double singlySeconds = 0.0;
    for (auto _ : state) {
        const GlobalLines lines(scene.mesh, caster, {.lines = kLines, .set = set, .seed = ++seed});
        GlobalLineCounts counts(scene.mesh.size());
        IsotropicLines::Block block;
        double bareSeconds = 0.0;
        for (std::uint64_t b = 0; b < lines.lines().blockCount(); ++b) {
            lines.lines().fill(b, block, IsotropicLines::Keep::All);
            CpuStopwatch watch;
            hits += trace(bare.handle(), block.packets);
            bareSeconds += watch.lap();
            lines.lines().fill(b, block);
            watch.lap();
            trace(bare.handle(), block.packets);
            meetingSeconds += watch.lap();
            lines.lines().fill(b, block, IsotropicLines::Keep::AllAsDrawn);
            watch.lap();
            trace(bare.handle(), block.packets);
            drawnSeconds += watch.lap();
            traceSingly(bare.handle(), block.packets);
            singlySeconds += watch.lap();
        }
        allSeconds += bareSeconds;
        CpuStopwatch watch;
        lines.trace(counts, progress);
        comparison.add(kLines, bareSeconds, watch.lap());
    }
    comparison.report(state);
    state.counters["bare_meeting"] = meetingSeconds / allSeconds;
    state.counters["ratio_as_drawn"] = state.counters["ratio"] * drawnSeconds / allSeconds;
    state.counters["ratio_singly"] = state.counters["ratio"] * singlySeconds / allSeconds;
    state.counters["hits/line"] = static_cast<double>(hits) / (static_cast<double>(kLines) * static_cast<double>(seed));
}

const bool registered = [] {
    registerComparison("global_lines_chords", 9, [](benchmark::State& state, const BenchmarkScene& scene) {
        compareGlobalLines(state, scene, LineSet::Chords);
    });
    registerComparison("global_lines_bundles", 9, [](benchmark::State& state, const BenchmarkScene& scene) {
        compareGlobalLines(state, scene, LineSet::Bundles);
    });
    return true;
}();

} // namespace
} // namespace lambert
