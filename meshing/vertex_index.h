#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <span>
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

} // namespace lambert
