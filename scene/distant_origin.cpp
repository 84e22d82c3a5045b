#include "scene/distant_origin.h"

#include <algorithm>
#include <cmath>

namespace lambert {

glm::dvec3 distantOrigin(const PlaceBounds& bounds) {
    glm::dvec3 origin(0.0);
    const double diagonal = bounds.diagonal();
    if (!(diagonal > 0.0)) return origin; // nothing is read from it either way
    const double step = std::exp2(std::floor(std::log2(diagonal)));
    for (int axis = 0; axis < 3; ++axis) {
        const double farthest = std::max(std::abs(bounds.lower[axis]), std::abs(bounds.upper[axis]));
        if (farthest > kMostDiagonals * diagonal)
            origin[axis] = std::round(0.5 * (bounds.lower[axis] + bounds.upper[axis]) / step) * step;
    }
    return origin;
}

} // namespace lambert
