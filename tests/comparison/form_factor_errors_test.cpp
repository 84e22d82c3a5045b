#include "comparison/form_factor_errors.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace lambert {
namespace {

using Dense = std::array<std::array<double, 3>, 3>;

/// What rows lack of 1 leaves the scene.
FormFactorMatrix matrixOf(const Dense& factors) {
    FormFactorMatrix matrix(3, MatrixStorage::Double);
    for (std::size_t i = 0; i < 3; ++i) {
        FormFactorRow row;
        row.out = 1.0;
        for (std::uint32_t j = 0; j < 3; ++j) {
            row.out -= factors[i][j];
            if (factors[i][j] > 0.0) row.entries.push_back({j, factors[i][j]});
        }
        matrix.setRow(i, row);
    }
    return matrix;
}

constexpr std::array kArea{1.0F, 2.0F, 1.0F};
constexpr Dense kReference{{{0.0, 0.5, 0.5}, {0.25, 0.0, 0.05}, {0.5, 0.1, 0.0}}};

TEST(FormFactorErrors, AMatrixHasNoneAgainstItself) {
    const FormFactorMatrix reference = matrixOf(kReference);
    const FormFactorErrors errors = formFactorErrors(reference, reference, kArea, 0.0);
    EXPECT_EQ(errors.rms, 0.0);
    EXPECT_EQ(errors.maximum, 0.0);
    EXPECT_EQ(errors.relativeRms, 0.0);
    EXPECT_EQ(errors.bias, 0.0);
    EXPECT_EQ(errors.misdirected, 0.0);
}

TEST(FormFactorErrors, KnownErrorsAreFound) {
    // F_01 too large by a fifth, F_02 too small by as much; F_12 missed altogether.
    const FormFactorMatrix found = matrixOf({{{0.0, 0.6, 0.4}, {0.25, 0.0, 0.0}, {0.5, 0.1, 0.0}}});
    const FormFactorErrors errors = formFactorErrors(found, matrixOf(kReference), kArea, 0.2);
    EXPECT_NEAR(errors.rms, std::sqrt((0.01 + 0.01 + 0.0025) / 6.0), 1e-15);
    EXPECT_NEAR(errors.maximum, 0.1, 1e-15);
    // Above 0.2: F_01, F_02, F_10, F_20.
    EXPECT_NEAR(errors.relativeRms, std::sqrt((0.04 + 0.04) / 4.0), 1e-15);
    EXPECT_NEAR(errors.bias, 0.0, 1e-15);
    // Row 0: 0.1 went to 1 instead of 2; row 1: 0.05 left instead of going to 2.
    EXPECT_NEAR(static_cast<double>(errors.misdirectedBy[0]), 0.1, 1e-7);
    EXPECT_NEAR(static_cast<double>(errors.misdirectedBy[1]), 0.05, 1e-7);
    EXPECT_NEAR(errors.misdirected, (1.0 * 0.1 + 2.0 * 0.05) / 4.0, 1e-15);
    // With all pairs the missed one counts −1.
    EXPECT_NEAR(formFactorErrors(found, matrixOf(kReference), kArea, 0.0).bias, -1.0 / 6.0, 1e-15);
}

TEST(FormFactorErrors, WhatAllSeedsShareIsSystematic) {
    // Errors of F_01: 0.1 ± 0.02 of two matrices; without the noise 0.1. K m − M = 2 · 0.1² − (0.12² + 0.08²) / 2, per 6 pairs
    // and relative to 0.5.
    const std::array found{matrixOf({{{0.0, 0.62, 0.38}, {0.25, 0.0, 0.05}, {0.5, 0.1, 0.0}}}),
                           matrixOf({{{0.0, 0.58, 0.42}, {0.25, 0.0, 0.05}, {0.5, 0.1, 0.0}}})};
    const auto systematic = systematicError(found, matrixOf(kReference), 0.4);
    ASSERT_TRUE(systematic);
    // F_01, F_02 and F_20 are above 0.4.
    const double square = 2.0 * (2.0 * 0.01 - 0.5 * (0.0144 + 0.0064)) / 0.25 / 3.0;
    EXPECT_NEAR(*systematic, std::sqrt(square), 1e-12);
    EXPECT_FALSE(systematicError(std::span(found).first(1), matrixOf(kReference), 0.4));
}

TEST(FormFactorErrors, PureNoiseIsNotSystematic) {
    const std::array found{matrixOf({{{0.0, 0.6, 0.4}, {0.25, 0.0, 0.05}, {0.5, 0.1, 0.0}}}),
                           matrixOf({{{0.0, 0.4, 0.6}, {0.25, 0.0, 0.05}, {0.5, 0.1, 0.0}}})};
    EXPECT_EQ(systematicError(found, matrixOf(kReference), 0.0).value(), 0.0);
}

TEST(FormFactorErrors, RadiosityIsComparedWithTheReflectedLight) {
    PatchMesh mesh;
    mesh.area = {1.0F, 3.0F};
    mesh.corners.resize(2);
    PatchOptics optics;
    optics.emittedRadiosity = {Rgb(100.0F), Rgb(0.0F)};
    const std::vector<RgbSum> reference{RgbSum(101.0), RgbSum(2.0)};
    const std::vector<RgbSum> found{RgbSum(101.5), RgbSum(2.1)};
    // Reflected: 1 and 2; errors 0.5 and 0.1; areas 1 and 3.
    EXPECT_NEAR(radiosityError(mesh, optics, found, reference), std::sqrt((0.25 + 0.03) / (1.0 + 12.0)), 1e-12);
}

TEST(FormFactorErrors, FactorsAreSortedBySize) {
    // 20 factors of 0.2 that are found as 0.22, 20 of 0.002 that are missed.
    FormFactorMatrix reference(20, MatrixStorage::Double), found(20, MatrixStorage::Double);
    for (std::uint32_t i = 0; i < 20; ++i) {
        const std::uint32_t first = i == 0 ? 1 : 0;
        const std::uint32_t last = i == 19 ? 18 : 19;
        FormFactorRow row;
        row.entries = {{first, 0.2}, {last, 0.002}};
        reference.setRow(i, row);
        row.entries = {{first, 0.22}};
        found.setRow(i, row);
    }
    const auto sizes = errorsBySize(std::span(&found, 1), reference);
    ASSERT_EQ(sizes.size(), 2U);
    EXPECT_NEAR(sizes[0].lower, 1e-3, 1e-12);
    EXPECT_NEAR(sizes[0].upper, std::sqrt(1e-5), 1e-12);
    EXPECT_EQ(sizes[0].pairs, 20U);
    EXPECT_NEAR(sizes[0].relativeRms, 1.0, 1e-12);
    EXPECT_NEAR(sizes[1].relativeRms, 0.1, 1e-12);
}

} // namespace
} // namespace lambert
