#include "cli/patch_groups.h"

#include "core/error.h"

#include <fmt/format.h>

#include <unordered_map>

namespace lambert {

PatchGroups groupPatches(const MeshedScene& scene, GroupBy by) {
    constexpr std::size_t kMost = 2'000;
    const std::vector<Polygon>& polygons = scene.scene->polygons;
    const auto nameOf = [&](std::size_t patch) -> const std::string& {
        return by == GroupBy::Material ? scene.scene->materials[scene.mesh.material[patch]].name
                                       : scene.scene->nodes[polygons[scene.mesh.polygon[patch]].node];
    };
    PatchGroups result;
    std::unordered_map<std::string, std::uint32_t> known;
    for (std::size_t i = 0; i < scene.mesh.size(); ++i) {
        const auto [entry, isNew] = known.emplace(nameOf(i), static_cast<std::uint32_t>(result.names.size()));
        if (isNew) result.names.push_back(entry->first);
        result.group.push_back(entry->second);
    }
    if (result.names.size() > kMost)
        throw UsageError(fmt::format("--group-by: the scene has {} {}s, a table holds at most {}", result.names.size(),
                                     by == GroupBy::Material ? "material" : "node", kMost));
    return result;
}

} // namespace lambert
