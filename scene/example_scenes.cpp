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
    for (std::uint32_t i = 0; i < quads.size(); ++i) {
        const auto first = static_cast<std::uint32_t>(scene.positions.size());
        scene.positions.insert(scene.positions.end(), quads[i].begin(), quads[i].end());
        scene.polygons.push_back({{first, first + 1, first + 2, first + 3}, i, 0});
    }
    return scene;
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

} // namespace lambert
