// A. Keller, "Instant radiosity", SIGGRAPH 1997.

#include "vpl/trace_lights.h"

#include "core/error.h"
#include "core/low_discrepancy.h"
#include "core/named.h"
#include "core/orthonormal_basis.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/russian_roulette.h"
#include "core/warps.h"
#include "vpl/particle_sources.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace lambert {

namespace {

constexpr std::array kWalks{Named{Walk::Quasi, "quasi"}, Named{Walk::Roulette, "roulette"},
                            Named{Walk::Fixed, "fixed"}};
constexpr std::uint32_t kMostParticles = 1U << 24;
constexpr std::uint32_t kMostBounces = kPrimes / 2 - 2; ///< every hit takes two primes
constexpr float kRounding = 1e-6F;                      ///< of sums of reflectances
constexpr std::uint32_t kTextureSamples = 16;           ///< per polygon, for its mean reflectance

/// Of both its parts.
glm::dvec3 fluxOf(const VirtualPointLight& light) { return glm::dvec3(light.flux) + glm::dvec3(light.lobe.flux); }

/// The numbers that decide on particles.
class Numbers {
public:
    explicit Numbers(const TraceOptions& options) : options_(options) {}

    /// The pair of dimensions 2k and 2k + 1 of particle j, counted from 1: k = 0 is its start, k >= 1 its direction to hit k.
    glm::dvec2 pair(std::uint32_t j, std::uint32_t k) const {
        // Beyond the last prime nothing is left but chance.
        if (options_.sampler == Sampler::Random || 2 * k + 1 >= kPrimes) return random(j, k, 0);
        if (options_.seed == 0) return {halton(j, 2 * k), halton(j, 2 * k + 1)};
        return {scrambledHalton(j, 2 * k, options_.seed), scrambledHalton(j, 2 * k + 1, options_.seed)};
    }
    /// Decides on whether particle j survives hit k.
    float survival(std::uint32_t j, std::uint32_t k) const { return static_cast<float>(random(j, k, 1).x); }

private:
    glm::dvec2 random(std::uint32_t j, std::uint32_t k, std::uint32_t purpose) const {
        const auto bits = philox({j, k, purpose, 0x56504C53}, options_.seed);
        return 0x1p-24 * glm::dvec2(bits[0] >> 8, bits[1] >> 8); // below 1 in float too
    }

    const TraceOptions& options_;
};

/// A particle between two hits.
struct Particle {
    glm::vec3 origin{0.0F}, direction{0.0F};
    Rgb weight{0.0F}; ///< flux, if N of them start
    bool alive = false;
    bool direct = false; ///< comes straight from a light without area
    bool sunk = false;   ///< into the surface that reflected it
};

/// What a particle's way to its next hit left behind.
struct Arrival {
    enum class End : std::uint8_t { None, Escaped, BackFace, BelowHorizon, Surface } end = End::None;
    bool direct = false; ///< as Particle's
    glm::dvec3 incoming{0.0};
    std::optional<VirtualPointLight> light;
};

class Tracer {
public:
    Tracer(const RayCaster& rays, const TraceOptions& options)
        : rays_(rays),
          options_(options),
          numbers_(options),
          sources_(rays),
          meanReflectance_(meanReflectance(rays.scene(), options.gloss)) {}

    VirtualPointLights run(Progress& progress) {
        if (sources_.empty()) return std::move(result_);
        progress.begin("virtual point lights", 0);
        start();
        for (std::uint32_t k = 1; followed(k) > 0; ++k) {
            progress.throwIfCancelled();
            if (!level(k, followed(k), progress)) break;
        }
        for (std::size_t i = result_.lights.size(); i-- > 0 && result_.lights[i].bounce == lastBounce();)
            if (options_.walk != Walk::Roulette) result_.flux.lost += fluxOf(result_.lights[i]);
        progress.end();
        return std::move(result_);
    }

private:
    std::uint32_t lastBounce() const { return static_cast<std::uint32_t>(result_.particles.size() - 1); }

    /// S_k.
    std::uint32_t followed(std::uint32_t k) const {
        if (options_.walk == Walk::Fixed) return k <= options_.bounces ? options_.particles : 0;
        if (options_.walk == Walk::Roulette) return options_.particles;
        return static_cast<std::uint32_t>(std::pow(meanReflectance_, k) * options_.particles);
    }

    void start() {
        const std::uint32_t count = options_.particles;
        const float share = 1.0F / static_cast<float>(count);
        particles_.resize(count);
        std::vector<Arrival> arrivals(count);
        parallelFor(count, 1024, [&](std::size_t begin, std::size_t end, int) {
            for (std::size_t i = begin; i < end; ++i) {
                const auto j = static_cast<std::uint32_t>(i + 1);
                const Emission emission = sources_.emit(numbers_.pair(j, 0), numbers_.pair(j, 1));
                particles_[i] = {emission.origin, emission.direction, share * emission.flux, emission.flux != Rgb(0.0F),
                                 !emission.surface};
                if (emission.surface && particles_[i].alive)
                    arrivals[i].light = VirtualPointLight{emission.surface->position, emission.surface->normal,
                                                          particles_[i].weight, 0, emission.surface->lift};
            }
        });
        for (const Particle& particle : particles_)
            if (!particle.direct) result_.flux.emitted += glm::dvec3(particle.weight);
        collect(arrivals, count);
    }

    /// Follows the first `count` particles to their hit k. False if none is left.
    bool level(std::uint32_t k, std::uint32_t count, Progress& progress) {
        const double scale = static_cast<double>(options_.particles) / count;
        std::vector<Arrival> arrivals(count);
        parallelFor(count, 1024, [&](std::size_t begin, std::size_t end, int) {
            for (std::size_t i = begin; i < end; ++i)
                if (particles_[i].alive) arrivals[i] = advance(static_cast<std::uint32_t>(i + 1), k, scale);
            progress.advance(end - begin);
        });
        particles_.resize(count);
        return collect(arrivals, count);
    }

    Arrival advance(std::uint32_t j, std::uint32_t k, double scale) {
        Particle& particle = particles_[j - 1];
        particle.alive = false;
        Arrival arrival;
        arrival.incoming = scale * glm::dvec3(particle.weight);
        arrival.direct = std::exchange(particle.direct, false);
        if (particle.sunk) {
            arrival.end = Arrival::End::BelowHorizon;
            return arrival;
        }
        const auto hit = rays_.closest({particle.origin, particle.direction});
        if (!hit) {
            arrival.end = Arrival::End::Escaped;
            return arrival;
        }
        const Polygon& polygon = rays_.scene().polygons[hit->polygon];
        const SurfaceSide side = sideOf(rays_.scene(), polygon, hit->front);
        if (!side) {
            arrival.end = Arrival::End::BackFace;
            return arrival;
        }
        arrival.end = Arrival::End::Surface;
        const PhongLobe gloss = options_.gloss.empty() ? PhongLobe{} : options_.gloss[side.material];
        const Rgb diffuse = reflectanceAt(rays_.scene(), polygon, side, hit->u, hit->v);
        const Rgb reflectance =
            glm::min(diffuse + gloss.reflectance, Rgb(1.0F)); // textures may be brighter than factors
        if (!reflect(particle, reflectance, numbers_.survival(j, k))) return arrival;
        const SurfacePoint point = surfacePoint(rays_, hit->polygon, hit->front, hit->u, hit->v);
        const auto atScale = [scale](const Rgb& flux) { return Rgb(scale * glm::dvec3(flux)); };
        LightLobe lobe;
        if (gloss) lobe = glossyPart(particle, gloss, reflectance, point.normal);
        arrival.light =
            VirtualPointLight{point.position, point.normal, atScale(particle.weight - lobe.flux), k, point.lift};
        arrival.light->lobe = {atScale(lobe.flux), lobe.axis, lobe.exponent};
        send(particle, point, lobe, numbers_.pair(j, k + 1));
        return arrival;
    }

    /// Of a particle's weight after a reflection by both parts.
    static LightLobe glossyPart(const Particle& particle, const PhongLobe& gloss, const Rgb& reflectance,
                                const glm::vec3& normal) {
        LightLobe lobe{Rgb(0.0F), mirrored(particle.direction, normal), gloss.exponent};
        for (int c = 0; c < 3; ++c)
            if (gloss.reflectance[c] > 0.0F)
                lobe.flux[c] = particle.weight[c] * (gloss.reflectance[c] / reflectance[c]);
        return lobe;
    }

    /// Sends a particle on from where it was reflected, by chance with the lobe or the rest of its weight.
    static void send(Particle& particle, const SurfacePoint& from, const LightLobe& lobe, glm::dvec2 u) {
        bool byLobe = false;
        if (lobe) {
            const double probability = sumOf(RgbSum(lobe.flux)) / sumOf(RgbSum(particle.weight));
            byLobe = u.x < probability;
            const double chosen = byLobe ? probability : 1.0 - probability;
            u.x = std::min((byLobe ? u.x : u.x - probability) / chosen, 1.0);
            particle.weight = (byLobe ? lobe.flux : particle.weight - lobe.flux) / static_cast<float>(chosen);
        }
        const OrthonormalBasis frame(byLobe ? lobe.axis : from.normal);
        const glm::vec3 local(byLobe ? phongDirection(u, static_cast<double>(lobe.exponent)) : cosineHemisphere(u));
        particle.origin = from.position + from.lift * from.normal;
        particle.direction = local.x * frame.x + local.y * frame.y + local.z * frame.z;
        particle.sunk = byLobe && glm::dot(particle.direction, from.normal) <= 0.0F;
        particle.alive = true;
    }

    /// Whether anything is reflected.
    bool reflect(Particle& particle, const Rgb& reflectance, float survival) const {
        if (options_.walk != Walk::Roulette) {
            particle.weight *= reflectance;
        } else {
            const RussianRoulette roulette(reflectance);
            if (!roulette.survives(survival)) return false;
            particle.weight *= roulette.weight();
        }
        return particle.weight != Rgb(0.0F);
    }

    /// In the order of the particles, so that sums do not depend on threads.
    bool collect(const std::vector<Arrival>& arrivals, std::uint32_t count) {
        bool alive = false;
        result_.particles.push_back(count);
        for (std::size_t i = 0; i < arrivals.size(); ++i) {
            const Arrival& arrival = arrivals[i];
            alive = alive || particles_[i].alive;
            if (arrival.light) result_.lights.push_back(*arrival.light);
            if (arrival.end == Arrival::End::None) continue;
            if (arrival.end != Arrival::End::BelowHorizon) ++result_.rays;
            account(arrival);
        }
        return alive;
    }

    void account(const Arrival& arrival) {
        ParticleFlux& flux = result_.flux;
        if (arrival.end == Arrival::End::Surface) {
            if (arrival.direct) flux.received += arrival.incoming;
            flux.absorbed += arrival.incoming - (arrival.light ? fluxOf(*arrival.light) : glm::dvec3(0.0));
        } else if (arrival.end == Arrival::End::BelowHorizon) {
            flux.belowHorizon += arrival.incoming;
        } else if (!arrival.direct) {
            (arrival.end == Arrival::End::Escaped ? flux.escaped : flux.backFaces) += arrival.incoming;
        }
    }

    const RayCaster& rays_;
    const TraceOptions options_;
    const Numbers numbers_;
    const ParticleSources sources_;
    const double meanReflectance_;
    std::vector<Particle> particles_; ///< the first S_k
    VirtualPointLights result_;
};

/// By area over a polygon's side.
Rgb meanReflectanceOf(const Scene& scene, const Polygon& polygon, const SurfaceSide& side) {
    if (side.surface == kNone) return scene.materials[side.material].reflectance;
    const PolygonPoints points(scene, polygon);
    Rgb sum(0.0F);
    for (std::uint32_t k = 1; k <= kTextureSamples; ++k) {
        const glm::vec2 chart = points.chartAt({halton(k, 0), halton(k, 1)});
        sum += reflectanceAt(scene, polygon, side, chart.x, chart.y);
    }
    return sum / static_cast<float>(kTextureSamples);
}

} // namespace

double meanReflectance(const Scene& scene, std::span<const PhongLobe> gloss) {
    double reflecting = 0.0;
    double area = 0.0;
    for (const Polygon& polygon : scene.polygons) {
        const double polygonSize = polygonArea(scene, polygon);
        for (const bool front : {true, false}) {
            const SurfaceSide side = sideOf(scene, polygon, front);
            if (!side) continue;
            glm::dvec3 reflectance(meanReflectanceOf(scene, polygon, side));
            if (!gloss.empty()) reflectance += glm::dvec3(gloss[side.material].reflectance);
            reflecting += polygonSize * sumOf(reflectance) / 3.0;
            area += polygonSize;
        }
    }
    return area > 0.0 ? reflecting / area : 0.0;
}

std::span<const VirtualPointLight> VirtualPointLights::ofBounces(std::uint32_t first, std::uint32_t last) const {
    const auto begin =
        std::lower_bound(lights.begin(), lights.end(), first,
                         [](const VirtualPointLight& light, std::uint32_t b) { return light.bounce < b; });
    const auto end = std::upper_bound(begin, lights.end(), last,
                                      [](std::uint32_t b, const VirtualPointLight& light) { return b < light.bounce; });
    return {begin, end};
}

std::optional<Walk> walkByName(std::string_view name) { return valueNamed(kWalks, name); }
std::string_view nameOf(Walk walk) { return rowOf(kWalks, walk).name; }

void checkTrace(const TraceOptions& options) {
    if (options.particles < 1 || options.particles > kMostParticles)
        throw UsageError(
            fmt::format("virtual point lights: found {}, allowed are 1 to {}", options.particles, kMostParticles));
    if (options.bounces > kMostBounces)
        throw UsageError(
            fmt::format("bounces of a fixed walk: found {}, allowed are 0 to {}", options.bounces, kMostBounces));
    if (options.sampler != Sampler::Halton && options.sampler != Sampler::Random)
        throw UsageError(fmt::format("sampler of virtual point lights: found {}, allowed are halton and random",
                                     nameOf(options.sampler)));
}

void checkGloss(const Scene& scene, std::span<const PhongLobe> gloss) {
    if (!gloss.empty() && gloss.size() != scene.materials.size())
        throw UsageError(
            fmt::format("gloss: found that of {} materials, expected {}", gloss.size(), scene.materials.size()));
    for (std::size_t m = 0; m < gloss.size(); ++m) {
        const Material& material = scene.materials[m];
        const Rgb& glossy = gloss[m].reflectance;
        for (int c = 0; c < 3; ++c)
            if (!(glossy[c] >= 0.0F && (glossy[c] == 0.0F || material.reflectance[c] + glossy[c] <= 1.0F + kRounding)))
                throw UsageError(
                    fmt::format("gloss of material {}: found the reflectance {:g} beside the diffuse {:g}, "
                                "allowed are 0 and more, together at most 1",
                                material.name, glossy[c], material.reflectance[c]));
        if (!(gloss[m].exponent >= 0.0F && gloss[m].exponent <= kLargestPhongExponent))
            throw UsageError(fmt::format("gloss of material {}: found the exponent {:g}, allowed are 0 to {:g}",
                                         material.name, gloss[m].exponent, kLargestPhongExponent));
    }
}

VirtualPointLights traceLights(const RayCaster& rays, const TraceOptions& options, Progress& progress) {
    checkTrace(options);
    checkGloss(rays.scene(), options.gloss);
    return Tracer(rays, options).run(progress);
}

} // namespace lambert
