#include "baking/reconstruction.h"

#include "meshing/half_edge_mesh.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

namespace lambert {

namespace {

/// Lets a vertex that has nothing but covered patches keep their mean.
constexpr double kSmallestOpenness = 1e-4;

double angleAt(const PatchMesh& mesh, std::size_t patch, int k) {
    const int count = mesh.cornerCount(patch);
    const glm::dvec3 here(mesh.position(patch, k));
    const glm::dvec3 next = glm::dvec3(mesh.position(patch, (k + 1) % count)) - here;
    const glm::dvec3 previous = glm::dvec3(mesh.position(patch, (k + count - 1) % count)) - here;
    return std::atan2(glm::length(glm::cross(next, previous)), glm::dot(next, previous));
}

/// Positions and faces; what the half-edges take is free again before light comes to the vertices.
BakedMesh makeVertices(const PatchMesh& mesh, float creaseAngle, std::size_t* separatedFaces) {
    BakedMesh baked;
    std::size_t vertices = 0;
    {
        HalfEdgeMesh halfEdges = buildHalfEdgeMesh(mesh, creaseAngle);
        if (separatedFaces != nullptr) *separatedFaces = halfEdges.separatedFaces;
        baked.faces = std::move(halfEdges.corners);
        vertices = halfEdges.topology.n_vertices();
    }
    // A separated face may have left vertices that no face has.
    std::vector<std::uint32_t> places(vertices, kNone);
    baked.positions.reserve(vertices);
    for (std::size_t patch = 0; patch < mesh.size(); ++patch) {
        for (int k = 0; k < mesh.cornerCount(patch); ++k) {
            std::uint32_t& vertex = baked.faces[patch][static_cast<std::size_t>(k)];
            if (places[vertex] == kNone) {
                places[vertex] = static_cast<std::uint32_t>(baked.positions.size());
                baked.positions.push_back(mesh.position(patch, k));
            }
            vertex = places[vertex];
        }
    }
    return baked;
}

/// Of each vertex its corners (4 × patch + k), in order.
class VertexCorners {
public:
    VertexCorners(const PatchMesh& mesh, const BakedMesh& baked) : ends_(baked.positions.size() + 1, 0) {
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

    std::span<const std::uint32_t> of(std::size_t vertex) const {
        const std::size_t begin = vertex == 0 ? 0 : ends_[vertex - 1];
        return std::span(corners_).subspan(begin, ends_[vertex] - begin);
    }

private:
    std::vector<std::uint32_t> ends_; ///< #vertices + 1, into corners_
    std::vector<std::uint32_t> corners_;
};

} // namespace

BakedMesh reconstructAverage(const PatchMesh& mesh, const PatchOptics& optics, const Scene& scene,
                             const RadiositySolution& solution, const ReconstructionOptions& options,
                             std::size_t* separatedFaces) {
    BakedMesh baked = makeVertices(mesh, options.creaseAngle, separatedFaces);
    baked.origin = scene.origin;
    baked.materials = scene.materials;
    baked.faceMaterials = mesh.material;
    baked.opacity = mesh.opacity;
    if (!options.keepHidden && !mesh.hidden.empty()) {
        baked.opacity.resize(mesh.size(), 1.0F);
        for (std::size_t patch = 0; patch < mesh.size(); ++patch)
            if (mesh.hidden[patch]) baked.opacity[patch] = 0.0F;
    }
    baked.emitters.reserve(mesh.size());
    for (const Rgb& b : optics.emittedRadiosity) baked.emitters.push_back(b != Rgb(0.0F));

    const VertexCorners around(mesh, baked);
    const std::size_t count = baked.positions.size();
    baked.irradiance.reserve(count);
    baked.radiosity.reserve(count);
    baked.normals.reserve(count);
    for (std::size_t vertex = 0; vertex < count; ++vertex) {
        RgbSum irradiance(0.0), reflectance(0.0), emitted(0.0);
        glm::dvec3 normal(0.0);
        double weights = 0.0;
        for (const std::uint32_t corner : around.of(vertex)) {
            const std::uint32_t patch = corner / 4;
            const double openness = std::max(1.0 - static_cast<double>(solution.covered[patch]), kSmallestOpenness);
            const double whole =
                static_cast<double>(mesh.area[patch]) * angleAt(mesh, patch, static_cast<int>(corner % 4));
            const double weight = whole * openness;
            irradiance += weight * solution.irradiance[patch];
            reflectance += weight * RgbSum(optics.reflectance[patch]);
            emitted += weight * RgbSum(optics.emittedRadiosity[patch]);
            normal += whole * glm::dvec3(mesh.normal[patch]);
            weights += weight;
        }
        const double share = weights > 0.0 ? 1.0 / weights : 0.0;
        const RgbSum e = glm::max(share * irradiance, RgbSum(0.0)); // the noise of random lines may come out below 0
        baked.irradiance.emplace_back(e);
        baked.radiosity.emplace_back(share * emitted + share * reflectance * e);
        const double length = glm::length(normal);
        baked.normals.push_back(length > 0.0 ? glm::vec3(normal / length) : glm::vec3(0.0F, 0.0F, 1.0F));
    }
    return baked;
}

} // namespace lambert
