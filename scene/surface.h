#pragma once

#include "scene/scene.h"

#include <glm/vec2.hpp>

#include <cstdint>

namespace lambert {

/// The texel of an infinite, wrapped row of texels: `cell` counts from the image's first texel and may be negative.
int wrappedTexel(std::int64_t cell, int size, TextureWrap wrap);

/// The texel in which a texture coordinate (finite) lies, along an axis of `size` texels.
int texelAt(float coordinate, int size, TextureWrap wrap);

/// The texture coordinates of reflectance and opacity at a point of a polygon's chart, see polygonPoint.
glm::vec2 uvAt(const SurfaceCorners& surface, bool isQuad, float u, float v);

/// Whether light may pass through the polygon. The holes of a polygon are those of its front; they go through both sides.
bool hasHoles(const Scene& scene, const Polygon& polygon);

/// Whether a polygon that has holes has one at a point of its chart.
bool isHole(const Scene& scene, const Polygon& polygon, float u, float v);

} // namespace lambert
