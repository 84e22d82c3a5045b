#include "sample_scenes.h"

#include "meshing/prepare.h"
#include "scene/example_scenes.h"
#include "scene/reading/scene_reader.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

namespace lambert {

namespace {

const std::vector<std::pair<std::string, std::vector<glm::vec2>>> kShapes{
    {"square", {{0, 0}, {1, 0}, {1, 1}, {0, 1}}},
    {"parallelogram", {{0, 0}, {2, 0.3F}, {2.7F, 1.4F}, {0.7F, 1.1F}}},
    {"trapezoid", {{0, 0}, {3, 0}, {2, 1}, {1, 1}}},
    {"pointed_trapezoid", {{0, 0}, {3, 0}, {1.52F, 1}, {1.48F, 1}}},
    {"skewed_quad", {{0, 0}, {1, 0}, {2.6F, 1.9F}, {-0.1F, 0.6F}}},
    {"kite", {{0, 0}, {1, -0.5F}, {4, 0}, {1, 0.5F}}},
    {"blunt_corner", {{0, 0}, {1, 0}, {1, 1}, {0.49F, 0.51F}}},
    {"triangle", {{0, 0}, {2, 0.5F}, {0.3F, 1}}},
    {"obtuse_triangle", {{0, 0}, {4, 0}, {3.5F, 0.4F}}},
    {"sliver_triangle", {{0, 0}, {1, 0}, {0.4F, 1e-4F}}},
    {"sliver_quad", {{0, 0}, {1, 0}, {1, 1e-4F}, {0, 1e-4F}}},
};

Scene greyBox() {
    std::array<Material, 6> materials;
    for (std::size_t i = 0; i < 6; ++i) materials[i] = greyMaterial("wall " + std::to_string(i), 0.5F);
    return boxScene({1.0F, 2.0F, 3.0F}, materials);
}

} // namespace

Scene emptyScene() {
    Scene scene;
    scene.materials = {greyMaterial("grey", 0.5F)};
    scene.nodes = {"scene"};
    return scene;
}

void addPolygon(Scene& scene, std::span<const glm::vec3> corners) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    scene.positions.insert(scene.positions.end(), corners.begin(), corners.end());
    Polygon polygon;
    for (std::uint32_t k = 0; k < corners.size(); ++k) polygon.vertices[k] = first + k;
    polygon.node = static_cast<std::uint32_t>(scene.nodes.size() - 1);
    scene.polygons.push_back(polygon);
}

Scene flatScene(std::span<const glm::vec2> corners) {
    Scene scene = emptyScene();
    std::vector<glm::vec3> points;
    for (const glm::vec2& p : corners) points.emplace_back(p.x, p.y, 0.0F);
    addPolygon(scene, points);
    return turned(scene);
}

Scene turned(Scene scene) {
    const glm::dvec3 x = glm::normalize(glm::dvec3(1.0, 2.0, -0.5));
    const glm::dvec3 y = glm::normalize(glm::cross(glm::dvec3(0.3, -0.2, 1.0), x));
    const glm::dvec3 z = glm::cross(x, y);
    for (glm::vec3& p : scene.positions) {
        const glm::dvec3 q(p);
        p = glm::vec3(glm::dvec3(0.3, -0.1, 0.2) + q.x * x + q.y * y + q.z * z);
    }
    return scene;
}

Scene scaled(Scene scene, float factor) {
    for (glm::vec3& p : scene.positions) p *= factor;
    return scene;
}

void addBox(Scene& scene, const glm::vec3& lower, const glm::vec3& upper, bool withBottom) {
    scene.nodes.push_back("box " + std::to_string(scene.nodes.size()));
    const auto at = [&](int k) {
        return glm::vec3((k & 1) != 0 ? upper.x : lower.x, (k & 2) != 0 ? upper.y : lower.y,
                         (k & 4) != 0 ? upper.z : lower.z);
    };
    const int faces[6][4]{{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {4, 5, 7, 6}, {0, 2, 3, 1}};
    for (int i = 0; i < (withBottom ? 6 : 5); ++i) {
        const glm::vec3 corners[4]{at(faces[i][0]), at(faces[i][1]), at(faces[i][2]), at(faces[i][3])};
        addPolygon(scene, corners);
    }
}

Scene roomWithTurnedBox() {
    Scene scene = emptyScene();
    addBox(scene, {0.8F, 0.9F, 0.0F}, {1.7F, 1.6F, 1.1F}, false);
    for (glm::vec3& p : scene.positions) { // about the vertical
        const glm::vec2 q(p.x - 1.2F, p.y - 1.2F);
        p = glm::vec3(1.2F + 0.9F * q.x - 0.43589F * q.y, 1.2F + 0.43589F * q.x + 0.9F * q.y, p.z);
    }
    scene.nodes.emplace_back("room");
    addBox(scene, {0.0F, 0.0F, 0.0F}, {4.0F, 3.0F, 2.5F}, true);
    for (Polygon& polygon : scene.polygons)
        if (polygon.node == scene.nodes.size() - 1) std::reverse(polygon.vertices.begin(), polygon.vertices.end());
    return prepareScene(scene);
}

std::vector<glm::vec2> randomConvexQuad(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
    const float height = 0.1F + 0.9F * uniform(random);
    std::vector<glm::vec2> corners;
    for (int k = 0; k < 4; ++k) {
        const float angle = 1.5708F * (static_cast<float>(k) + 0.05F + 0.9F * uniform(random));
        corners.emplace_back(std::cos(angle), height * std::sin(angle));
    }
    return corners;
}

Scene dataScene(const std::string& file) {
    return prepareScene(readScene(std::filesystem::path(LAMBERT_DATA) / file).scene);
}

std::vector<SampleScene> sampleScenes() {
    std::vector<SampleScene> samples;
    for (const auto& [name, corners] : kShapes) samples.push_back({name, flatScene(corners)});
    for (std::uint32_t seed = 1; seed <= 12; ++seed)
        samples.push_back({"random_quad_" + std::to_string(seed), flatScene(randomConvexQuad(seed))});
    samples.push_back({"box", greyBox(), true});
    samples.push_back({"turned_box", turned(greyBox()), true});
    samples.push_back({"room_with_turned_box", roomWithTurnedBox()});
    for (SampleScene& sample : samples) sample.scene = prepareScene(sample.scene);
    for (const char* name : {"cornell_box", "cube6", "furnace_box", "parallel_squares", "perpendicular_squares",
                             "room432", "table_room", "tetrahedron"}) {
        const std::string text(name);
        const bool closed = text == "cube6" || text == "furnace_box" || text == "room432" || text == "tetrahedron";
        samples.push_back({text, dataScene(text + ".obj"), closed});
    }
    return samples;
}

PatchMesh meshWithLength(const Scene& scene, double patchLength, MeshReport* report) {
    Progress progress;
    MeshOptions options;
    options.patchLength = patchLength;
    return buildPatchMesh(scene, options, progress, report);
}

} // namespace lambert
