#include "scene/example_scenes.h"

#include <numbers>

namespace lambert {

Material greyMaterial(std::string name, float reflectance, float emitted) {
    return {std::move(name), Rgb(reflectance), Rgb(emitted / std::numbers::pi_v<float>), false};
}

Scene quadScene(std::span<const std::array<glm::vec3, 4>> quads, std::span<const Material> materials) {
    Scene scene;
    scene.materials.assign(materials.begin(), materials.end());
    scene.nodes = {"scene"};
    for (std::uint32_t i = 0; i < quads.size(); ++i) addQuad(scene, quads[i], i);
    return scene;
}

void addQuad(Scene& scene, const std::array<glm::vec3, 4>& quad, std::uint32_t material) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    scene.positions.insert(scene.positions.end(), quad.begin(), quad.end());
    scene.polygons.push_back({{first, first + 1, first + 2, first + 3}, material, 0});
}

Scene boxScene(const glm::vec3& size, const std::array<Material, 6>& materials) {
    const auto [x, y, z] = std::array{size.x, size.y, size.z};
    const std::array<std::array<glm::vec3, 4>, 6> faces{{
        {{{0, 0, 0}, {0, y, 0}, {0, y, z}, {0, 0, z}}},
        {{{x, 0, 0}, {x, 0, z}, {x, y, z}, {x, y, 0}}},
        {{{0, 0, 0}, {0, 0, z}, {x, 0, z}, {x, 0, 0}}},
        {{{0, y, 0}, {x, y, 0}, {x, y, z}, {0, y, z}}},
        {{{0, 0, 0}, {x, 0, 0}, {x, y, 0}, {0, y, 0}}},
        {{{0, 0, z}, {0, y, z}, {x, y, z}, {x, 0, z}}},
    }};
    return quadScene(faces, materials);
}

Scene roomWithBoxScene() {
    std::array<Material, 6> walls;
    for (Material& wall : walls) wall = greyMaterial("wall", 0.5F);
    walls[5] = greyMaterial("lamp", 0.5F, 1.0F);
    Scene scene = boxScene(glm::vec3(2.0F), walls);
    scene.materials.push_back(greyMaterial("box", 0.5F));
    const std::array<glm::vec3, 4> base{{{0.83F, 0.61F, 0}, {1.37F, 0.79F, 0}, {1.19F, 1.33F, 0}, {0.65F, 1.15F, 0}}};
    const glm::vec3 up(0.0F, 0.0F, 0.5F);
    for (std::size_t k = 0; k < 4; ++k)
        addQuad(scene, {base[k], base[(k + 1) % 4], base[(k + 1) % 4] + up, base[k] + up}, 6);
    addQuad(scene, {base[0] + up, base[1] + up, base[2] + up, base[3] + up}, 6);
    return scene;
}

} // namespace lambert
