#include "core/error.h"
#include "core/parallel.h"
#include "solver/computed_rows.h"
#include "solver/gauss_seidel.h"
#include "solver/jacobi.h"
#include "solver/solver.h"
#include "solver/southwell.h"
#include "solver_case.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lambert {
namespace {

/// What is true of every solver with form factors.
class Solvers : public testing::TestWithParam<SolverMethod> {
protected:
    static RadiositySolution solved(const PatchViews& patches, const FormFactorMatrix& matrix, double tolerance,
                                    std::vector<RgbSum> direct = {}) {
        Progress progress;
        StoredRows rows(matrix);
        SolverOptions options;
        options.method = GetParam();
        options.tolerance = tolerance;
        return solve(SolverProblem(patches, std::move(direct)), rows, options, progress);
    }
};

INSTANTIATE_TEST_SUITE_P(All, Solvers, deterministicSolvers(), solverTestName);

TEST_P(Solvers, SolveTheSixPatchesOfTheCubeExactly) {
    const ReferenceCase cube("cube6", "B_6patch_exact");
    const auto solution = solved(cube.patches, cubeMatrix(), 1e-12);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(solution.radiosity[i].x, cube.values[i], kFloatReflectance);
}

TEST_P(Solvers, SolveTheTetrahedronExactly) {
    const ReferenceCase tetrahedron("tetrahedron", "B");
    const auto matrix = dense(4, [](std::size_t i, std::size_t j) { return i == j ? 0.0 : 1.0 / 3.0; });
    const auto solution = solved(tetrahedron.patches, matrix, 1e-12);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(solution.radiosity[i].x, tetrahedron.values[i], kFloatReflectance);
}

TEST_P(Solvers, GiveEveryPatchOfAFurnaceTheSameRadiosity) {
    RandomMatrix random(300, 7, true);
    for (Rgb& rho : random.patches.optics.reflectance) rho = Rgb(0.75F, 0.5F, 0.0F);
    for (Rgb& emitted : random.patches.optics.emittedRadiosity) emitted = Rgb(1.0F, 2.0F, 3.0F);
    const auto solution = solved(random.patches, random.matrix, 1e-9);
    // The error of a radiosity is at most the residual over 1 − ρ, here per patch and not in the mean.
    for (const RgbSum& b : solution.radiosity) {
        EXPECT_NEAR(b.x, 4.0, 1e-6);
        EXPECT_NEAR(b.y, 4.0, 1e-6);
        EXPECT_NEAR(b.z, 3.0, 1e-6);
    }
}

TEST_P(Solvers, AgreeOnARandomMatrixWithLightsWithoutArea) {
    const RandomMatrix random(300, 11);
    std::vector<RgbSum> direct(300, RgbSum(0.0));
    for (std::size_t i = 0; i < 300; i += 7) direct[i] = {1.0, 2.0, 0.5};
    Progress progress;
    StoredRows rows(random.matrix);
    const auto expected = solveJacobi(SolverProblem(random.patches, direct), rows, {.tolerance = 1e-14}, progress);
    const auto solution = solved(random.patches, random.matrix, 1e-12, direct);
    EXPECT_LE(solution.residual, 1e-12);
    // ‖error‖ <= ‖residual‖ / (1 − ρ), ρ <= 0.95, and the norm is that of some 10 per patch.
    for (std::size_t i = 0; i < 300; ++i)
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(solution.radiosity[i][c], expected.radiosity[i][c], 1e-9);
            EXPECT_NEAR(solution.irradiance[i][c], expected.irradiance[i][c], 1e-9);
        }
    EXPECT_NEAR(solution.energy.imbalance(), 0.0, 1e-10);
    EXPECT_GT(solution.energy.received.x, 0.0);
}

TEST_P(Solvers, TheResidualIsThatOfTheEquation) {
    // Loose, so that there is some. The matrix is reciprocal: shooting solves the same equation.
    const RandomMatrix random(200, 3);
    const auto solution = solved(random.patches, random.matrix, 1e-2);
    EXPECT_LE(solution.residual, 1e-2);
    EXPECT_EQ(solution.history.back().residual, solution.residual);
    EXPECT_EQ(solution.history.back().iteration, solution.iterations);
    const SolverProblem problem(random.patches);
    std::vector<RgbSum> difference(200);
    for (std::size_t i = 0; i < 200; ++i) {
        RgbSum irradiance(0.0);
        random.matrix.visit(i, [&](std::uint32_t j, double f) { irradiance += f * solution.radiosity[j]; });
        difference[i] = problem.radiosity(i, irradiance) - solution.radiosity[i];
    }
    // One bounce after the iterate whose residual is told: smaller by about the reflectance, never larger.
    EXPECT_LE(problem.relativeNorm(difference), solution.residual);
    EXPECT_GT(problem.relativeNorm(difference), 0.0);
}

TEST_P(Solvers, BlackPatchesAndBlackChannelsAreSolved) {
    RandomMatrix random(100, 5);
    for (std::size_t i = 0; i < 100; ++i) {
        random.patches.optics.reflectance[i].z = 0.0F;
        if (i % 3 == 0) random.patches.optics.reflectance[i] = Rgb(0.0F);
    }
    const auto solution = solved(random.patches, random.matrix, 1e-10);
    EXPECT_LE(solution.residual, 1e-10);
    for (std::size_t i = 0; i < 100; ++i)
        EXPECT_EQ(solution.radiosity[i].z, random.patches.optics.emittedRadiosity[i].z);
}

TEST_P(Solvers, ReachTheToleranceOnRowsThatAreNotReciprocal) {
    // Each row as from eight lines: factors off by their own size.
    const RandomMatrix random(300, 13);
    const FormFactorMatrix noisy = fromFewLines(random.matrix, 8, 17);
    const auto solution = solved(random.patches, noisy, 1e-8);
    EXPECT_LE(solution.residual, 1e-8);
}

TEST_P(Solvers, GiveTheSameBitsForAnyNumberOfThreads) {
    const RandomMatrix random(500, 19);
    const ThreadCountGuard guard;
    setThreadCount(1);
    const auto one = solved(random.patches, random.matrix, 1e-6);
    for (const int threads : {2, 8}) {
        setThreadCount(threads);
        const auto several = solved(random.patches, random.matrix, 1e-6);
        EXPECT_EQ(one.radiosity, several.radiosity);
        EXPECT_EQ(one.irradiance, several.irradiance);
        EXPECT_EQ(one.iterations, several.iterations);
    }
}

TEST_P(Solvers, ComputedRowsGiveTheBitsOfStoredOnes) {
    const RandomMatrix random(200, 23);
    Progress progress;
    SolverOptions options;
    options.method = GetParam();
    options.tolerance = 1e-6;
    StoredRows stored(random.matrix);
    const auto expected = solve(SolverProblem(random.patches), stored, options, progress);
    const MatrixAsMethod method(random.matrix);
    ComputedRows computed(method);
    const auto found = solve(SolverProblem(random.patches), computed, options, progress);
    EXPECT_EQ(found.radiosity, expected.radiosity);
    EXPECT_EQ(found.irradiance, expected.irradiance);
    EXPECT_EQ(found.covered, expected.covered);
    EXPECT_EQ(found.energy.escaped, expected.energy.escaped);
    EXPECT_EQ(found.iterations, expected.iterations);
}

TEST_P(Solvers, CanBeInterrupted) {
    const RandomMatrix random(100, 29);
    Progress progress;
    progress.cancel();
    StoredRows rows(random.matrix);
    SolverOptions options;
    options.method = GetParam();
    EXPECT_THROW(solve(SolverProblem(random.patches), rows, options, progress), Cancelled);
}

TEST(GaussSeidel, FirstSweepOverTheCubeIsExact) {
    const ReferenceCase cube("cube6", "gauss_seidel_first_sweep (start B=E)");
    const FormFactorMatrix matrix = cubeMatrix();
    StoredRows rows(matrix);
    const SolverProblem problem(cube.patches);
    std::vector<RgbSum> radiosity = problem.emitted();
    gaussSeidelSweep(problem, rows, 1.0, radiosity, Progress());
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(radiosity[i].x, cube.values[i], kFloatReflectance);
}

TEST(GaussSeidel, ASweepOverSeveralBlocksIsOnePatchAfterTheOther) {
    const RandomMatrix random(300, 31);
    StoredRows rows(random.matrix);
    const SolverProblem problem(random.patches);
    std::vector<RgbSum> found = problem.emitted();
    std::vector<RgbSum> expected = found;
    gaussSeidelSweep(problem, rows, 1.25, found, Progress());
    for (std::size_t i = 0; i < 300; ++i) {
        RgbSum irradiance(0.0);
        random.matrix.visit(i, [&](std::uint32_t j, double f) { irradiance += f * expected[j]; });
        expected[i] += 1.25 * (problem.radiosity(i, irradiance) - expected[i]);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[i][c], expected[i][c], 1e-12 * expected[i][c]);
    }
}

TEST(GaussSeidel, OverRelaxationPaysInABrightRoom) {
    std::vector<float> emitted(60, 0.0F);
    emitted[0] = 1.0F;
    const BarePatches patches = patchesWith(std::vector<float>(60, 0.9F), emitted);
    const auto matrix = dense(60, [](std::size_t i, std::size_t j) { return i == j ? 0.0 : 1.0 / 59.0; });
    Progress progress;
    StoredRows rows(matrix);
    const SolverProblem problem(patches);
    const auto plain = solveGaussSeidel(problem, rows, {.tolerance = 1e-6}, progress);
    const auto relaxed = solveGaussSeidel(problem, rows, {.tolerance = 1e-6, .relaxation = 1.4}, progress);
    EXPECT_LT(2 * relaxed.iterations, plain.iterations);
}

TEST(Jacobi, FirstIterateOverTheCubeIsExact) {
    const ReferenceCase cube("cube6", "jacobi_first_iterate (start B=E)");
    const FormFactorMatrix matrix = cubeMatrix();
    StoredRows rows(matrix);
    Progress progress;
    const auto solution = solveJacobi(SolverProblem(cube.patches), rows, {.tolerance = 0.0, .bounces = 1}, progress);
    EXPECT_EQ(solution.iterations, 1);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(solution.radiosity[i].x, cube.values[i], kFloatReflectance);
}

TEST(Southwell, ShootsTheCubeInTheOrderOfTheReference) {
    const ReferenceCase cube("cube6", "southwell_shooting_order");
    const FormFactorMatrix matrix = cubeMatrix();
    StoredRows rows(matrix);
    const SolverProblem problem(cube.patches);
    Southwell method(problem, rows);
    for (const double expected : cube.values) {
        const std::uint32_t patch = method.brightest();
        EXPECT_EQ(patch, static_cast<std::uint32_t>(expected));
        method.shoot(patch);
    }
}

TEST(ConjugateGradient, IsSlowedDownLittleByHighReflectances) {
    RandomMatrix random(300, 43, true);
    for (Rgb& rho : random.patches.optics.reflectance) rho = Rgb(0.99F);
    StoredRows rows(random.matrix);
    Progress progress;
    SolverOptions options;
    options.method = SolverMethod::ConjugateGradient;
    options.tolerance = 1e-8;
    const auto solution = solve(SolverProblem(random.patches), rows, options, progress);
    EXPECT_LE(solution.residual, 1e-8);
    EXPECT_LE(solution.iterations, 40); // Jacobi: log(1e-8) / log(0.99) = 1833
}

TEST(SolverOptions, ThatMeanNothingToASolverAreUsageErrors) {
    EXPECT_THROW(checkSolver({.method = SolverMethod::GaussSeidel, .bounces = 3}), UsageError);
    EXPECT_THROW(checkSolver({.method = SolverMethod::Southwell, .keepBounces = true}), UsageError);
    EXPECT_THROW(checkSolver({.method = SolverMethod::Jacobi, .relaxation = 1.2}), UsageError);
    EXPECT_THROW(checkSolver({.method = SolverMethod::GaussSeidel, .relaxation = 2.0}), UsageError);
    EXPECT_THROW(checkSolver({.method = SolverMethod::ConjugateGradient, .tolerance = 0.0}), UsageError);
    EXPECT_NO_THROW(checkSolver({.method = SolverMethod::Jacobi, .tolerance = 0.0, .bounces = 2}));
    EXPECT_NO_THROW(checkSolver({}));
}

} // namespace
} // namespace lambert
