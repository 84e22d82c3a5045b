#pragma once

#include "baking/baked_mesh.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace lambert::test {

/// A unit square of two materials: a grey quad on the left half, a triangle and a quad of an emitter on the
/// right, and a third material that nothing uses. Its light is bright enough to be clamped in places.
inline BakedMesh sampleMesh() {
    BakedMesh mesh;
    mesh.materials.resize(3);
    mesh.materials[0].name = "wall";
    mesh.materials[1].name = "unused";
    mesh.materials[2].name = "lamp";
    mesh.materials[2].emittedRadiance = Rgb(10.0F);
    const auto vertex = [&](float x, float y, const Rgb& radiosity) {
        mesh.positions.emplace_back(x, y, -0.0F);
        mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
        mesh.radiosity.push_back(radiosity);
        mesh.irradiance.push_back(2.0F * radiosity);
    };
    vertex(0.0F, 0.0F, Rgb(0.1F, 0.2F, 0.3F));
    vertex(0.5F, 0.0F, Rgb(1.0F, 0.5F, 0.25F));
    vertex(0.5F, 1.0F, Rgb(0.1F, 0.2F, 0.35F));
    vertex(0.0F, 1.0F, Rgb(0.0F));
    vertex(0.5F, 0.0F, Rgb(31.4F));
    vertex(1.0F, 0.0F, Rgb(31.4F));
    vertex(1.0F, 0.5F, Rgb(31.4F));
    vertex(0.5F, 0.5F, Rgb(31.4F));
    vertex(0.5F, 1.0F, Rgb(31.4F));
    mesh.faces = {{4, 5, 6, 7}, {0, 1, 2, 3}, {7, 6, 8, kNone}};
    mesh.faceMaterials = {2, 0, 2};
    mesh.emitters = {true, false, true};
    return mesh;
}

/// A file name in the tests' temporary folder that no other test uses.
inline std::filesystem::path temporaryFile(const std::string& name) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "lambert-tests";
    std::filesystem::create_directories(folder);
    return folder / name;
}

inline std::string contentOf(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

} // namespace lambert::test
