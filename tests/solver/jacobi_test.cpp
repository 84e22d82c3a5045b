#include "core/error.h"
#include "solver/jacobi.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <span>

namespace lambert {
namespace {

/// Patches of area 1 that exist for their material only.
PatchMesh patchesWith(std::span<const float> reflectance, std::span<const float> emitted) {
    PatchMesh mesh;
    mesh.frontCount = reflectance.size();
    for (std::size_t i = 0; i < reflectance.size(); ++i) {
        mesh.corners.push_back({0, 0, 0, 0});
        mesh.area.push_back(1.0F);
        mesh.reflectance.emplace_back(reflectance[i]);
        mesh.emittedRadiosity.emplace_back(emitted[i]);
    }
    return mesh;
}

FormFactorMatrix dense(std::size_t count, const std::function<double(std::size_t, std::size_t)>& factor) {
    FormFactorMatrix matrix(count, MatrixStorage::Double);
    for (std::size_t i = 0; i < count; ++i) {
        FormFactorRow row;
        for (std::size_t j = 0; j < count; ++j)
            if (const double f = factor(i, j); f > 0.0) row.entries.push_back({static_cast<std::uint32_t>(j), f});
        matrix.setRow(i, row);
    }
    return matrix;
}

constexpr std::array kCubeReflectance{0.65F, 0.15F, 0.5F, 0.8F, 0.7F, 0.3F};
constexpr std::array kCubeEmitted{0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.25F};

/// Six patches of a cube: faces 2k and 2k + 1 oppose each other.
FormFactorMatrix cubeMatrix() {
    return dense(6, [](std::size_t i, std::size_t j) {
        if (i == j) return 0.0;
        return i / 2 == j / 2 ? 0.1998248957 : 0.2000437761;
    });
}

// data/reference/analytic.json, nine digits; factors are stored as floats, which costs about 1e-7.
constexpr double kFloatStorage = 3e-7;

TEST(Jacobi, SolvesTheSixPatchCubeExactly) {
    constexpr std::array expected{0.282250025, 0.071452995, 0.222925591, 1.200418941, 0.301253967, 0.374705604};
    Progress progress;
    const auto solution =
        solveJacobi(patchesWith(kCubeReflectance, kCubeEmitted), cubeMatrix(), {.tolerance = 1e-12}, progress);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(solution.radiosity[i].x, expected[i], kFloatStorage);
}

TEST(Jacobi, FirstIterateIsTheFirstBounce) {
    constexpr std::array expected{0.162535568, 0.037508208, 0.12491792, 1.040008755, 0.175, 0.310013133};
    Progress progress;
    const auto solution = solveJacobi(patchesWith(kCubeReflectance, kCubeEmitted), cubeMatrix(),
                                      {.tolerance = 0.0, .bounces = 1}, progress);
    EXPECT_EQ(solution.iterations, 1);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(solution.radiosity[i].x, expected[i], kFloatStorage);
}

TEST(Jacobi, SolvesTheTetrahedronExactly) {
    constexpr std::array reflectance{0.2F, 0.4F, 0.6F, 0.8F};
    constexpr std::array emitted{1.0F, 0.0F, 0.0F, 0.0F};
    constexpr std::array expected{1.069867405, 0.249162174, 0.352979746, 0.445869153};
    Progress progress;
    const auto solution = solveJacobi(patchesWith(reflectance, emitted),
                                      dense(4, [](std::size_t i, std::size_t j) { return i == j ? 0.0 : 1.0 / 3.0; }),
                                      {.tolerance = 1e-12}, progress);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(solution.radiosity[i].x, expected[i], kFloatStorage);
}

TEST(Jacobi, SolvesInfinitePlatesExactly) {
    constexpr std::array reflectance{0.5F, 0.8F};
    constexpr std::array emitted{1.0F, 0.0F};
    Progress progress;
    const auto solution = solveJacobi(patchesWith(reflectance, emitted),
                                      dense(2, [](std::size_t i, std::size_t j) { return i == j ? 0.0 : 1.0; }),
                                      {.tolerance = 1e-12}, progress);
    EXPECT_NEAR(solution.radiosity[0].x, 1.0 / (1.0 - 0.4), kFloatStorage);
    EXPECT_NEAR(solution.radiosity[1].x, 0.8 / (1.0 - 0.4), kFloatStorage);
}

TEST(Jacobi, ChannelsDoNotMix) {
    PatchMesh mesh = patchesWith(std::array{0.5F, 0.5F}, std::array{0.0F, 0.0F});
    mesh.emittedRadiosity[0] = {3.0F, 0.0F, 1.5F};
    Progress progress;
    const auto solution = solveJacobi(mesh, dense(2, [](std::size_t i, std::size_t j) { return i == j ? 0.0 : 1.0; }),
                                      {.tolerance = 1e-12}, progress);
    EXPECT_NEAR(solution.radiosity[1].x, 2.0, 1e-9);
    EXPECT_EQ(solution.radiosity[1].y, 0.0);
    EXPECT_NEAR(solution.radiosity[1].z, 1.0, 1e-9);
}

TEST(Jacobi, ResidualFallsAsTheReflectance) {
    Progress progress;
    const auto solution = solveJacobi(patchesWith(std::array{0.5F, 0.5F}, std::array{1.0F, 1.0F}),
                                      dense(2, [](std::size_t i, std::size_t j) { return i == j ? 0.0 : 1.0; }),
                                      {.tolerance = 1e-6}, progress);
    ASSERT_EQ(solution.history.size(), static_cast<std::size_t>(solution.iterations));
    for (std::size_t k = 0; k < solution.history.size(); ++k)
        EXPECT_NEAR(solution.history[k].residual, std::pow(0.5, static_cast<double>(k) + 1.0), 1e-12);
    EXPECT_LE(solution.residual, 1e-6);
}

TEST(Jacobi, EnergyBalancesWithReciprocalRowsAndEachTermIsItsOwn) {
    // Half of what leaves a patch reaches the other, a quarter a black back, a quarter the outside.
    PatchMesh mesh = patchesWith(std::array{0.5F, 0.25F}, std::array{1.0F, 0.0F});
    FormFactorMatrix matrix = dense(2, [](std::size_t i, std::size_t j) { return i == j ? 0.0 : 0.5; });
    for (std::size_t i = 0; i < 2; ++i) {
        FormFactorRow row = matrix.row(i);
        row.back = row.out = 0.25;
        matrix.setRow(i, row);
    }
    Progress progress;
    const auto solution = solveJacobi(mesh, matrix, {.tolerance = 1e-14}, progress);
    const double b0 = 1.0 / (1.0 - 0.5 * 0.5 * 0.25 * 0.5);
    const double b1 = 0.25 * 0.5 * b0;
    EXPECT_NEAR(solution.energy.emitted.x, 1.0, 1e-12);
    EXPECT_NEAR(solution.energy.backFaces.x, 0.25 * (b0 + b1), 1e-12);
    EXPECT_NEAR(solution.energy.escaped.x, 0.25 * (b0 + b1), 1e-12);
    EXPECT_NEAR(solution.energy.absorbed.x, 0.5 * 0.5 * b1 + 0.75 * 0.5 * b0, 1e-12);
    EXPECT_NEAR(solution.energy.imbalance(), 0.0, 1e-12);
}

TEST(Jacobi, ASceneWithoutLightIsAnInputError) {
    Progress progress;
    const FormFactorMatrix matrix = dense(2, [](std::size_t i, std::size_t j) { return i == j ? 0.0 : 1.0; });
    EXPECT_THROW(solveJacobi(patchesWith(std::array{0.5F, 0.5F}, std::array{0.0F, 0.0F}), matrix, {}, progress),
                 InputError);
}

} // namespace
} // namespace lambert
