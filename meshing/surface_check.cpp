#include "meshing/surface_check.h"

#include "meshing/disjoint_sets.h"
#include "meshing/edge_division.h"
#include "meshing/pair_triangles.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <limits>
#include <span>
#include <tuple>

namespace lambert {

namespace {

/// One polygon at one edge.
struct EdgeUse {
    std::pair<std::uint32_t, std::uint32_t> edge;
    std::uint32_t node;
    std::uint32_t polygon;
    bool forward; ///< the polygon runs from the smaller vertex to the larger
};

/// All uses of all edges, sorted by edge and node.
std::vector<EdgeUse> edgeUses(const Scene& scene) {
    std::vector<glm::vec3> positions = scene.positions;
    const EdgeDivision division(scene, BoxIndex(boxesOf(scene.positions)), std::numeric_limits<double>::infinity(),
                                positions);
    std::vector<EdgeUse> uses;
    uses.reserve(4 * scene.polygons.size());
    for (std::uint32_t i = 0; i < scene.polygons.size(); ++i) {
        const Polygon& polygon = scene.polygons[i];
        for (int k = 0; k < polygon.size(); ++k) {
            const std::vector<std::uint32_t> vertices = division.side(polygon, k).vertices;
            for (std::size_t j = 0; j + 1 < vertices.size(); ++j)
                uses.push_back({edgeKey(vertices[j], vertices[j + 1]), polygon.node, i, vertices[j] < vertices[j + 1]});
        }
    }
    std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
        return std::tie(a.edge, a.node, a.polygon, a.forward) < std::tie(b.edge, b.node, b.polygon, b.forward);
    });
    return uses;
}

/// Whether it matters where the front is.
bool isOneSided(const Scene& scene, const Polygon& polygon) {
    return polygon.backMaterial == kNone && !isOccluder(scene, polygon);
}

/// What happens at edges, kept by one polygon each until the shells are known.
class EdgeFindings {
public:
    explicit EdgeFindings(const Scene& scene)
        : sets(scene.polygons.size()),
          open(scene.polygons.size(), 0),
          branched(open),
          inconsistent(open),
          scene_(scene) {}

    /// The uses of one edge.
    void add(std::span<const EdgeUse> uses) {
        std::vector<EdgeUse> single;
        for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
            while (end < uses.size() && uses[end].node == uses[begin].node) ++end;
            const auto ofNode = uses.subspan(begin, end - begin);
            if (ofNode.size() == 1)
                single.push_back(ofNode.front());
            else
                join(ofNode);
        }
        if (single.size() == 2)
            join(single);
        else
            for (const EdgeUse& use : single) ++open[use.polygon];
    }

    DisjointSets sets;                                       ///< of polygons
    std::vector<std::uint32_t> open, branched, inconsistent; ///< #polygons

private:
    void join(std::span<const EdgeUse> uses) {
        const EdgeUse& first = uses.front();
        for (const EdgeUse& use : uses.subspan(1)) sets.unite(first.polygon, use.polygon);
        if (uses.size() > 2) {
            ++branched[first.polygon];
        } else if (uses[1].forward == first.forward && isOneSided(scene_, scene_.polygons[first.polygon]) &&
                   isOneSided(scene_, scene_.polygons[uses[1].polygon])) {
            ++inconsistent[first.polygon];
        }
    }

    const Scene& scene_;
};

/// Six times the volume between a polygon and the origin `from`.
double sixfoldVolume(const Scene& scene, const Polygon& polygon, const glm::dvec3& from) {
    const auto at = [&](int k) { return glm::dvec3(corner(scene, polygon, k)) - from; };
    double sum = glm::dot(at(0), glm::cross(at(1), at(2)));
    if (polygon.isQuad()) sum += glm::dot(at(0), glm::cross(at(2), at(3)));
    return sum;
}

void grow(Bounds& bounds, const Bounds& by) {
    bounds.lower = glm::min(bounds.lower, by.lower);
    bounds.upper = glm::max(bounds.upper, by.upper);
}

bool contains(const Bounds& outer, const Bounds& inner) {
    return glm::all(glm::lessThanEqual(outer.lower, inner.lower)) &&
           glm::all(glm::greaterThanEqual(outer.upper, inner.upper)) && outer.diagonal() > inner.diagonal();
}

/// A shell that grows by one polygon after the other.
struct GrowingShell {
    Shell shell;
    double largest = 0.0; ///< area of a polygon

    explicit GrowingShell(const glm::vec3& point) { shell.bounds = {point, point}; }

    void add(const Scene& scene, const Polygon& polygon, const glm::dvec3& from) {
        const auto area = polygonArea(scene, polygon);
        ++shell.polygons;
        shell.area += area;
        shell.volume += sixfoldVolume(scene, polygon, from) / 6.0;
        shell.oneSided = shell.oneSided && isOneSided(scene, polygon);
        grow(shell.bounds, boundsOf(scene, polygon));
        if (area <= largest) return;
        largest = area;
        shell.node = polygon.node;
        shell.material = polygon.material;
    }
};

std::vector<Shell> collectShells(const Scene& scene, EdgeFindings& findings) {
    const Bounds bounds = boundsOf(scene);
    const glm::dvec3 centre(0.5F * (bounds.lower + bounds.upper));
    std::vector<std::uint32_t> shellOf(scene.polygons.size(), kNone);
    std::vector<GrowingShell> growing;
    for (std::uint32_t i = 0; i < scene.polygons.size(); ++i) {
        const Polygon& polygon = scene.polygons[i];
        std::uint32_t& index = shellOf[findings.sets.root(i)];
        if (index == kNone) {
            index = static_cast<std::uint32_t>(growing.size());
            growing.emplace_back(corner(scene, polygon, 0));
        }
        growing[index].add(scene, polygon, centre);
        growing[index].shell.openEdges += findings.open[i];
        growing[index].shell.branchedEdges += findings.branched[i];
        growing[index].shell.inconsistentEdges += findings.inconsistent[i];
    }
    std::vector<Shell> shells;
    for (GrowingShell& grown : growing) {
        if (!grown.shell.isClosed() || grown.shell.inconsistentEdges > 0) grown.shell.volume = 0.0;
        shells.push_back(grown.shell);
    }
    std::stable_sort(shells.begin(), shells.end(), [](const Shell& a, const Shell& b) { return a.area > b.area; });
    return shells;
}

/// Marks the shells that are inside out.
void findInsideOut(std::vector<Shell>& shells) {
    constexpr std::size_t kCompared = 2000; // pairs are compared; what is smaller than so many others matters little
    const auto compared = std::span(shells).first(std::min(shells.size(), kCompared));
    for (Shell& shell : compared) {
        if (!(shell.volume < 0.0) || !shell.oneSided) continue;
        bool inside = false, holds = false;
        for (const Shell& other : compared) {
            inside = inside || contains(other.bounds, shell.bounds);
            holds = holds || contains(shell.bounds, other.bounds);
        }
        shell.insideOut = inside && !holds;
    }
}

} // namespace

SurfaceCheck checkSurfaces(const Scene& scene) {
    EdgeFindings findings(scene);
    const std::vector<EdgeUse> uses = edgeUses(scene);
    for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
        while (end < uses.size() && uses[end].edge == uses[begin].edge) ++end;
        findings.add(std::span(uses).subspan(begin, end - begin));
    }
    SurfaceCheck check;
    check.shells = collectShells(scene, findings);
    findInsideOut(check.shells);
    for (const Shell& shell : check.shells) {
        check.openEdges += shell.openEdges;
        check.branchedEdges += shell.branchedEdges;
        check.inconsistentEdges += shell.inconsistentEdges;
        check.closedShells += shell.isClosed() ? 1 : 0;
        check.insideOutShells += shell.insideOut ? 1 : 0;
    }
    return check;
}

} // namespace lambert
