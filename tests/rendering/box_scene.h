#pragma once

#include "baking/baked_mesh.h"
#include "meshing/patch_mesh.h"

#include <glm/geometric.hpp>

#include <initializer_list>
#include <vector>

namespace lambert::test {

/// The sides of a box, by their outward axis.
enum Side { Left, Right, Bottom, Top, Back, Front };

/// A 2 × 2 × 2 m box around the origin, its fronts inside, without the `missing` sides. One quad and one
/// material per side.
inline Scene boxScene(std::initializer_list<Side> missing = {}) {
    Scene scene;
    for (int k = 0; k < 8; ++k)
        scene.positions.emplace_back((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1, (k & 4) != 0 ? 1 : -1);
    const std::vector<std::array<std::uint32_t, 4>> sides{{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1},
                                                          {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}};
    for (std::size_t side = 0; side < sides.size(); ++side) {
        bool wanted = true;
        for (const Side m : missing) wanted = wanted && side != static_cast<std::size_t>(m);
        if (!wanted) continue;
        Polygon polygon;
        polygon.vertices = sides[side];
        polygon.material = static_cast<std::uint32_t>(scene.materials.size());
        scene.polygons.push_back(polygon);
        scene.materials.emplace_back();
    }
    return scene;
}

/// Every polygon (a parallelogram) divided into n × n patches that share no vertices with those of others.
inline PatchMesh gridMesh(const Scene& scene, std::uint32_t n) {
    PatchMesh mesh;
    const auto addSide = [&](std::uint32_t index, bool back) {
        const Polygon& polygon = scene.polygons[index];
        const auto firstVertex = static_cast<std::uint32_t>(mesh.positions.size());
        const glm::vec3 a = corner(scene, polygon, 0);
        const glm::vec3 e = corner(scene, polygon, 1) - a;
        const glm::vec3 f = corner(scene, polygon, 3) - a;
        for (std::uint32_t row = 0; row <= n; ++row)
            for (std::uint32_t column = 0; column <= n; ++column)
                mesh.positions.push_back(a + e * (static_cast<float>(column) / static_cast<float>(n)) +
                                         f * (static_cast<float>(row) / static_cast<float>(n)));
        for (std::uint32_t row = 0; row < n; ++row) {
            for (std::uint32_t column = 0; column < n; ++column) {
                const std::uint32_t v = firstVertex + row * (n + 1) + column;
                if (back)
                    mesh.corners.push_back({v, v + n + 1, v + n + 2, v + 1});
                else
                    mesh.corners.push_back({v, v + 1, v + n + 2, v + n + 1});
                mesh.normal.push_back((back ? -1.0F : 1.0F) * glm::normalize(glm::cross(e, f)));
                mesh.polygon.push_back(index);
                mesh.material.push_back(back ? polygon.backMaterial : polygon.material);
            }
        }
    };
    for (std::uint32_t i = 0; i < scene.polygons.size(); ++i) {
        mesh.lookup.addGrid(scene, scene.polygons[i], static_cast<std::uint32_t>(mesh.corners.size()), n, n);
        addSide(i, false);
    }
    mesh.frontCount = mesh.corners.size();
    for (std::uint32_t i = 0; i < scene.polygons.size(); ++i) {
        if (scene.polygons[i].backMaterial == kNone) continue;
        mesh.lookup.setBack(i, static_cast<std::uint32_t>(mesh.corners.size()));
        addSide(i, true);
    }
    return mesh;
}

/// The mesh with a radiosity of `radiosity(position, normal)` at its vertices, and twice as much irradiance.
template <typename Function>
BakedMesh bakedWith(const Scene& scene, const PatchMesh& mesh, const Function& radiosity) {
    BakedMesh baked;
    baked.positions = mesh.positions;
    baked.normals.resize(mesh.positions.size());
    baked.radiosity.resize(mesh.positions.size());
    baked.irradiance.resize(mesh.positions.size());
    baked.faces = mesh.corners;
    baked.faceMaterials = mesh.material;
    baked.materials = scene.materials;
    for (const std::uint32_t material : mesh.material)
        baked.emitters.push_back(scene.materials[material].emittedRadiance != Rgb(0.0F));
    for (std::size_t patch = 0; patch < mesh.size(); ++patch) {
        for (int k = 0; k < mesh.cornerCount(patch); ++k) {
            const std::uint32_t v = mesh.corners[patch][static_cast<std::size_t>(k)];
            baked.normals[v] = mesh.normal[patch];
            baked.radiosity[v] = radiosity(mesh.positions[v], mesh.normal[patch]);
            baked.irradiance[v] = 2.0F * baked.radiosity[v];
        }
    }
    return baked;
}

} // namespace lambert::test
