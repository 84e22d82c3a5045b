#include "baking/per_light.h"

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

bool isDark(const PatchMesh& mesh, const std::vector<RgbSum>& direct) {
    return std::all_of(direct.begin(), direct.end(), [](const RgbSum& e) { return e == RgbSum(0.0); }) &&
           std::all_of(mesh.emittedRadiosity.begin(), mesh.emittedRadiosity.end(),
                       [](const Rgb& b) { return b == Rgb(0.0F); });
}

/// Of lights that reach nothing.
RadiositySolution darkness(std::size_t patches) {
    RadiositySolution solution;
    solution.radiosity.assign(patches, RgbSum(0.0));
    solution.irradiance.assign(patches, RgbSum(0.0));
    solution.covered.assign(patches, 0.0F);
    return solution;
}

BakedLight bakeGroup(MeshedScene& scene, LightGroup group, const LightSolver& solver, const PerLightOptions& o,
                     Progress& progress) {
    const OtherEmission emission(scene.mesh, emittedBy(group, scene.mesh));
    std::vector<RgbSum> direct =
        DirectLight(*scene.rays, o.directLight).irradiance(scene.mesh, sourcesOf(group, *scene.scene), progress);
    const RadiositySolution solution =
        isDark(scene.mesh, direct) ? darkness(scene.mesh.size()) : solver(SolverProblem(scene.mesh, std::move(direct)));
    BakedMesh baked = reconstructAverage(scene.mesh, *scene.scene, solution, o.reconstruction);
    return {std::move(group),           solution.energy,
            solution.iterations,        solution.residual,
            std::move(baked.radiosity), std::move(baked.irradiance),
            std::move(baked.emitters)};
}

} // namespace

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
