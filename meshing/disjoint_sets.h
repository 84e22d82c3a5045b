#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace lambert {

/// Elements 0 to count − 1 in sets that can be united; each set is known by its smallest element.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

    std::uint32_t root(std::uint32_t element) {
        while (parent_[element] != element) {
            parent_[element] = parent_[parent_[element]];
            element = parent_[element];
        }
        return element;
    }
    void unite(std::uint32_t a, std::uint32_t b) {
        a = root(a);
        b = root(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }
    /// The root of each element; the sets are used up.
    std::vector<std::uint32_t> roots() && {
        for (std::uint32_t element = 0; element < parent_.size(); ++element) parent_[element] = root(element);
        return std::move(parent_);
    }

private:
    std::vector<std::uint32_t> parent_;
};

} // namespace lambert
