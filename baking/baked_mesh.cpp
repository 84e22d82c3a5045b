#include "baking/baked_mesh.h"

#include <glm/common.hpp>
#include <glm/ext/scalar_constants.hpp>

#include <algorithm>

namespace lambert {

Rgb shownRadiance(const BakedMesh& mesh, std::size_t vertex, Quantity quantity) {
    const std::vector<Rgb>& values = quantity == Quantity::Radiosity ? mesh.radiosity : mesh.irradiance;
    return values[vertex] / glm::pi<float>();
}

bool isEmitter(const BakedMesh& mesh, std::size_t face) {
    const Rgb& emitted = mesh.materials[mesh.faceMaterials[face]].emittedRadiance;
    return std::max({emitted.x, emitted.y, emitted.z}) > 0.0F;
}

} // namespace lambert
