#pragma once

#include "scene/box_index.h"

#include <boost/functional/hash.hpp>

#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace lambert {

/// Divides every edge of a scene once, for all polygons on it, so that no T-vertex remains: a vertex that lies on
/// another polygon's edge is inserted into that edge, and the segments in between are cut into equal parts no longer than
/// the target length.
class EdgeDivision {
public:
    /// Appends the division points to `positions`, which begin with the scene's; `index` is of these. `targetLength` in metres,
    /// may be infinite.
    EdgeDivision(const Scene& scene, const BoxIndex& index, double targetLength, std::vector<glm::vec3>& positions);

    /// One side of a polygon: all vertices from corner k to corner k + 1, both included.
    struct Side {
        std::vector<std::uint32_t> vertices;
        int segments = 1; ///< between vertices of the scene; more than 1 if others were inserted
    };
    Side side(const Polygon& polygon, int k) const;

    /// Segments that end in a vertex of the scene, as indices.
    std::vector<std::uint32_t> segmentsAt(std::uint32_t vertex) const;
    /// The two vertices of the scene that a segment joins.
    std::pair<std::uint32_t, std::uint32_t> segment(std::uint32_t index) const { return segments_[index].key; }
    /// All vertices of a segment from one end to the other.
    std::vector<std::uint32_t> segmentVertices(std::uint32_t index) const;

private:
    using Key = std::pair<std::uint32_t, std::uint32_t>;
    struct Segment {
        Key key;
        std::uint32_t parts = 1;
        std::uint32_t firstPoint = kNone; ///< division points, from key.first to key.second
    };

    std::uint32_t find(std::uint32_t a, std::uint32_t b) const;
    void insertVertices(const Scene& scene, const BoxIndex& index, const std::vector<Key>& edges);
    void collectSegments(const std::vector<Key>& edges, std::size_t vertexCount);
    void balanceQuads(const Scene& scene);
    void chain(std::uint32_t a, std::uint32_t b, std::vector<std::uint32_t>& vertices) const;

    /// Vertices inserted into an edge, from the smaller end to the larger; edges without any are absent.
    std::unordered_map<Key, std::vector<std::uint32_t>, boost::hash<Key>> inserted_;
    std::vector<Segment> segments_; ///< sorted by key
    std::vector<std::uint32_t> firstSegmentAt_, segmentsAt_;
};

} // namespace lambert
