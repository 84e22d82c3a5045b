#include "baking/reconstruction.h"

#include "baking/vertex_gather.h"
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
constexpr float kWithinPatch = 1.0F / 3.0F; ///< see varianceWithin

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

/// What a vertex reflects and emits, by the means below.
struct VertexOptics {
    Rgb reflectance{0.0F}, emitted{0.0F};
};

/// Means over the patches about a vertex, weighted by area, angle and openness; `vertexOptics`, if given, becomes #vertices.
BakedMesh averaged(const LitPatches& lit, const ReconstructionOptions& options, std::size_t* separatedFaces,
                   std::vector<VertexOptics>* vertexOptics) {
    const auto& [mesh, optics, scene, solution, unused] = lit;
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
    if (vertexOptics != nullptr) vertexOptics->reserve(count);
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
        if (vertexOptics != nullptr) vertexOptics->push_back({Rgb(share * reflectance), Rgb(share * emitted)});
        const double length = glm::length(normal);
        baked.normals.push_back(length > 0.0 ? glm::vec3(normal / length) : glm::vec3(0.0F, 0.0F, 1.0F));
    }
    return baked;
}

GatherReport reportOf(const std::vector<VertexLight>& vertices) {
    GatherReport report;
    RgbSum light(0.0), squares(0.0);
    for (const VertexLight& vertex : vertices) {
        if (vertex.rays == 0) continue;
        ++report.vertices;
        report.rays += vertex.rays;
        light += vertex.irradiance;
        squares += vertex.standardError * vertex.standardError;
        report.largestError = std::max(report.largestError, vertex.relative);
    }
    const double n = static_cast<double>(std::max<std::size_t>(report.vertices, 1));
    if (sumOf(light) > 0.0) report.error = std::sqrt(sumOf(squares) / (3.0 * n)) / (sumOf(light) / (3.0 * n));
    return report;
}

} // namespace

BakedMesh reconstructAverage(const LitPatches& lit, const ReconstructionOptions& options, std::size_t* separatedFaces) {
    return averaged(lit, options, separatedFaces, nullptr);
}

std::vector<Rgb> varianceWithin(const LitPatches& lit, const BakedMesh& average) {
    std::vector<Rgb> variance;
    variance.reserve(lit.mesh.size());
    for (std::size_t patch = 0; patch < lit.mesh.size(); ++patch) {
        const int count = lit.mesh.cornerCount(patch);
        Rgb squares(0.0F);
        for (int k = 0; k < count; ++k) {
            const Rgb& corner = average.irradiance[average.faces[patch][static_cast<std::size_t>(k)]];
            const Rgb difference = corner - Rgb(lit.solution.irradiance[patch]);
            squares += difference * difference;
        }
        squares *= kWithinPatch / static_cast<float>(count);
        if (!lit.standardError.empty()) squares += lit.standardError[patch] * lit.standardError[patch];
        variance.push_back(lit.optics.reflectance[patch] * lit.optics.reflectance[patch] * squares);
    }
    return variance;
}

BakedMesh reconstructGather(const LitPatches& lit, const RayCaster& rays, const LightSources& sources,
                            const ReconstructionOptions& options, const FinalGatherOptions& gatherOptions,
                            Progress& progress, GatherReport* report, std::size_t* separatedFaces) {
    std::vector<VertexOptics> optics;
    BakedMesh baked = averaged(lit, options, separatedFaces, &optics);
    const FinalGather gather(rays, lit, sources, varianceWithin(lit, baked), gatherOptions);
    const VertexPlaces places(rays, lit.mesh, baked, lit.solution.covered);
    const std::vector<VertexLight> found = gatherAtVertices(gather, places, baked, progress);
    for (std::size_t vertex = 0; vertex < found.size(); ++vertex) {
        if (found[vertex].rays == 0) continue;
        baked.irradiance[vertex] = Rgb(found[vertex].irradiance);
        baked.radiosity[vertex] = optics[vertex].emitted + optics[vertex].reflectance * baked.irradiance[vertex];
    }
    if (report != nullptr) *report = reportOf(found);
    return baked;
}

} // namespace lambert
