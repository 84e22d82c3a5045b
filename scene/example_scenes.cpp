#include "scene/example_scenes.h"

#include <cmath>

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

glm::dvec3 same(const glm::dvec3& p) { return p; }

glm::dvec3 sheared(const glm::dvec3& p) { return {p.x + 0.3 * p.z + 0.1 * p.y, p.y + 0.2 * p.z, p.z}; }

glm::dvec3 turned(const glm::dvec3& p) {
    const double c = std::cos(0.7), s = std::sin(0.7);
    const glm::dvec3 q(c * p.x - s * p.y, s * p.x + c * p.y, p.z);
    return {q.x, c * q.y - s * q.z, s * q.y + c * q.z};
}

glm::dvec3 dented(const glm::dvec3& p) {
    return std::abs(p.x - 0.5) < 0.26 ? glm::dvec3(p.x, p.y, 0.25 + 0.75 * p.z) : p;
}

GridScene::GridScene() {
    scene_.materials = {greyMaterial("grey", 0.5F, 1.0F)};
    scene_.nodes = {"grids"};
}

GridScene& GridScene::box(const glm::dvec3& low, const glm::dvec3& high, int n, bool inside, const Map& map) {
    const glm::dvec3 d = high - low, x(d.x, 0, 0), y(0, d.y, 0), z(0, 0, d.z);
    const std::array corners{low, low + x, low, low + y, low, low + z};
    const std::array along{y, z, z, x, x, y}, across{z, y, x, z, y, x};
    for (std::size_t k = 0; k < 6; ++k)
        inside ? grid(corners[k], along[k], across[k], n, map) : grid(corners[k], across[k], along[k], n, map);
    return *this;
}

void GridScene::grid(const glm::dvec3& corner, const glm::dvec3& along, const glm::dvec3& across, int n,
                     const Map& map) {
    const auto vertex = [&](int a, int b) {
        const glm::dvec3 p = corner + along * (static_cast<double>(a) / n) + across * (static_cast<double>(b) / n);
        const std::array key{std::lround(p.x * 1e6), std::lround(p.y * 1e6), std::lround(p.z * 1e6)};
        const auto [found, isNew] = vertices_.try_emplace(key, static_cast<std::uint32_t>(scene_.positions.size()));
        if (isNew) scene_.positions.emplace_back(map(p));
        return found->second;
    };
    for (int a = 0; a < n; ++a) {
        for (int b = 0; b < n; ++b) {
            Polygon polygon;
            polygon.vertices = {vertex(a, b), vertex(a + 1, b), vertex(a + 1, b + 1), vertex(a, b + 1)};
            scene_.polygons.push_back(polygon);
        }
    }
}

} // namespace lambert
