// Prints how long each solver takes on one scene to a residual of 1e-6, as a Markdown table; the shortest of three runs:
//
//     build/benchmarks/solver_table SCENE PATCHES RESOLUTION [REFLECTANCE]
//
// REFLECTANCE replaces that of all materials.
#include "core/error.h"
#include "core/process.h"
#include "formfactors/hemicube.h"
#include "formfactors/repair.h"
#include "formfactors/transport.h"
#include "meshing/mesh_scene.h"
#include "scene/reading/scene_reader.h"
#include "solver/computed_rows.h"
#include "solver/gauss_seidel.h"
#include "solver/solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <string>

namespace lambert {
namespace {

constexpr double kTolerance = 1e-6;
constexpr int kRepeats = 3;

template <typename Solve>
void print(const std::string& name, Solve&& solved) {
    double best = std::numeric_limits<double>::infinity();
    RadiositySolution solution;
    for (int k = 0; k < kRepeats; ++k) {
        const double before = processorSeconds();
        solution = solved();
        best = std::min(best, processorSeconds() - before);
    }
    fmt::print("| {} | {} | {:.3g} | {:.1e} |\n", name, solution.iterations, best, solution.residual);
}

int run(int argc, char** argv) {
    if (argc < 4) throw UsageError("solver_table SCENE PATCHES RESOLUTION [REFLECTANCE]");
    Progress progress;
    Scene scene = readScene(argv[1]).scene;
    if (argc > 4)
        for (Material& material : scene.materials) material.reflectance = Rgb(std::stof(argv[4]));
    MeshOptions meshOptions;
    meshOptions.patches = std::stoul(argv[2]);
    const MeshedScene meshed = meshLitScene(scene, meshOptions, progress);
    const PatchMesh& mesh = meshed.mesh;
    const Hemicube method(mesh, *meshed.rays, {.resolution = std::stoi(argv[3])});
    const double before = processorSeconds();
    FormFactorMatrix matrix = computeMatrix(method, MatrixStorage::Float, progress);
    const double seconds = processorSeconds() - before;
    repair(matrix, mesh.area, repairWeights(mesh));
    fmt::print("{}: {} patches, {} factors, computed in {:.1f} CPU s\n\n", argv[1], mesh.size(), matrix.entryCount(),
               seconds);
    fmt::print("| solver | iterations | CPU s | residual |\n|---|---|---|---|\n");
    const SolverProblem problem({mesh, meshed.optics});
    StoredRows rows(matrix);
    for (const std::string& name : solverNames()) {
        SolverOptions options;
        options.method = solverByName(name).value();
        options.tolerance = kTolerance;
        print(name, [&] { return solve(problem, rows, options, progress); });
        if (options.method != SolverMethod::GaussSeidel) continue;
        for (const double relaxation : {1.1, 1.2, 1.3, 1.5})
            print(fmt::format("{}, W = {}", name, relaxation), [&] {
                return solveGaussSeidel(problem, rows, {.tolerance = kTolerance, .relaxation = relaxation}, progress);
            });
    }
    return 0;
}

} // namespace
} // namespace lambert

int main(int argc, char** argv) {
    try {
        return lambert::run(argc, argv);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return EXIT_FAILURE;
    }
}
