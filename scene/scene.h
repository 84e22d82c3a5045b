#pragma once

#include "core/rgb.h"
#include "picture/camera.h"
#include "scene/texture.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace lambert {

/// Marks "none" wherever an index is expected.
inline constexpr std::uint32_t kNone = 0xFFFFFFFF;

inline bool isFinite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// What texture coordinates beyond [0, 1] mean.
enum class TextureWrap : std::uint8_t { Repeat, Mirror, Clamp };

/// A texture as a material uses it.
struct TextureUse {
    std::uint32_t texture = kNone; //!< into Scene::textures; none: white and opaque
    TextureWrap wrapU = TextureWrap::Repeat;
    TextureWrap wrapV = TextureWrap::Repeat;

    explicit operator bool() const { return texture != kNone; }
    bool operator==(const TextureUse&) const = default;
};

/// Of a reflectance, per channel; above it the number of bounces grows without bound.
inline constexpr float kMaxReflectance = 0.99F;

/// A diffuse surface.
struct Material {
    std::string name;
    Rgb reflectance{0.5F};     //!< per channel, 0 to kMaxReflectance; times its texture and the polygon's tint
    Rgb emittedRadiance{0.0F}; //!< L_e, >= 0, per m² and sr; the emitted radiosity is π L_e; times its texture
    bool twoSided = false;     //!< reflects and emits on the back as well
    /// Only blocks light, is black on both sides and not part of what is baked: its polygons have no patches, their edges
    /// still divide what they touch.
    bool occluder = false;
    bool diffusePartOnly = false; //!< the file gives it gloss, a mirror or glass as well, which is left out

    TextureUse reflectanceTexture{};
    TextureUse emissionTexture{};
    TextureUse opacityTexture{}; //!< its opacity counts, with the texture coordinates of the reflectance
    float opacityCutoff = 0.0F;  //!< where the opacity texture is below it, there is a hole; 0: nowhere

    bool isTextured() const { return reflectanceTexture || emissionTexture || hasHoles(); }
    bool hasHoles() const { return opacityTexture && opacityCutoff > 0.0F; }
};

/// What varies over a polygon, given at its corners (a triangle's fourth is unused) and linear on its triangles:
/// (0, 1, 2), or of a quad (0, 1, 3) and (2, 3, 1), as in polygonPoint.
struct SurfaceCorners {
    std::array<glm::vec2, 4> uv{};         //!< of reflectance and opacity; (0, 0) is the image's upper left corner
    std::array<glm::vec2, 4> emissionUv{}; //!< of emission
    std::array<Rgb, 4> tint{Rgb(1.0F), Rgb(1.0F), Rgb(1.0F), Rgb(1.0F)}; //!< factor of the reflectance
};

/// A triangle or a convex planar quad, its front counter-clockwise.
struct Polygon {
    /// Into Scene::positions; a triangle ends in kNone.
    std::array<std::uint32_t, 4> vertices{kNone, kNone, kNone, kNone};
    std::uint32_t material = 0;    //!< of the front, into Scene::materials
    std::uint32_t node = 0;        //!< into Scene::nodes
    std::uint32_t surface = kNone; //!< into Scene::surfaces; none: nothing varies over it
    /// Of the back; none: black. Set where scenes are prepared, see prepareScene.
    std::uint32_t backMaterial = kNone;
    std::uint32_t backSurface = kNone; //!< into Scene::surfaces, at the same corners; with backMaterial

    bool isQuad() const { return vertices[3] != kNone; }
    int size() const { return isQuad() ? 4 : 3; }
};

/// A light without area, as KHR_lights_punctual defines it.
struct PunctualLight {
    enum class Kind : std::uint8_t { Point, Spot, Directional };
    std::string name;
    Kind kind = Kind::Point;
    glm::vec3 position{0.0F};               //!< metres; not of a directional light
    glm::vec3 direction{0.0F, 0.0F, -1.0F}; //!< unit length, the way the light travels; not of a point light
    Rgb intensity{1.0F};                    //!< per sr (candela); of a directional light per m² across (lux)
    float innerConeAngle = 0.0F;            //!< radians, half angle; full intensity inside; of a spot
    float outerConeAngle = 0.785398F;       //!< radians, half angle, at most π/2; nothing outside; of a spot
};

class Environment;

/// Source polygons in world space, in metres, with their materials, lights and cameras. Immutable once read. All places (of
/// vertices, lights and cameras) are relative to `origin`.
struct Scene {
    std::vector<glm::vec3> positions;
    std::vector<Polygon> polygons;
    std::vector<Material> materials;
    std::vector<std::string> nodes; //!< names of the groups, objects or glTF nodes that polygons belong to
    std::vector<Camera> cameras;
    std::vector<SurfaceCorners> surfaces; //!< of the polygons that need them
    std::vector<std::shared_ptr<const Texture>> textures;
    std::vector<PunctualLight> lights;
    std::shared_ptr<const Environment> environment{}; //!< what the scene lies in; none: darkness
    /// Metres. What was subtracted from the file's places, so that single precision holds those of a scene that lies far
    /// away: see distantOrigin. 0 0 0 for all others.
    glm::dvec3 origin{0.0};
};

/// Where the file has a place of the scene, in metres.
inline glm::dvec3 placeInFile(const Scene& scene, const glm::vec3& place) { return scene.origin + glm::dvec3(place); }

/// The place in the scene of one in the file, in metres.
inline glm::vec3 placeInScene(const Scene& scene, const glm::dvec3& place) { return glm::vec3(place - scene.origin); }

/// The corner `k` of a polygon.
inline const glm::vec3& corner(const Scene& scene, const Polygon& polygon, int k) {
    return scene.positions[polygon.vertices[static_cast<std::size_t>(k)]];
}

/// Whether a polygon only blocks light.
inline bool isOccluder(const Scene& scene, const Polygon& polygon) {
    return scene.materials[polygon.material].occluder;
}

/// In metres.
double longestEdge(const Scene& scene, const Polygon& polygon);

/// Half the cross product of the diagonals: points to the front, its length is the area in m².
glm::vec3 areaVector(const Scene& scene, const Polygon& polygon);

/// In m². Unlike the length of the vector in single precision it is exact below 1e-19 m² too.
double polygonArea(const Scene& scene, const Polygon& polygon);

/// Axis-aligned box around all vertices that a polygon uses.
struct Bounds {
    glm::vec3 lower{0.0F};
    glm::vec3 upper{0.0F};
    glm::vec3 size() const { return upper - lower; }
    float diagonal() const; //!< length, 0 for an empty scene
    Bounds grownBy(float margin) const { return {lower - margin, upper + margin}; }
};
Bounds boundsOf(const Scene& scene);
Bounds boundsOf(const Scene& scene, const Polygon& polygon);

} // namespace lambert
