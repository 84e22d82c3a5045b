#include "meshing/half_edge_mesh.h"

#include "meshing/disjoint_sets.h"
#include "meshing/pair_triangles.h"

#include <OpenMesh/Core/System/omstream.hh>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace lambert {

namespace {

struct PatchEdge {
    std::pair<std::uint32_t, std::uint32_t> key;
    std::uint32_t patch; ///< kNone: of an occluder
    bool forward;        ///< the patch runs from the smaller vertex to the larger
    glm::vec3 centroid;  ///< of the patch or occluder
};

std::uint32_t cornerAt(const PatchMesh& mesh, std::uint32_t patch, std::uint32_t vertex) {
    const Corners& corners = mesh.corners[patch];
    const auto k = std::find(corners.begin(), corners.end(), vertex) - corners.begin();
    return 4 * patch + static_cast<std::uint32_t>(k);
}

/// Edges of the fronts and of the occluders, sorted.
std::vector<PatchEdge> frontEdges(const PatchMesh& mesh) {
    std::vector<PatchEdge> edges;
    edges.reserve(4 * mesh.frontCount);
    for (std::uint32_t patch = 0; patch < mesh.frontCount; ++patch) {
        const int count = mesh.cornerCount(patch);
        for (int k = 0; k < count; ++k) {
            const std::uint32_t a = mesh.corners[patch][static_cast<std::size_t>(k)];
            const std::uint32_t b = mesh.corners[patch][static_cast<std::size_t>((k + 1) % count)];
            edges.push_back({edgeKey(a, b), patch, a < b, mesh.centroid[patch]});
        }
    }
    for (const OccluderEdge& edge : mesh.occluderEdges) edges.push_back({edge.vertices, kNone, true, edge.centroid});
    std::sort(edges.begin(), edges.end(), [](const PatchEdge& a, const PatchEdge& b) {
        return std::tie(a.key, a.patch) < std::tie(b.key, b.patch);
    });
    return edges;
}

/// Whether another patch or an occluder at the edge rises on the front side of these two (`side` 1) or on their back (−1).
bool somethingStandsOn(const PatchMesh& mesh, std::span<const PatchEdge> around, const PatchEdge& one,
                       const PatchEdge& two, float side) {
    const glm::vec3 normal = side * glm::normalize(mesh.normal[one.patch] + mesh.normal[two.patch]);
    const glm::vec3 foot = mesh.positions[one.key.first];
    return std::any_of(around.begin(), around.end(), [&](const PatchEdge& other) {
        if (other.patch == one.patch || other.patch == two.patch) return false;
        const glm::vec3 toOther = other.centroid - foot;
        return glm::dot(normal, toOther) > 0.01F * glm::length(toOther);
    });
}

/// Corners (4 × patch + k) that share a vertex of one smoothing side.
DisjointSets smoothCorners(const PatchMesh& mesh, float creaseAngle) {
    const float smallestCosine = std::cos(creaseAngle);
    DisjointSets sets(4 * mesh.size());
    const auto connect = [&](std::uint32_t one, std::uint32_t two, std::uint32_t vertex) {
        sets.unite(cornerAt(mesh, one, vertex), cornerAt(mesh, two, vertex));
    };
    const std::vector<PatchEdge> edges = frontEdges(mesh);
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        while (end < edges.size() && edges[end].key == edges[begin].key) ++end;
        const auto around = std::span(edges).subspan(begin, end - begin);
        for (std::size_t i = 0; i < around.size(); ++i) {
            for (std::size_t j = i + 1; j < around.size(); ++j) {
                const PatchEdge& one = around[i];
                const PatchEdge& two = around[j];
                if (two.patch == kNone) break; // occluders come last
                if (one.forward == two.forward || mesh.material[one.patch] != mesh.material[two.patch] ||
                    glm::dot(mesh.normal[one.patch], mesh.normal[two.patch]) < smallestCosine)
                    continue;
                const std::uint32_t backOne = mesh.lookup.backPatch(mesh.polygon[one.patch], one.patch);
                const std::uint32_t backTwo = mesh.lookup.backPatch(mesh.polygon[two.patch], two.patch);
                const bool openFront = !somethingStandsOn(mesh, around, one, two, 1.0F);
                const bool openBack =
                    backOne != kNone && backTwo != kNone && !somethingStandsOn(mesh, around, one, two, -1.0F);
                for (const std::uint32_t vertex : {one.key.first, one.key.second}) {
                    if (openFront) connect(one.patch, two.patch, vertex);
                    if (openBack) connect(backOne, backTwo, vertex);
                }
            }
        }
    }
    return sets;
}

} // namespace

HalfEdgeMesh buildHalfEdgeMesh(const PatchMesh& mesh, float creaseAngle) {
    using Topology = decltype(HalfEdgeMesh::topology);
    DisjointSets sets = smoothCorners(mesh, creaseAngle);
    HalfEdgeMesh result;
    Topology& topology = result.topology;
    const auto addVertex = [&](std::uint32_t position) {
        const glm::vec3& p = mesh.positions[position];
        return topology.add_vertex(Topology::Point(p.x, p.y, p.z));
    };

    ::omerr().disable(); // it reports each refused face; they are counted instead
    std::vector<int> vertexOfSet(4 * mesh.size(), -1);
    std::vector<Topology::VertexHandle> face;
    for (std::uint32_t patch = 0; patch < mesh.size(); ++patch) {
        face.clear();
        for (int k = 0; k < mesh.cornerCount(patch); ++k) {
            int& vertex = vertexOfSet[sets.root(4 * patch + static_cast<std::uint32_t>(k))];
            if (vertex < 0) vertex = addVertex(mesh.corners[patch][static_cast<std::size_t>(k)]).idx();
            face.emplace_back(vertex);
        }
        if (topology.add_face(face).is_valid()) continue;
        ++result.separatedFaces;
        for (std::size_t k = 0; k < face.size(); ++k) face[k] = addVertex(mesh.corners[patch][k]);
        topology.add_face(face);
    }
    ::omerr().enable();
    return result;
}

} // namespace lambert
