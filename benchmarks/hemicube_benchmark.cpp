/// Hemicube rows against bare rtcIntersect16 on the same rays, in the same run, on one thread.
///
/// "Bare" gets its directions from memory and throws the hits away; a hemicube row also makes the directions, finds the
/// patches and sums the delta form factors.

#include "core/stopwatch.h"
#include "formfactors/hemicube.h"
#include "meshing/build_patch_mesh.h"
#include "meshing/prepare.h"
#include "scene/example_scenes.h"
#include "scene/scene_reader.h"

#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

#include <algorithm>
#include <memory>

namespace lambert {
namespace {

constexpr int kResolution = 128;
constexpr std::size_t kRows = 24;

/// The scene once more, as Embree alone sees it.
class BareEmbree {
public:
    explicit BareEmbree(const Scene& scene) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_QUAD);
        auto* indices = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 16, scene.polygons.size()));
        for (const Polygon& polygon : scene.polygons)
            for (std::size_t k = 0; k < 4; ++k) *indices++ = polygon.vertices[polygon.isQuad() || k < 3 ? k : 2];
        auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                                     RTC_FORMAT_FLOAT3, 12, scene.positions.size()));
        for (const glm::vec3& p : scene.positions)
            for (int axis = 0; axis < 3; ++axis) *vertices++ = p[axis];
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    ~BareEmbree() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    BareEmbree(const BareEmbree&) = delete;
    BareEmbree& operator=(const BareEmbree&) = delete;

    /// Traces the packets; returns how many rays hit.
    std::size_t trace(const glm::vec3& origin, const std::vector<RayPacket>& packets) const {
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
            rtcIntersect16(packet.active, scene_, &context, &rays);
            for (int lane = 0; lane < 16; ++lane) hits += rays.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID ? 1 : 0;
        }
        return hits;
    }

private:
    RTCDevice device_;
    RTCScene scene_;
};

std::vector<RayPacket> packetsOf(const Hemicube& hemicube, const PatchMesh& mesh, std::uint32_t patch) {
    std::vector<RayPacket> packets;
    for (const HemicubeFace& face : hemicubeFaces(mesh.normal[patch], hemicube.viewpoint(patch).angle, kResolution))
        for (int row = 0; row < face.rows; row += 4)
            for (int column = 0; column < face.columns; column += 4)
                tileDirections(face, column, row, kResolution, packets.emplace_back());
    return packets;
}

void compare(benchmark::State& state, const Scene& input, std::size_t patches) {
    const Scene scene = prepareScene(input);
    const RayCaster rays(scene);
    const BareEmbree bare(scene);
    Progress progress;
    MeshOptions options;
    options.patches = patches;
    const PatchMesh mesh = buildPatchMesh(scene, options, progress);
    const Hemicube hemicube(mesh, rays, {.resolution = kResolution});
    RowAccumulator accumulator(mesh.size());
    FormFactorRow row;

    double bareSeconds = 0.0;
    double rowSeconds = 0.0;
    std::size_t hits = 0;
    std::size_t traced = 0;
    for (auto _ : state) {
        for (std::size_t k = 0; k < kRows; ++k) {
            const auto patch = static_cast<std::uint32_t>(k * mesh.size() / kRows);
            const std::vector<RayPacket> packets = packetsOf(hemicube, mesh, patch);
            Stopwatch watch;
            hits += bare.trace(hemicube.viewpoint(patch).origin, packets);
            bareSeconds += watch.lap();
            hemicube.row(patch, accumulator);
            accumulator.take(row);
            rowSeconds += watch.lap();
            traced += hemicube.raysPerRow();
        }
    }
    const auto count = static_cast<double>(traced);
    state.counters["bare_Mrays/s"] = 1e-6 * count / bareSeconds;
    state.counters["hemicube_Mrays/s"] = 1e-6 * count / rowSeconds;
    state.counters["ratio"] = bareSeconds / rowSeconds;
    state.counters["hit"] = static_cast<double>(hits) / count;
}

void closedCube(benchmark::State& state) {
    const Material wall = greyMaterial("wall", 0.5F, 1.0F);
    compare(state, boxScene(glm::vec3(1.0F), {wall, wall, wall, wall, wall, wall}), 5000);
}
BENCHMARK(closedCube)->Unit(benchmark::kMillisecond);

void tableRoom(benchmark::State& state) { compare(state, readScene(LAMBERT_DATA "/table_room.gltf").scene, 5000); }
BENCHMARK(tableRoom)->Unit(benchmark::kMillisecond);

void cornellBox(benchmark::State& state) { compare(state, readScene(LAMBERT_DATA "/cornell_box.obj").scene, 5000); }
BENCHMARK(cornellBox)->Unit(benchmark::kMillisecond);

} // namespace
} // namespace lambert
