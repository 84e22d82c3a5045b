#include "meshing/back_faces.h"

#include "core/random.h"
#include "meshing/plane_frame.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace lambert {

namespace {

constexpr std::size_t kPoints = 4096;
constexpr double kInside = 0.8; // of a point's rays on backs: as where form factors are judged after a bake
constexpr int kStrata = 4;      // a packet's rays: kStrata × kStrata
static_assert(kStrata * kStrata == RayPacket::kSize);

/// One side of a polygon, and the sum of the weights up to and including it.
struct Side {
    std::uint32_t polygon;
    bool back;
    double upTo;
};

using Weight = std::function<double(double area, const Material& material)>;

std::vector<Side> weightedSides(const Scene& scene, const Weight& weight) {
    std::vector<Side> sides;
    double sum = 0.0;
    const auto add = [&](std::uint32_t polygon, bool back, std::uint32_t material) {
        if (material == kNone || scene.materials[material].occluder) return;
        const double area = polygonArea(scene, scene.polygons[polygon]);
        const double own = weight(area, scene.materials[material]);
        if (own > 0.0) sides.push_back({polygon, back, sum += own});
    };
    for (std::uint32_t i = 0; i < scene.polygons.size(); ++i) {
        add(i, false, scene.polygons[i].material);
        add(i, true, scene.polygons[i].backMaterial);
    }
    return sides;
}

/// A point spread evenly over a polygon, from two numbers in [0, 1).
glm::vec3 pointOn(const Scene& scene, const Polygon& polygon, float one, float two) {
    std::array<int, 3> triangle{0, 1, 2};
    if (polygon.isQuad()) {
        const auto area = [&](int a, int b, int c) {
            const glm::dvec3 from(corner(scene, polygon, a));
            return glm::length(
                glm::cross(glm::dvec3(corner(scene, polygon, b)) - from, glm::dvec3(corner(scene, polygon, c)) - from));
        };
        const double first = area(0, 1, 2), second = area(0, 2, 3);
        const auto share = static_cast<float>(first / (first + second));
        if (one < share) {
            one /= share;
        } else {
            one = (one - share) / (1.0F - share);
            triangle = {0, 2, 3};
        }
    }
    const float root = std::sqrt(one);
    const glm::vec3 a = corner(scene, polygon, triangle[0]);
    return a + root * (1.0F - two) * (corner(scene, polygon, triangle[1]) - a) +
           root * two * (corner(scene, polygon, triangle[2]) - a);
}

/// Directions of a packet around `normal`, density cos/π, one in each of 4 × 4 strata.
void aim(const PlaneFrame& frame, const glm::vec3& normal, std::uint32_t point, RayPacket& packet) {
    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
        const auto random = philox({point, static_cast<std::uint32_t>(lane), 1, 0}, 0);
        const float squaredRadius = (static_cast<float>(lane / kStrata) + uniformFloat(random[0])) / kStrata;
        const float turn = (static_cast<float>(lane % kStrata) + uniformFloat(random[1])) / kStrata;
        const float radius = std::sqrt(squaredRadius);
        const float angle = 2.0F * std::numbers::pi_v<float> * turn;
        const glm::vec3 direction = radius * std::cos(angle) * glm::vec3(frame.axisX) +
                                    radius * std::sin(angle) * glm::vec3(frame.axisY) +
                                    std::sqrt(std::max(1.0F - squaredRadius, 0.0F)) * normal;
        packet.directionX[lane] = direction.x;
        packet.directionY[lane] = direction.y;
        packet.directionZ[lane] = direction.z;
        packet.active[lane] = -1;
    }
}

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

BackFaceSample sample(const RayCaster& rays, const Weight& weight) {
    const Scene& scene = rays.scene();
    BackFaceSample result;
    result.byMaterial.assign(scene.materials.size(), 0.0);
    const std::vector<Side> sides = weightedSides(scene, weight);
    if (sides.empty()) return result;
    std::size_t counted = 0;
    RayPacket packet;
    auto side = sides.begin();
    for (std::uint32_t i = 0; i < kPoints; ++i) {
        const double target = sides.back().upTo * (static_cast<double>(i) + 0.5) / static_cast<double>(kPoints);
        while (side->upTo < target) ++side;
        const Polygon& polygon = scene.polygons[side->polygon];
        const PlaneFrame frame = planeFrame(scene, polygon);
        glm::vec3 normal(glm::cross(frame.axisX, frame.axisY)); // of a sliver better than its area vector
        if (side->back) normal = -normal;
        const auto random = philox({i, 0, 0, 0}, 0);
        const auto size = static_cast<float>(std::sqrt(polygonArea(scene, polygon)));
        aim(frame, normal, i, packet);
        rays.closest(pointOn(scene, polygon, uniformFloat(random[0]), uniformFloat(random[1])) +
                         rays.originOffset(size) * normal,
                     packet);
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
    return sample(rays, [](double area, const Material&) { return area; });
}

BackFaceSample sampleBackFacesFromLights(const RayCaster& rays) {
    return sample(rays, [](double area, const Material& material) {
        const Rgb& emitted = material.emittedRadiance;
        return area * static_cast<double>(emitted.x + emitted.y + emitted.z);
    });
}

} // namespace lambert
