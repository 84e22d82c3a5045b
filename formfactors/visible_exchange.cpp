/// Lines of discontinuity: P. Heckbert, "Discontinuity meshing for radiosity", Eurographics Workshop on Rendering 1992;
/// D. Lischinski, F. Tampieri, D. P. Greenberg, "Discontinuity meshing for accurate radiosity", IEEE CG&A 12(6), 1992.
#include "formfactors/visible_exchange.h"

#include "formfactors/closed_form.h"
#include "formfactors/gauss_exchange.h"
#include "formfactors/quadrature.h"

#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

/// With more lines than these the cells are left to subdivision alone.
constexpr std::size_t kMostCuts = 16;
constexpr std::size_t kMostCells = 64;
/// A cell is halved at most so often.
constexpr int kMostHalvings = 6;
/// Parts of the unoccluded exchange below this one are found to the absolute error of it.
constexpr double kSmallestShare = 0.01;
/// Smaller parts are gaps that single precision makes.
constexpr double kRounding = 1e-6;

bool allAbove(const Plane& plane, std::span<const glm::dvec3> points, double height) {
    return std::all_of(points.begin(), points.end(), [&](const auto& p) { return plane.height(p) >= height; });
}
bool allBelow(const Plane& plane, std::span<const glm::dvec3> points, double height) {
    return std::all_of(points.begin(), points.end(), [&](const auto& p) { return plane.height(p) <= height; });
}

/// Whether every line from one polygon to the other crosses the occluder's plane beside it (Clear) or in it (Hidden).
/// For polygons on different sides of the plane the crossings of all lines lie within the convex hull of those between
/// corners.
enum class Crossing { Clear, Hidden, Unknown };

using Points2 = std::vector<glm::dvec2>;

glm::dvec2 inPlane(const Occluder& occluder, const glm::dvec3& p) {
    const glm::dvec3 d = p - occluder.corners[0];
    return {glm::dot(d, occluder.axisU), glm::dot(d, occluder.axisV)};
}

/// The lowest and highest of the points along an axis.
std::array<double, 2> range(const Points2& points, const glm::dvec2& axis) {
    std::array<double, 2> result{glm::dot(points[0], axis), glm::dot(points[0], axis)};
    for (const glm::dvec2& p : points) {
        const double t = glm::dot(p, axis);
        result[0] = std::min(result[0], t);
        result[1] = std::max(result[1], t);
    }
    return result;
}

Crossing crossing(const OccludedPair& pair, const Occluder& occluder) {
    static thread_local Points2 points, corners;
    points.clear();
    std::array<double, ConvexPolygon::kMostCorners> heightTo;
    for (std::size_t j = 0; j < pair.to.size; ++j) heightTo[j] = occluder.plane.height(pair.to.corners[j]);
    for (const glm::dvec3& p : pair.from.points()) {
        const double heightFrom = occluder.plane.height(p);
        for (std::size_t j = 0; j < pair.to.size; ++j) {
            if (!(heightFrom * heightTo[j] < 0.0)) return Crossing::Unknown;
            const double t = heightFrom / (heightFrom - heightTo[j]);
            points.push_back(inPlane(occluder, p + t * (pair.to.corners[j] - p)));
        }
    }
    corners.clear();
    for (const glm::dvec3& p : occluder.corners) corners.push_back(inPlane(occluder, p));

    bool hidden = true;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const glm::dvec2 along = corners[(k + 1) % corners.size()] - corners[k];
        const glm::dvec2 inward(-along.y, along.x);
        const double edge = glm::dot(inward, corners[k]);
        const auto [low, high] = range(points, inward);
        if (high <= edge) return Crossing::Clear;
        hidden = hidden && low >= edge;
    }
    if (hidden) return Crossing::Hidden;
    // The sides of the hull run between lines that share an end: try the directions of those from the first corners.
    const auto separates = [&](const glm::dvec2& side) {
        const glm::dvec2 axis(-side.y, side.x);
        const auto lines = range(points, axis), blocker = range(corners, axis);
        return lines[1] < blocker[0] || blocker[1] < lines[0];
    };
    for (std::size_t j = 0; j < pair.to.size; ++j)
        if (separates(points[(j + 1) % pair.to.size] - points[j])) return Crossing::Clear;
    for (std::size_t i = 0; i < pair.from.size; ++i)
        if (separates(points[(i + 1) % pair.from.size * pair.to.size] - points[i * pair.to.size]))
            return Crossing::Clear;
    return Crossing::Unknown;
}

/// Collects the planes that cut `from` where what is visible of `to` changes its shape.
class Cuts {
public:
    explicit Cuts(const OccludedPair& pair) : pair_(pair) {
        for (const Occluder* occluder : pair.occluders) gather(*occluder);
    }
    const std::vector<Plane>& planes() const { return planes_; }
    bool complete() const { return complete_; }

private:
    void gather(const Occluder& occluder) {
        const std::size_t n = occluder.corners.size();
        std::array<bool, ConvexPolygon::kMostCorners> inner;
        for (std::size_t k = 0; k < n; ++k) inner[k] = continues(occluder, occluder.neighbour[k]);
        const auto number = static_cast<std::uint32_t>(&occluder - pair_.firstOccluder);
        for (std::size_t k = 0; k < n; ++k) {
            const glm::dvec3& begin = occluder.corners[k];
            const glm::dvec3& end = occluder.corners[(k + 1) % n];
            const bool beginStands = pair_.fromPlane.height(begin) <= pair_.tolerance;
            if (beginStands && pair_.fromPlane.height(end) <= pair_.tolerance) {
                // On the edge's two sides the polygon sees different things.
                add(Plane::through(begin, glm::normalize(glm::cross(pair_.fromPlane.normal, end - begin))));
                continue;
            }
            const std::uint32_t beyond = occluder.neighbour[k];
            const bool done = beyond < number && present(beyond); // with that occluder's edges
            if (!inner[k] && !done)
                for (const glm::dvec3& corner : pair_.to.points()) addIfSeen(corner, begin, end, 1.0);
            if (beginStands || (inner[k] && inner[(k + n - 1) % n])) continue;
            for (std::size_t j = 0; j < pair_.to.size; ++j)
                addIfSeen(begin, pair_.to.corners[j], pair_.to.next(j), -1.0);
        }
        add(occluder.plane); // beyond it the occluder shows its other side
    }

    bool present(std::uint32_t occluder) const {
        const Occluder* found = pair_.firstOccluder + occluder;
        return std::find(pair_.occluders.begin(), pair_.occluders.end(), found) != pair_.occluders.end();
    }

    /// Whether both occluders show all of the polygon the same side, so that the edge between them is no outline.
    bool continues(const Occluder& occluder, std::uint32_t neighbour) const {
        if (neighbour == kNone) return false;
        if (!present(neighbour)) return false;
        const Occluder* other = pair_.firstOccluder + neighbour;
        const auto from = pair_.from.points();
        const double t = pair_.tolerance;
        return (allAbove(occluder.plane, from, t) && allAbove(other->plane, from, t)) ||
               (allBelow(occluder.plane, from, -t) && allBelow(other->plane, from, -t));
    }

    /// The plane through an apex and an edge, if one of its lines through the apex and the edge meets the polygon; on the
    /// apex's other side for `side` = −1.
    void addIfSeen(const glm::dvec3& apex, const glm::dvec3& begin, const glm::dvec3& end, double side) {
        const glm::dvec3 toBegin = begin - apex, toEnd = end - apex;
        glm::dvec3 normal = glm::cross(toBegin, toEnd);
        const double length = glm::length(normal);
        if (length < 1e-12 * (glm::dot(toBegin, toBegin) + glm::dot(toEnd, toEnd))) return;
        normal /= length;
        const Plane plane = Plane::through(apex, normal);
        std::array<double, ConvexPolygon::kMostCorners> height;
        bool above = false, below = false;
        for (std::size_t k = 0; k < pair_.from.size; ++k) {
            height[k] = plane.height(pair_.from.corners[k]);
            above = above || height[k] > pair_.tolerance;
            below = below || height[k] < -pair_.tolerance;
        }
        if (!above || !below) return;
        const glm::dvec3 afterBegin = glm::cross(normal, toBegin), beforeEnd = glm::cross(toEnd, normal);
        bool anyAfter = false, anyBefore = false;
        for (std::size_t k = 0; k < pair_.from.size; ++k) {
            const std::size_t next = k + 1 < pair_.from.size ? k + 1 : 0;
            if ((height[k] > 0.0) == (height[next] > 0.0)) continue;
            const glm::dvec3 at = pair_.from.corners[k] + height[k] / (height[k] - height[next]) *
                                                              (pair_.from.corners[next] - pair_.from.corners[k]);
            const glm::dvec3 direction = side * (at - apex);
            anyAfter = anyAfter || glm::dot(direction, afterBegin) >= 0.0;
            anyBefore = anyBefore || glm::dot(direction, beforeEnd) >= 0.0;
        }
        if (anyAfter && anyBefore) add(plane);
    }

    void add(const Plane& plane) {
        bool above = false, below = false;
        for (const glm::dvec3& p : pair_.from.points()) {
            const double height = plane.height(p);
            above = above || height > pair_.tolerance;
            below = below || height < -pair_.tolerance;
        }
        if (!above || !below || known(plane)) return;
        if (planes_.size() >= kMostCuts)
            complete_ = false;
        else
            planes_.push_back(plane);
    }

    /// Whether a plane cuts the polygon in the same line as an earlier one.
    bool known(const Plane& plane) const {
        const auto from = pair_.from.points();
        const auto same = [&](const Plane& other, double sign) {
            return std::all_of(from.begin(), from.end(), [&](const glm::dvec3& p) {
                return std::abs(plane.height(p) - sign * other.height(p)) <= pair_.tolerance;
            });
        };
        return std::any_of(planes_.begin(), planes_.end(),
                           [&](const Plane& other) { return same(other, 1.0) || same(other, -1.0); });
    }

    const OccludedPair& pair_;
    std::vector<Plane> planes_;
    bool complete_ = true;
};

/// Appends what of `part` lies outside of the convex region in front of all planes; returns whether anything lies inside.
bool subtractCone(std::span<const Plane> planes, const ConvexPolygon& part, std::vector<ConvexPolygon>& left) {
    std::array<std::size_t, ConvexPolygon::kMostCorners + 1> crossing;
    std::size_t count = 0;
    for (std::size_t k = 0; k < planes.size(); ++k) {
        bool above = false, below = false;
        for (const glm::dvec3& p : part.points()) {
            const double height = planes[k].height(p);
            above = above || height > 0.0;
            below = below || height < 0.0;
        }
        if (!above) {
            left.push_back(part);
            return false;
        }
        if (below) crossing[count++] = k;
    }
    const std::size_t first = left.size();
    ConvexPolygon inside = part, front, behind;
    for (std::size_t c = 0; c < count; ++c) {
        split(inside, planes[crossing[c]], 0.0, front, behind);
        if (!behind.empty()) left.push_back(behind);
        if (front.empty()) {
            // Beside the region after all: it need not stay in pieces.
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(first), left.end());
            left.push_back(part);
            return false;
        }
        inside = front;
    }
    return true;
}

/// The exchange between a cell and the target polygon, by Gauss's rule over the cell.
class CellIntegral {
public:
    explicit CellIntegral(const OccludedPair& pair) : pair_(pair) {}

    /// With the visible part of the target found at each point.
    double visible(const ConvexPolygon& cell, int order) const {
        static thread_local std::vector<WeightedPoint> points;
        points.clear();
        appendGaussPoints(cell.points(), order, points);
        double sum = 0.0;
        for (const auto& [x, weight] : points)
            sum +=
                weight * VisibleParts(x, pair_.to, pair_.occluders, pair_.tolerance).formFactor(pair_.fromPlane.normal);
        return sum;
    }

    /// By three points per axis, or by halves until that agrees. `low` is the integral by two.
    double refined(const ConvexPolygon& cell, double low, double error, int halvings) const {
        const double high = visible(cell, 3);
        if (std::abs(high - low) <= error || halvings == 0) return high;
        const glm::dvec3 centre = cell.centre();
        glm::dvec3 longest(0.0);
        for (const glm::dvec3& p : cell.points())
            if (glm::dot(p - centre, p - centre) > glm::dot(longest, longest)) longest = p - centre;
        ConvexPolygon front, behind;
        split(cell, Plane::through(centre, longest), 0.0, front, behind);
        double sum = 0.0;
        for (const ConvexPolygon& part : {front, behind})
            if (!part.empty()) sum += refined(part, visible(part, 2), error, halvings - 1);
        return sum;
    }

private:
    const OccludedPair& pair_;
};

std::vector<ConvexPolygon> divided(const ConvexPolygon& polygon, const Cuts& cuts, double tolerance) {
    std::vector<ConvexPolygon> result{polygon}, next;
    ConvexPolygon front, behind;
    for (const Plane& plane : cuts.planes()) {
        if (result.size() > kMostCells) break;
        next.clear();
        for (const ConvexPolygon& cell : result) {
            split(cell, plane, tolerance, front, behind);
            for (const ConvexPolygon& part : {front, behind})
                if (!part.empty()) next.push_back(part);
        }
        result.swap(next);
    }
    return result;
}

} // namespace

bool dropClearOccluders(OccludedPair& pair) {
    const auto from = pair.from.points(), to = pair.to.points();
    const double t = pair.tolerance;
    Extents both;
    for (const auto& points : {from, to})
        for (const glm::dvec3& p : points) both.add(p, pair.directions);
    bool hidden = false;
    std::erase_if(pair.occluders, [&](const Occluder* occluder) {
        if (hidden) return false;
        if (both.apart(occluder->extents, pair.directions.size(), t)) return true;
        const Plane& plane = occluder->plane;
        if (allAbove(plane, from, -t) && allAbove(plane, to, -t)) return true;
        if (allBelow(plane, from, t) && allBelow(plane, to, t)) return true;
        if (allBelow(pair.fromPlane, occluder->corners, t) || allBelow(pair.toPlane, occluder->corners, t)) return true;
        const Crossing found = crossing(pair, *occluder);
        hidden = found == Crossing::Hidden && !occluder->holes;
        return found == Crossing::Clear;
    });
    return !hidden;
}

VisibleParts::VisibleParts(const glm::dvec3& point, const ConvexPolygon& polygon,
                           std::span<const Occluder* const> occluders, double tolerance)
    : point_(point), parts_([]() -> std::vector<ConvexPolygon>& {
          static thread_local std::vector<ConvexPolygon> scratch;
          return scratch;
      }()) {
    parts_.assign(1, polygon);
    for (const Occluder* occluder : occluders) {
        subtract(*occluder, tolerance);
        if (parts_.empty()) break;
    }
    if (parts_.empty()) visibility_ = Visibility::None;
}

void VisibleParts::subtract(const Occluder& occluder, double tolerance) {
    static thread_local std::vector<ConvexPolygon> left;
    const double height = occluder.plane.height(point_);
    if (std::abs(height) <= 1e-3 * tolerance) return; // seen edge-on
    // What is hidden lies behind the occluder and within the cone of its edges.
    std::array<Plane, ConvexPolygon::kMostCorners + 1> cone;
    const double side = height > 0.0 ? 1.0 : -1.0;
    const std::size_t n = occluder.corners.size();
    for (std::size_t k = 0; k < n; ++k)
        cone[k] = Plane::through(
            point_, side * glm::cross(occluder.corners[(k + 1) % n] - point_, occluder.corners[k] - point_));
    cone[n] = {-side * occluder.plane.normal, -side * occluder.plane.offset, -1};
    const std::span<const Plane> planes(cone.data(), n + 1);
    left.clear();
    bool changed = false;
    for (const ConvexPolygon& part : parts_) changed = subtractCone({cone.data(), n + 1}, part, left) || changed;
    if (!changed) return;
    visibility_ = Visibility::Part;
    parts_.swap(left);
}

double VisibleParts::formFactor(const glm::dvec3& normal) const {
    double sum = 0.0;
    for (const ConvexPolygon& part : parts_) sum += pointToVisiblePolygon(point_, normal, part.points());
    return sum;
}

double visibleExchange(const OccludedPair& pair, double unoccluded, double relativeError) {
    const Cuts cuts(pair);
    const CellIntegral integral(pair);
    struct Cell {
        ConvexPolygon polygon;
        double low;
    };
    std::vector<Cell> partly;
    double clear = 0.0, estimate = 0.0;
    std::size_t clearCells = 0;
    const std::vector<ConvexPolygon> cells = divided(pair.from, cuts, pair.tolerance);
    for (const ConvexPolygon& cell : cells) {
        const Visibility atCentre = VisibleParts(cell.centre(), pair.to, pair.occluders, pair.tolerance).visibility();
        // Without a line through it, a cell that sees all from one point sees all from every point; likewise nothing, but
        // where several occluders together hide the target there may be gaps between them.
        if (atCentre == Visibility::All && cuts.complete()) {
            clear += cells.size() > 1 ? convexExchange(cell, pair.fromPlane, pair.to, pair.toPlane) : unoccluded;
            ++clearCells;
        } else if (atCentre != Visibility::None || pair.occluders.size() > 1 || !cuts.complete()) {
            estimate += partly.emplace_back(cell, integral.visible(cell, 2)).low;
        }
    }
    if (clearCells == cells.size()) return unoccluded;
    const double error = relativeError * std::max(clear + estimate, kSmallestShare * unoccluded);
    double sum = clear;
    for (const Cell& cell : partly)
        if (cell.low > 0.0) sum += integral.refined(cell.polygon, cell.low, error, kMostHalvings);
    return sum > kRounding * unoccluded ? std::min(sum, unoccluded) : 0.0;
}

} // namespace lambert
