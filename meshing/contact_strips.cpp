#include "meshing/contact_strips.h"

#include "meshing/face_lines.h"
#include "meshing/plane_frame.h"

#include <boost/geometry.hpp>
#include <boost/geometry/geometries/linestring.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace lambert {

namespace {

constexpr double kSimplified = 0.125; ///< of a line's distance from the edge, by which it may be off
constexpr double kClear = 0.3;        ///< of that distance, which lines keep from the border beside them
constexpr double kShallow = 0.3;      ///< sine of an angle, below which a line runs along another
constexpr double kSharpest = 1.75; ///< radians: at a sharper turn offset lines are not drawn out to their meeting point
constexpr double kDrawnOut = 1.2;  ///< in distances, beyond the end of the edge at most

using Chain = std::vector<glm::dvec2>;

/// The edges joined end to end. A chain that closes ends where it begins.
std::vector<Chain> chainsOf(std::span<const HoveringEdge> edges) {
    const auto key = [](glm::dvec2 p) { return std::pair(p.x, p.y); };
    std::multimap<std::pair<double, double>, std::size_t> at;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        at.emplace(key(edges[i].from), i);
        at.emplace(key(edges[i].to), i);
    }
    std::vector<bool> used(edges.size(), false);
    // The only other edge at the end of one; none where it ends or branches.
    const auto beyond = [&](glm::dvec2 end, std::size_t edge) {
        if (at.count(key(end)) != 2) return edges.size();
        const auto [first, last] = at.equal_range(key(end));
        for (auto it = first; it != last; ++it)
            if (it->second != edge && !used[it->second]) return it->second;
        return edges.size();
    };
    const auto grow = [&](Chain& chain, std::size_t edge) {
        for (std::size_t next = beyond(chain.back(), edge); next != edges.size(); next = beyond(chain.back(), edge)) {
            used[next] = true;
            chain.push_back(key(edges[next].from) == key(chain.back()) ? edges[next].to : edges[next].from);
            edge = next;
        }
    };
    std::vector<Chain> chains;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (used[i]) continue;
        used[i] = true;
        Chain chain{edges[i].from, edges[i].to};
        grow(chain, i);
        if (chain.front() != chain.back()) {
            std::reverse(chain.begin(), chain.end());
            grow(chain, i);
        }
        chains.push_back(std::move(chain));
    }
    return chains;
}

Chain simplified(const Chain& chain, double tolerance) {
    using Point = boost::geometry::model::d2::point_xy<double>;
    boost::geometry::model::linestring<Point> line, result;
    // A ring is to keep a corner that it turns around.
    Chain from = chain;
    if (chain.size() > 3 && chain.front() == chain.back()) {
        from.pop_back();
        std::rotate(
            from.begin(),
            std::min_element(from.begin(), from.end(),
                             [](glm::dvec2 a, glm::dvec2 b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); }),
            from.end());
        from.push_back(from.front());
    }
    for (const glm::dvec2& p : from) line.emplace_back(p.x, p.y);
    boost::geometry::simplify(line, result, tolerance);
    Chain simple;
    for (const Point& p : result) simple.emplace_back(p.x(), p.y());
    return simple;
}

/// How far offset lines of two consecutive edges are drawn out to meet on the outer side of their turn.
double drawnOut(glm::dvec2 before, glm::dvec2 after, double side, double distance) {
    const double turn = std::atan2(cross(before, after), glm::dot(before, after));
    if (side * turn >= 0.0) return 0.0; // the inner side
    return std::abs(turn) < kSharpest ? std::min(distance * std::tan(0.5 * std::abs(turn)), kDrawnOut * distance) : 0.0;
}

/// Draws the lines at one distance from the edges.
class Level {
public:
    Level(std::span<const HoveringEdge> edges, double distance, FaceDrawing& lines)
        : distance_(distance), lines_(lines) {
        for (const Chain& chain : chainsOf(edges)) {
            chains_.push_back(simplified(chain, kSimplified * distance));
            const Chain& simple = chains_.back();
            for (std::size_t k = 0; k + 1 < simple.size(); ++k) segments_.push_back({simple[k], simple[k + 1]});
        }
    }

    /// The edges themselves.
    void drawEdges() const {
        for (const FaceSegment& s : segments_) lines_.add({s, 0.0, 1.0, glm::distance(s.from, s.to)}, distance_);
    }

    /// Both sides, cut off where they come too near to some edge, also to those that have no line at this distance.
    void drawSides(std::span<const HoveringEdge> others) const {
        std::size_t own = 0;
        for (const Chain& chain : chains_) {
            const bool closed = chain.front() == chain.back();
            for (std::size_t k = 0; k + 1 < chain.size(); ++k, ++own) {
                const glm::dvec2 edge = chain[k + 1] - chain[k];
                const double length = glm::length(edge);
                if (!(length > 0.0)) continue;
                for (const double side : {-1.0, 1.0}) {
                    double before = 0.0, after = 0.0;
                    if (k > 0 || closed)
                        before = drawnOut(k > 0 ? chain[k] - chain[k - 1] : chain[0] - chain[chain.size() - 2], edge,
                                          side, distance_);
                    if (k + 2 < chain.size() || closed)
                        after = drawnOut(edge, k + 2 < chain.size() ? chain[k + 2] - chain[k + 1] : chain[1] - chain[0],
                                         side, distance_);
                    const glm::dvec2 along = edge / length;
                    const glm::dvec2 offset = side * distance_ * glm::dvec2(-along.y, along.x);
                    draw({{chain[k] + offset - before * along, chain[k + 1] + offset + after * along},
                          -before / length,
                          1.0 + after / length,
                          length},
                         own, others);
                }
            }
        }
    }

private:
    void draw(DrawnLine line, std::size_t own, std::span<const HoveringEdge> others) const {
        std::vector<DrawnLine> pieces{line};
        for (std::size_t i = 0; i < segments_.size(); ++i)
            if (i != own) cutAway(segments_[i], (1.0 - 1e-6) * distance_, pieces);
        for (const HoveringEdge& other : others) cutAway({other.from, other.to}, 0.5 * distance_, pieces);
        for (const DrawnLine& piece : pieces) lines_.add(piece, distance_);
    }

    double distance_;
    FaceDrawing& lines_;
    std::vector<Chain> chains_;
    std::vector<FaceSegment> segments_; ///< of all chains, in order
};

} // namespace

int stripLevels(double gap, const StripOptions& options) {
    const double levels = 1.0 + std::round(std::log2(options.length / gap));
    return static_cast<int>(std::clamp(levels, 1.0, static_cast<double>(options.levels)));
}

namespace {

/// Calls back with the edges that are drawn at each distance (metres), from the nearest on: the edges themselves, then strips.
template <class DrawEdges, class DrawSides>
void forEachLevel(std::span<const HoveringEdge> edges, const StripOptions& options, const DrawEdges& drawEdges,
                  const DrawSides& drawSides) {
    // Strips of all edges end at the same distances, so that they join.
    const auto levelOf = [&](const HoveringEdge& edge) {
        return std::min(edge.levels, stripLevels(edge.gap, options));
    };
    const double finest = std::ldexp(options.length, -options.levels);
    std::map<double, std::vector<HoveringEdge>> byGap;
    for (const HoveringEdge& edge : edges)
        byGap[std::max(finest, edge.levels > 0 ? std::ldexp(options.length, -levelOf(edge)) : edge.gap)].push_back(
            edge);
    for (const auto& [gap, alike] : byGap) drawEdges(alike, gap);
    for (int level = options.levels; level >= 1; --level) {
        const double distance = std::ldexp(options.length, -level);
        if (distance < 8.0 * options.tolerance) continue;
        std::vector<HoveringEdge> drawn, others;
        for (const HoveringEdge& edge : edges) (levelOf(edge) >= level ? drawn : others).push_back(edge);
        if (!drawn.empty()) drawSides(drawn, others, distance);
    }
}

} // namespace

double patchesAlong(std::span<const HoveringEdge> edges, const StripOptions& options) {
    double patches = 0.0;
    const auto oneLine = [&](const std::vector<HoveringEdge>& drawn, double distance) {
        double along = 0.0;
        for (const Chain& chain : chainsOf(drawn)) {
            const Chain simple = simplified(chain, kSimplified * distance);
            for (std::size_t k = 0; k + 1 < simple.size(); ++k)
                along += glm::distance(simple[k], simple[k + 1]) / options.length + 1.0;
        }
        return along;
    };
    forEachLevel(
        edges, options, [&](const std::vector<HoveringEdge>& drawn, double gap) { patches += oneLine(drawn, gap); },
        [&](const std::vector<HoveringEdge>& drawn, const std::vector<HoveringEdge>&, double distance) {
            patches += 2.0 * oneLine(drawn, distance);
        });
    return patches;
}

FaceLines contactStrips(std::span<const glm::dvec2> border, std::span<const HoveringEdge> edges,
                        std::span<const std::pair<glm::dvec2, glm::dvec2>> contacts, const StripOptions& options) {
    FaceDrawing lines(border, contacts, {options.tolerance, kClear, kShallow});
    forEachLevel(
        edges, options,
        [&](const std::vector<HoveringEdge>& drawn, double gap) { Level(drawn, gap, lines).drawEdges(); },
        [&](const std::vector<HoveringEdge>& drawn, const std::vector<HoveringEdge>& others, double distance) {
            Level(drawn, distance, lines).drawSides(others);
        });
    return std::move(lines).finish();
}

} // namespace lambert
