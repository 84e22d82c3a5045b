#include "vpl/particle_sources.h"

#include "core/low_discrepancy.h"
#include "core/orthonormal_basis.h"
#include "core/warps.h"
#include "scene/environment.h"
#include "scene/punctual_light.h"
#include "scene/texel_average.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

namespace lambert {

namespace {

/// The scene's bounding sphere.
struct BoundingSphere {
    glm::dvec3 centre;
    double radius;

    explicit BoundingSphere(const Bounds& bounds)
        : centre(0.5 * (glm::dvec3(bounds.lower) + glm::dvec3(bounds.upper))),
          radius(0.5 * glm::distance(glm::dvec3(bounds.lower), glm::dvec3(bounds.upper))) {}

    double crossSection() const { return std::numbers::pi * radius * radius; }

    /// Where rays along `direction` begin that meet the sphere, uniformly across it.
    glm::vec3 diskPoint(const glm::vec3& direction, const glm::dvec2& u) const {
        const OrthonormalBasis frame(direction);
        const glm::dvec2 disk = radius * concentricDisk(u);
        // From further away than the sphere: what touches it must not lie behind the origin.
        return glm::vec3(centre + disk.x * glm::dvec3(frame.x) + disk.y * glm::dvec3(frame.y) -
                         1.01 * radius * glm::dvec3(frame.z));
    }
};

/// A direction to the environment, by its brightness.
struct SkySample {
    glm::dvec3 direction;
    glm::dvec3 worth; ///< L over the density; its mean is ∫ L dω
};

SkySample sampleSky(const Environment& environment, const glm::dvec2& u) {
    if (environment.distribution() == nullptr) {
        const glm::dvec3 direction = uniformSphere(u);
        return {direction, 4.0 * std::numbers::pi * glm::dvec3(environment.radiance(direction))};
    }
    const SkyMapDistribution::Sample sample = environment.distribution()->sample(u);
    return {sample.direction, glm::dvec3(environment.radiance(sample.direction)) / sample.density};
}

/// Good enough to choose lights by.
glm::dvec3 fluxOf(const Environment& environment, const Bounds& bounds) {
    constexpr std::uint32_t kSamples = 1024;
    glm::dvec3 sum(0.0);
    for (std::uint32_t k = 1; k <= kSamples; ++k) sum += sampleSky(environment, {halton(k, 0), halton(k, 1)}).worth;
    return BoundingSphere(bounds).crossSection() / kSamples * sum;
}

glm::dvec3 fluxOf(const PunctualLight& light, const Bounds& bounds) {
    if (light.kind != PunctualLight::Kind::Directional) return totalFlux(light);
    return BoundingSphere(bounds).crossSection() * glm::dvec3(light.intensity);
}

/// Of each of so many textured emitters; all together have a million cells, or one each.
int cellsPerAxis(std::size_t emitters) {
    int cells = 256;
    while (cells > 1 && emitters * static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells) > 1U << 20)
        cells /= 2;
    return cells;
}

/// The averages of emission textures, made when asked for.
class EmissionAverages {
public:
    explicit EmissionAverages(const Scene& scene) : scene_(scene) {}

    const TexelAverage& of(const TextureUse& use) {
        auto& average = averages_[{use.texture, use.wrapU, use.wrapV}];
        if (average) return *average;
        const Texture& texture = *scene_.textures[use.texture];
        const auto texel = [&texture](int x, int y) {
            return glm::dvec4(glm::max(glm::dvec3(texture.texel(x, y)), 0.0), 1.0);
        };
        average = std::make_unique<TexelAverage>(texture.width(), texture.height(), use.wrapU, use.wrapV, texel);
        return *average;
    }

private:
    const Scene& scene_;
    std::map<std::tuple<std::uint32_t, TextureWrap, TextureWrap>, std::unique_ptr<const TexelAverage>> averages_;
};

} // namespace

SurfacePoint surfacePoint(const RayCaster& rays, std::uint32_t polygon, bool front, float u, float v) {
    const Polygon& p = rays.scene().polygons[polygon];
    const glm::dvec3 area(areaVector(rays.scene(), p));
    const double size = glm::length(area);
    return {polygonPoint(rays.scene(), polygon, u, v), glm::vec3((front ? 1.0 : -1.0) / size * area),
            rays.originOffset(static_cast<float>(std::sqrt(size)))};
}

ParticleSources::ParticleSources(const RayCaster& rays) : rays_(rays) {
    const Scene& scene = rays.scene();
    addPolygons();
    for (std::uint32_t i = 0; i < scene.lights.size(); ++i)
        add({kNone, i, true, fluxOf(scene.lights[i], rays.bounds())});
    if (scene.environment) add({kNone, kNone, true, fluxOf(*scene.environment, rays.bounds())});
}

void ParticleSources::addPolygons() {
    const Scene& scene = rays_.scene();
    const auto emissionOf = [&](const Polygon& polygon, bool front) {
        const SurfaceSide side = sideOf(scene, polygon, front);
        const bool emits = side && scene.materials[side.material].emittedRadiance != Rgb(0.0F);
        return emits ? side : SurfaceSide{};
    };
    const auto textured = [&](const SurfaceSide& side) {
        return side && side.surface != kNone && scene.materials[side.material].emissionTexture;
    };
    std::size_t texturedSides = 0;
    for (const Polygon& polygon : scene.polygons)
        for (const bool front : {true, false}) texturedSides += textured(emissionOf(polygon, front)) ? 1 : 0;
    const int mostCells = cellsPerAxis(texturedSides);
    EmissionAverages averages(scene);
    for (std::uint32_t i = 0; i < scene.polygons.size(); ++i) {
        const Polygon& polygon = scene.polygons[i];
        for (const bool front : {true, false}) {
            const SurfaceSide side = emissionOf(polygon, front);
            if (!side) continue;
            Source source{i, kNone, front};
            glm::dvec3 radiance(scene.materials[side.material].emittedRadiance);
            if (textured(side)) {
                const TexelAverage& texels = averages.of(scene.materials[side.material].emissionTexture);
                source.texture = std::make_shared<TexturedEmitter>(scene, polygon, side, texels, mostCells);
                radiance = source.texture->meanRadiance();
            }
            source.flux = std::numbers::pi * polygonArea(scene, polygon) * radiance;
            add(source);
        }
    }
}

void ParticleSources::add(const Source& source) {
    const double flux = sumOf(source.flux);
    if (!(flux > 0.0)) return;
    cumulative_.push_back((cumulative_.empty() ? 0.0 : cumulative_.back()) + flux);
    sources_.push_back(source);
}

Emission ParticleSources::emit(const glm::dvec2& place, const glm::dvec2& direction) const {
    const double target = place.x * cumulative_.back();
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, target);
    const auto index = static_cast<std::size_t>(found - cumulative_.begin());
    const Source& source = sources_[index];
    const double before = index == 0 ? 0.0 : cumulative_[index - 1];
    const double share = *found - before;
    const glm::dvec2 rescaled(std::clamp((target - before) / share, 0.0, 1.0), place.y);
    Emission emission = source.polygon != kNone ? fromPolygon(source, rescaled, direction)
                        : source.light != kNone ? fromLight(rays_.scene().lights[source.light], rescaled, direction)
                                                : fromEnvironment(rescaled, direction);
    emission.flux *= static_cast<float>(cumulative_.back() / share);
    return emission;
}

Emission ParticleSources::fromPolygon(const Source& source, const glm::dvec2& place,
                                      const glm::dvec2& direction) const {
    const Scene& scene = rays_.scene();
    const Polygon& polygon = scene.polygons[source.polygon];
    const TexturedEmitter::Point point = source.texture
                                             ? source.texture->at(place)
                                             : TexturedEmitter::Point{PolygonPoints(scene, polygon).chartAt(place)};
    const glm::vec2& chart = point.chart;
    Emission emission;
    emission.surface = surfacePoint(rays_, source.polygon, source.front, chart.x, chart.y);
    if (!hasHoles(scene, polygon) || !isHole(scene, polygon, chart.x, chart.y)) {
        const SurfaceSide side = sideOf(scene, polygon, source.front);
        const double area = point.weight * polygonArea(scene, polygon);
        emission.flux =
            Rgb(std::numbers::pi * area * glm::dvec3(emittedRadianceAt(scene, polygon, side, chart.x, chart.y)));
    }
    const OrthonormalBasis frame(emission.surface->normal);
    const glm::vec3 local(cosineHemisphere(direction));
    emission.origin = emission.surface->position + emission.surface->lift * frame.z;
    emission.direction = local.x * frame.x + local.y * frame.y + local.z * frame.z;
    return emission;
}

Emission ParticleSources::fromLight(const PunctualLight& light, const glm::dvec2& place,
                                    const glm::dvec2& direction) const {
    Emission emission;
    emission.flux = Rgb(fluxOf(light, rays_.bounds()));
    if (light.kind != PunctualLight::Kind::Directional) {
        emission.origin = light.position;
        emission.direction = glm::vec3(sampleDirection(light, direction));
        return emission;
    }
    emission.origin = BoundingSphere(rays_.bounds()).diskPoint(light.direction, place);
    emission.direction = light.direction;
    return emission;
}

Emission ParticleSources::fromEnvironment(const glm::dvec2& place, const glm::dvec2& direction) const {
    const BoundingSphere sphere(rays_.bounds());
    const SkySample sample = sampleSky(*rays_.scene().environment, direction);
    Emission emission;
    emission.direction = glm::vec3(-sample.direction);
    emission.origin = sphere.diskPoint(emission.direction, place);
    emission.flux = Rgb(sphere.crossSection() * sample.worth);
    return emission;
}

} // namespace lambert
