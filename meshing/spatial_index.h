#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace lambert {

/// Finds the vertices in a box: an R-tree over #positions points.
class VertexIndex {
public:
    explicit VertexIndex(std::span<const glm::vec3> positions);
    ~VertexIndex();

    /// Replaces `found` by the indices of the positions p with lower <= p <= upper, ascending.
    void inBox(const glm::vec3& lower, const glm::vec3& upper, std::vector<std::uint32_t>& found) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Finds the edges whose bounding boxes meet that of a given edge: an R-tree over #edges boxes.
class EdgeIndex {
public:
    using Edge = std::pair<std::uint32_t, std::uint32_t>; ///< two vertices

    /// Boxes are enlarged by `margin` (metres).
    EdgeIndex(std::span<const glm::vec3> positions, std::span<const Edge> edges, float margin);
    ~EdgeIndex();

    /// Replaces `found` by the edges near edge `index` that come after it, ascending.
    void nearLater(std::uint32_t index, std::vector<std::uint32_t>& found) const;
    /// Replaces `found` by the edges whose boxes meet a box, ascending.
    void inBox(const glm::vec3& lower, const glm::vec3& upper, std::vector<std::uint32_t>& found) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace lambert
