// T. Kollig, A. Keller, "Illumination in the presence of weak singularities", Monte Carlo and Quasi-Monte Carlo Methods 2004.

#include "vpl/recovery.h"

#include "core/low_discrepancy.h"
#include "core/orthonormal_basis.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/russian_roulette.h"
#include "core/warps.h"
#include "scene/surface.h"
#include "vpl/particle_sources.h"
#include "vpl/shadowed_sum.h"
#include "vpl/sky_light.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lambert {

namespace {

constexpr std::uint32_t kSkyRays = 16; ///< from one of many points that stand for a receiver's surroundings

/// A point whose light counts for a receiver.
struct Branch {
    Receiver point;
    std::uint32_t receiver; ///< whose irradiance it adds to
    glm::dvec3 weight;      ///< by how much
};

/// What one point's rays found.
struct Found {
    glm::dvec3 emitted{0.0};
    std::vector<Branch> branches;
};

/// Russian roulette of which every single trial is fair, and together they succeed as often as they should, to within one: a
/// trial succeeds if the sum of all probabilities so far passes a whole number.
class FairTrials {
public:
    /// `u` uniform in [0, 1).
    explicit FairTrials(float u) : sum_(static_cast<double>(u)) {}
    bool succeeds(float probability) {
        const double before = std::floor(sum_);
        sum_ += static_cast<double>(probability);
        return std::floor(sum_) > before;
    }

private:
    double sum_;
};

class Recovery {
public:
    Recovery(const RayCaster& rays, double largestTerm, std::uint64_t seed)
        : rays_(rays), largestTerm_(largestTerm), seed_(seed) {}

    /// Shoots `count` rays from a point, the `index`-th of its generation.
    Found shoot(const Branch& from, std::uint32_t index, std::uint32_t generation, std::uint32_t count) const {
        const auto key = philox({index, generation, 0, 0x5245434F}, seed_);
        const OrthonormalBasis frame(from.point.normal);
        Found found;
        FairTrials trials(uniformFloat(key[2]));
        for (std::uint32_t k = 0; k < count; ++k) {
            const glm::vec3 local(cosineHemisphere({scrambledSobol(k, 0, key[0]), scrambledSobol(k, 1, key[1])}));
            const Ray ray{from.point.position + from.point.lift * from.point.normal,
                          local.x * frame.x + local.y * frame.y + local.z * frame.z};
            follow(from, ray, from.weight / static_cast<double>(count), trials, found);
        }
        return found;
    }

private:
    void follow(const Branch& from, const Ray& ray, const glm::dvec3& weight, FairTrials& trials, Found& found) const {
        const auto hit = rays_.closest(ray);
        if (!hit) return;
        const Scene& scene = rays_.scene();
        const Polygon& polygon = scene.polygons[hit->polygon];
        const SurfaceSide side = sideOf(scene, polygon, hit->front);
        if (!side) return;
        const SurfacePoint point = surfacePoint(rays_, hit->polygon, hit->front, hit->u, hit->v);
        const double excess = excessAt(from.point, point);
        if (!(excess > 0.0)) return;
        // A cosine-distributed ray is worth π L, of which the bound has left G_max / G.
        const glm::dvec3 emitted =
            std::numbers::pi * glm::dvec3(emittedRadianceAt(scene, polygon, side, hit->u, hit->v));
        found.emitted += excess * weight * emitted;
        const RussianRoulette roulette(static_cast<float>(excess) *
                                       reflectanceAt(scene, polygon, side, hit->u, hit->v));
        if (!trials.succeeds(roulette.probability())) return;
        found.branches.push_back(
            {{point.position, point.normal, point.lift}, from.receiver, weight * glm::dvec3(roulette.weight())});
    }

    /// The share of the geometric term that lies above its bound.
    double excessAt(const Receiver& receiver, const SurfacePoint& point) const {
        const glm::dvec3 way = glm::dvec3(point.position) - glm::dvec3(receiver.position);
        const double squared = glm::dot(way, way);
        const double cosines =
            -glm::dot(way, glm::dvec3(receiver.normal)) * glm::dot(way, glm::dvec3(point.normal)) / squared;
        return cosines > 0.0 ? std::max(0.0, 1.0 - largestTerm_ * squared / cosines) : 0.0;
    }

    const RayCaster& rays_;
    double largestTerm_;
    std::uint64_t seed_;
};

} // namespace

Recovered recoverLight(const RayCaster& rays, std::span<const VirtualPointLight> lights,
                       std::span<const Receiver> receivers, double largestTerm, const GatherOptions& options,
                       Progress& progress) {
    const Recovery recovery(rays, largestTerm, options.seed);
    Recovered result;
    result.irradiance.assign(receivers.size(), glm::dvec3(0.0));
    std::vector<Branch> branches;
    for (std::uint32_t i = 0; i < receivers.size(); ++i) branches.push_back({receivers[i], i, glm::dvec3(1.0)});
    for (std::uint32_t generation = 0; !branches.empty(); ++generation) {
        const std::uint32_t count = generation == 0 ? options.recoveryRays : 1;
        progress.begin("recover light", branches.size());
        std::vector<Found> found(branches.size());
        parallelFor(branches.size(), 64, [&](std::size_t begin, std::size_t end, int) {
            for (std::size_t i = begin; i < end; ++i)
                found[i] = recovery.shoot(branches[i], static_cast<std::uint32_t>(i), generation, count);
            progress.advance(end - begin);
        });
        progress.end();
        result.rays += branches.size() * count;
        std::vector<Branch> next;
        for (std::size_t i = 0; i < branches.size(); ++i) {
            result.irradiance[branches[i].receiver] += found[i].emitted;
            next.insert(next.end(), found[i].branches.begin(), found[i].branches.end());
        }
        branches = std::move(next);
        std::vector<Receiver> points;
        for (const Branch& branch : branches) points.push_back(branch.point);
        progress.begin("gather light", points.size() * lights.size());
        const ShadowedSum sum = sumLights(rays, {lights, rays.scene().lights}, points, largestTerm, progress);
        progress.end();
        const std::vector<glm::dvec3> sky = skyLight(rays, points, kSkyRays, options.seed + generation + 1, progress);
        result.shadowRays += sum.rays + sky.size() * kSkyRays;
        for (std::size_t i = 0; i < branches.size(); ++i)
            result.irradiance[branches[i].receiver] +=
                branches[i].weight * (sum.irradiance[i] + (sky.empty() ? glm::dvec3(0.0) : sky[i]));
    }
    return result;
}

} // namespace lambert
