#include "meshing/patch_offset.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

/// How far the lowest corner of a patch may be beneath the highest point of its polygon, seen from the patch's side.
double depthBeneathPolygon(const Scene& scene, const PatchMesh& mesh, std::size_t patch) {
    const Polygon& polygon = scene.polygons[mesh.polygon[patch]];
    glm::dvec3 points[4]; // relative to the first, in double: of a sliver the normal must still be one
    for (int k = 1; k < polygon.size(); ++k)
        points[k] = glm::dvec3(corner(scene, polygon, k)) - glm::dvec3(corner(scene, polygon, 0));
    glm::dvec3 normal =
        polygon.isQuad() ? glm::cross(points[2], points[3] - points[1]) : glm::cross(points[1], points[2]);
    const double length = glm::length(normal);
    if (!(length > 0.0)) return 0.0;
    normal /= glm::dot(normal, glm::dvec3(mesh.normal[patch])) < 0.0 ? -length : length;
    double highest = 0.0;
    for (int k = 1; k < polygon.size(); ++k) highest = std::max(highest, glm::dot(normal, points[k]));
    double lowest = highest;
    for (int k = 0; k < mesh.cornerCount(patch); ++k)
        lowest = std::min(
            lowest, glm::dot(normal, glm::dvec3(mesh.position(patch, k)) - glm::dvec3(corner(scene, polygon, 0))));
    return highest - lowest;
}

} // namespace

float patchOriginOffset(const RayCaster& rays, const PatchMesh& mesh, std::size_t patch) {
    const float offset = rays.originOffset(std::sqrt(mesh.area[patch]));
    const auto depth = static_cast<float>(depthBeneathPolygon(rays.scene(), mesh, patch));
    // Rounding of coordinates alone is a tenth of this, and what the offset is for.
    return depth > 0.25F * rays.originOffset(0.0F) ? offset + depth : offset;
}

} // namespace lambert
