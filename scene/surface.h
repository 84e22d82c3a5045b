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

/// Those of emission.
glm::vec2 emissionUvAt(const SurfaceCorners& surface, bool isQuad, float u, float v);

/// One side of a polygon that is not black, as rays meet it.
struct SurfaceSide {
    std::uint32_t material = kNone; //!< into Scene::materials
    std::uint32_t surface = kNone;  //!< into Scene::surfaces; none: nothing varies over it

    explicit operator bool() const { return material != kNone; }
};

/// The front or the back of a polygon of a prepared scene; nothing if it is black, as are both sides of an occluder.
SurfaceSide sideOf(const Scene& scene, const Polygon& polygon, bool front);

/// The reflectance of such a side at a point of the polygon's chart, 0 to 0.99: of a texture that of the texel it lies in.
/// Black where a back has a hole that its front has not.
Rgb reflectanceAt(const Scene& scene, const Polygon& polygon, const SurfaceSide& side, float u, float v);

/// The radiance it emits there, >= 0; in the same way.
Rgb emittedRadianceAt(const Scene& scene, const Polygon& polygon, const SurfaceSide& side, float u, float v);

/// Whether light may pass through the polygon. The holes of a polygon are those of its front; they go through both sides.
bool hasHoles(const Scene& scene, const Polygon& polygon);

/// Whether a polygon that has holes has one at a point of its chart.
bool isHole(const Scene& scene, const Polygon& polygon, float u, float v);

} // namespace lambert
