#include "baking/reconstruction.h"

#include "meshing/half_edge_mesh.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

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

} // namespace

BakedMesh reconstructAverage(const PatchMesh& mesh, const Scene& scene, const RadiositySolution& solution,
                             const ReconstructionOptions& options, std::size_t* separatedFaces) {
    const HalfEdgeMesh halfEdges = buildHalfEdgeMesh(mesh, options.creaseAngle);
    if (separatedFaces != nullptr) *separatedFaces = halfEdges.separatedFaces;
    const auto& topology = halfEdges.topology;

    BakedMesh baked;
    baked.materials = scene.materials;
    baked.faceMaterials = mesh.material;
    baked.opacity = mesh.opacity;
    for (const Rgb& b : mesh.emittedRadiosity) baked.emitters.push_back(b != Rgb(0.0F));
    baked.positions.resize(topology.n_vertices());
    std::vector<RgbSum> irradiance(topology.n_vertices(), RgbSum(0.0));
    std::vector<double> weights(topology.n_vertices(), 0.0);
    std::vector<glm::dvec3> normals(topology.n_vertices(), glm::dvec3(0.0));
    std::vector<RgbSum> reflectance(topology.n_vertices(), RgbSum(0.0));
    std::vector<RgbSum> emitted(topology.n_vertices(), RgbSum(0.0));
    baked.faces.reserve(mesh.size());
    for (const auto face : topology.faces()) {
        const auto patch = static_cast<std::size_t>(face.idx());
        const double openness = std::max(1.0 - static_cast<double>(solution.covered[patch]), kSmallestOpenness);
        std::array<std::uint32_t, 4> corners{kNone, kNone, kNone, kNone};
        // OpenMesh starts a face's walk at any of its vertices; the patch knows the order.
        for (const auto vertex : face.vertices()) {
            const auto p = topology.point(vertex);
            const glm::vec3 position(p[0], p[1], p[2]);
            int k = 0;
            while (k + 1 < mesh.cornerCount(patch) && mesh.position(patch, k) != position) ++k;
            const auto index = static_cast<std::size_t>(vertex.idx());
            corners[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(index);
            const double weight = static_cast<double>(mesh.area[patch]) * angleAt(mesh, patch, k);
            irradiance[index] += weight * openness * solution.irradiance[patch];
            weights[index] += weight * openness;
            normals[index] += weight * glm::dvec3(mesh.normal[patch]);
            reflectance[index] += weight * openness * RgbSum(mesh.reflectance[patch]);
            emitted[index] += weight * openness * RgbSum(mesh.emittedRadiosity[patch]);
            baked.positions[index] = position;
        }
        baked.faces.push_back(corners);
    }
    for (std::size_t i = 0; i < baked.positions.size(); ++i) {
        const double share = weights[i] > 0.0 ? 1.0 / weights[i] : 0.0;
        const RgbSum e = share * irradiance[i];
        baked.irradiance.emplace_back(e);
        baked.radiosity.emplace_back(share * emitted[i] + share * reflectance[i] * e);
        const double length = glm::length(normals[i]);
        baked.normals.push_back(length > 0.0 ? glm::vec3(normals[i] / length) : glm::vec3(0.0F, 0.0F, 1.0F));
    }
    return baked;
}

} // namespace lambert
