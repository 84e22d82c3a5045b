#pragma once

#include "scene/scene.h"

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace lambert {

/// Finds the boxes that meet a given one, their borders included: an R-tree over #boxes. Thread-safe.
class BoxIndex {
public:
    explicit BoxIndex(std::vector<Bounds> boxes);
    ~BoxIndex();

    /// Replaces `found` by the boxes that meet this one, ascending.
    void meeting(const Bounds& box, std::vector<std::uint32_t>& found) const;
    /// The same of box `index`: those that come after it.
    void nearLater(std::uint32_t index, std::vector<std::uint32_t>& found) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Boxes of single points.
std::vector<Bounds> boxesOf(std::span<const glm::vec3> positions);
/// Boxes of edges, as pairs of positions, `margin` (metres) larger on all sides.
std::vector<Bounds> boxesOf(std::span<const glm::vec3> positions,
                            std::span<const std::pair<std::uint32_t, std::uint32_t>> edges, float margin);

} // namespace lambert
