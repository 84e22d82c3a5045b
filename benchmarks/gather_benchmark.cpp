/// Gathering from 1024 virtual point lights at what the pixels of a 640 × 480 picture show, against bare Embree with the
/// same shadow rays in packets of the processor's own width; in turns, on one thread.
///
/// "Bare" gets its packets from memory, full ones in the order in which gathering traces them, and throws the answers away;
/// gathering also sorts receivers, computes geometric terms, packs the rays and adds up the light. One turn of `gather` takes every
/// 16th block of neighbouring receivers, that of `gather_picture` all of them; `shadows` leaves it at the shadow rays.

#include "benchmarks/bare_embree.h"
#include "benchmarks/comparison.h"
#include "picture/camera_rays.h"
#include "rendering/default_camera.h"
#include "vpl/gather.h"
#include "vpl/particle_sources.h"
#include "vpl/receiver_order.h"
#include "vpl/trace_lights.h"

#include <glm/geometric.hpp>

namespace lambert {
namespace {

constexpr int kWidth = 640, kHeight = 480;
constexpr std::size_t kLights = 1024, kBlock = 512;

/// What the pixels' centres show, of the sides that are not black.
std::vector<Receiver> pixelReceivers(const BenchmarkScene& scene) {
    const Camera camera =
        scene.scene.cameras.empty() ? defaultCamera(scene.scene, scene.rays, 4.0F / 3.0F) : scene.scene.cameras.front();
    const CameraRays rays(camera, kWidth, kHeight);
    std::vector<Receiver> receivers;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const auto hit = scene.rays.closest(
                {camera.eye, rays.direction(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F)});
            if (!hit || !sideOf(scene.scene, scene.scene.polygons[hit->polygon], hit->front)) continue;
            const SurfacePoint point = surfacePoint(scene.rays, hit->polygon, hit->front, hit->u, hit->v);
            receivers.push_back({point.position, point.normal, point.lift});
        }
    }
    return receivers;
}

std::vector<VirtualPointLight> lightsOf(const BenchmarkScene& scene) {
    Progress progress;
    std::vector<VirtualPointLight> lights;
    for (std::uint32_t n = kLights / 4; lights.size() < kLights; n += n / 4)
        lights = traceLights(scene.rays, {.particles = n}, progress).lights;
    lights.resize(kLights);
    return lights;
}

template <typename Rays>
constexpr int kLanes = sizeof(Rays::id) / sizeof(unsigned);

/// Calls `add` with the origin and the way, of length 1, of each shadow ray of a block of receivers.
template <typename Add>
void visitRays(const std::vector<VirtualPointLight>& lights, std::span<const Receiver> receivers, Add add) {
    for (const VirtualPointLight& light : lights) {
        const glm::vec3 origin = light.position + light.lift * light.normal;
        bool first = true;
        for (const Receiver& receiver : receivers) {
            const glm::vec3 way = receiver.position - light.position;
            const float length = glm::length(way);
            if (!(glm::dot(way, light.normal) > 1e-5F * length) || !(glm::dot(way, receiver.normal) < -1e-5F * length))
                continue;
            add(origin, receiver.position + receiver.lift * receiver.normal - origin, first);
            first = false;
        }
    }
}

/// These rays as Embree takes them, in packets of type Rays with the rays of one light.
template <typename Rays>
std::vector<Rays> bareRays(const std::vector<VirtualPointLight>& lights, std::span<const Receiver> receivers) {
    std::vector<Rays> packets;
    int lane = 0;
    visitRays(lights, receivers, [&](const glm::vec3& origin, const glm::vec3& direction, bool first) {
        if (first || lane == kLanes<Rays>) {
            packets.emplace_back();
            lane = 0;
        }
        Rays& rays = packets.back();
        rays.org_x[lane] = origin.x;
        rays.org_y[lane] = origin.y;
        rays.org_z[lane] = origin.z;
        rays.dir_x[lane] = direction.x;
        rays.dir_y[lane] = direction.y;
        rays.dir_z[lane] = direction.z;
        rays.tfar[lane] = 1.0F;
        rays.mask[lane] = ~0U;
        rays.id[lane] = 1; // a ray
        ++lane;
    });
    return packets;
}

/// These rays as a RayCaster takes them.
std::vector<ShadowPacket> shadowPackets(const std::vector<VirtualPointLight>& lights,
                                        std::span<const Receiver> receivers) {
    std::vector<ShadowPacket> packets;
    int lane = 0;
    visitRays(lights, receivers, [&](const glm::vec3& origin, const glm::vec3& direction, bool first) {
        if (first || lane == ShadowPacket::kSize) {
            packets.emplace_back();
            lane = 0;
        }
        packets.back().set(lane++, {origin, direction, 1.0F});
    });
    return packets;
}

template <typename Rays>
std::size_t trace(RTCScene scene, std::vector<Rays>& packets) {
    QueryContext context;
    beginQuery(context);
    std::size_t rays = 0;
    for (Rays& packet : packets) {
        alignas(64) int valid[kLanes<Rays>];
        for (int lane = 0; lane < kLanes<Rays>; ++lane) {
            valid[lane] = packet.id[lane] != 0 ? -1 : 0;
            rays += packet.id[lane];
        }
        occluded(valid, scene, context, Likeness::Coherent, packet);
    }
    return rays;
}

/// Of every `every`-th block.
void compareGather(benchmark::State& state, const BenchmarkScene& scene, std::size_t every) {
    const BareEmbree bare(scene.scene);
    const std::vector<Receiver> all = pixelReceivers(scene);
    const std::vector<std::uint32_t> order = receiverOrder(all);
    const std::vector<VirtualPointLight> lights = lightsOf(scene);
    Comparison comparison;
    Progress progress;
    std::size_t turn = 0;
    for (auto _ : state) {
        double bareSeconds = 0.0, ourSeconds = 0.0, rays = 0.0;
        std::vector<Receiver> some;
        for (std::size_t first = turn++ % every * kBlock; first < all.size(); first += every * kBlock) {
            std::vector<Receiver> block;
            for (std::size_t i = first; i < std::min(first + kBlock, all.size()); ++i) block.push_back(all[order[i]]);
            withPacketOf(bare.width(), [&]<typename RayHits>(RayHits*) {
                auto packets = bareRays<decltype(RayHits::ray)>(lights, block);
                CpuStopwatch watch;
                rays += static_cast<double>(trace(bare.handle(), packets));
                bareSeconds += watch.lap();
            });
            some.insert(some.end(), block.begin(), block.end());
        }
        CpuStopwatch watch;
        const Gathered gathered = gatherIrradiance(scene.rays, lights, some, {}, progress);
        ourSeconds += watch.lap();
        if (std::abs(static_cast<double>(gathered.shadowRays) / rays - 1.0) > 1e-3)
            state.SkipWithError("the two trace different rays");
        comparison.add(rays, bareSeconds, ourSeconds);
        state.counters["rays"] = rays;
        state.counters["bare_seconds"] = bareSeconds;
        state.counters["our_seconds"] = ourSeconds;
    }
    state.counters["bare_width"] = static_cast<int>(bare.width());
    state.counters["receivers"] = static_cast<double>(all.size());
    comparison.report(state);
}

/// The same rays, of every 64th block, by the caster alone.
void compareShadows(benchmark::State& state, const BenchmarkScene& scene) {
    const BareEmbree bare(scene.scene);
    const std::vector<Receiver> all = pixelReceivers(scene);
    const std::vector<std::uint32_t> order = receiverOrder(all);
    const std::vector<VirtualPointLight> lights = lightsOf(scene);
    Comparison comparison;
    for (auto _ : state) {
        double bareSeconds = 0.0, ourSeconds = 0.0, rays = 0.0;
        for (std::size_t first = 0; first < all.size(); first += 64 * kBlock) {
            std::vector<Receiver> block;
            for (std::size_t i = first; i < std::min(first + kBlock, all.size()); ++i) block.push_back(all[order[i]]);
            withPacketOf(bare.width(), [&]<typename RayHits>(RayHits*) {
                auto packets = bareRays<decltype(RayHits::ray)>(lights, block);
                CpuStopwatch watch;
                rays += static_cast<double>(trace(bare.handle(), packets));
                bareSeconds += watch.lap();
            });
            std::vector<ShadowPacket> packets = shadowPackets(lights, block);
            CpuStopwatch watch;
            for (ShadowPacket& packet : packets) scene.rays.occluded(packet);
            ourSeconds += watch.lap();
        }
        comparison.add(rays, bareSeconds, ourSeconds);
    }
    state.counters["bare_width"] = static_cast<int>(bare.width());
    comparison.report(state);
}

const bool registered = [] {
    registerComparison("gather", 5,
                       [](benchmark::State& state, const BenchmarkScene& scene) { compareGather(state, scene, 16); });
    registerComparison("shadows", 9, compareShadows);
    registerComparison("gather_picture", 1,
                       [](benchmark::State& state, const BenchmarkScene& scene) { compareGather(state, scene, 1); });
    return true;
}();

} // namespace
} // namespace lambert
