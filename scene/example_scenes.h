#pragma once

#include "scene/scene.h"

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <span>

namespace lambert {

/// A grey diffuse surface with emitted radiosity `emitted` (per m²).
Material greyMaterial(std::string name, float reflectance, float emitted = 0.0F);

/// A closed box [0, size] seen from inside: six quads in the order x = 0, x = size, y = 0, y = size, z = 0, z = size, each
/// with a material of its own.
Scene boxScene(const glm::vec3& size, const std::array<Material, 6>& materials);

/// A scene with one quad per material; `quads` holds four corners for each, counter-clockwise seen from the front.
Scene quadScene(std::span<const std::array<glm::vec3, 4>> quads, std::span<const Material> materials);

/// Adds a quad of a material of the scene, with vertices of its own.
void addQuad(Scene& scene, const std::array<glm::vec3, 4>& quad, std::uint32_t material);

/// A lit room of 2 × 2 × 2 m with a box on its floor, the box's base not aligned with the room. Materials: "wall" (five times),
/// "lamp" (the ceiling, B_e = 1), "box"; all of reflectance 1/2.
Scene roomWithBoxScene();

/// Boxes whose walls are grids of quads with common vertices, of one grey material.
class GridScene {
public:
    /// Where a point of the boxes is put.
    using Map = std::function<glm::dvec3(const glm::dvec3&)>;

    GridScene();
    /// Adds six walls of n² quads each, their fronts inside or outside.
    GridScene& box(const glm::dvec3& low, const glm::dvec3& high, int n, bool inside, const Map& map);
    const Scene& scene() const { return scene_; }

private:
    void grid(const glm::dvec3& corner, const glm::dvec3& along, const glm::dvec3& across, int n, const Map& map);

    Scene scene_;
    std::map<std::array<long, 3>, std::uint32_t> vertices_; ///< by place before the map, in µm
};

/// Maps for GridScene. The first three are affine; a turned box has no edge along an axis.
glm::dvec3 same(const glm::dvec3& p);
glm::dvec3 sheared(const glm::dvec3& p);
glm::dvec3 turned(const glm::dvec3& p);
/// A strip of the wall z = 0 of the unit cube is pushed in, so that the room is not convex.
glm::dvec3 dented(const glm::dvec3& p);

} // namespace lambert
