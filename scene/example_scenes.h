#pragma once

#include "scene/scene.h"

#include <array>
#include <cstdint>
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

} // namespace lambert
