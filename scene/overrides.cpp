#include "scene/overrides.h"

#include "core/error.h"
#include "core/text.h"
#include "scene/name_match.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

namespace lambert {

namespace {

constexpr std::size_t kNamesInMessage = 5;

[[noreturn]] void fail(const OverrideSource& source, const std::string& text) {
    const std::string message = source.place + ": " + text;
    if (source.inFile) throw InputError(message);
    throw UsageError(message);
}

/// The indices of the names that are meant, at least one. `kind`: what they are names of.
std::vector<std::uint32_t> resolve(const std::string& name, const OverrideSource& source, const char* kind,
                                   std::span<const std::string> names) {
    std::vector<std::uint32_t> found = matchingNames(names, name);
    if (!found.empty()) return found;
    std::vector<std::string> closest = closestNames(name, names, kNamesInMessage);
    for (std::string& candidate : closest) candidate = inQuotes(candidate);
    fail(source, fmt::format("the scene has no {} {}; the closest of its {} {}s: {}", kind, inQuotes(name),
                             names.size(), kind, fmt::join(closest, ", ")));
}

void resetTint(Scene& scene, const std::vector<std::uint32_t>& materials) {
    std::vector<bool> changed(scene.materials.size(), false);
    for (const std::uint32_t material : materials) changed[material] = true;
    for (const Polygon& polygon : scene.polygons)
        if (changed[polygon.material] && polygon.surface != kNone) scene.surfaces[polygon.surface].tint.fill(Rgb(1.0F));
}

void overrideMaterials(Scene& scene, const std::vector<MaterialOverride>& overrides) {
    std::vector<std::string> names;
    for (const Material& material : scene.materials) names.push_back(material.name);
    for (const MaterialOverride& change : overrides) {
        const std::vector<std::uint32_t> found = resolve(change.name, change.source, "material", names);
        for (const std::uint32_t index : found) {
            Material& material = scene.materials[index];
            if (change.emittedRadiance) {
                material.emittedRadiance = *change.emittedRadiance;
                material.emissionTexture = {};
            }
            if (change.reflectance) {
                material.reflectance = *change.reflectance;
                material.reflectanceTexture = {};
            }
            if (change.twoSided) material.twoSided = *change.twoSided;
        }
        if (change.reflectance) resetTint(scene, found);
    }
}

/// The index of a material's black twin, added to the scene when first asked for.
class OccluderMaterials {
public:
    explicit OccluderMaterials(Scene& scene) : scene_(scene), twins_(scene.materials.size(), kNone) {}

    std::uint32_t of(std::uint32_t index) {
        if (twins_[index] != kNone) return twins_[index];
        const Material& source = scene_.materials[index];
        Material twin;
        twin.name = source.name;
        twin.reflectance = Rgb(0.0F);
        twin.opacityTexture = source.opacityTexture;
        twin.opacityCutoff = source.opacityCutoff;
        twin.occluder = true;
        scene_.materials.push_back(std::move(twin));
        twins_[index] = static_cast<std::uint32_t>(scene_.materials.size() - 1);
        return twins_[index];
    }

private:
    Scene& scene_;
    std::vector<std::uint32_t> twins_;
};

void overrideNodes(Scene& scene, const std::vector<NodeOverride>& overrides) {
    if (overrides.empty()) return;
    std::vector<std::optional<NodeOverride::Treatment>> treatment(scene.nodes.size());
    for (const NodeOverride& change : overrides)
        for (const std::uint32_t node : resolve(change.name, change.source, "node", scene.nodes))
            treatment[node] = change.treatment;

    std::erase_if(scene.polygons,
                  [&](const Polygon& polygon) { return treatment[polygon.node] == NodeOverride::Treatment::Exclude; });
    OccluderMaterials occluders(scene);
    for (Polygon& polygon : scene.polygons)
        if (treatment[polygon.node] == NodeOverride::Treatment::OccludeOnly)
            polygon.material = occluders.of(polygon.material);
    if (std::all_of(scene.polygons.begin(), scene.polygons.end(),
                    [&](const Polygon& polygon) { return isOccluder(scene, polygon); }))
        fail(overrides.back().source, "no polygon is left to be lit");
}

} // namespace

void applyOverrides(Scene& scene, const SceneOverrides& overrides) {
    overrideMaterials(scene, overrides.materials);
    overrideNodes(scene, overrides.nodes);
}

} // namespace lambert
