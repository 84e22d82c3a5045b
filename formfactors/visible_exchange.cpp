/// Lines of discontinuity: P. Heckbert, "Discontinuity meshing for radiosity", Eurographics Workshop on Rendering 1992;
/// D. Lischinski, F. Tampieri, D. P. Greenberg, "Discontinuity meshing for accurate radiosity", IEEE CG&A 12(6), 1992.
#include "formfactors/visible_exchange.h"

#include "formfactors/blocking.h"
#include "formfactors/closed_form.h"
#include "formfactors/quadrature.h"

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

/// With more lines than these the cells are left to subdivision alone.
constexpr std::size_t kMostCuts = 32;
constexpr std::size_t kMostCells = 512;
/// A cell is halved at most so often.
constexpr int kMostHalvings = 6;
/// Parts of the unoccluded exchange below this one are found to the absolute error of it.
constexpr double kSmallestShare = 0.01;
/// Smaller parts are gaps that single precision makes.
constexpr double kRounding = 1e-6;

/// Collects the planes that cut `from` where what is visible of `to` changes its shape.
class Cuts {
public:
    explicit Cuts(const OccludedPair& pair) : pair_(pair) {
        // The lines that matter most first.
        for (const Occluder* occluder : pair.occluders) gatherFeet(*occluder);
        for (const Occluder* occluder : pair.occluders) gather(*occluder);
    }
    /// `from`, cut by the lines; `complete`: by all of them.
    std::vector<ConvexPolygon> cells(bool& complete) const {
        std::vector<ConvexPolygon> result{pair_.from}, next;
        ConvexPolygon front, behind;
        complete = complete_;
        for (const Plane& plane : planes_) {
            if (result.size() > kMostCells) {
                complete = false;
                break;
            }
            next.clear();
            for (const ConvexPolygon& cell : result) {
                split(cell, plane, pair_.tolerance, front, behind);
                for (const ConvexPolygon& part : {front, behind})
                    if (!part.empty()) next.push_back(part);
            }
            result.swap(next);
        }
        return result;
    }

private:
    /// Whether a corner stands in the plane of the polygon.
    bool stands(const glm::dvec3& corner) const { return pair_.fromPlane.height(corner) <= pair_.tolerance; }

    /// On the two sides of an edge that stands in it the polygon sees different things.
    void gatherFeet(const Occluder& occluder) {
        for (std::size_t k = 0; k < occluder.corners.size(); ++k) {
            const glm::dvec3& begin = occluder.corners[k];
            const glm::dvec3& end = occluder.corners[k + 1 < occluder.corners.size() ? k + 1 : 0];
            if (stands(begin) && stands(end))
                add(Plane::through(begin, glm::normalize(glm::cross(pair_.fromPlane.normal, end - begin))));
        }
    }

    void gather(const Occluder& occluder) {
        const std::size_t n = occluder.corners.size();
        std::array<bool, ConvexPolygon::kMostCorners> inner;
        for (std::size_t k = 0; k < n; ++k) inner[k] = continues(occluder, occluder.neighbour[k]);
        const auto number = static_cast<std::uint32_t>(&occluder - pair_.firstOccluder);
        for (std::size_t k = 0; k < n; ++k) {
            const glm::dvec3& begin = occluder.corners[k];
            const glm::dvec3& end = occluder.corners[(k + 1) % n];
            const bool beginStands = stands(begin);
            if (beginStands && stands(end)) continue;
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
        if (!cuts(plane)) return;
        std::array<double, ConvexPolygon::kMostCorners> height;
        for (std::size_t k = 0; k < pair_.from.size; ++k) height[k] = plane.height(pair_.from.corners[k]);
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

    /// Whether a plane goes through the polygon.
    bool cuts(const Plane& plane) const {
        const auto [low, high] = cornerHeights(plane, pair_.from.points());
        return low < -pair_.tolerance && high > pair_.tolerance;
    }

    void add(const Plane& plane) {
        if (!cuts(plane) || known(plane)) return;
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

/// The exchange between parts of `from`, each with the occluders that matter there, and the target polygon.
class CellIntegral {
public:
    struct Cell {
        ConvexPolygon polygon;
        std::vector<const Occluder*> occluders;
    };

    /// `error` aimed at in each cell, m².
    CellIntegral(const OccludedPair& pair, double error, VisibleExchangeScratch& scratch)
        : pair_(pair), error_(error), scratch_(scratch) {}

    /// Of all of `from`, cut along the lines where the visible part changes its shape.
    double whole() const {
        bool complete = false;
        const std::vector<ConvexPolygon> polygons = Cuts(pair_).cells(complete);
        double sum = 0.0;
        for (const ConvexPolygon& polygon : polygons) {
            Cell cell{polygon, pair_.occluders};
            if (polygons.size() > 1 && !keepBlocking(cell)) continue;
            const Visibility atCentre = visibleFrom(polygon.centre(), cell).visibility();
            // Without a line through it, a cell that sees all from one point sees all from every point; likewise nothing,
            // but where several occluders together hide the target there may be gaps between them.
            if (cell.occluders.empty() || (atCentre == Visibility::All && complete))
                sum += free(cell);
            else if (atCentre != Visibility::None || cell.occluders.size() > 1 || !complete) {
                const double low = byRule(cell, 2);
                if (low > 0.0 || !complete) sum += refined(cell, low, kMostHalvings);
            }
        }
        return sum;
    }

    /// By Gauss's rule over the cell, with the visible part of the target found at each point.
    double byRule(const Cell& cell, int order) const {
        scratch_.points.clear();
        appendGaussPoints(cell.polygon.points(), order, scratch_.points);
        double sum = 0.0;
        for (const auto& [x, weight] : scratch_.points)
            sum += weight * visibleFrom(x, cell).formFactor(pair_.fromPlane.normal);
        return sum;
    }

private:
    VisibleParts visibleFrom(const glm::dvec3& point, const Cell& cell) const {
        return {point, pair_.to, cell.occluders, pair_.tolerance, scratch_.parts};
    }

    /// Leaves the occluders that may hide something from the cell; false if one hides all.
    bool keepBlocking(Cell& cell) const {
        bool hidden = false;
        std::erase_if(cell.occluders, [&](const Occluder* occluder) {
            if (hidden) return false;
            const Blocking found =
                blocking(cell.polygon, pair_.fromPlane, pair_.to, pair_.toPlane, *occluder, pair_.tolerance);
            hidden = found == Blocking::Hidden;
            return found == Blocking::Clear;
        });
        return !hidden;
    }

    double free(const Cell& cell) const {
        return convexExchange(cell.polygon, pair_.fromPlane, pair_.to, pair_.toPlane, scratch_.exchange);
    }

    /// By three points per axis, or by halves until that agrees with two (`low`).
    double refined(const Cell& cell, double low, int halvings) const {
        const double high = byRule(cell, 3);
        if (std::abs(high - low) <= error_ || halvings == 0) return high;
        double sum = 0.0;
        for (const ConvexPolygon& polygon : halvesOf(cell.polygon)) {
            Cell half{polygon, cell.occluders};
            if (polygon.empty() || !keepBlocking(half)) continue;
            sum += half.occluders.empty() ? free(half) : refined(half, byRule(half, 2), halvings - 1);
        }
        return sum;
    }

    const OccludedPair& pair_;
    double error_;
    VisibleExchangeScratch& scratch_;
};

} // namespace

bool dropClearOccluders(OccludedPair& pair) {
    Extents both;
    for (const auto& points : {pair.from.points(), pair.to.points()})
        for (const glm::dvec3& p : points) both.add(p, pair.directions);
    bool hidden = false;
    std::erase_if(pair.occluders, [&](const Occluder* occluder) {
        if (hidden) return false;
        if (both.apart(occluder->extents, pair.directions.size(), pair.tolerance)) return true;
        const Blocking found = blocking(pair.from, pair.fromPlane, pair.to, pair.toPlane, *occluder, pair.tolerance);
        hidden = found == Blocking::Hidden;
        return found == Blocking::Clear;
    });
    return !hidden;
}

double visibleExchange(const OccludedPair& pair, double unoccluded, double relativeError,
                       VisibleExchangeScratch& scratch) {
    const double estimate = CellIntegral(pair, 0.0, scratch).byRule({pair.from, pair.occluders}, 2);
    const double error = relativeError * std::max(estimate, kSmallestShare * unoccluded);
    const double sum = CellIntegral(pair, error, scratch).whole();
    if (sum >= (1.0 - kRounding) * unoccluded) return unoccluded;
    return sum > kRounding * unoccluded ? sum : 0.0;
}

} // namespace lambert
