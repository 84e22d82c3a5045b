#include "vpl/particle_sources.h"

#include "core/orthonormal_basis.h"
#include "core/warps.h"
#include "scene/punctual_light.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lambert {

namespace {

double sumOf(const glm::dvec3& flux) { return flux.x + flux.y + flux.z; }

/// The scene's bounding sphere.
struct BoundingSphere {
    glm::dvec3 centre;
    double radius;

    explicit BoundingSphere(const Bounds& bounds)
        : centre(0.5 * (glm::dvec3(bounds.lower) + glm::dvec3(bounds.upper))),
          radius(0.5 * glm::distance(glm::dvec3(bounds.lower), glm::dvec3(bounds.upper))) {}
};

glm::dvec3 fluxOf(const PunctualLight& light, const Bounds& bounds) {
    if (light.kind != PunctualLight::Kind::Directional) return totalFlux(light);
    const double radius = BoundingSphere(bounds).radius;
    return std::numbers::pi * radius * radius * glm::dvec3(light.intensity);
}

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
    for (std::uint32_t i = 0; i < scene.polygons.size(); ++i) {
        for (const bool front : {true, false}) {
            const SurfaceSide side = sideOf(scene, scene.polygons[i], front);
            if (!side) continue;
            const glm::dvec3 radiance(scene.materials[side.material].emittedRadiance);
            add({i, kNone, front, std::numbers::pi * polygonArea(scene, scene.polygons[i]) * radiance});
        }
    }
    for (std::uint32_t i = 0; i < scene.lights.size(); ++i)
        add({kNone, i, true, fluxOf(scene.lights[i], rays.bounds())});
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
                                                : fromLight(rays_.scene().lights[source.light], rescaled, direction);
    emission.flux *= static_cast<float>(cumulative_.back() / share);
    return emission;
}

Emission ParticleSources::fromPolygon(const Source& source, const glm::dvec2& place,
                                      const glm::dvec2& direction) const {
    const Scene& scene = rays_.scene();
    const Polygon& polygon = scene.polygons[source.polygon];
    const glm::vec2 chart = PolygonPoints(scene, polygon).chartAt(place);
    Emission emission;
    emission.surface = surfacePoint(rays_, source.polygon, source.front, chart.x, chart.y);
    if (!hasHoles(scene, polygon) || !isHole(scene, polygon, chart.x, chart.y)) {
        const SurfaceSide side = sideOf(scene, polygon, source.front);
        const double area = polygonArea(scene, polygon);
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
    const BoundingSphere sphere(rays_.bounds());
    const OrthonormalBasis frame(light.direction);
    const glm::dvec2 disk = sphere.radius * concentricDisk(place);
    // From further away than the sphere: what touches it must not lie behind the origin.
    emission.origin = glm::vec3(sphere.centre + disk.x * glm::dvec3(frame.x) + disk.y * glm::dvec3(frame.y) -
                                1.01 * sphere.radius * glm::dvec3(frame.z));
    emission.direction = light.direction;
    return emission;
}

} // namespace lambert
