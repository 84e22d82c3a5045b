#include "scene/surface.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

/// What is given at a polygon's corners, at a point of its chart.
template <typename Value>
Value atChart(const std::array<Value, 4>& corners, bool isQuad, float u, float v) {
    const auto& [a, b, c, d] = corners;
    if (!isQuad) return a + u * (b - a) + v * (c - a);
    if (u + v <= 1.0F) return a + u * (b - a) + v * (d - a);
    return c + (1.0F - u) * (d - c) + (1.0F - v) * (b - c);
}

Rgb texelOf(const Scene& scene, const TextureUse& use, const glm::vec2& uv) {
    const Texture& texture = *scene.textures[use.texture];
    const glm::vec4 texel = texture.texel(texelAt(uv.x, texture.width(), use.wrapU), //
                                          texelAt(uv.y, texture.height(), use.wrapV));
    return {texel.x, texel.y, texel.z};
}

/// Whether the material's opacity texture leaves a hole at a point of a surface.
bool isHole(const Scene& scene, const Material& material, const glm::vec2& uv) {
    const TextureUse& use = material.opacityTexture;
    const Texture& texture = *scene.textures[use.texture];
    return texture.opacity(texelAt(uv.x, texture.width(), use.wrapU), texelAt(uv.y, texture.height(), use.wrapV)) <
           material.opacityCutoff;
}

} // namespace

int wrappedTexel(std::int64_t cell, int size, TextureWrap wrap) {
    const std::int64_t n = size;
    switch (wrap) {
    case TextureWrap::Clamp:
        return static_cast<int>(std::clamp<std::int64_t>(cell, 0, n - 1));
    case TextureWrap::Repeat:
        return static_cast<int>((cell % n + n) % n);
    case TextureWrap::Mirror:
        break;
    }
    const std::int64_t place = (cell % (2 * n) + 2 * n) % (2 * n);
    return static_cast<int>(place < n ? place : 2 * n - 1 - place);
}

int texelAt(float coordinate, int size, TextureWrap wrap) {
    // One period first: a cell's number beyond it need not fit an integer.
    double place = static_cast<double>(coordinate);
    if (wrap == TextureWrap::Clamp) place = std::clamp(place, 0.0, 1.0);
    if (wrap == TextureWrap::Repeat) place -= std::floor(place);
    if (wrap == TextureWrap::Mirror) place -= 2.0 * std::floor(0.5 * place);
    return wrappedTexel(static_cast<std::int64_t>(place * size), size, wrap);
}

glm::vec2 uvAt(const SurfaceCorners& surface, bool isQuad, float u, float v) {
    return atChart(surface.uv, isQuad, u, v);
}

glm::vec2 emissionUvAt(const SurfaceCorners& surface, bool isQuad, float u, float v) {
    return atChart(surface.emissionUv, isQuad, u, v);
}

SurfaceSide sideOf(const Scene& scene, const Polygon& polygon, bool front) {
    if (isOccluder(scene, polygon)) return {};
    if (front) return {polygon.material, polygon.surface};
    return {polygon.backMaterial, polygon.backSurface};
}

Rgb reflectanceAt(const Scene& scene, const Polygon& polygon, const SurfaceSide& side, float u, float v) {
    const Material& material = scene.materials[side.material];
    if (side.surface == kNone) return material.reflectance;
    const SurfaceCorners& corners = scene.surfaces[side.surface];
    const glm::vec2 uv = uvAt(corners, polygon.isQuad(), u, v);
    if (material.hasHoles() && isHole(scene, material, uv)) return Rgb(0.0F);
    Rgb reflectance = material.reflectance * atChart(corners.tint, polygon.isQuad(), u, v);
    if (material.reflectanceTexture) reflectance *= texelOf(scene, material.reflectanceTexture, uv);
    return glm::clamp(reflectance, 0.0F, kMaxReflectance);
}

Rgb emittedRadianceAt(const Scene& scene, const Polygon& polygon, const SurfaceSide& side, float u, float v) {
    const Material& material = scene.materials[side.material];
    if (side.surface == kNone) return material.emittedRadiance;
    const SurfaceCorners& corners = scene.surfaces[side.surface];
    if (material.hasHoles() && isHole(scene, material, uvAt(corners, polygon.isQuad(), u, v))) return Rgb(0.0F);
    if (!material.emissionTexture) return material.emittedRadiance;
    const glm::vec2 uv = emissionUvAt(corners, polygon.isQuad(), u, v);
    return material.emittedRadiance * glm::max(texelOf(scene, material.emissionTexture, uv), 0.0F);
}

bool hasHoles(const Scene& scene, const Polygon& polygon) {
    return polygon.surface != kNone && scene.materials[polygon.material].hasHoles();
}

bool isHole(const Scene& scene, const Polygon& polygon, float u, float v) {
    return isHole(scene, scene.materials[polygon.material],
                  uvAt(scene.surfaces[polygon.surface], polygon.isQuad(), u, v));
}

} // namespace lambert
