#include "solver/emitter_light.h"

#include "core/parallel.h"
#include "core/random.h"
#include "core/sample_points.h"
#include "core/spherical_triangle.h"
#include "formfactors/closed_form.h"
#include "formfactors/patch_sampling.h"
#include "meshing/patch_offset.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lambert {

namespace {

constexpr std::uint32_t kPatchPoints = 16; ///< of one batch
constexpr std::uint32_t kPatchRays = 16;   ///< of one point
constexpr int kMostBatches = 4;
constexpr std::size_t kManyPatches = 30'000; ///< of so many each takes one batch, to bound the time
constexpr int kPointBatches = 8;
constexpr double kPatchError = 3e-3; ///< relative, of a patch's mean: no more batches
constexpr double kEven = 0.1;        ///< relative: points of a patch that vary less, and all see the same, are enough
/// Triangles of fewer radii per distance are points, and up to the second one their points are chosen by area.
constexpr double kPointRatio = 0.03;
constexpr double kAreaRatio = 0.2;

double sum(const RgbSum& v) { return v.x + v.y + v.z; }

std::uint64_t keyOf(std::uint32_t index, std::uint32_t kind, std::uint64_t seed) {
    const auto key = philox({index, 0, 0, kind}, seed);
    return std::uint64_t{key[0]} << 32 | key[1];
}

/// Points of the unit square, each of which fills a gap of those before it, from anywhere on: the plastic number's Kronecker
/// sequence.
class PlanePoints {
public:
    explicit PlanePoints(const glm::dvec2& start) : at_(start) {}
    glm::dvec2 next() {
        at_ += glm::dvec2(0.7548776662466927, 0.5698402909980532);
        at_ -= glm::floor(at_);
        return at_;
    }

private:
    glm::dvec2 at_;
};

/// A triangle, or a node as good as a point, as one point sees it.
struct Source {
    double value;           ///< F B_e over the channels, if all of it is seen
    RgbSum irradiance;      ///< the same per channel
    std::uint32_t node;     ///< where it is as good as a point: kNone for a triangle
    std::uint32_t triangle; ///< kNone for a node
    std::uint32_t group;
    std::array<glm::dvec3, 3> corners; ///< of a triangle, above the horizon
};

/// What rays are to find out together: the share that is seen, by weight.
struct Question {
    RgbSum irradiance; ///< if all is seen
    std::uint32_t group;
    double all = 0.0, seen = 0.0;
};

} // namespace

/// One point after the other of a plane, with the same terminals; one per thread and plane.
class EmitterLight::Receiver {
public:
    Receiver(const EmitterLight& light, const ReceiverPlane& plane, float lift, std::uint64_t key)
        : light_(light),
          plane_(plane),
          lift_(static_cast<double>(lift)),
          points_(start(key, 0)),
          choices_(start(key, 1)) {
        light.tree_.cut(plane, terminals());
    }

    bool isDark() const { return terminals().empty(); }

    /// Adds what comes from each group, times `weight`, to `sums`.
    void gather(const glm::vec3& point, std::uint32_t rays, double weight, std::span<RgbSum> sums) {
        point_ = glm::dvec3(point);
        findSources();
        ask(rays);
        trace();
        for (const Question& q : questions()) {
            if (!(q.all > 0.0)) continue;
            sums[q.group] += weight * (q.seen / q.all) * q.irradiance;
            partly_ = partly_ || (q.seen > 0.0 && q.seen < q.all);
            (q.seen > 0.0 ? someSeen_ : someHidden_) = true;
        }
    }

    /// Whether not all rays from all points had the same answer.
    bool seesParts() const { return partly_ || (someSeen_ && someHidden_); }

private:
    static constexpr int kLanes = ShadowPacket::kSize;

    struct Scratch {
        std::vector<EmitterTerminal> terminals;
        std::vector<Source> sources;
        std::vector<std::uint32_t> few; ///< sources that are less than a ray's share
        std::vector<Question> questions;
        std::vector<glm::dvec3> clipped;
    };
    static Scratch& scratch() {
        thread_local Scratch scratch;
        return scratch;
    }
    static std::vector<EmitterTerminal>& terminals() { return scratch().terminals; }
    static std::vector<Question>& questions() { return scratch().questions; }

    static glm::dvec2 start(std::uint64_t key, std::uint32_t kind) {
        const auto bits = philox({kind, 0, 0, 0x454D4954}, key);
        return {static_cast<double>(uniformFloat(bits[0])), static_cast<double>(uniformFloat(bits[1]))};
    }

    void findSources() {
        scratch().sources.clear();
        for (const EmitterTerminal& terminal : terminals()) {
            const EmitterNode& node = light_.tree_.node(terminal.node);
            if (terminal.sampled) {
                const auto choice = light_.tree_.choose(terminal.node, {point_, plane_.normal, 0.0}, choices_.next().x);
                if (choice.triangle != kNone) addTriangle(choice.triangle, 1.0 / choice.probability);
            } else if (node.isTriangle()) {
                isPoint(node) ? addPoint(node, kNone, node.right) : addTriangle(node.right, 1.0);
            } else {
                addPoint(node, terminal.node, kNone);
            }
        }
    }

    /// Whether a triangle is as good as a point, and lies above the horizon.
    bool isPoint(const EmitterNode& triangle) const {
        const glm::dvec3 way = triangle.centre - point_;
        return triangle.radius * triangle.radius < kPointRatio * kPointRatio * glm::dot(way, way) &&
               glm::dot(way, plane_.normal) > triangle.radius;
    }

    void addPoint(const EmitterNode& node, std::uint32_t index, std::uint32_t triangle) {
        const glm::dvec3 way = point_ - node.centre;
        const double squared = glm::dot(way, way);
        const double scale = -glm::dot(way, plane_.normal) / (std::numbers::pi * squared * squared);
        const RgbSum e =
            scale * RgbSum(glm::dot(node.flux[0], way), glm::dot(node.flux[1], way), glm::dot(node.flux[2], way));
        if (!(sum(e) > 0.0)) return;
        const bool single = triangle != kNone;
        const std::uint32_t group = single ? light_.tree_.triangles()[triangle].group : light_.tree_.groupOf(index);
        Source& source = scratch().sources.emplace_back();
        source.value = sum(e);
        source.irradiance = e;
        source.node = index;
        source.triangle = triangle;
        source.group = group;
        if (single) source.corners = light_.tree_.triangles()[triangle].corners;
    }

    void addTriangle(std::uint32_t index, double weight) {
        const EmitterTriangle& t = light_.tree_.triangles()[index];
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

    void addVisible(std::uint32_t index, const EmitterTriangle& t, const std::array<glm::dvec3, 3>& corners,
                    double weight) {
        const double factor = weight * pointToVisiblePolygon(point_, plane_.normal, corners);
        if (!(factor > 0.0)) return;
        const RgbSum e = factor * t.radiosity;
        scratch().sources.push_back({sum(e), e, kNone, index, t.group, corners});
    }

    /// Sources of a ray's share or more get rays of their own; all others together those that are left, in proportion.
    void ask(std::uint32_t rays) {
        questions().clear();
        double total = 0.0;
        for (const Source& s : scratch().sources) total += s.value;
        if (!(total > 0.0)) return;
        auto& few = scratch().few;
        few.clear();
        double rest = 0.0;
        for (std::uint32_t k = 0; k < scratch().sources.size(); ++k) {
            const Source& s = scratch().sources[k];
            const double share = s.value / total * rays;
            if (share >= 1.0) {
                questions().push_back({s.irradiance, s.group});
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
                questions().push_back({step / s.value * s.irradiance, s.group});
                aimAt(s, 1);
            }
            before += s.value;
        }
    }

    void aimAt(const Source& s, std::uint32_t rays) {
        if (s.triangle == kNone) {
            for (std::uint32_t k = 0; k < rays; ++k) {
                const std::uint32_t index = light_.tree_.chooseFar(s.node, point_, choices_.next().x);
                const EmitterTriangle& t = light_.tree_.triangles()[index];
                addRay(t, pointOf(t.corners, points_.next()), 1.0);
            }
            return;
        }
        const EmitterTriangle& t = light_.tree_.triangles()[s.triangle];
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
    void aimByDirection(const Source& s, const EmitterTriangle& t, const SphericalTriangle& seen, std::uint32_t rays) {
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

    std::optional<SphericalTriangle> nearTriangle(const std::array<glm::dvec3, 3>& corners) const {
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

    static glm::dvec3 pointOf(const std::array<glm::dvec3, 3>& corners, const glm::dvec2& u) {
        const glm::dvec3 w = uniformTriangle(u);
        return w.x * corners[0] + w.y * corners[1] + w.z * corners[2];
    }

    /// For the last question. What begins behind the emitter once it is lifted was in contact with it, and sees nothing. Where two
    /// surfaces meet in an edge, both ends are lifted less, so that neither comes to lie behind the other's plane.
    void addRay(const EmitterTriangle& t, const glm::dvec3& target, double weight) {
        if (!(weight > 0.0)) return;
        questions().back().all += weight;
        const double before = glm::dot(point_ + lift_ * plane_.normal - t.corners[0], t.normal);
        const double above = glm::dot(target - point_, plane_.normal);
        if (!(before > 0.0 && above > 0.0)) return;
        const glm::vec3 origin(point_ + std::min(lift_, 0.5 * above) * plane_.normal);
        const glm::vec3 way(target + std::min(t.lift, 0.5 * before) * t.normal - glm::dvec3(origin));
        const int lane = pending_++;
        packet_.originX[lane] = origin.x;
        packet_.originY[lane] = origin.y;
        packet_.originZ[lane] = origin.z;
        packet_.directionX[lane] = way.x;
        packet_.directionY[lane] = way.y;
        packet_.directionZ[lane] = way.z;
        packet_.maxDistance[lane] = 1.0F;
        packet_.active[lane] = -1;
        weight_[lane] = weight;
        question_[lane] = static_cast<std::uint32_t>(questions().size() - 1);
        if (pending_ == kLanes) trace();
    }

    void trace() {
        if (pending_ == 0) return;
        for (int lane = pending_; lane < kLanes; ++lane) { // repeat the last one, inactive
            packet_.originX[lane] = packet_.originX[pending_ - 1];
            packet_.originY[lane] = packet_.originY[pending_ - 1];
            packet_.originZ[lane] = packet_.originZ[pending_ - 1];
            packet_.directionX[lane] = packet_.directionX[pending_ - 1];
            packet_.directionY[lane] = packet_.directionY[pending_ - 1];
            packet_.directionZ[lane] = packet_.directionZ[pending_ - 1];
            packet_.maxDistance[lane] = 1.0F;
            packet_.active[lane] = 0;
        }
        light_.rays_.occluded(packet_);
        for (int lane = 0; lane < pending_; ++lane)
            if (!packet_.occluded[lane]) questions()[question_[lane]].seen += weight_[lane];
        pending_ = 0;
    }

    const EmitterLight& light_;
    ReceiverPlane plane_;
    double lift_;
    PlanePoints points_, choices_;
    glm::dvec3 point_{0.0};
    bool partly_ = false, someSeen_ = false, someHidden_ = false;
    ShadowPacket packet_;
    double weight_[kLanes];
    std::uint32_t question_[kLanes];
    int pending_ = 0;
};

namespace {

/// The mean of batches, and what it may be off by.
class BatchStatistics {
public:
    void add(const RgbSum& batch) {
        ++count_;
        sum_ += batch;
        squares_ += batch * batch;
    }
    RgbSum mean() const { return sum_ / static_cast<double>(count_); }
    RgbSum standardError() const {
        if (count_ < 2) return RgbSum(0.0);
        const double n = count_;
        return glm::sqrt(glm::max(squares_ / n - mean() * mean(), RgbSum(0.0)) / (n - 1.0));
    }
    /// Larger, as few batches may agree by chance.
    RgbSum carefulError() const { return (1.0 + 2.0 / ((count_ - 1.0) * (count_ - 1.0))) * standardError(); }
    int count() const { return count_; }

private:
    int count_ = 0;
    RgbSum sum_{0.0}, squares_{0.0};
};

ReceiverPlane planeOf(const PatchMesh& mesh, std::size_t patch) {
    ReceiverPlane plane{glm::dvec3(mesh.centroid[patch]), glm::dvec3(mesh.normal[patch]), 0.0};
    for (int k = 0; k < mesh.cornerCount(patch); ++k)
        plane.radius = std::max(plane.radius, glm::distance(glm::dvec3(mesh.position(patch, k)), plane.centre));
    return plane;
}

} // namespace

EmitterLight::EmitterLight(const RayCaster& rays, const PatchMesh& mesh, std::uint64_t seed)
    : rays_(rays), seed_(seed), tree_(rays, mesh) {}

EmitterLight::~EmitterLight() = default;

std::vector<RgbSum> EmitterLight::irradiance(const PatchMesh& mesh, Progress& progress,
                                             std::vector<std::vector<RgbSum>>* byMaterial) const {
    std::vector<RgbSum> result(mesh.size(), RgbSum(0.0));
    const std::size_t groups = materials().size();
    if (byMaterial) byMaterial->assign(groups, result);
    if (empty()) return result;
    const int mostBatches = mesh.size() > kManyPatches ? 1 : kMostBatches;
    const auto ofPatch = [&](std::size_t patch, std::vector<RgbSum>& sums) {
        if (mesh.isHidden(patch)) return;
        const std::uint64_t key = keyOf(static_cast<std::uint32_t>(patch), 0x454D4950, seed_);
        Receiver receiver(*this, planeOf(mesh, patch), patchOriginOffset(rays_, mesh, patch), key);
        if (receiver.isDark()) return;
        const PatchPoints surface(mesh, patch);
        const SamplePoints samples(Sampler::Sobol, kPatchPoints * kMostBatches, 2, key);
        BatchStatistics batches;
        double squares = 0.0;
        std::vector<RgbSum> batch(groups);
        const auto enough = [&] {
            const double mean = sum(batches.mean());
            if (batches.count() == mostBatches) return true;
            if (batches.count() > 1) return sum(batches.carefulError()) <= kPatchError * mean;
            const double variance = squares / kPatchPoints - mean * mean;
            return !receiver.seesParts() && variance <= kEven * kEven * mean * mean;
        };
        do {
            const std::uint32_t first = static_cast<std::uint32_t>(batches.count()) * kPatchPoints;
            std::fill(batch.begin(), batch.end(), RgbSum(0.0));
            RgbSum before(0.0);
            for (std::uint32_t k = first; k < first + kPatchPoints; ++k) {
                receiver.gather(surface.at({samples.at(k, 0), samples.at(k, 1)}), kPatchRays, 1.0, batch);
                RgbSum now(0.0);
                for (const RgbSum& e : batch) now += e;
                squares += sum(now - before) * sum(now - before);
                before = now;
            }
            for (std::size_t g = 0; g < groups; ++g) sums[g] += batch[g];
            batches.add(before / static_cast<double>(kPatchPoints));
        } while (!enough());
        for (RgbSum& e : sums) e /= static_cast<double>(batches.count()) * kPatchPoints;
    };
    progress.begin("light of emitters", mesh.size());
    parallelFor(mesh.size(), 16, [&](std::size_t begin, std::size_t end, int) {
        std::vector<RgbSum> sums(groups);
        for (std::size_t i = begin; i < end; ++i) {
            std::fill(sums.begin(), sums.end(), RgbSum(0.0));
            ofPatch(i, sums);
            for (std::size_t g = 0; g < groups; ++g) {
                result[i] += sums[g];
                if (byMaterial) (*byMaterial)[g][i] = sums[g];
            }
        }
        progress.advance(end - begin);
    });
    progress.end();
    return result;
}

EstimatedLight EmitterLight::irradiance(const glm::vec3& point, const glm::vec3& normal, float lift,
                                        std::uint32_t index, std::uint32_t rays) const {
    if (empty()) return {};
    Receiver receiver(*this, {glm::dvec3(point), glm::dvec3(normal), 0.0}, lift, keyOf(index, 0x454D4954, seed_));
    if (receiver.isDark()) return {};
    BatchStatistics batches;
    std::vector<RgbSum> sums(materials().size());
    for (int k = 0; k < kPointBatches; ++k) {
        std::fill(sums.begin(), sums.end(), RgbSum(0.0));
        receiver.gather(point, std::max(rays / kPointBatches, 8U), 1.0, sums);
        RgbSum batch(0.0);
        for (const RgbSum& e : sums) batch += e;
        batches.add(batch);
    }
    return {batches.mean(), batches.standardError()};
}

} // namespace lambert
