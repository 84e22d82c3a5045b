#pragma once

#include "meshing/patch_optics.h"
#include "solver/direct_light.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lambert {

/// What is switched on and off together: an emitting material, the lights without area of one name, or the environment.
struct LightGroup {
    enum class Kind : std::uint8_t { Material, Lights, Environment };
    Kind kind = Kind::Material;
    std::string name; //!< of the material or the lights; "sky"; followed by " 2" and so on where another has that name
    std::uint32_t material = kNone;      //!< into Scene::materials
    std::vector<PunctualLight> lights{}; //!< one at least; all others: none
};

std::string_view nameOf(LightGroup::Kind kind); //!< material, lights or sky

/// The groups, which together are all light of the scene: materials that emit anywhere on the mesh in the scene's order, lights in
/// the order in which their names first occur, the environment.
std::vector<LightGroup> lightGroups(const Scene& scene, const PatchMesh& mesh, const PatchOptics& optics);

/// B_e of every patch, #patches, as far as it comes from the group.
std::vector<Rgb> emittedBy(const LightGroup& group, const PatchMesh& mesh, const PatchOptics& optics);

/// The lights without area of the group; it and the scene must be kept.
LightSources sourcesOf(const LightGroup& group, const Scene& scene);

} // namespace lambert
