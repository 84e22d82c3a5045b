#include "baking/per_light.h"

#include <utility>

namespace lambert {

BakedLight bakeLight(const SolvedScene& scene, SolvedLight light, const ReconstructionOptions& options,
                     const std::optional<FinalGatherOptions>& gather, Progress& progress) {
    const LitPatches lit{scene.mesh, light.optics, *scene.scene, light.solution};
    BakedMesh baked =
        gather ? reconstructGather(lit, *scene.rays, sourcesOf(light.group, *scene.scene), options, *gather, progress)
               : reconstructAverage(lit, options);
    return {std::move(light.group),     light.solution.energy,       light.solution.iterations, light.solution.residual,
            std::move(baked.radiosity), std::move(baked.irradiance), std::move(baked.emitters)};
}

BakedMesh withLight(BakedMesh mesh, const BakedLight& light, Quantity shown) {
    if (mesh.splitBy.empty()) mesh.splitBy = shown == Quantity::Radiosity ? mesh.radiosity : mesh.irradiance;
    mesh.radiosity = light.radiosity;
    mesh.irradiance = light.irradiance;
    mesh.emitters = light.emitters;
    return mesh;
}

} // namespace lambert
