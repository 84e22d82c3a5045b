#pragma once

#include <glm/common.hpp>

#include <limits>

namespace lambert {

/// The smallest box along the axes around points; of none, its lower corner lies above the upper one.
template <typename Point>
struct Box {
    Point lower{std::numeric_limits<typename Point::value_type>::max()};
    Point upper{std::numeric_limits<typename Point::value_type>::lowest()};

    void add(const Point& point) {
        lower = glm::min(lower, point);
        upper = glm::max(upper, point);
    }
    Point size() const { return upper - lower; }
};

} // namespace lambert
