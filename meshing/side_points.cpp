#include "meshing/side_points.h"

#include "core/random.h"
#include "meshing/plane_frame.h"
#include "scene/polygon_points.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lambert {

glm::vec3 SidePoint::above(const RayCaster& rays) const {
    const auto size = static_cast<float>(std::sqrt(polygonArea(rays.scene(), rays.scene().polygons[polygon])));
    return point + rays.originOffset(size) * normal;
}

SidePoints::SidePoints(const Scene& scene, const std::function<double(double, const Material&)>& weight)
    : scene_(scene) {
    double sum = 0.0;
    const auto add = [&](std::uint32_t polygon, bool back, std::uint32_t material) {
        if (material == kNone || scene.materials[material].occluder) return;
        const double own = weight(polygonArea(scene, scene.polygons[polygon]), scene.materials[material]);
        if (own > 0.0) sides_.push_back({polygon, back, sum += own});
    };
    for (std::uint32_t i = 0; i < scene.polygons.size(); ++i) {
        add(i, false, scene.polygons[i].material);
        add(i, true, scene.polygons[i].backMaterial);
    }
}

SidePoint SidePoints::at(double share, const glm::dvec2& u) const {
    const double target = share * sides_.back().upTo;
    const auto found = std::upper_bound(sides_.begin(), sides_.end(), target,
                                        [](double value, const Side& side) { return value < side.upTo; });
    const Side& side = found != sides_.end() ? *found : sides_.back();
    const Polygon& polygon = scene_.polygons[side.polygon];
    const glm::vec2 chart = PolygonPoints(scene_, polygon).chartAt(u);
    const glm::vec3 normal(planeFrame(scene_, polygon).normal()); // of a sliver better than its area vector
    return {polygonPoint(scene_, side.polygon, chart.x, chart.y), side.back ? -normal : normal, side.polygon};
}

SidePoints emittingSides(const Scene& scene) {
    return {scene, [](double area, const Material& material) {
                const Rgb& emitted = material.emittedRadiance;
                return area * static_cast<double>(emitted.x + emitted.y + emitted.z);
            }};
}

void aimPacket(const glm::vec3& normal, std::uint32_t one, std::uint32_t two, RayPacket& packet) {
    constexpr std::uint32_t kStrata = 4;
    static_assert(kStrata * kStrata == RayPacket::kSize);
    const glm::vec3 x = glm::normalize(
        glm::cross(normal, std::abs(normal.x) < 0.6F ? glm::vec3(1.0F, 0.0F, 0.0F) : glm::vec3(0.0F, 1.0F, 0.0F)));
    const glm::vec3 y = glm::cross(normal, x);
    for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
        const auto random = philox({one, two, lane, 2}, 0);
        const float squaredRadius = (static_cast<float>(lane / kStrata) + uniformFloat(random[0])) / kStrata;
        const float angle =
            2.0F * std::numbers::pi_v<float> * (static_cast<float>(lane % kStrata) + uniformFloat(random[1])) / kStrata;
        const float radius = std::sqrt(squaredRadius);
        packet.aim(static_cast<int>(lane), radius * (std::cos(angle) * x + std::sin(angle) * y) +
                                               std::sqrt(std::max(1.0F - squaredRadius, 0.0F)) * normal);
    }
}

} // namespace lambert
