#include "meshing/pair_triangles.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace lambert {

namespace {

constexpr double kLargestCosine = 0.70711; ///< corners of 45° to 135°
constexpr double kFlatness = 1e-5;         ///< of the quad's size, as for quads that are read

struct HalfEdge {
    std::pair<std::uint32_t, std::uint32_t> key;
    std::uint32_t face;
    std::uint32_t opposite; ///< the face's vertex that is not on the edge
    bool forward;           ///< the face runs from the smaller vertex to the larger
};

struct Candidate {
    double badness; ///< largest |cosine| of the four corners
    std::uint32_t first, second;
    Corners quad;
};

std::optional<double> badness(const Corners& quad, std::span<const glm::vec3> positions) {
    std::array<glm::dvec3, 4> p;
    for (std::size_t k = 0; k < 4; ++k) p[k] = glm::dvec3(positions[quad[k]]);
    const glm::dvec3 normal = glm::cross(p[2] - p[0], p[3] - p[1]);
    const double length = glm::length(normal);
    const double size = std::max(glm::length(p[2] - p[0]), glm::length(p[3] - p[1]));
    if (!(length > 0.0)) return std::nullopt;
    // For a quad the four distances from its mean plane are equal.
    if (std::abs(glm::dot(normal / length, p[1] - p[0])) * 0.5 > kFlatness * size) return std::nullopt;
    double worst = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
        const glm::dvec3 in = p[k] - p[(k + 3) % 4];
        const glm::dvec3 out = p[(k + 1) % 4] - p[k];
        if (glm::dot(glm::cross(in, out), normal) <= 0.0) return std::nullopt; // not convex
        const double lengths = glm::length(in) * glm::length(out);
        worst = std::max(worst, std::abs(glm::dot(in, out)) / lengths);
    }
    if (worst > kLargestCosine) return std::nullopt;
    return worst;
}

std::vector<HalfEdge> triangleEdges(const std::vector<Corners>& faces) {
    std::vector<HalfEdge> edges;
    for (std::uint32_t face = 0; face < faces.size(); ++face) {
        const Corners& c = faces[face];
        if (c[3] != kNone) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = c[k];
            const std::uint32_t b = c[(k + 1) % 3];
            edges.push_back({edgeKey(a, b), face, c[(k + 2) % 3], a < b});
        }
    }
    std::sort(edges.begin(), edges.end(),
              [](const HalfEdge& a, const HalfEdge& b) { return std::tie(a.key, a.face) < std::tie(b.key, b.face); });
    return edges;
}

} // namespace

std::vector<FaceOrigin> pairTriangles(std::vector<Corners>& faces, std::span<const std::uint32_t> group,
                                      std::span<const glm::vec3> positions,
                                      std::span<const std::pair<std::uint32_t, std::uint32_t>> fixed) {
    const std::vector<HalfEdge> edges = triangleEdges(faces);
    std::vector<Candidate> candidates;
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        while (end < edges.size() && edges[end].key == edges[begin].key) ++end;
        if (end - begin != 2) continue; // a border, or an edge where something else meets
        const HalfEdge& one = edges[begin];
        const HalfEdge& two = edges[begin + 1];
        if (one.forward == two.forward || group[one.face] != group[two.face]) continue;
        if (std::binary_search(fixed.begin(), fixed.end(), one.key)) continue;
        const auto [low, high] = one.key;
        const std::uint32_t from = one.forward ? low : high;
        const std::uint32_t to = one.forward ? high : low;
        const Corners quad{from, two.opposite, to, one.opposite};
        if (const auto value = badness(quad, positions)) candidates.push_back({*value, one.face, two.face, quad});
    }
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return std::tie(a.badness, a.first, a.second) < std::tie(b.badness, b.first, b.second);
    });

    std::vector<bool> used(faces.size(), false);
    std::vector<bool> dropped(faces.size(), false);
    std::vector<std::uint32_t> partner(faces.size(), kNone);
    for (const Candidate& candidate : candidates) {
        if (used[candidate.first] || used[candidate.second]) continue;
        used[candidate.first] = used[candidate.second] = true;
        faces[candidate.first] = candidate.quad;
        partner[candidate.first] = candidate.second;
        dropped[candidate.second] = true;
    }
    std::vector<FaceOrigin> origin;
    std::size_t kept = 0;
    for (std::uint32_t face = 0; face < faces.size(); ++face) {
        if (dropped[face]) continue;
        faces[kept++] = faces[face];
        origin.push_back({face, partner[face]});
    }
    faces.resize(kept);
    return origin;
}

} // namespace lambert
