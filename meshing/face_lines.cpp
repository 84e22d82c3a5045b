#include "meshing/face_lines.h"

#include "meshing/pair_triangles.h"
#include "meshing/plane_frame.h"
#include "meshing/plane_lines.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace lambert {

namespace {

/// Where the line from p along d is nearer to a point than r.
Interval nearPoint(glm::dvec2 p, glm::dvec2 d, double r) {
    const double a = glm::dot(d, d);
    const double b = glm::dot(p, d);
    const double root = b * b - a * (glm::dot(p, p) - r * r);
    if (!(root > 0.0) || !(a > 0.0)) return {0.0, 0.0};
    return {(-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a};
}

/// Where a line is nearer to a segment than r: one interval, as what is near to a segment is convex.
Interval nearSegment(const FaceSegment& line, const FaceSegment& segment, double r) {
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

bool mayBeNear(const FaceSegment& one, const FaceSegment& two, double distance) {
    const glm::dvec2 lower = glm::max(glm::min(one.from, one.to), glm::min(two.from, two.to));
    const glm::dvec2 upper = glm::min(glm::max(one.from, one.to), glm::max(two.from, two.to));
    return lower.x - upper.x <= distance && lower.y - upper.y <= distance;
}

} // namespace

DrawnLine DrawnLine::part(double from, double to) const {
    return {{glm::mix(segment.from, segment.to, from), glm::mix(segment.from, segment.to, to)},
            start + from * (end - start),
            start + to * (end - start),
            edgeLength};
}

void cutAway(const FaceSegment& segment, double distance, std::vector<DrawnLine>& lines) {
    std::vector<DrawnLine> left;
    for (const DrawnLine& line : lines) {
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

FaceDrawing::FaceDrawing(std::span<const glm::dvec2> border,
                         std::span<const std::pair<glm::dvec2, glm::dvec2>> contacts, const Options& options)
    : border_(border.begin(), border.end()), contacts_(contacts.begin(), contacts.end()), options_(options) {}

bool FaceDrawing::clip(DrawnLine& line) const {
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
void FaceDrawing::reachBorder(DrawnLine& line, double within) const {
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

void FaceDrawing::add(const DrawnLine& line, double clearance) {
    DrawnLine inside = line;
    if (!clip(inside)) return;
    const double clear = std::max(options_.clear * clearance, 4.0 * options_.tolerance);
    std::vector<DrawnLine> pieces{inside};
    const glm::dvec2 direction = line.segment.to - line.segment.from;
    for (std::size_t k = 0; k < border_.size(); ++k) {
        const FaceSegment side{border_[k], border_[(k + 1) % border_.size()]};
        const double sine = std::abs(cross(side.to - side.from, direction)) /
                            (glm::distance(side.to, side.from) * glm::length(direction));
        if (sine < options_.shallow) cutAway(side, clear, pieces);
    }
    for (const auto& [from, to] : contacts_) cutAway({from, to}, clear, pieces);
    for (DrawnLine& piece : pieces) {
        if (glm::distance(piece.segment.from, piece.segment.to) < clear) continue;
        reachBorder(piece, clear);
        if (clip(piece)) lines_.push_back(piece);
    }
}

FaceLines FaceDrawing::finish() && {
    PlaneLines drawing;
    const auto pointAt = [&](glm::dvec2 point) {
        const auto near = std::find_if(drawing.points.begin(), drawing.points.end(), [&](glm::dvec2 known) {
            return glm::distance(known, point) <= options_.tolerance;
        });
        if (near == drawing.points.end()) {
            drawing.points.push_back(point);
            drawing.places.emplace_back(point, 0.0);
            return static_cast<std::uint32_t>(drawing.points.size() - 1);
        }
        return static_cast<std::uint32_t>(near - drawing.points.begin());
    };
    std::vector<DrawnLine> drawn;
    for (const DrawnLine& line : lines_) {
        const std::uint32_t from = pointAt(line.segment.from), to = pointAt(line.segment.to);
        if (from == to) continue;
        drawing.lines.push_back({from, to});
        drawn.push_back(line);
    }
    const std::vector<std::vector<std::uint32_t>> chains = cutLines(drawing, options_.tolerance);
    FaceLines result;
    if (chains.empty()) return result;
    for (const glm::dvec2& point : drawing.points)
        result.onBorder.push_back(depthInside(border_, point) <= options_.tolerance);
    std::set<std::pair<std::uint32_t, std::uint32_t>> known; // each once, also where two edges lie above each other
    for (std::size_t i = 0; i < chains.size(); ++i) {
        const FaceSegment& line = drawn[i].segment;
        const glm::dvec2 along = line.to - line.from;
        const auto partAt = [&](std::uint32_t point) {
            return glm::dot(drawing.points[point] - line.from, along) / glm::dot(along, along);
        };
        for (std::size_t k = 0; k + 1 < chains[i].size(); ++k) {
            const std::uint32_t from = chains[i][k], to = chains[i][k + 1];
            if (!known.insert(edgeKey(from, to)).second) continue;
            const glm::dvec2 middle = 0.5 * (drawing.points[from] + drawing.points[to]);
            if (result.onBorder[from] && result.onBorder[to] && depthInside(border_, middle) <= options_.tolerance)
                continue;
            const DrawnLine piece =
                drawn[i].part(k == 0 ? 0.0 : partAt(from), k + 2 == chains[i].size() ? 1.0 : partAt(to));
            result.lines.push_back({from, to, piece.start, piece.end, piece.edgeLength});
        }
    }
    result.points = std::move(drawing.points);
    result.vertices.assign(result.points.size(), kNone);
    return result;
}

} // namespace lambert
