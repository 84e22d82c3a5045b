#pragma once

#include "meshing/mesh_scene.h"

#include <cstdint>
#include <string>
#include <vector>

namespace lambert {

/// The patches of a mesh by name.
struct PatchGroups {
    std::vector<std::string> names;   //!< #groups, each once, in the scene's order
    std::vector<std::uint32_t> group; //!< #patches, into names
};

enum class GroupBy { Material, Node };

/// Materials, or nodes, of one name are one group. Throws UsageError if there are too many for a table.
PatchGroups groupPatches(const MeshedScene& scene, GroupBy by);

} // namespace lambert
