#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <span>

namespace lambert {

/// A plane; points with a positive height lie in front.
struct Plane {
    glm::dvec3 normal{0.0};
    double offset = 0.0;
    /// Into a list of directions that are this plane's normal or its opposite, see Extents; −1 if none is.
    int direction = -1;

    static Plane through(const glm::dvec3& point, const glm::dvec3& normal) {
        return {normal, glm::dot(normal, point), -1};
    }
    /// In lengths of the normal.
    double height(const glm::dvec3& p) const { return glm::dot(normal, p) - offset; }
};

/// A plane convex polygon of few corners, which needs no memory of its own.
struct ConvexPolygon {
    static constexpr std::size_t kMostCorners = 24;

    std::array<glm::dvec3, kMostCorners> corners;
    std::size_t size = 0;

    ConvexPolygon() {} // the corners stay as they are: they are not read before they are set
    explicit ConvexPolygon(std::span<const glm::dvec3> points);
    ConvexPolygon(const ConvexPolygon& other) : ConvexPolygon(other.points()) {}
    ConvexPolygon& operator=(const ConvexPolygon& other);

    /// Corners past the last that fits are left out.
    void add(const glm::dvec3& p) {
        if (size < kMostCorners) corners[size++] = p;
    }
    bool empty() const { return size < 3; }
    const glm::dvec3& next(std::size_t k) const { return corners[k + 1 < size ? k + 1 : 0]; }
    std::span<const glm::dvec3> points() const { return {corners.data(), size}; }
    glm::dvec3 centre() const;                          ///< mean of the corners
    double radiusAround(const glm::dvec3& point) const; ///< to the farthest corner
};

/// Lowest and highest point over a plane; at least one point.
std::array<double, 2> cornerHeights(const Plane& plane, std::span<const glm::dvec3> points);

/// The same polygon seen from its other side.
ConvexPolygon reversed(const ConvexPolygon& polygon);

/// Cuts a polygon by a plane. Either part may be empty. Corners within `tolerance` of the plane count as in it.
void split(const ConvexPolygon& polygon, const Plane& plane, double tolerance, ConvexPolygon& front,
           ConvexPolygon& behind);

/// Cuts a polygon across, through its centre.
std::array<ConvexPolygon, 2> halvesOf(const ConvexPolygon& polygon);

} // namespace lambert
