#pragma once

#include "formfactors/convex_polygon.h"

#include <array>
#include <span>
#include <vector>

namespace lambert {

/// Directions that many planes of a scene are normal to. Few in rooms, whichever way they are turned.
class Directions {
public:
    static constexpr std::size_t kMost = 16;

    /// Finds the plane's direction, or takes it in while there is room, and notes it in the plane.
    void enter(Plane& plane);
    std::span<const glm::dvec3> list() const { return directions_; }

private:
    std::vector<glm::dvec3> directions_;
};

/// How far a set of points reaches along the axes and along the directions of a list.
class Extents {
public:
    Extents(); ///< of no points
    void add(const glm::dvec3& point, std::span<const glm::dvec3> directions);
    void add(const Extents& other);

    glm::dvec3 centre() const { return 0.5 * (lower_ + upper_); } //!< of the box along the axes

    /// Lowest and highest point over a plane, whose normal has unit length: exact for a plane with a direction of the list,
    /// otherwise bounds.
    std::array<double, 2> heights(const Plane& plane, std::span<const glm::dvec3> directions) const;

    /// Whether a plane normal to an axis or a direction of the list, of which there are `directions`, has the one set on one
    /// side and the other on the other; both may reach past it by half of
    /// `tolerance`, or must keep so far from it if that is negative.
    bool apart(const Extents& other, std::size_t directions, double tolerance) const;

private:
    glm::dvec3 lower_, upper_;
    std::array<double, Directions::kMost> low_, high_;
};

} // namespace lambert
