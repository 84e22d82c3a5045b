#include "lighting/light_groups.h"

#include "core/named.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

namespace lambert {

namespace {

void makeNamesUnique(std::vector<LightGroup>& groups) {
    std::set<std::string> taken;
    for (LightGroup& group : groups) {
        const std::string name = group.name;
        for (int k = 2; !taken.insert(group.name).second; ++k) group.name = fmt::format("{} {}", name, k);
    }
}

} // namespace

std::string_view nameOf(LightGroup::Kind kind) {
    using Kind = LightGroup::Kind;
    static constexpr std::array kKinds{Named{Kind::Material, "material"}, Named{Kind::Lights, "lights"},
                                       Named{Kind::Environment, "sky"}};
    return rowOf(kKinds, kind).name;
}

std::vector<LightGroup> lightGroups(const Scene& scene, const PatchMesh& mesh, const PatchOptics& optics) {
    std::vector<bool> emits(scene.materials.size(), false);
    for (std::size_t i = 0; i < mesh.size(); ++i)
        if (optics.emittedRadiosity[i] != Rgb(0.0F)) emits[mesh.material[i]] = true;
    std::vector<LightGroup> groups;
    for (std::uint32_t m = 0; m < scene.materials.size(); ++m)
        if (emits[m]) groups.push_back({LightGroup::Kind::Material, scene.materials[m].name, m});
    for (const PunctualLight& light : scene.lights) {
        const auto same = std::find_if(groups.begin(), groups.end(), [&](const LightGroup& group) {
            return group.kind == LightGroup::Kind::Lights && group.name == light.name;
        });
        if (same != groups.end())
            same->lights.push_back(light);
        else
            groups.push_back({LightGroup::Kind::Lights, light.name, kNone, {light}});
    }
    if (scene.environment) groups.push_back({LightGroup::Kind::Environment, "sky"});
    makeNamesUnique(groups);
    return groups;
}

std::vector<Rgb> emittedBy(const LightGroup& group, const PatchMesh& mesh, const PatchOptics& optics) {
    std::vector<Rgb> emitted(mesh.size(), Rgb(0.0F));
    for (std::size_t i = 0; i < mesh.size(); ++i)
        if (mesh.material[i] == group.material) emitted[i] = optics.emittedRadiosity[i];
    return emitted;
}

LightSources sourcesOf(const LightGroup& group, const Scene& scene) {
    return {group.lights, group.kind == LightGroup::Kind::Environment ? scene.environment.get() : nullptr};
}

} // namespace lambert
