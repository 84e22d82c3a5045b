#include "meshing/half_edge_mesh.h"

#include "core/process.h"
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
    std::uint32_t owner; ///< patch; from #patches on, #patches + index into occluderEdges
    bool forward;        ///< the patch runs from the smaller vertex to the larger

    const glm::vec3& centroid(const PatchMesh& mesh) const {
        return owner < mesh.size() ? mesh.centroid[owner] : mesh.occluderEdges[owner - mesh.size()].centroid;
    }
};

std::uint32_t cornerAt(const PatchMesh& mesh, std::uint32_t patch, std::uint32_t vertex) {
    const Corners& corners = mesh.corners[patch];
    const auto k = std::find(corners.begin(), corners.end(), vertex) - corners.begin();
    return 4 * patch + static_cast<std::uint32_t>(k);
}

/// Edges of the fronts and of the occluders, sorted.
std::vector<PatchEdge> frontEdges(const PatchMesh& mesh) {
    std::vector<PatchEdge> edges;
    edges.reserve(4 * mesh.frontCount + mesh.occluderEdges.size());
    for (std::uint32_t patch = 0; patch < mesh.frontCount; ++patch) {
        const int count = mesh.cornerCount(patch);
        for (int k = 0; k < count; ++k) {
            const std::uint32_t a = mesh.corners[patch][static_cast<std::size_t>(k)];
            const std::uint32_t b = mesh.corners[patch][static_cast<std::size_t>((k + 1) % count)];
            edges.push_back({edgeKey(a, b), patch, a < b});
        }
    }
    auto occluder = static_cast<std::uint32_t>(mesh.size());
    for (const OccluderEdge& edge : mesh.occluderEdges) edges.push_back({edge.vertices, occluder++, true});
    std::sort(edges.begin(), edges.end(), [](const PatchEdge& a, const PatchEdge& b) {
        return std::tie(a.key, a.owner) < std::tie(b.key, b.owner);
    });
    return edges;
}

/// Whether another patch or an occluder at the edge rises on the front side of these two (`side` 1) or on their back (−1).
bool somethingStandsOn(const PatchMesh& mesh, std::span<const PatchEdge> around, const PatchEdge& one,
                       const PatchEdge& two, float side) {
    const glm::vec3 normal = side * glm::normalize(mesh.normal[one.owner] + mesh.normal[two.owner]);
    const glm::vec3 foot = mesh.positions[one.key.first];
    return std::any_of(around.begin(), around.end(), [&](const PatchEdge& other) {
        if (other.owner == one.owner || other.owner == two.owner) return false;
        const glm::vec3 toOther = other.centroid(mesh) - foot;
        return glm::dot(normal, toOther) > 0.01F * glm::length(toOther);
    });
}

/// Of each corner (4 × patch + k) the first one that shares its vertex of one smoothing side.
std::vector<std::uint32_t> smoothCorners(const PatchMesh& mesh, float creaseAngle) {
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
                if (two.owner >= mesh.size()) break; // occluders come last
                if (one.forward == two.forward || mesh.material[one.owner] != mesh.material[two.owner] ||
                    glm::dot(mesh.normal[one.owner], mesh.normal[two.owner]) < smallestCosine)
                    continue;
                const std::uint32_t backOne = mesh.lookup.backPatch(mesh.polygon[one.owner], one.owner);
                const std::uint32_t backTwo = mesh.lookup.backPatch(mesh.polygon[two.owner], two.owner);
                const bool openFront = !somethingStandsOn(mesh, around, one, two, 1.0F);
                const bool openBack =
                    backOne != kNone && backTwo != kNone && !somethingStandsOn(mesh, around, one, two, -1.0F);
                for (const std::uint32_t vertex : {one.key.first, one.key.second}) {
                    if (openFront) connect(one.owner, two.owner, vertex);
                    if (openBack) connect(backOne, backTwo, vertex);
                }
            }
        }
    }
    return std::move(sets).roots();
}

} // namespace

HalfEdgeMesh buildHalfEdgeMesh(const PatchMesh& mesh, float creaseAngle) {
    using Topology = decltype(HalfEdgeMesh::topology);
    HalfEdgeMesh result;
    Topology& topology = result.topology;
    std::vector<Corners>& corners = result.corners;
    const auto addVertex = [&](std::uint32_t position) {
        const glm::vec3& p = mesh.positions[position];
        return static_cast<std::uint32_t>(topology.add_vertex(Topology::Point(p.x, p.y, p.z)).idx());
    };
    {
        const std::vector<std::uint32_t> first = smoothCorners(mesh, creaseAngle);
        corners.reserve(mesh.size());
        for (std::uint32_t patch = 0; patch < mesh.size(); ++patch) {
            Corners& vertices = corners.emplace_back(Corners{kNone, kNone, kNone, kNone});
            for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(mesh.cornerCount(patch)); ++k) {
                const std::uint32_t of = first[4 * patch + k];
                vertices[k] = of == 4 * patch + k ? addVertex(mesh.corners[patch][k]) : corners[of / 4][of % 4];
            }
        }
    }

    ::omerr().disable(); // it reports each refused face; they are counted instead
    // A bake has most in memory here, and the sets of corners may have lain in gaps that earlier work left.
    returnFreedMemory();
    // Growing, the edges would be in memory twice; there are never more of them than corners.
    topology.reserve(topology.n_vertices(), 4 * mesh.size(), mesh.size());
    std::vector<Topology::VertexHandle> face;
    const auto add = [&](std::size_t patch) {
        face.clear();
        for (int k = 0; k < mesh.cornerCount(patch); ++k)
            face.emplace_back(static_cast<int>(corners[patch][static_cast<std::size_t>(k)]));
        return topology.add_face(face).is_valid();
    };
    for (std::size_t patch = 0; patch < mesh.size(); ++patch) {
        if (add(patch)) continue;
        ++result.separatedFaces;
        for (std::size_t k = 0; k < static_cast<std::size_t>(mesh.cornerCount(patch)); ++k)
            corners[patch][k] = addVertex(mesh.corners[patch][k]);
        add(patch);
    }
    ::omerr().enable();
    return result;
}

} // namespace lambert
