#include "core/error.h"
#include "solver/energy_balance.h"
#include "solver/jacobi.h"
#include "solver_case.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace lambert {
namespace {

RadiositySolution jacobi(const SolverProblem& problem, const FormFactorMatrix& matrix, const SolverOptions& options) {
    Progress progress;
    StoredRows rows(matrix);
    return solveJacobi(problem, rows, options, progress);
}

TEST(Jacobi, SolvesInfinitePlatesExactly) {
    const BarePatches patches = patchesWith(std::array{0.5F, 0.8F}, std::array{1.0F, 0.0F});
    const auto solution = jacobi(SolverProblem(patches), plates(), {.tolerance = 1e-12});
    EXPECT_NEAR(solution.radiosity[0].x, 1.0 / (1.0 - 0.4), kFloatReflectance);
    EXPECT_NEAR(solution.radiosity[1].x, 0.8 / (1.0 - 0.4), kFloatReflectance);
}

TEST(Jacobi, ChannelsDoNotMix) {
    BarePatches patches = patchesWith(std::array{0.5F, 0.5F}, std::array{0.0F, 0.0F});
    patches.optics.emittedRadiosity[0] = {3.0F, 0.0F, 1.5F};
    const auto solution = jacobi(SolverProblem(patches), plates(), {.tolerance = 1e-12});
    EXPECT_NEAR(solution.radiosity[1].x, 2.0, 1e-9);
    EXPECT_EQ(solution.radiosity[1].y, 0.0);
    EXPECT_NEAR(solution.radiosity[1].z, 1.0, 1e-9);
}

TEST(Jacobi, ResidualFallsAsTheReflectance) {
    const BarePatches patches = patchesWith(std::array{0.5F, 0.5F}, std::array{1.0F, 1.0F});
    const auto solution = jacobi(SolverProblem(patches), plates(), {.tolerance = 1e-6});
    ASSERT_EQ(solution.history.size(), static_cast<std::size_t>(solution.iterations));
    for (std::size_t k = 0; k < solution.history.size(); ++k)
        EXPECT_NEAR(solution.history[k].residual, std::pow(0.5, static_cast<double>(k) + 1.0), 1e-12);
    EXPECT_LE(solution.residual, 1e-6);
}

TEST(Jacobi, KeptBouncesAreTheTermsOfTheNeumannSeries) {
    // Between two plates the light that leaves plate 0 comes back as ρ_0 ρ_1 of itself after two bounces.
    const BarePatches patches = patchesWith(std::array{0.5F, 0.25F}, std::array{1.0F, 0.0F});
    const auto solution =
        jacobi(SolverProblem(patches), plates(), {.tolerance = 0.0, .bounces = 4, .keepBounces = true});
    ASSERT_EQ(solution.bounces.size(), 4U);
    EXPECT_EQ(solution.bounces[0], (std::vector<Rgb>{Rgb(0.0F), Rgb(0.25F)}));
    EXPECT_EQ(solution.bounces[1], (std::vector<Rgb>{Rgb(0.125F), Rgb(0.0F)}));
    EXPECT_EQ(solution.bounces[2], (std::vector<Rgb>{Rgb(0.0F), Rgb(0.03125F)}));
    for (std::size_t i = 0; i < 2; ++i) {
        RgbSum sum(patches.optics.emittedRadiosity[i]);
        for (const auto& bounce : solution.bounces) sum += RgbSum(bounce[i]);
        EXPECT_EQ(sum, solution.radiosity[i]);
    }
}

TEST(Jacobi, TheFirstBounceIncludesLightWithoutArea) {
    const BarePatches patches = patchesWith(std::array{0.5F, 0.25F}, std::array{1.0F, 0.0F});
    const SolverProblem problem(patches, {RgbSum(0.0), RgbSum(8.0)});
    const auto once = jacobi(problem, plates(), {.tolerance = 0.0, .bounces = 1});
    EXPECT_EQ(once.radiosity[0].x, 1.0);
    EXPECT_EQ(once.radiosity[1].x, 0.25 * (8.0 + 1.0));
    const auto twice = jacobi(problem, plates(), {.tolerance = 0.0, .bounces = 2});
    EXPECT_EQ(twice.radiosity[0].x, 1.0 + 0.5 * 0.25 * 9.0);
}

TEST(EnergyBalance, HoldsWithReciprocalRowsAndEachTermIsItsOwn) {
    // Half of what leaves a patch reaches the other, a quarter a black back, a quarter the outside.
    const BarePatches patches = patchesWith(std::array{0.5F, 0.25F}, std::array{1.0F, 0.0F});
    FormFactorMatrix matrix = dense(2, [](std::size_t i, std::size_t j) { return i == j ? 0.0 : 0.5; });
    for (std::size_t i = 0; i < 2; ++i) {
        FormFactorRow row = matrix.row(i);
        row.back = row.out = 0.25;
        matrix.setRow(i, row);
    }
    const auto solution = jacobi(SolverProblem(patches), matrix, {.tolerance = 1e-14});
    const double b0 = 1.0 / (1.0 - 0.5 * 0.5 * 0.25 * 0.5);
    const double b1 = 0.25 * 0.5 * b0;
    EXPECT_NEAR(solution.energy.emitted.x, 1.0, 1e-12);
    EXPECT_EQ(solution.energy.received.x, 0.0);
    EXPECT_NEAR(solution.energy.backFaces.x, 0.25 * (b0 + b1), 1e-12);
    EXPECT_NEAR(solution.energy.escaped.x, 0.25 * (b0 + b1), 1e-12);
    EXPECT_NEAR(solution.energy.absorbed.x, 0.5 * 0.5 * b1 + 0.75 * 0.5 * b0, 1e-12);
    EXPECT_NEAR(solution.energy.imbalance(), 0.0, 1e-12);
}

TEST(EnergyBalance, CountsWhatLightsWithoutAreaGive) {
    BarePatches patches = patchesWith(std::array{0.5F, 0.25F}, std::array{0.0F, 0.0F});
    patches.area = {2.0F, 2.0F};
    const auto solution = jacobi(SolverProblem(patches, {RgbSum(3.0), RgbSum(0.0)}), plates(), {.tolerance = 1e-14});
    EXPECT_NEAR(solution.energy.received.x, 6.0, 1e-12);
    EXPECT_EQ(solution.energy.emitted.x, 0.0);
    EXPECT_NEAR(solution.energy.imbalance(), 0.0, 1e-12);
}

TEST(SolverProblem, WithoutLightIsAnInputError) {
    const BarePatches patches = patchesWith(std::array{0.5F, 0.5F}, std::array{0.0F, 0.0F});
    EXPECT_THROW(SolverProblem{patches}, InputError);
    EXPECT_THROW(SolverProblem(patches, {RgbSum(0.0), RgbSum(0.0)}), InputError);
    EXPECT_NO_THROW(SolverProblem(patches, {RgbSum(1.0), RgbSum(0.0)}));
}

TEST(SolverProblem, BlackSurfacesUnderLightsWithoutAreaAreSolved) {
    const BarePatches patches = patchesWith(std::array{0.0F, 0.0F}, std::array{0.0F, 0.0F});
    const auto solution = jacobi(SolverProblem(patches, {RgbSum(1.0), RgbSum(0.0)}), plates(), {});
    EXPECT_EQ(solution.irradiance[0].x, 1.0);
    EXPECT_EQ(solution.radiosity[0].x, 0.0);
    EXPECT_EQ(solution.energy.imbalance(), 0.0);
}

} // namespace
} // namespace lambert
