#include "baking/vertex_corners.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <numeric>

namespace lambert {

VertexCorners::VertexCorners(const PatchMesh& mesh, const BakedMesh& baked) : ends_(baked.positions.size() + 1, 0) {
    const auto forEachCorner = [&](const auto& action) {
        for (std::uint32_t patch = 0; patch < mesh.size(); ++patch)
            for (int k = 0; k < mesh.cornerCount(patch); ++k)
                action(4 * patch + static_cast<std::uint32_t>(k), baked.faces[patch][static_cast<std::size_t>(k)]);
    };
    forEachCorner([&](std::uint32_t, std::uint32_t vertex) { ++ends_[vertex + 1]; });
    std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
    corners_.resize(ends_.back());
    // Filling moves each vertex's begin to its end, which is where the next one begins.
    forEachCorner([&](std::uint32_t corner, std::uint32_t vertex) { corners_[ends_[vertex]++] = corner; });
}

double angleAt(const PatchMesh& mesh, std::size_t patch, int k) {
    const int count = mesh.cornerCount(patch);
    const glm::dvec3 here(mesh.position(patch, k));
    const glm::dvec3 next = glm::dvec3(mesh.position(patch, (k + 1) % count)) - here;
    const glm::dvec3 previous = glm::dvec3(mesh.position(patch, (k + count - 1) % count)) - here;
    return std::atan2(glm::length(glm::cross(next, previous)), glm::dot(next, previous));
}

} // namespace lambert
