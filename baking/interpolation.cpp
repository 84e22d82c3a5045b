#include "baking/interpolation.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

/// Twice the signed area that two edges in the patch's plane span, seen from `normal`.
double cross(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& normal) {
    return glm::dot(glm::cross(a, b), normal);
}

InterpolationWeights triangleWeights(const std::array<glm::dvec3, 4>& corners, const glm::dvec3& point) {
    const auto& [a, b, c, unused] = corners;
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    InterpolationWeights weights{std::max(0.0, cross(b - point, c - point, normal)),
                                 std::max(0.0, cross(c - point, a - point, normal)),
                                 std::max(0.0, cross(a - point, b - point, normal)), 0.0};
    const double sum = weights[0] + weights[1] + weights[2];
    if (!(sum > 0.0)) return {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 0.0};
    for (double& weight : weights) weight /= sum;
    return weights;
}

/// Where `point` = a + u e + v f + u v g with e = b − a, f = d − a, g = a − b + c − d. Eliminating u leaves
/// k2 v² + k1 v + k0 = 0. The root wanted is the one at which the map preserves orientation: its Jacobian is
/// k1 + 2 k2 v, which is plus the square root of the discriminant.
InterpolationWeights quadWeights(const std::array<glm::dvec3, 4>& corners, const glm::dvec3& point) {
    const auto& [a, b, c, d] = corners;
    const glm::dvec3 normal = glm::cross(c - a, d - b);
    const glm::dvec3 e = b - a;
    const glm::dvec3 f = d - a;
    const glm::dvec3 g = a - b + c - d;
    const glm::dvec3 h = point - a;
    const double k2 = cross(g, f, normal);
    const double k1 = cross(e, f, normal) + cross(h, g, normal);
    const double k0 = cross(h, e, normal);
    const double root = std::sqrt(std::max(0.0, k1 * k1 - 4.0 * k2 * k0));
    // Of the two forms of the root, the one without cancellation; the first also holds for parallelograms (k2
    // = 0).
    const double v = k1 >= 0.0 ? -2.0 * k0 / (k1 + root) : (root - k1) / (2.0 * k2);
    const double row = std::isfinite(v) ? std::clamp(v, 0.0, 1.0) : 0.0;
    const glm::dvec3 along = e + row * g;
    const double u = glm::dot(h - row * f, along) / glm::dot(along, along);
    const double column = std::isfinite(u) ? std::clamp(u, 0.0, 1.0) : 0.0;
    return {(1.0 - column) * (1.0 - row), column * (1.0 - row), column * row, (1.0 - column) * row};
}

} // namespace

InterpolationWeights interpolationWeights(const PatchMesh& mesh, std::uint32_t patch, const glm::vec3& point) {
    std::array<glm::dvec3, 4> corners{};
    for (int k = 0; k < mesh.cornerCount(patch); ++k)
        corners[static_cast<std::size_t>(k)] = glm::dvec3(mesh.position(patch, k));
    return mesh.isQuad(patch) ? quadWeights(corners, glm::dvec3(point)) : triangleWeights(corners, glm::dvec3(point));
}

} // namespace lambert
