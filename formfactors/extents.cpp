/// T. L. Kay, J. T. Kajiya, "Ray tracing complex scenes", SIGGRAPH 1986: bounds by slabs, here along the scene's own normals.
#include "formfactors/extents.h"

#include <limits>

namespace lambert {

namespace {

/// Sine of the angle between normals of one direction: what single precision makes of one.
constexpr double kSame = 5e-7;
constexpr double kHuge = std::numeric_limits<double>::max();

} // namespace

void Directions::enter(Plane& plane) {
    for (std::size_t k = 0; k < directions_.size(); ++k) {
        const glm::dvec3 sine = glm::cross(directions_[k], plane.normal);
        if (glm::dot(sine, sine) < kSame * kSame) {
            plane.direction = static_cast<int>(k);
            return;
        }
    }
    if (directions_.size() >= kMost) return;
    plane.direction = static_cast<int>(directions_.size());
    directions_.push_back(plane.normal);
}

Extents::Extents() : lower_(kHuge), upper_(-kHuge) {
    low_.fill(kHuge);
    high_.fill(-kHuge);
}

void Extents::add(const glm::dvec3& point, std::span<const glm::dvec3> directions) {
    lower_ = glm::min(lower_, point);
    upper_ = glm::max(upper_, point);
    for (std::size_t k = 0; k < directions.size(); ++k) {
        const double t = glm::dot(directions[k], point);
        low_[k] = std::min(low_[k], t);
        high_[k] = std::max(high_[k], t);
    }
}

void Extents::add(const Extents& other) {
    lower_ = glm::min(lower_, other.lower_);
    upper_ = glm::max(upper_, other.upper_);
    for (std::size_t k = 0; k < low_.size(); ++k) {
        low_[k] = std::min(low_[k], other.low_[k]);
        high_[k] = std::max(high_[k], other.high_[k]);
    }
}

bool Extents::apart(const Extents& other, std::size_t directions, double tolerance) const {
    for (int axis = 0; axis < 3; ++axis)
        if (lower_[axis] >= other.upper_[axis] - tolerance || upper_[axis] <= other.lower_[axis] + tolerance)
            return true;
    for (std::size_t k = 0; k < directions; ++k)
        if (low_[k] >= other.high_[k] - tolerance || high_[k] <= other.low_[k] + tolerance) return true;
    return false;
}

std::array<double, 2> Extents::heights(const Plane& plane, std::span<const glm::dvec3> directions) const {
    if (plane.direction >= 0) {
        const auto k = static_cast<std::size_t>(plane.direction);
        if (glm::dot(directions[k], plane.normal) > 0.0) return {low_[k] - plane.offset, high_[k] - plane.offset};
        return {-high_[k] - plane.offset, -low_[k] - plane.offset};
    }
    const double centre = plane.height(0.5 * (lower_ + upper_));
    const double reach = 0.5 * glm::dot(glm::abs(plane.normal), upper_ - lower_);
    return {centre - reach, centre + reach};
}

} // namespace lambert
