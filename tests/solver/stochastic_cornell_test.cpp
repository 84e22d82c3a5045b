/// The Cornell box, which is open, has colours, blocks that hide one another, and black backs under them: against Jacobi with fine local
/// lines of the same mesh.
#include "formfactors/local_lines.h"
#include "meshing/build_patch_mesh.h"
#include "meshing/prepare.h"
#include "scene/reading/scene_reader.h"
#include "solver/jacobi.h"
#include "solver/random_walks.h"
#include "solver/stochastic_relaxation.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace lambert {
namespace {

struct CornellBox {
    CornellBox() : scene(prepareScene(readScene(LAMBERT_DATA "/cornell_box.obj").scene)), rays(scene) {
        MeshOptions options;
        options.patches = 300;
        Progress progress;
        mesh = buildPatchMesh(scene, options, progress);
        optics = patchOptics(scene, mesh);
    }
    RadiositySolution jacobi(std::uint64_t seed) const {
        const LocalLines lines(mesh, rays, {.lines = 1U << 15, .seed = seed});
        FormFactorMatrix matrix(mesh.size(), MatrixStorage::Float);
        RowAccumulator accumulator(mesh.size());
        FormFactorRow row;
        for (std::uint32_t i = 0; i < mesh.size(); ++i) {
            lines.row(i, accumulator);
            accumulator.take(row);
            matrix.setRow(i, row);
        }
        Progress progress;
        StoredRows stored(matrix);
        return solveJacobi(SolverProblem({mesh, optics}), stored, {.tolerance = 1e-9}, progress);
    }
    /// Σ A |a − b|².
    double squares(const std::vector<RgbSum>& a, const std::vector<RgbSum>& b) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < mesh.size(); ++i)
            sum += static_cast<double>(mesh.area[i]) * glm::dot(a[i] - b[i], a[i] - b[i]);
        return sum;
    }
    Scene scene;
    RayCaster rays;
    PatchMesh mesh;
    PatchOptics optics;
};

// The sum of squares of the differences of some 300 patches is within a factor of 1.5 of what both errors, that of the reference
// from two of its seeds, let expect: its relative standard deviation is √(2/300) = 8 % and up to twice that, as patches depend on each other.
void expectSame(const CornellBox& box, const StochasticSolution& solution, const RadiositySolution& a,
                const RadiositySolution& b) {
    const double ofReference = 0.25 * box.squares(a.irradiance, b.irradiance);
    double stated = 0.0;
    std::vector<RgbSum> mean;
    for (std::size_t i = 0; i < box.mesh.size(); ++i) {
        mean.push_back(0.5 * (a.irradiance[i] + b.irradiance[i]));
        const RgbSum error(solution.standardError[i]);
        stated += static_cast<double>(box.mesh.area[i]) * glm::dot(error, error);
    }
    const double found = box.squares(solution.irradiance, mean);
    EXPECT_LT(found / (stated + ofReference), 1.5);
    EXPECT_GT(found / (stated + ofReference), 1.0 / 1.5);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(solution.energy.escaped[c], a.energy.escaped[c], 0.005 * a.energy.emitted[c]);
        EXPECT_NEAR(solution.energy.backFaces[c], a.energy.backFaces[c], 0.005 * a.energy.emitted[c]);
        EXPECT_NEAR(solution.energy.absorbed[c], a.energy.absorbed[c], 0.005 * a.energy.emitted[c]);
    }
}

TEST(StochasticCornellBox, AllMethodsAgreeWithJacobiWithinTheirErrors) {
    const CornellBox box;
    const RadiositySolution a = box.jacobi(1);
    const RadiositySolution b = box.jacobi(2);
    Progress progress;
    for (const RelaxationLines lines : {RelaxationLines::Local, RelaxationLines::Global})
        expectSame(box,
                   solveStochasticRelaxation(SolverProblem({box.mesh, box.optics}), box.mesh, box.rays,
                                             {.rays = 2'000'000, .lines = lines}, progress),
                   a, b);
    expectSame(
        box,
        solveRandomWalks(SolverProblem({box.mesh, box.optics}), box.mesh, box.rays, {.walks = 2'000'000}, progress), a,
        b);
}

} // namespace
} // namespace lambert
