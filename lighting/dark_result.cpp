#include "lighting/dark_result.h"

#include "lighting/lost_light.h"

#include <fmt/format.h>

#include <algorithm>

namespace lambert {

bool isDark(const PatchOptics& optics, const std::vector<RgbSum>& direct) {
    return std::all_of(direct.begin(), direct.end(), [](const RgbSum& e) { return e == RgbSum(0.0); }) &&
           std::all_of(optics.emittedRadiosity.begin(), optics.emittedRadiosity.end(),
                       [](const Rgb& b) { return b == Rgb(0.0F); });
}

RadiositySolution darkness(std::size_t patches) {
    RadiositySolution solution;
    solution.radiosity.assign(patches, RgbSum(0.0));
    solution.irradiance.assign(patches, RgbSum(0.0));
    solution.covered.assign(patches, 0.0F);
    return solution;
}

std::vector<std::string> warningsOfDarkness(const MeshedScene& scene, const RadiositySolution& solution,
                                            std::size_t strayRays) {
    bool receives = false, isLit = false, reflects = false;
    for (std::size_t i = 0; i < scene.mesh.size(); ++i) {
        if (scene.optics.emittedRadiosity[i] != Rgb(0.0F)) continue;
        receives = true;
        isLit = isLit || solution.irradiance[i] != RgbSum(0.0);
        reflects = reflects || solution.radiosity[i] != RgbSum(0.0);
    }
    if (!receives || reflects) return {};
    if (isLit)
        return {"the result is black: no surface on which light falls reflects any; give one with --reflectance "
                "MATERIAL=r,g,b, or show --quantity irradiance"};
    std::vector<std::string> warnings;
    for (const LostLight& lost : findLostLight(*scene.rays))
        warnings.push_back(fmt::format("the result is black: {}: {}", lost.problem, lost.remedy));
    if (warnings.empty())
        warnings.emplace_back("the result is black: no light arrives at any front; see `lambert info`");
    if (strayRays > 0)
        warnings.front() += fmt::format(" ({} ray{} got through, as between polygons that touch: counted as none)",
                                        strayRays, strayRays == 1 ? "" : "s");
    return warnings;
}

} // namespace lambert
