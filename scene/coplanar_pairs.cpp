#include "scene/coplanar_pairs.h"

#include "core/parallel.h"
#include "scene/box_index.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

namespace lambert {

namespace {

constexpr double kAlike = 0.99; ///< of the normals, to 8°: what is steeper crosses the plane

constexpr std::size_t kGrain = 4096; ///< polygons at once

struct OrientedPlane {
    glm::dvec3 normal; ///< unit length
    double offset;     ///< metres

    double height(const glm::vec3& p) const { return glm::dot(normal, glm::dvec3(p)) - offset; }
};

OrientedPlane planeOf(const Scene& scene, const Polygon& polygon) {
    const glm::dvec3 a(corner(scene, polygon, 0));
    const glm::dvec3 b(corner(scene, polygon, 1));
    const glm::dvec3 c(corner(scene, polygon, 2));
    const glm::dvec3 normal = glm::normalize(
        polygon.isQuad() ? glm::cross(c - a, glm::dvec3(corner(scene, polygon, 3)) - b) : glm::cross(b - a, c - a));
    return {normal, glm::dot(normal, a)};
}

/// Coordinates in a polygon's plane, seen from its front.
struct Frame {
    glm::dvec3 origin, axisX, axisY;

    Frame(const Scene& scene, const Polygon& polygon, const glm::dvec3& normal) : origin(corner(scene, polygon, 0)) {
        glm::dvec3 least(0.0); // the axis that is most nearly in the plane
        const glm::dvec3 slopes = glm::abs(normal);
        least[slopes.x <= slopes.y && slopes.x <= slopes.z ? 0 : slopes.y <= slopes.z ? 1 : 2] = 1.0;
        axisX = glm::normalize(glm::cross(least, normal));
        axisY = glm::cross(normal, axisX);
    }
    glm::dvec2 project(const glm::vec3& p) const {
        const glm::dvec3 offset = glm::dvec3(p) - origin;
        return {glm::dot(offset, axisX), glm::dot(offset, axisY)};
    }
};

/// A convex polygon in a plane; a quad clipped by another has at most eight corners.
struct Outline {
    std::array<glm::dvec2, 8> corners{};
    std::size_t count = 0;

    void add(glm::dvec2 p) {
        if (count < corners.size()) corners[count++] = p;
    }
    std::span<const glm::dvec2> points() const { return {corners.data(), count}; }
    /// From corner k to the next.
    std::pair<glm::dvec2, glm::dvec2> edge(std::size_t k) const { return {corners[k], corners[(k + 1) % count]}; }
};

/// The outline of a polygon in a frame, counter-clockwise there.
Outline outlineIn(const Frame& frame, const Scene& scene, const Polygon& polygon, bool reversed) {
    Outline outline;
    for (int k = 0; k < polygon.size(); ++k) outline.add(frame.project(corner(scene, polygon, k)));
    if (reversed) std::reverse(outline.corners.begin(), outline.corners.begin() + polygon.size());
    return outline;
}

/// Distance of a point to the left of the line from a to b.
double leftOf(glm::dvec2 a, glm::dvec2 b, glm::dvec2 p) {
    const glm::dvec2 edge = b - a;
    const double length = glm::length(edge);
    return length > 0.0 ? (edge.x * (p.y - a.y) - edge.y * (p.x - a.x)) / length : 0.0;
}

/// Whether `other` reaches over every edge of `outline` by more than `depth`.
bool reachesInto(const Outline& outline, const Outline& other, double depth) {
    for (std::size_t k = 0; k < outline.count; ++k) {
        const auto [a, b] = outline.edge(k);
        double most = std::numeric_limits<double>::lowest();
        for (const glm::dvec2& p : other.points()) most = std::max(most, leftOf(a, b, p));
        if (most <= depth) return false;
    }
    return true;
}

/// The part of `outline` inside the convex `by`; Sutherland, Hodgman 1974.
Outline clipped(Outline outline, const Outline& by) {
    for (std::size_t k = 0; k < by.count && outline.count > 0; ++k) {
        const auto [a, b] = by.edge(k);
        Outline inside;
        for (std::size_t i = 0; i < outline.count; ++i) {
            const auto [p, q] = outline.edge(i);
            const double heightP = leftOf(a, b, p);
            const double heightQ = leftOf(a, b, q);
            if (heightP >= 0.0) inside.add(p);
            if ((heightP < 0.0) != (heightQ < 0.0)) inside.add(p + heightP / (heightP - heightQ) * (q - p));
        }
        outline = inside;
    }
    return outline;
}

class PairFinder {
public:
    PairFinder(const Scene& scene, float tolerance)
        : scene_(scene), tolerance_(static_cast<double>(tolerance)), index_(boxes(tolerance)) {
        planes_.reserve(scene.polygons.size());
        for (const Polygon& polygon : scene.polygons) planes_.push_back(planeOf(scene, polygon));
    }

    std::vector<CoplanarPair> find() const {
        const std::size_t count = scene_.polygons.size();
        std::vector<std::vector<CoplanarPair>> found((count + kGrain - 1) / kGrain);
        parallelFor(found.size(), 1, [&](std::size_t begin, std::size_t end, int) {
            std::vector<std::uint32_t> near;
            for (std::size_t chunk = begin; chunk < end; ++chunk)
                for (std::size_t i = chunk * kGrain; i < std::min(count, (chunk + 1) * kGrain); ++i) {
                    const auto one = static_cast<std::uint32_t>(i);
                    index_.nearLater(one, near);
                    for (const std::uint32_t two : near)
                        if (const auto pair = pairOf(one, two)) found[chunk].push_back(*pair);
                }
        });
        std::vector<CoplanarPair> pairs;
        for (const auto& some : found) pairs.insert(pairs.end(), some.begin(), some.end());
        return pairs;
    }

private:
    BoxIndex boxes(float margin) const {
        std::vector<Bounds> boxes;
        boxes.reserve(scene_.polygons.size());
        for (const Polygon& polygon : scene_.polygons)
            boxes.push_back(boundsOf(scene_, polygon).grownBy(0.5F * margin));
        return BoxIndex(std::move(boxes));
    }

    /// Whether all corners of a polygon lie on one side of a plane, out of reach.
    bool apart(const OrientedPlane& plane, const Polygon& polygon) const {
        double least = std::numeric_limits<double>::max();
        double most = std::numeric_limits<double>::lowest();
        for (int k = 0; k < polygon.size(); ++k) {
            const double height = plane.height(corner(scene_, polygon, k));
            least = std::min(least, height);
            most = std::max(most, height);
        }
        return least > tolerance_ || most < -tolerance_;
    }

    std::optional<CoplanarPair> pairOf(std::uint32_t one, std::uint32_t two) const {
        const double alike = glm::dot(planes_[one].normal, planes_[two].normal);
        if (std::abs(alike) < kAlike) return std::nullopt;
        if (apart(planes_[one], scene_.polygons[two]) || apart(planes_[two], scene_.polygons[one])) return std::nullopt;
        const Frame frame(scene_, scene_.polygons[one], planes_[one].normal);
        const Outline outlineOne = outlineIn(frame, scene_, scene_.polygons[one], false);
        const Outline outlineTwo = outlineIn(frame, scene_, scene_.polygons[two], alike < 0.0);
        if (!reachesInto(outlineOne, outlineTwo, tolerance_) || !reachesInto(outlineTwo, outlineOne, tolerance_) ||
            !areClose(frame, planes_[two], clipped(outlineTwo, outlineOne)))
            return std::nullopt;
        return CoplanarPair{one, two, alike > 0.0};
    }

    /// Whether a plane is within the tolerance of the frame's everywhere in an outline.
    bool areClose(const Frame& frame, const OrientedPlane& plane, const Outline& outline) const {
        const double slope = glm::dot(plane.normal, glm::cross(frame.axisX, frame.axisY));
        const auto points = outline.points();
        return std::all_of(points.begin(), points.end(), [&](const glm::dvec2& p) {
            const glm::dvec3 point = frame.origin + p.x * frame.axisX + p.y * frame.axisY;
            return std::abs((plane.offset - glm::dot(plane.normal, point)) / slope) <= tolerance_;
        });
    }

    const Scene& scene_;
    double tolerance_;
    BoxIndex index_;
    std::vector<OrientedPlane> planes_;
};

} // namespace

std::vector<CoplanarPair> coplanarPairs(const Scene& scene, float tolerance) {
    if (scene.polygons.size() < 2) return {};
    return PairFinder(scene, tolerance).find();
}

} // namespace lambert
