#include "formfactors/occluders.h"

#include "formfactors/closed_form.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace lambert {

namespace {

using Loop = std::vector<std::uint32_t>; // into Scene::positions, counter-clockwise
using Edge = std::pair<std::uint32_t, std::uint32_t>;

constexpr std::size_t kMostCorners = 12;

class Joining {
public:
    Joining(const Scene& scene, double tolerance) : scene_(scene), tolerance_(tolerance) {}

    Occluders run() {
        for (std::uint32_t p = 0; p < scene_.polygons.size(); ++p) {
            const Polygon& polygon = scene_.polygons[p];
            Loop loop(polygon.vertices.begin(), polygon.vertices.begin() + polygon.size());
            const Plane plane = planeOf(loop);
            const Material& material = scene_.materials[polygon.material];
            pieces_.push_back({std::move(loop), plane, p, material.hasHoles()});
            if (!material.hasHoles()) enter(p);
        }
        // The longest edges first: the halves of a quad become one before they join others. Then by direction, so that the
        // quads of a grid become rows and these the whole, not bricks that no full edge joins.
        bool joined = true;
        while (joined) {
            joined = false;
            std::vector<std::pair<std::array<long, 4>, Edge>> edges;
            for (const auto& [edge, owner] : owner_)
                if (edge.first < edge.second && owner_.contains({edge.second, edge.first}))
                    edges.emplace_back(sortKey(edge), edge);
            std::sort(edges.begin(), edges.end());
            for (const auto& [key, edge] : edges) joined = joinAcross(edge) || joined;
        }
        Occluders occluders{result(), {}};
        std::vector<std::uint32_t> number(pieces_.size(), kNone);
        for (std::uint32_t k = 0; k < occluders.list.size(); ++k) number[occluders.list[k].polygon] = k;
        for (std::uint32_t p = 0; p < pieces_.size(); ++p) occluders.ofPolygon.push_back(number[whole(p)]);
        return occluders;
    }

private:
    struct Piece {
        Loop loop; ///< empty: has been joined to another
        Plane plane;
        std::uint32_t polygon;
        bool holes;
        std::uint32_t into = kNone; ///< the piece that it has been joined to
    };

    std::uint32_t whole(std::uint32_t piece) const {
        while (pieces_[piece].into != kNone) piece = pieces_[piece].into;
        return piece;
    }

    glm::dvec3 position(std::uint32_t v) const { return glm::dvec3(scene_.positions[v]); }

    Plane planeOf(const Loop& loop) const {
        std::vector<glm::dvec3> points;
        glm::dvec3 centre(0.0);
        for (const std::uint32_t v : loop) {
            points.push_back(position(v));
            centre += points.back() / static_cast<double>(loop.size());
        }
        return Plane::through(centre, glm::normalize(polygonAreaVector(points)));
    }

    void enter(std::uint32_t piece) {
        const Loop& loop = pieces_[piece].loop;
        for (std::size_t k = 0; k < loop.size(); ++k) owner_[{loop[k], loop[(k + 1) % loop.size()]}] = piece;
    }
    void leave(std::uint32_t piece) {
        const Loop& loop = pieces_[piece].loop;
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const auto found = owner_.find({loop[k], loop[(k + 1) % loop.size()]});
            if (found != owner_.end() && found->second == piece) owner_.erase(found);
        }
    }

    /// Length, descending, and direction, whichever way; equal for edges that differ by rounding.
    std::array<long, 4> sortKey(const Edge& edge) const {
        glm::dvec3 along = position(edge.second) - position(edge.first);
        const double length = glm::length(along);
        along /= length;
        std::array<long, 4> key{-std::lround(1e3 * std::log(length)), 0, 0, 0};
        long sign = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const long rounded = std::lround(1e3 * along[axis]);
            if (sign == 0 && rounded != 0) sign = rounded > 0 ? 1 : -1;
            key[static_cast<std::size_t>(axis) + 1] = sign * rounded;
        }
        return key;
    }

    /// How far b lies outside of the line from a to c, metres; positive where a loop about `normal` is convex.
    double bulge(std::uint32_t a, std::uint32_t b, std::uint32_t c, const glm::dvec3& normal) const {
        const glm::dvec3 whole = position(c) - position(a);
        return glm::dot(glm::cross(position(b) - position(a), whole), normal) / glm::length(whole);
    }

    bool joinAcross(const Edge& edge) {
        const auto one = owner_.find(edge);
        const auto two = owner_.find({edge.second, edge.first});
        if (one == owner_.end() || two == owner_.end() || one->second == two->second) return false;
        Piece& a = pieces_[one->second];
        Piece& b = pieces_[two->second];
        if (glm::dot(a.plane.normal, b.plane.normal) <= 0.0) return false;
        const std::optional<Loop> loop = joinedLoop(a, b, edge);
        if (!loop) return false;
        // The plane of the whole: those of small parts are tilted by rounding.
        const Plane plane = planeOf(*loop);
        for (const Loop& part : {a.loop, b.loop})
            for (const std::uint32_t v : part)
                if (std::abs(plane.height(position(v))) > tolerance_) return false;
        const std::uint32_t kept = one->second, gone = two->second;
        leave(kept);
        leave(gone);
        pieces_[kept].loop = *loop;
        pieces_[kept].plane = plane;
        pieces_[gone].into = kept;
        pieces_[gone].loop.clear();
        enter(kept);
        return true;
    }

    /// The loop around both without the edge, if it is convex.
    std::optional<Loop> joinedLoop(const Piece& a, const Piece& b, const Edge& edge) const {
        Loop whole;
        const auto append = [&](const Loop& loop, std::uint32_t from, std::uint32_t to) {
            std::size_t k = static_cast<std::size_t>(std::find(loop.begin(), loop.end(), from) - loop.begin());
            for (; loop[k % loop.size()] != to; ++k) whole.push_back(loop[k % loop.size()]);
        };
        append(a.loop, edge.second, edge.first);
        append(b.loop, edge.first, edge.second);
        Loop corners;
        for (std::size_t k = 0; k < whole.size(); ++k) {
            const std::uint32_t before = whole[(k + whole.size() - 1) % whole.size()];
            const std::uint32_t after = whole[(k + 1) % whole.size()];
            const bool atJoint = whole[k] == edge.first || whole[k] == edge.second;
            const double out = bulge(before, whole[k], after, a.plane.normal);
            if (atJoint && out < -tolerance_) return std::nullopt;
            if (!(atJoint && out <= tolerance_)) corners.push_back(whole[k]);
        }
        if (corners.size() < 3 || corners.size() > kMostCorners) return std::nullopt;
        return corners;
    }

    std::vector<Occluder> result() const {
        std::vector<Occluder> occluders;
        std::vector<std::uint32_t> number(pieces_.size(), kNone);
        for (std::size_t p = 0, next = 0; p < pieces_.size(); ++p)
            if (!pieces_[p].loop.empty()) number[p] = static_cast<std::uint32_t>(next++);
        for (const Piece& piece : pieces_) {
            if (piece.loop.empty()) continue;
            Occluder& o = occluders.emplace_back();
            for (const std::uint32_t v : piece.loop) o.corners.push_back(position(v));
            for (std::size_t k = 0; k < piece.loop.size(); ++k) {
                const auto twin = owner_.find({piece.loop[(k + 1) % piece.loop.size()], piece.loop[k]});
                o.neighbour.push_back(twin == owner_.end() ? kNone : number[twin->second]);
            }
            o.axisU = glm::normalize(o.corners[1] - o.corners[0]);
            o.axisV = glm::cross(piece.plane.normal, o.axisU);
            o.plane = piece.plane;
            o.polygon = piece.polygon;
            o.holes = piece.holes;
        }
        return occluders;
    }

    const Scene& scene_;
    double tolerance_;
    std::vector<Piece> pieces_;
    std::map<Edge, std::uint32_t> owner_; ///< of directed edges
};

void findSolids(std::vector<Occluder>& occluders) {
    std::vector<bool> seen(occluders.size(), false);
    for (std::uint32_t first = 0; first < occluders.size(); ++first) {
        if (seen[first]) continue;
        seen[first] = true;
        std::vector<std::uint32_t> surface{first};
        bool closed = true;
        double volume = 0.0;
        Extents extents;
        for (std::size_t k = 0; k < surface.size(); ++k) {
            const Occluder& o = occluders[surface[k]];
            extents.add(o.extents);
            volume += glm::dot(polygonAreaVector(o.corners), o.corners[0] - occluders[first].corners[0]) / 3.0;
            closed = closed && !o.holes;
            for (const std::uint32_t next : o.neighbour) {
                closed = closed && next != kNone;
                if (next == kNone || seen[next]) continue;
                seen[next] = true;
                surface.push_back(next);
            }
        }
        if (!closed || !(volume > 0.0)) continue;
        for (const std::uint32_t k : surface) {
            occluders[k].solid = true;
            occluders[k].solidExtents = extents;
        }
    }
}

} // namespace

bool mayStandBetween(const Occluder& occluder, std::span<const glm::dvec3> from, const Extents& there,
                     const Extents& both, std::span<const glm::dvec3> directions, double tolerance) {
    if (both.apart(occluder.extents, directions.size(), tolerance)) return false;
    const auto near = cornerHeights(occluder.plane, from);
    const auto far = there.heights(occluder.plane, directions);
    if (near[0] >= -tolerance && far[0] >= -tolerance) return false;
    return !(near[1] <= tolerance && far[1] <= tolerance);
}

Occluders gatherOccluders(const Scene& scene, Directions& directions, double tolerance) {
    Occluders occluders = Joining(scene, tolerance).run();
    for (Occluder& occluder : occluders.list) directions.enter(occluder.plane);
    for (Occluder& occluder : occluders.list)
        for (const glm::dvec3& p : occluder.corners) occluder.extents.add(p, directions.list());
    findSolids(occluders.list);
    return occluders;
}

} // namespace lambert
