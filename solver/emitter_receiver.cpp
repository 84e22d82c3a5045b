#include "solver/emitter_receiver.h"

#include "core/random.h"
#include "core/warps.h"
#include "formfactors/closed_form.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lambert {

namespace {

/// Triangles of fewer radii per distance are points, and up to the second one their points are chosen by area.
constexpr double kPointRatio = 0.03;
constexpr double kAreaRatio = 0.2;

glm::dvec3 pointOf(const std::array<glm::dvec3, 3>& corners, const glm::dvec2& u) {
    const glm::dvec3 w = uniformTriangle(u);
    return w.x * corners[0] + w.y * corners[1] + w.z * corners[2];
}

glm::dvec2 start(std::uint64_t key, std::uint32_t kind) {
    const auto bits = philox({kind, 0, 0, 0x454D4954}, key);
    return {static_cast<double>(uniformFloat(bits[0])), static_cast<double>(uniformFloat(bits[1]))};
}

} // namespace

glm::dvec2 EmitterReceiver::PlanePoints::next() {
    at_ += glm::dvec2(0.7548776662466927, 0.5698402909980532);
    at_ -= glm::floor(at_);
    return at_;
}

EmitterReceiver::Scratch& EmitterReceiver::scratch() {
    thread_local Scratch scratch;
    return scratch;
}

EmitterReceiver::EmitterReceiver(const EmitterTree& tree, const RayCaster& rays, const ReceiverPlane& plane, float lift,
                                 std::uint64_t key)
    : tree_(tree),
      rays_(rays),
      plane_(plane),
      lift_(static_cast<double>(lift)),
      points_(start(key, 0)),
      choices_(start(key, 1)) {
    tree.cut(plane, terminals());
}

void EmitterReceiver::gather(const glm::vec3& point, std::uint32_t rays, double weight, std::span<RgbSum> sums) {
    point_ = glm::dvec3(point);
    findSources();
    ask(rays);
    trace();
    answer(weight, sums);
}

void EmitterReceiver::answer(double weight, std::span<RgbSum> sums) {
    double all = 0.0, seen = 0.0;
    for (const Question& q : questions()) {
        if (!(q.all > 0.0)) continue;
        partly_ = partly_ || (q.seen > 0.0 && q.seen < q.all);
        (q.seen > 0.0 ? someSeen_ : someHidden_) = true;
        all += q.isOfFew ? 1.0 : 0.0;
        seen += q.isOfFew ? q.seen / q.all : 0.0;
    }
    const double beta = all > 0.0 ? seen / all : 0.0;
    for (const Question& q : questions())
        if (q.all > 0.0) sums[q.group] += weight * (q.seen / q.all - (q.isOfFew ? beta : 0.0)) * q.irradiance;
    for (const std::uint32_t k : scratch().few) {
        const Source& s = scratch().sources[k];
        sums[s.group] += weight * beta * s.irradiance;
    }
}

void EmitterReceiver::findSources() {
    scratch().sources.clear();
    for (const EmitterTerminal& terminal : terminals()) {
        const EmitterNode& node = tree_.node(terminal.node);
        if (terminal.sampled) {
            const auto choice = tree_.choose(terminal.node, {point_, plane_.normal, 0.0}, choices_.next().x);
            if (choice.triangle != kNone) addTriangle(choice.triangle, 1.0 / choice.probability);
        } else if (node.isTriangle()) {
            isPoint(node) ? addPoint(node, kNone, node.right) : addTriangle(node.right, 1.0);
        } else {
            addPoint(node, terminal.node, kNone);
        }
    }
}

/// Whether a triangle is as good as a point, and lies above the horizon.
bool EmitterReceiver::isPoint(const EmitterNode& triangle) const {
    const glm::dvec3 way = triangle.centre - point_;
    return triangle.radius * triangle.radius < kPointRatio * kPointRatio * glm::dot(way, way) &&
           glm::dot(way, plane_.normal) > triangle.radius;
}

void EmitterReceiver::addPoint(const EmitterNode& node, std::uint32_t index, std::uint32_t triangle) {
    const glm::dvec3 way = point_ - node.centre;
    const double squared = glm::dot(way, way);
    const double scale = -glm::dot(way, plane_.normal) / (std::numbers::pi * squared * squared);
    const RgbSum e =
        scale * RgbSum(glm::dot(node.flux[0], way), glm::dot(node.flux[1], way), glm::dot(node.flux[2], way));
    if (!(sumOf(e) > 0.0)) return;
    const bool single = triangle != kNone;
    const std::uint32_t group = single ? tree_.triangles()[triangle].group : tree_.groupOf(index);
    Source& source = scratch().sources.emplace_back();
    source.value = sumOf(e);
    source.irradiance = e;
    source.node = index;
    source.triangle = triangle;
    source.group = group;
    if (single) source.corners = tree_.triangles()[triangle].corners;
}

void EmitterReceiver::addTriangle(std::uint32_t index, double weight) {
    const EmitterTriangle& t = tree_.triangles()[index];
    if (!(glm::dot(point_ - t.corners[0], t.normal) > 0.0)) return;
    double lowest = 1.0, highest = -1.0;
    for (const glm::dvec3& p : t.corners) {
        const double height = glm::dot(p - point_, plane_.normal);
        lowest = std::min(lowest, height);
        highest = std::max(highest, height);
    }
    if (!(highest > 0.0)) return;
    if (lowest >= 0.0) return addVisible(index, t, t.corners, weight);
    auto& clipped = scratch().clipped;
    clipped = clippedToHalfSpace(t.corners, point_, plane_.normal);
    for (std::size_t k = 1; k + 1 < clipped.size(); ++k)
        addVisible(index, t, {clipped[0], clipped[k], clipped[k + 1]}, weight);
}

void EmitterReceiver::addVisible(std::uint32_t index, const EmitterTriangle& t,
                                 const std::array<glm::dvec3, 3>& corners, double weight) {
    const double factor = weight * pointToVisiblePolygon(point_, plane_.normal, corners);
    if (!(factor > 0.0)) return;
    const RgbSum e = factor * t.radiosity;
    scratch().sources.push_back({sumOf(e), e, kNone, index, t.group, corners});
}

/// Sources of a ray's share or more get rays of their own; all others together those that are left, in proportion.
void EmitterReceiver::ask(std::uint32_t rays) {
    questions().clear();
    auto& few = scratch().few;
    few.clear();
    double total = 0.0;
    for (const Source& s : scratch().sources) total += s.value;
    if (!(total > 0.0)) return;
    double rest = 0.0;
    for (std::uint32_t k = 0; k < scratch().sources.size(); ++k) {
        const Source& s = scratch().sources[k];
        const double share = s.value / total * rays;
        if (share >= 1.0) {
            questions().push_back({s.irradiance, s.group, false});
            aimAt(s, static_cast<std::uint32_t>(share));
        } else {
            few.push_back(k);
            rest += s.value;
        }
    }
    if (!(rest > 0.0)) return;
    const auto count = static_cast<std::uint32_t>(std::ceil(rest / total * rays));
    const double step = rest / count;
    double next = choices_.next().y * step;
    double before = 0.0;
    for (const std::uint32_t k : few) {
        const Source& s = scratch().sources[k];
        for (; next < before + s.value; next += step) {
            questions().push_back({step / s.value * s.irradiance, s.group, true});
            aimAt(s, 1);
        }
        before += s.value;
    }
}

void EmitterReceiver::aimAt(const Source& s, std::uint32_t rays) {
    if (s.triangle == kNone) {
        for (std::uint32_t k = 0; k < rays; ++k) {
            const std::uint32_t index = tree_.chooseFar(s.node, point_, choices_.next().x);
            const EmitterTriangle& t = tree_.triangles()[index];
            addRay(t, pointOf(t.corners, points_.next()), 1.0);
        }
        return;
    }
    const EmitterTriangle& t = tree_.triangles()[s.triangle];
    if (const auto seen = nearTriangle(s.corners)) {
        aimByDirection(s, t, *seen, rays);
        return;
    }
    for (std::uint32_t k = 0; k < rays; ++k) {
        const glm::dvec3 y = pointOf(s.corners, points_.next());
        const glm::dvec3 way = y - point_;
        const double squared = glm::dot(way, way);
        addRay(t, y, -glm::dot(way, plane_.normal) * glm::dot(way, t.normal) / (squared * squared));
    }
}

/// Near triangles by solid angle and about by the cosine: weights hardly differ, and nothing grows without bounds.
void EmitterReceiver::aimByDirection(const Source& s, const EmitterTriangle& t, const SphericalTriangle& seen,
                                     std::uint32_t rays) {
    const auto cosine = [&](std::size_t k) {
        return std::max(0.01, glm::dot(glm::normalize(s.corners[k] - point_), plane_.normal));
    };
    const double second = cosine(1);
    const BilinearWarp warp({second, second, cosine(0), cosine(2)});
    const double plane = glm::dot(s.corners[0] - point_, t.normal);
    for (std::uint32_t k = 0; k < rays; ++k) {
        const glm::dvec2 u = warp.at(points_.next());
        const glm::dvec3 direction = seen.direction(u);
        const double along = glm::dot(direction, t.normal);
        if (!(along < 0.0)) continue;
        addRay(t, point_ + plane / along * direction, glm::dot(direction, plane_.normal) / warp.density(u));
    }
}

std::optional<SphericalTriangle> EmitterReceiver::nearTriangle(const std::array<glm::dvec3, 3>& corners) const {
    const glm::dvec3 centre = (corners[0] + corners[1] + corners[2]) / 3.0 - point_;
    std::array<glm::dvec3, 3> relative;
    double radius = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        relative[k] = corners[k] - point_;
        const glm::dvec3 fromCentre = relative[k] - centre;
        radius = std::max(radius, glm::dot(fromCentre, fromCentre));
        if (!(glm::dot(relative[k], relative[k]) > 0.0)) return std::nullopt;
    }
    if (radius < kAreaRatio * kAreaRatio * glm::dot(centre, centre)) return std::nullopt;
    return SphericalTriangle::seenFromOrigin(relative);
}

/// For the last question. What begins behind the emitter once it is lifted was in contact with it, and sees nothing. Where two
/// surfaces meet in an edge, both ends are lifted less, so that neither comes to lie behind the other's plane.
void EmitterReceiver::addRay(const EmitterTriangle& t, const glm::dvec3& target, double weight) {
    if (!(weight > 0.0)) return;
    questions().back().all += weight;
    const double before = glm::dot(point_ + lift_ * plane_.normal - t.corners[0], t.normal);
    const double above = glm::dot(target - point_, plane_.normal);
    if (!(before > 0.0 && above > 0.0)) return;
    const glm::vec3 origin(point_ + std::min(lift_, 0.5 * above) * plane_.normal);
    const glm::vec3 way(target + std::min(t.lift, 0.5 * before) * t.normal - glm::dvec3(origin));
    last_ = {origin, way, 1.0F};
    packet_.set(pending_, last_);
    weight_[pending_] = weight;
    question_[pending_] = static_cast<std::uint32_t>(questions().size() - 1);
    if (++pending_ == kLanes) trace();
}

void EmitterReceiver::trace() {
    if (pending_ == 0) return;
    for (int lane = pending_; lane < kLanes; ++lane) packet_.set(lane, last_, false);
    rays_.occluded(packet_);
    for (int lane = 0; lane < pending_; ++lane)
        if (!packet_.occluded[lane]) questions()[question_[lane]].seen += weight_[lane];
    pending_ = 0;
}

} // namespace lambert
