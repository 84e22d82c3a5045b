#pragma once

#include "formfactors/repair.h"
#include "formfactors/transport.h"
#include "meshing/build_patch_mesh.h"
#include "meshing/prepare.h"
#include "scene/reading/scene_reader.h"
#include "solver/solver.h"
#include "solver/stochastic_solution.h"
#include "solver_case.h"

#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace lambert {

inline TransportOptions hemicubes(int resolution) {
    TransportOptions options;
    options.method = TransportMethod::Hemicube;
    options.resolution = resolution;
    return options;
}

inline TransportOptions closedForm() {
    TransportOptions options;
    options.method = TransportMethod::ClosedForm;
    return options;
}

/// A scene of data/ with repaired form factors.
struct SceneCase {
    SceneCase(const std::string& name, std::size_t patches, TransportOptions options)
        : scene(prepareScene(readScene(LAMBERT_DATA "/" + name).scene)), rays(scene) {
        Progress progress;
        MeshOptions meshOptions;
        meshOptions.patches = patches;
        mesh = buildPatchMesh(scene, meshOptions, progress);
        optics = patchOptics(scene, mesh);
        options.storage = MatrixStorage::Double;
        TransportMatrix computed = computeMatrix(planTransport(options, mesh, rays, progress), mesh, rays, progress);
        matrix = std::move(computed.matrix);
        repair(matrix, mesh.area, computed.repairWeights);
    }

    /// Area-weighted means over the materials, by name.
    std::map<std::string, RgbSum> means(const std::vector<RgbSum>& values) const {
        std::map<std::string, RgbSum> sums;
        std::map<std::string, double> areas;
        for (std::size_t i = 0; i < mesh.size(); ++i) {
            const std::string& name = scene.materials[mesh.material[i]].name;
            sums[name] += static_cast<double>(mesh.area[i]) * values[i];
            areas[name] += static_cast<double>(mesh.area[i]);
        }
        for (auto& [name, sum] : sums) sum /= areas[name];
        return sums;
    }

    /// Standard errors of the means of irradiance, as if all patches of a material erred to the same side.
    std::map<std::string, RgbSum> meanErrors(const StochasticSolution& solution) const {
        return means(std::vector<RgbSum>(solution.standardError.begin(), solution.standardError.end()));
    }

    RadiositySolution solved(SolverMethod method) const {
        Progress progress;
        StoredRows rows(matrix);
        SolverOptions options;
        options.method = method;
        options.tolerance = 1e-7;
        return solve(SolverProblem({mesh, optics}), rows, options, progress);
    }

    Scene scene;
    RayCaster rays;
    PatchMesh mesh;
    PatchOptics optics;
    FormFactorMatrix matrix;
};

/// The same case for all solvers, made once.
inline const SceneCase& sceneCase(const std::string& name, std::size_t patches, const TransportOptions& options) {
    static std::map<std::string, std::unique_ptr<SceneCase>> cases;
    auto& found = cases[name + std::to_string(patches) + std::string(nameOf(options.method))];
    if (!found) found = std::make_unique<SceneCase>(name, patches, options);
    return *found;
}

/// Irradiance of the Cornell box's surfaces, by name, as data/reference has it.
inline std::map<std::string, RgbSum> cornellSurfaces() {
    std::map<std::string, RgbSum> surfaces;
    std::ifstream file(LAMBERT_DATA "/reference/cornell_surfaces.csv");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with('#')) continue;
        std::istringstream fields(line);
        std::string name, value;
        std::getline(fields, name, ',');
        for (int channel = 0; channel < 3 && std::getline(fields, value, ','); ++channel)
            surfaces[name][channel] = std::stod(value);
    }
    return surfaces;
}

} // namespace lambert
