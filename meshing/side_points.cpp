#include "meshing/side_points.h"

#include "meshing/plane_frame.h"
#include "scene/polygon_points.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace lambert {

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
    const PlaneFrame frame = planeFrame(scene_, polygon);
    const glm::vec3 normal(glm::cross(frame.axisX, frame.axisY)); // of a sliver better than its area vector
    return {polygonPoint(scene_, side.polygon, chart.x, chart.y), side.back ? -normal : normal, side.polygon};
}

} // namespace lambert
