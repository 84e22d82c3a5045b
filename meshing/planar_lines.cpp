#include "meshing/planar_lines.h"

#include "meshing/pair_triangles.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lambert {

namespace {

double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

/// Parts of a line, from 0 to 1; empty if from >= to.
struct Interval {
    double from = -std::numeric_limits<double>::infinity();
    double to = std::numeric_limits<double>::infinity();

    /// Keeps where a + t b < limit.
    void below(double a, double b, double limit) {
        if (b > 0.0)
            to = std::min(to, (limit - a) / b);
        else if (b < 0.0)
            from = std::max(from, (limit - a) / b);
        else if (a >= limit)
            to = from;
    }
    bool isEmpty() const { return !(from < to); }
    void unite(const Interval& other) {
        if (other.isEmpty()) return;
        if (isEmpty()) *this = other;
        from = std::min(from, other.from);
        to = std::max(to, other.to);
    }
};

/// Where the line from p along d is nearer to a point than r.
Interval nearPoint(glm::dvec2 p, glm::dvec2 d, double r) {
    const double a = glm::dot(d, d);
    const double b = glm::dot(p, d);
    const double root = b * b - a * (glm::dot(p, p) - r * r);
    if (!(root > 0.0) || !(a > 0.0)) return {0.0, 0.0};
    return {(-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a};
}

/// Where a line is nearer to a segment than r: one interval, as what is near to a segment is convex.
Interval nearSegment(const PlanarSegment& line, const PlanarSegment& segment, double r) {
    const glm::dvec2 d = line.to - line.from;
    Interval result = nearPoint(line.from - segment.from, d, r);
    result.unite(nearPoint(line.from - segment.to, d, r));
    const glm::dvec2 edge = segment.to - segment.from;
    const double length = glm::length(edge);
    if (!(length > 0.0)) return result;
    const glm::dvec2 along = edge / length;
    const glm::dvec2 p = line.from - segment.from;
    Interval beside;
    beside.below(cross(along, p), cross(along, d), r);
    beside.below(-cross(along, p), -cross(along, d), r);
    beside.below(glm::dot(along, p), glm::dot(along, d), length);
    beside.below(-glm::dot(along, p), -glm::dot(along, d), 0.0);
    result.unite(beside);
    return result;
}

bool mayBeNear(const PlanarSegment& one, const PlanarSegment& two, double distance) {
    const glm::dvec2 lower = glm::max(glm::min(one.from, one.to), glm::min(two.from, two.to));
    const glm::dvec2 upper = glm::min(glm::max(one.from, one.to), glm::max(two.from, two.to));
    return lower.x - upper.x <= distance && lower.y - upper.y <= distance;
}

} // namespace

PlanarLine PlanarLine::part(double from, double to) const {
    return {{glm::mix(segment.from, segment.to, from), glm::mix(segment.from, segment.to, to)},
            start + from * (end - start),
            start + to * (end - start),
            edgeLength};
}

void cutAway(const PlanarSegment& segment, double distance, std::vector<PlanarLine>& lines) {
    std::vector<PlanarLine> left;
    for (const PlanarLine& line : lines) {
        const Interval near = mayBeNear(line.segment, segment, distance) ? nearSegment(line.segment, segment, distance)
                                                                         : Interval{0.0, 0.0};
        if (near.isEmpty() || near.from >= 1.0 || near.to <= 0.0) {
            left.push_back(line);
            continue;
        }
        if (near.from > 0.0) left.push_back(line.part(0.0, near.from));
        if (near.to < 1.0) left.push_back(line.part(near.to, 1.0));
    }
    lines = std::move(left);
}

PlanarLines::PlanarLines(std::span<const glm::dvec2> border,
                         std::span<const std::pair<glm::dvec2, glm::dvec2>> contacts, const Options& options)
    : border_(border.begin(), border.end()), contacts_(contacts.begin(), contacts.end()), options_(options) {}

/// Depth below the border, metres; negative outside.
double PlanarLines::depth(glm::dvec2 point) const {
    double depth = std::numeric_limits<double>::max();
    for (std::size_t k = 0; k < border_.size(); ++k) {
        const glm::dvec2 edge = border_[(k + 1) % border_.size()] - border_[k];
        depth = std::min(depth, cross(edge, point - border_[k]) / glm::length(edge));
    }
    return depth;
}

bool PlanarLines::clip(PlanarLine& line) const {
    Interval inside{0.0, 1.0};
    for (std::size_t k = 0; k < border_.size(); ++k) {
        const glm::dvec2 edge = border_[(k + 1) % border_.size()] - border_[k];
        inside.below(-cross(edge, line.segment.from - border_[k]), -cross(edge, line.segment.to - line.segment.from),
                     0.0);
    }
    if (inside.isEmpty()) return false;
    line = line.part(inside.from, inside.to);
    return true;
}

/// Draws an end that is nearer to the border than `within` out to it.
void PlanarLines::reachBorder(PlanarLine& line, double within) const {
    for (std::size_t k = 0; k < border_.size(); ++k) {
        const glm::dvec2 edge = border_[(k + 1) % border_.size()] - border_[k];
        const glm::dvec2 direction = line.segment.to - line.segment.from;
        const double approach = cross(edge, direction) / glm::length(edge);
        if (std::abs(approach) < options_.shallow * glm::length(direction)) continue;
        const double t = -cross(edge, line.segment.from - border_[k]) / (glm::length(edge) * approach);
        const double reach = within / std::abs(approach);
        if (t <= 0.0 && t > -reach) line = line.part(t, 1.0);
        if (t >= 1.0 && t < 1.0 + reach) line = line.part(0.0, t);
    }
}

void PlanarLines::add(const PlanarLine& line, double clearance) {
    PlanarLine inside = line;
    if (!clip(inside)) return;
    const double clear = std::max(options_.clear * clearance, 4.0 * options_.tolerance);
    std::vector<PlanarLine> pieces{inside};
    const glm::dvec2 direction = line.segment.to - line.segment.from;
    for (std::size_t k = 0; k < border_.size(); ++k) {
        const PlanarSegment side{border_[k], border_[(k + 1) % border_.size()]};
        const double sine = std::abs(cross(side.to - side.from, direction)) /
                            (glm::distance(side.to, side.from) * glm::length(direction));
        if (sine < options_.shallow) cutAway(side, clear, pieces);
    }
    for (const auto& [from, to] : contacts_) cutAway({from, to}, clear, pieces);
    for (PlanarLine& piece : pieces) {
        if (glm::distance(piece.segment.from, piece.segment.to) < clear) continue;
        reachBorder(piece, clear);
        if (clip(piece)) lines_.push_back(piece);
    }
}

std::uint32_t PlanarLines::pointAt(glm::dvec2 point) {
    for (std::uint32_t i = 0; i < result_.points.size(); ++i)
        if (glm::distance(result_.points[i], point) <= options_.tolerance) return i;
    result_.points.push_back(point);
    result_.onBorder.push_back(depth(point) <= options_.tolerance);
    return static_cast<std::uint32_t>(result_.points.size() - 1);
}

/// Appends the pieces of a line between its stops, at parts of it.
void PlanarLines::divideAt(std::size_t line, std::vector<std::pair<double, std::uint32_t>> stops,
                           std::vector<FaceLine>& divided) const {
    const PlanarLine& whole = lines_[line];
    std::sort(stops.begin(), stops.end());
    for (std::size_t k = 0; k + 1 < stops.size(); ++k) {
        if (stops[k].second == stops[k + 1].second) continue;
        const PlanarLine piece = whole.part(stops[k].first, stops[k + 1].first);
        divided.push_back({stops[k].second, stops[k + 1].second, piece.start, piece.end, piece.edgeLength});
    }
}

FaceLines PlanarLines::finish() && {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ends;
    for (const PlanarLine& line : lines_) {
        const std::uint32_t from = pointAt(line.segment.from); // in this order
        ends.emplace_back(from, pointAt(line.segment.to));
    }
    for (std::size_t i = 0; i < lines_.size(); ++i) {
        for (std::size_t j = i + 1; j < lines_.size(); ++j) {
            const PlanarSegment& one = lines_[i].segment;
            const PlanarSegment& two = lines_[j].segment;
            if (!mayBeNear(one, two, 0.0)) continue;
            const glm::dvec2 d = one.to - one.from;
            const glm::dvec2 e = two.to - two.from;
            const double turn = cross(d, e);
            if (std::abs(turn) < 1e-9 * glm::length(d) * glm::length(e)) continue;
            const double t = cross(two.from - one.from, e) / turn;
            const double s = cross(two.from - one.from, d) / turn;
            if (t > 0.0 && t < 1.0 && s > 0.0 && s < 1.0) pointAt(one.from + t * d);
        }
    }
    std::vector<FaceLine> divided;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
        const PlanarSegment& line = lines_[i].segment;
        const glm::dvec2 d = line.to - line.from;
        std::vector<std::pair<double, std::uint32_t>> stops{{0.0, ends[i].first}, {1.0, ends[i].second}};
        for (std::uint32_t k = 0; k < result_.points.size(); ++k) {
            if (k == ends[i].first || k == ends[i].second) continue;
            const double t = glm::dot(result_.points[k] - line.from, d) / glm::dot(d, d);
            if (t <= 0.0 || t >= 1.0) continue;
            if (glm::distance(line.from + t * d, result_.points[k]) <= options_.tolerance) stops.emplace_back(t, k);
        }
        divideAt(i, std::move(stops), divided);
    }
    // Each once, also where two edges lie above each other.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> known;
    for (const FaceLine& line : divided) {
        const auto key = edgeKey(line.from, line.to);
        if (std::find(known.begin(), known.end(), key) != known.end()) continue;
        known.push_back(key);
        if (!(result_.onBorder[line.from] && result_.onBorder[line.to] &&
              depth(0.5 * (result_.points[line.from] + result_.points[line.to])) <= options_.tolerance))
            result_.lines.push_back(line);
    }
    result_.vertices.assign(result_.points.size(), kNone);
    return std::move(result_);
}

} // namespace lambert
