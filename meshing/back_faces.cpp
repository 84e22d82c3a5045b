#include "meshing/back_faces.h"

#include "core/random.h"
#include "meshing/side_points.h"

#include <algorithm>

namespace lambert {

namespace {

constexpr std::uint32_t kPoints = 2048;
constexpr double kInside = 0.8; // of a point's rays on backs: as where form factors are judged after a bake

/// The materials whose black backs the packet's rays meet.
std::vector<std::uint32_t> blackBacks(const Scene& scene, const RayPacket& packet) {
    std::vector<std::uint32_t> materials;
    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
        if (packet.polygon[lane] == kNone || packet.facing[lane] < 0.0F) continue;
        const Polygon& polygon = scene.polygons[packet.polygon[lane]];
        if (polygon.backMaterial == kNone && !isOccluder(scene, polygon)) materials.push_back(polygon.material);
    }
    return materials;
}

BackFaceSample sample(const RayCaster& rays, const SidePoints& points) {
    const Scene& scene = rays.scene();
    BackFaceSample result;
    result.byMaterial.assign(scene.materials.size(), 0.0);
    if (points.empty()) return result;
    std::size_t counted = 0;
    RayPacket packet;
    for (std::uint32_t i = 0; i < kPoints; ++i) {
        const auto random = philox({i, 0, 0, 0}, 0);
        const SidePoint from = points.at((i + 0.5) / kPoints, {uniformFloat(random[0]), uniformFloat(random[1])});
        aimPacket(from.normal, i, 0, packet);
        rays.closest(from.above(rays), packet);
        const std::vector<std::uint32_t> met = blackBacks(scene, packet);
        if (static_cast<double>(met.size()) >= kInside * RayPacket::kSize) continue;
        ++counted;
        for (const std::uint32_t material : met) result.byMaterial[material] += 1.0;
    }
    for (double& part : result.byMaterial) {
        part /= std::max(1.0, static_cast<double>(counted * RayPacket::kSize));
        result.fraction += part;
    }
    return result;
}

} // namespace

std::uint32_t BackFaceSample::mostMet() const {
    const auto most = std::max_element(byMaterial.begin(), byMaterial.end());
    if (most == byMaterial.end() || !(*most > 0.0)) return kNone;
    return static_cast<std::uint32_t>(most - byMaterial.begin());
}

BackFaceSample sampleBackFaces(const RayCaster& rays) {
    return sample(rays, {rays.scene(), [](double area, const Material&) { return area; }});
}

BackFaceSample sampleBackFacesFromLights(const RayCaster& rays) { return sample(rays, emittingSides(rays.scene())); }

} // namespace lambert
