#pragma once

#include "scene/scene.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace lambert {

/// Finds the boxes that meet a given one: an R-tree over #boxes.
class BoxIndex {
public:
    explicit BoxIndex(std::span<const Bounds> boxes);
    ~BoxIndex();

    /// Replaces `found` by the boxes that meet box `index` and come after it, ascending. Thread-safe.
    void nearLater(std::uint32_t index, std::vector<std::uint32_t>& found) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace lambert
