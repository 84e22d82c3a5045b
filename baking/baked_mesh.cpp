#include "baking/baked_mesh.h"

#include <glm/ext/scalar_constants.hpp>

namespace lambert {

Rgb shownRadiance(const BakedMesh& mesh, std::size_t vertex, Quantity quantity) {
    const std::vector<Rgb>& values = quantity == Quantity::Radiosity ? mesh.radiosity : mesh.irradiance;
    return values[vertex] / glm::pi<float>();
}

bool isEmitter(const BakedMesh& mesh, std::size_t face) { return !mesh.emitters.empty() && mesh.emitters[face]; }

bool isHole(const BakedMesh& mesh, std::size_t face) { return !mesh.opacity.empty() && mesh.opacity[face] == 0.0F; }

BakedMesh withoutHoles(const BakedMesh& mesh) {
    BakedMesh result;
    result.materials = mesh.materials;
    result.origin = mesh.origin;
    std::vector<std::uint32_t> newIndex(mesh.positions.size(), 0);
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        if (isHole(mesh, face)) continue;
        result.faces.push_back(mesh.faces[face]);
        result.faceMaterials.push_back(mesh.faceMaterials[face]);
        result.emitters.push_back(isEmitter(mesh, face));
        if (!mesh.opacity.empty()) result.opacity.push_back(mesh.opacity[face]);
        for (std::size_t k = 0; k < (mesh.isQuad(face) ? 4U : 3U); ++k) newIndex[mesh.faces[face][k]] = 1;
    }
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        if (newIndex[v] == 0) continue;
        newIndex[v] = static_cast<std::uint32_t>(result.positions.size());
        result.positions.push_back(mesh.positions[v]);
        result.normals.push_back(mesh.normals[v]);
        result.radiosity.push_back(mesh.radiosity[v]);
        result.irradiance.push_back(mesh.irradiance[v]);
        if (!mesh.splitBy.empty()) result.splitBy.push_back(mesh.splitBy[v]);
    }
    for (auto& corners : result.faces)
        for (std::uint32_t& vertex : corners)
            if (vertex != kNone) vertex = newIndex[vertex];
    return result;
}

} // namespace lambert
