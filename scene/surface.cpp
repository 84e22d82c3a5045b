#include "scene/surface.h"

#include <algorithm>
#include <cmath>

namespace lambert {

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
    const auto& [a, b, c, d] = surface.uv;
    if (!isQuad) return a + u * (b - a) + v * (c - a);
    if (u + v <= 1.0F) return a + u * (b - a) + v * (d - a);
    return c + (1.0F - u) * (d - c) + (1.0F - v) * (b - c);
}

bool hasHoles(const Scene& scene, const Polygon& polygon) {
    return polygon.surface != kNone && scene.materials[polygon.material].hasHoles();
}

bool isHole(const Scene& scene, const Polygon& polygon, float u, float v) {
    const Material& material = scene.materials[polygon.material];
    const TextureUse& use = material.opacityTexture;
    const Texture& texture = *scene.textures[use.texture];
    const glm::vec2 uv = uvAt(scene.surfaces[polygon.surface], polygon.isQuad(), u, v);
    const int x = texelAt(uv.x, texture.width(), use.wrapU);
    const int y = texelAt(uv.y, texture.height(), use.wrapV);
    return texture.opacity(x, y) < material.opacityCutoff;
}

} // namespace lambert
