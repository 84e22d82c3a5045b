#include "lighting/lost_light.h"

#include "core/text.h"
#include "meshing/light_fate.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace lambert {

namespace {

constexpr std::size_t kNamesShown = 3;

/// What most of the light meets.
enum class End { Backs, Occluders, Emitters, Nothing };

End mostlyMet(const LightFate& fate) {
    const std::pair<double, End> ends[] = {{fate.backs, End::Backs},
                                           {fate.occluders, End::Occluders},
                                           {fate.emitters, End::Emitters},
                                           {fate.nothing, End::Nothing}};
    return std::max_element(std::begin(ends), std::end(ends),
                            [](const auto& a, const auto& b) { return a.first < b.first; })
        ->second;
}

std::string namesOf(const std::vector<std::string>& names) {
    const auto shown = static_cast<std::ptrdiff_t>(std::min(names.size(), kNamesShown));
    const std::string text = fmt::format("{}", fmt::join(names.begin(), names.begin() + shown, ", "));
    return names.size() > kNamesShown ? fmt::format("{} and {} more", text, names.size() - kNamesShown) : text;
}

class LostLights {
public:
    explicit LostLights(const RayCaster& rays) : scene_(rays.scene()) {
        add(emittersName(), fateOfEmission(rays));
        for (const PunctualLight& light : scene_.lights) add(inQuotes(light.name), fateOfLight(rays, light));
        if (scene_.environment) add("the sky", fateOfEnvironment(rays));
    }

    std::vector<LostLight> texts() const {
        std::vector<LostLight> result;
        for (const Entry& entry : entries_)
            result.push_back(
                {fmt::format("no light from {} arrives at any front: {}", namesOf(entry.lights), endText(entry.fate)),
                 remedy(entry.fate)});
        return result;
    }

private:
    struct Entry {
        std::vector<std::string> lights;
        LightFate fate;
    };

    void add(const std::string& light, const LightFate& fate) {
        if (!fate.isLost()) return;
        const auto same = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
            return mostlyMet(entry.fate) == mostlyMet(fate) && entry.fate.node == fate.node &&
                   entry.fate.material == fate.material;
        });
        if (same != entries_.end())
            same->lights.push_back(light);
        else
            entries_.push_back({{light}, fate});
    }

    std::string emittersName() const {
        std::set<std::uint32_t> emitting;
        for (const Polygon& polygon : scene_.polygons)
            for (const std::uint32_t material : {polygon.material, polygon.backMaterial})
                if (material != kNone && scene_.materials[material].emittedRadiance != Rgb(0.0F))
                    emitting.insert(material);
        std::vector<std::string> names;
        for (const std::uint32_t material : emitting) names.push_back(inQuotes(scene_.materials[material].name));
        return "material " + namesOf(names);
    }

    std::string endText(const LightFate& fate) const {
        switch (mostlyMet(fate)) {
        case End::Backs:
            return fmt::format("{:.0f} % of it meets black backs first, most of them of node {}, material {}",
                               100.0 * fate.backs, inQuotes(scene_.nodes[fate.node]),
                               inQuotes(scene_.materials[fate.material].name));
        case End::Occluders:
            return fmt::format("{:.0f} % of it meets first what only blocks light", 100.0 * fate.occluders);
        case End::Emitters:
            return fmt::format("{:.0f} % of it meets emitters only", 100.0 * fate.emitters);
        case End::Nothing:
            break;
        }
        return fmt::format("{:.0f} % of it leaves the scene", 100.0 * fate.nothing);
    }

    static std::string remedy(const LightFate& fate) {
        switch (mostlyMet(fate)) {
        case End::Backs:
            return "turn its polygons, make it two-sided (--two-sided for all, \"two_sided\" in an overrides file for "
                   "this one), or open it where the light is to pass";
        case End::Occluders:
            return "take it from --occlude-only, or --exclude it";
        case End::Emitters:
            return "nothing else is there to be lit: see the nodes and materials that `lambert info` lists";
        case End::Nothing:
            break;
        }
        return "turn or move the light, or make what emits two-sided (--two-sided)";
    }

    const Scene& scene_;
    std::vector<Entry> entries_;
};

} // namespace

std::vector<LostLight> findLostLight(const RayCaster& rays) { return LostLights(rays).texts(); }

} // namespace lambert
