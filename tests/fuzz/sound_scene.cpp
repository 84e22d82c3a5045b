#include "sound_scene.h"

#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace lambert {

namespace {

bool isWithin(const glm::vec3& v, float lowest, float highest) {
    return isFinite(v) && glm::all(glm::greaterThanEqual(v, glm::vec3(lowest))) &&
           glm::all(glm::lessThanEqual(v, glm::vec3(highest)));
}

/// Of a normalisation in single precision.
bool isUnit(const glm::vec3& v) { return isFinite(v) && std::abs(glm::length(v) - 1.0F) < 1e-4F; }

template <typename List>
bool isNoneOrIn(std::uint32_t index, const List& list) {
    return index == kNone || index < list.size();
}

void requireSoundPolygon(const Scene& scene, const Polygon& polygon) {
    for (int k = 0; k < polygon.size(); ++k) {
        require(polygon.vertices[static_cast<std::size_t>(k)] < scene.positions.size(), "a polygon's vertices exist");
        require(isFinite(corner(scene, polygon, k)), "a polygon's vertices are finite");
    }
    require(std::isnormal(static_cast<float>(polygonArea(scene, polygon))), "a polygon has an area");
    require(polygon.material < scene.materials.size(), "a polygon's material exists");
    require(polygon.node < scene.nodes.size(), "a polygon's node exists");
    require(isNoneOrIn(polygon.surface, scene.surfaces), "a polygon's surface exists");
    require(isNoneOrIn(polygon.backMaterial, scene.materials), "a polygon's back material exists");
    require(isNoneOrIn(polygon.backSurface, scene.surfaces), "a polygon's back surface exists");
}

void requireSoundMaterial(const Scene& scene, const Material& material) {
    require(isWithin(material.reflectance, 0.0F, 0.99F), "a reflectance is from 0 to 0.99");
    require(isWithin(material.emittedRadiance, 0.0F, 3.4e38F), "emission is finite and not negative");
    require(std::isfinite(material.opacityCutoff), "an opacity cutoff is finite");
    for (const TextureUse& use : {material.reflectanceTexture, material.emissionTexture, material.opacityTexture})
        require(isNoneOrIn(use.texture, scene.textures), "a material's texture exists");
}

void requireSoundSurface(const SurfaceCorners& surface) {
    for (std::size_t k = 0; k < 4; ++k) {
        for (const glm::vec2 uv : {surface.uv[k], surface.emissionUv[k]})
            require(std::isfinite(uv.x) && std::isfinite(uv.y), "texture coordinates are finite");
        require(isWithin(surface.tint[k], 0.0F, 1.0F), "a tint is from 0 to 1");
    }
}

void requireSoundCamera(const Camera& camera) {
    require(isFinite(camera.eye), "a camera's eye is finite");
    require(isUnit(camera.direction), "a camera's direction has unit length");
    require(glm::length(glm::cross(camera.direction, camera.up)) > 0.0F, "a camera's up is not along its direction");
    require(camera.verticalFov > 0.0F && camera.verticalFov < 3.1416F, "a field of view is from 0 to pi");
}

void requireSoundLight(const PunctualLight& light) {
    require(light.kind == PunctualLight::Kind::Directional || isFinite(light.position), "a light's place is finite");
    require(light.kind == PunctualLight::Kind::Point || isUnit(light.direction), "a light's direction has unit length");
    require(isWithin(light.intensity, 0.0F, 3.4e38F), "an intensity is finite and not negative");
    require(light.innerConeAngle >= 0.0F && light.innerConeAngle <= light.outerConeAngle &&
                light.outerConeAngle <= 1.5708F,
            "a spot's angles are ordered, the outer at most pi/2");
}

} // namespace

void require(bool kept, const char* promise) {
    if (kept) return;
    std::fprintf(stderr, "broken promise: %s\n", promise);
    std::abort();
}

void requireSoundScene(const Scene& scene) {
    for (const Polygon& polygon : scene.polygons) requireSoundPolygon(scene, polygon);
    for (const Material& material : scene.materials) requireSoundMaterial(scene, material);
    for (const SurfaceCorners& surface : scene.surfaces) requireSoundSurface(surface);
    for (const auto& texture : scene.textures) requireSoundTexture(*texture);
    for (const Camera& camera : scene.cameras) requireSoundCamera(camera);
    for (const PunctualLight& light : scene.lights) requireSoundLight(light);
}

void requireSoundTexture(const Texture& texture) {
    require(texture.width() >= 1 && texture.height() >= 1, "a texture has texels");
    // Some of a large one.
    const int stepX = texture.width() / 64 + 1;
    const int stepY = texture.height() / 64 + 1;
    for (int y = 0; y < texture.height(); y += stepY) {
        for (int x = 0; x < texture.width(); x += stepX) {
            const glm::vec4 texel = texture.texel(x, y);
            require(isWithin(glm::vec3(texel.x, texel.y, texel.z), 0.0F, 3.4e38F) && texel.w >= 0.0F &&
                        std::isfinite(texel.w),
                    "a texel is finite and not negative");
        }
    }
}

void requireSoundMesh(const Scene& scene, const PatchMesh& mesh) {
    const PatchOptics optics = patchOptics(scene, mesh);
    require(mesh.frontCount <= mesh.size(), "fronts are patches");
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        for (int k = 0; k < mesh.cornerCount(i); ++k) {
            require(mesh.corners[i][static_cast<std::size_t>(k)] < mesh.positions.size(), "a patch's corners exist");
            require(isFinite(mesh.position(i, k)), "a patch's corners are finite");
        }
        require(mesh.area[i] > 0.0F && std::isfinite(mesh.area[i]), "a patch has a finite area");
        require(isUnit(mesh.normal[i]) && isFinite(mesh.centroid[i]), "a patch has a unit normal and a centroid");
        require(isWithin(optics.reflectance[i], 0.0F, 0.99F), "a patch's reflectance is from 0 to 0.99");
        require(isWithin(optics.emittedRadiosity[i], 0.0F, 3.4e38F), "a patch's emission is finite");
        require(mesh.polygon[i] < scene.polygons.size() && mesh.material[i] < scene.materials.size(),
                "a patch belongs to a polygon and has a material");
    }
}

void requireSoundHit(const Scene& scene, const PatchMesh& mesh, const Hit& hit) {
    require(hit.polygon < scene.polygons.size(), "a hit is on a polygon");
    require(hit.u >= -1e-3F && hit.v >= -1e-3F && hit.u <= 1.001F && hit.v <= 1.001F, "a hit is inside the chart");
    // A polygon whose patches have no area in single precision has none, and no ray of a bake asks for it.
    if (mesh.size() == 0) return;
    const std::uint32_t patch = mesh.lookup.patchAt(hit.polygon, hit.u, hit.v);
    require(patch < mesh.frontCount, "a hit is on a patch");
    require(mesh.polygon[patch] == hit.polygon, "the patch of a hit is one of its polygon's");
}

} // namespace lambert
