#include "lighting/dark_result.h"
#include "lighting/light_solves.h"
#include "lighting/stray_light.h"

#include <algorithm>
#include <utility>

namespace lambert {

std::vector<RgbSum> LightOfMaterials::of(std::uint32_t material) const {
    const auto found = std::lower_bound(materials.begin(), materials.end(), material);
    if (irradiance.empty() || found == materials.end() || *found != material) return {};
    return irradiance[static_cast<std::size_t>(found - materials.begin())];
}

void solveLights(const LightTask& task, const ProblemSolver& solver) {
    if (!task.sink) return;
    SolvedScene& scene = task.scene;
    for (LightGroup& group : lightGroups(*scene.scene, scene.mesh, scene.optics)) {
        PatchOptics optics{scene.optics.reflectance, emittedBy(group, scene.mesh, scene.optics)};
        DirectIrradiance direct = directIrradiance(scene.mesh, *scene.rays, task.options.directLight,
                                                   sourcesOf(group, *scene.scene), task.progress);
        RadiositySolution solution = isDark(optics, direct.values)
                                         ? darkness(scene.mesh.size())
                                         : solver(SolverProblem({scene.mesh, optics}, std::move(direct.values),
                                                                task.emitters.of(group.material)));
        scene.largestResidual = std::max(scene.largestResidual, solution.residual);
        task.sink({std::move(group), std::move(optics), std::move(solution)}, scene);
    }
}

} // namespace lambert
