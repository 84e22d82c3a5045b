#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace lambert {

/// Linear RGB, Rec. 709 primaries.
using Rgb = glm::vec3;

/// Marks "none" wherever an index is expected.
inline constexpr std::uint32_t kNone = 0xFFFFFFFF;

/// A diffuse surface.
struct Material {
    std::string name;
    Rgb reflectance{0.5F};     //!< per channel, 0 to 0.99
    Rgb emittedRadiance{0.0F}; //!< L_e, >= 0, per m² and sr; the emitted radiosity is π L_e
    bool twoSided = false;     //!< reflects and emits on the back as well
};

/// A triangle or a convex planar quad, its front counter-clockwise.
struct Polygon {
    /// Into Scene::positions; a triangle ends in kNone.
    std::array<std::uint32_t, 4> vertices{kNone, kNone, kNone, kNone};
    std::uint32_t material = 0; //!< of the front, into Scene::materials
    std::uint32_t node = 0;     //!< into Scene::nodes
    /// Of the back; none: black. Set where scenes are prepared, see prepareScene.
    std::uint32_t backMaterial = kNone;

    bool isQuad() const { return vertices[3] != kNone; }
    int size() const { return isQuad() ? 4 : 3; }
};

/// A pinhole camera. Looks from `eye` along `direction`.
struct Camera {
    std::string name;
    glm::vec3 eye{0.0F};
    glm::vec3 direction{0.0F, 0.0F, -1.0F}; //!< unit length
    glm::vec3 up{0.0F, 1.0F, 0.0F};         //!< not parallel to `direction`
    float verticalFov = 0.8F;               //!< radians, full angle, 0 to π
};

/// Source polygons in world space, in metres, with their materials and cameras. Immutable once read.
struct Scene {
    std::vector<glm::vec3> positions;
    std::vector<Polygon> polygons;
    std::vector<Material> materials;
    std::vector<std::string> nodes; //!< names of the groups, objects or glTF nodes that polygons belong to
    std::vector<Camera> cameras;
};

/// The corner `k` of a polygon.
inline const glm::vec3& corner(const Scene& scene, const Polygon& polygon, int k) {
    return scene.positions[polygon.vertices[static_cast<std::size_t>(k)]];
}

/// Half the cross product of the diagonals: points to the front, its length is the area in m².
glm::vec3 areaVector(const Scene& scene, const Polygon& polygon);

/// Axis-aligned box around all vertices that a polygon uses.
struct Bounds {
    glm::vec3 lower{0.0F};
    glm::vec3 upper{0.0F};
    glm::vec3 size() const { return upper - lower; }
    float diagonal() const; //!< length, 0 for an empty scene
};
Bounds boundsOf(const Scene& scene);

} // namespace lambert
