#include "baking/per_light.h"

#include "baking/dark_result.h"
#include "baking/stray_light.h"

#include <algorithm>
#include <utility>

namespace lambert {

namespace {

/// Lets a mesh emit something else for a while.
class OtherEmission {
public:
    OtherEmission(PatchMesh& mesh, std::vector<Rgb> emitted) : mesh_(mesh), other_(std::move(emitted)) {
        mesh_.emittedRadiosity.swap(other_);
    }
    ~OtherEmission() { mesh_.emittedRadiosity.swap(other_); }
    OtherEmission(const OtherEmission&) = delete;
    OtherEmission& operator=(const OtherEmission&) = delete;

private:
    PatchMesh& mesh_;
    std::vector<Rgb> other_;
};

BakedLight bakeGroup(MeshedScene& scene, LightGroup group, const LightSolver& solver, const PerLightOptions& o,
                     Progress& progress) {
    const OtherEmission emission(scene.mesh, emittedBy(group, scene.mesh));
    DirectIrradiance direct =
        directIrradiance(scene.mesh, *scene.rays, o.directLight, sourcesOf(group, *scene.scene), progress);
    const RadiositySolution solution =
        isDark(scene.mesh, direct.values)
            ? darkness(scene.mesh.size())
            : solver(SolverProblem(scene.mesh, std::move(direct.values), o.emitters.of(group.material)));
    BakedMesh baked = reconstructAverage(scene.mesh, *scene.scene, solution, o.reconstruction);
    return {std::move(group),           solution.energy,
            solution.iterations,        solution.residual,
            std::move(baked.radiosity), std::move(baked.irradiance),
            std::move(baked.emitters)};
}

} // namespace

std::vector<RgbSum> LightOfMaterials::of(std::uint32_t material) const {
    const auto found = std::lower_bound(materials.begin(), materials.end(), material);
    if (irradiance.empty() || found == materials.end() || *found != material) return {};
    return irradiance[static_cast<std::size_t>(found - materials.begin())];
}

BakedMesh withLight(BakedMesh mesh, const BakedLight& light, Quantity shown) {
    if (mesh.splitBy.empty()) mesh.splitBy = shown == Quantity::Radiosity ? mesh.radiosity : mesh.irradiance;
    mesh.radiosity = light.radiosity;
    mesh.irradiance = light.irradiance;
    mesh.emitters = light.emitters;
    return mesh;
}

std::vector<BakedLight> bakePerLight(MeshedScene& scene, const LightSolver& solver, const PerLightOptions& options,
                                     Progress& progress) {
    std::vector<BakedLight> lights;
    for (LightGroup& group : lightGroups(*scene.scene, scene.mesh))
        lights.push_back(bakeGroup(scene, std::move(group), solver, options, progress));
    return lights;
}

} // namespace lambert
