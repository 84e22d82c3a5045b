#include "meshing/plane_lines.h"

#include "meshing/pair_triangles.h"
#include "meshing/plane_frame.h"
#include "meshing/weld.h"
#include "scene/box_index.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <optional>
#include <utility>

namespace lambert {

namespace {

constexpr int kMostPasses = 8; ///< pieces bend to the points near them, and may cross anew

using Chain = std::vector<std::uint32_t>;
using Piece = std::pair<std::uint32_t, std::uint32_t>;

/// The points of a plane as an index of points in space has them.
std::vector<glm::vec3> flatPoints(const PlaneLines& drawing) {
    std::vector<glm::vec3> flat;
    flat.reserve(drawing.points.size());
    for (const glm::dvec2& p : drawing.points) flat.emplace_back(p.x, p.y, 0.0);
    return flat;
}

/// All points within the tolerance of each line, in their order along it.
std::vector<Chain> chains(const PlaneLines& drawing, const std::vector<glm::vec3>& flat, double tolerance) {
    const BoxIndex index(boxesOf(flat));
    const auto margin = static_cast<float>(1.1 * tolerance);
    std::vector<Chain> result;
    std::vector<std::uint32_t> found;
    std::vector<std::pair<double, std::uint32_t>> between;
    for (const auto& [from, to] : drawing.lines) {
        const glm::dvec2 a = drawing.points[from];
        const glm::dvec2 along = drawing.points[to] - a;
        const double squared = glm::dot(along, along);
        between.clear();
        index.meeting(Bounds{glm::min(flat[from], flat[to]), glm::max(flat[from], flat[to])}.grownBy(margin), found);
        for (const std::uint32_t point : found) {
            if (point == from || point == to) continue;
            const glm::dvec2 offset = drawing.points[point] - a;
            const double t = glm::dot(offset, along) / squared;
            if (t > 0.0 && t < 1.0 && glm::length(offset - t * along) <= tolerance) between.emplace_back(t, point);
        }
        std::sort(between.begin(), between.end());
        Chain& chain = result.emplace_back(Chain{from});
        for (const auto& [t, point] : between) chain.push_back(point);
        chain.push_back(to);
    }
    return result;
}

std::vector<Piece> piecesOf(const std::vector<Chain>& chains) {
    std::vector<Piece> pieces;
    for (const Chain& chain : chains)
        for (std::size_t k = 0; k + 1 < chain.size(); ++k) pieces.push_back(edgeKey(chain[k], chain[k + 1]));
    std::sort(pieces.begin(), pieces.end());
    pieces.erase(std::unique(pieces.begin(), pieces.end()), pieces.end());
    return pieces;
}

/// Where two pieces cross between their ends.
struct LineCrossing {
    glm::dvec2 point;
    glm::dvec3 place;
};

std::optional<LineCrossing> crossingOf(const PlaneLines& drawing, const Piece& one, const Piece& two) {
    const glm::dvec2 a = drawing.points[one.first];
    const glm::dvec2 b = drawing.points[one.second];
    const glm::dvec2 c = drawing.points[two.first];
    const glm::dvec2 d = drawing.points[two.second];
    const double aSide = cross(d - c, a - c);
    const double bSide = cross(d - c, b - c);
    const double cSide = cross(b - a, c - a);
    const double dSide = cross(b - a, d - a);
    if ((aSide > 0.0) == (bSide > 0.0) || (cSide > 0.0) == (dSide > 0.0)) return std::nullopt;
    const double s = aSide / (aSide - bSide);
    const double t = cSide / (cSide - dSide);
    if (!(s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0)) return std::nullopt;
    return LineCrossing{0.5 * (glm::mix(a, b, s) + glm::mix(c, d, t)),
                        0.5 * (glm::mix(drawing.places[one.first], drawing.places[one.second], s) +
                               glm::mix(drawing.places[two.first], drawing.places[two.second], t))};
}

/// Adds the points where pieces cross; where several lines cross in one point only that. Returns whether there were any.
bool addCrossings(PlaneLines& drawing, const std::vector<glm::vec3>& flat, const std::vector<Piece>& pieces,
                  double tolerance) {
    const BoxIndex index(boxesOf(flat, pieces, static_cast<float>(tolerance)));
    std::vector<std::uint32_t> near;
    std::vector<LineCrossing> crossings;
    std::vector<glm::vec3> points;
    for (std::uint32_t i = 0; i < pieces.size(); ++i) {
        index.nearLater(i, near);
        for (const std::uint32_t j : near) {
            const auto [a, b] = pieces[i];
            const auto [c, d] = pieces[j];
            if (a == c || a == d || b == c || b == d) continue;
            const auto crossing = crossingOf(drawing, pieces[i], pieces[j]);
            if (!crossing) continue;
            crossings.push_back(*crossing);
            points.emplace_back(crossing->point.x, crossing->point.y, 0.0);
        }
    }
    const std::vector<std::uint32_t> representative = weldPositions(points, static_cast<float>(0.5 * tolerance));
    for (std::uint32_t k = 0; k < crossings.size(); ++k) {
        if (representative[k] != k) continue;
        drawing.points.push_back(crossings[k].point);
        drawing.places.push_back(crossings[k].place);
    }
    return !crossings.empty();
}

} // namespace

std::vector<std::vector<std::uint32_t>> cutLines(PlaneLines& drawing, double tolerance) {
    for (int pass = 0; pass < kMostPasses; ++pass) {
        const std::vector<glm::vec3> flat = flatPoints(drawing);
        std::vector<Chain> result = chains(drawing, flat, tolerance);
        if (!addCrossings(drawing, flat, piecesOf(result), tolerance)) return result;
    }
    return {};
}

} // namespace lambert
