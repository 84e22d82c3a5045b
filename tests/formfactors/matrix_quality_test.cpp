#include "formfactors/matrix_quality.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace lambert {
namespace {

FormFactorMatrix twoPatches(double f01, double f10, double out0, double out1) {
    FormFactorMatrix matrix(2, MatrixStorage::Double);
    matrix.setRow(0, {{{1, f01}}, 0.0, out0, 0});
    matrix.setRow(1, {{{0, f10}}, 0.0, out1, 0});
    return matrix;
}

constexpr std::array kArea{1.0F, 4.0F};

TEST(MatrixQuality, OfAnExactMatrixHasNoError) {
    const FormFactorMatrix matrix = twoPatches(0.8, 0.2, 0.2, 0.8);
    const MatrixQuality quality = assessMatrix(matrix, kArea);
    EXPECT_NEAR(quality.closureRms, 0.0, 1e-15);
    EXPECT_NEAR(quality.reciprocityRms, 0.0, 1e-15);
    EXPECT_NEAR(columnClosure(matrix, kArea).rms, 0.0, 1e-15);
}

TEST(MatrixQuality, RowsThatCloseMayStillMissTheColumns) {
    const FormFactorMatrix matrix = twoPatches(0.8, 0.25, 0.2, 0.75);
    const MatrixQuality quality = assessMatrix(matrix, kArea);
    EXPECT_NEAR(quality.closureRms, 0.0, 1e-15);
    // A F: 0.8 and 1; difference 0.2, mean 0.9.
    EXPECT_NEAR(quality.reciprocityRms, 0.2 / 0.9, 1e-12);
    EXPECT_NEAR(quality.reciprocityWorst, 0.2 / 1.0, 1e-12);
    // Column 0: 4 · 0.25 / 1 + 0.2 = 1.2; column 1: 0.8 / 4 + 0.75 = 0.95.
    const ColumnClosure columns = columnClosure(matrix, kArea);
    EXPECT_NEAR(static_cast<double>(columns.error[0]), 0.2, 1e-7);
    EXPECT_NEAR(static_cast<double>(columns.error[1]), 0.05, 1e-7);
    EXPECT_NEAR(columns.rms, std::sqrt((0.04 + 0.0025) / 2.0), 1e-12);
    // Too much arrives of patch 0, too little of patch 1, as much as A F differs.
    const std::vector<double> deficit = columnDeficit(matrix, kArea);
    EXPECT_NEAR(deficit[0], -0.2, 1e-12);
    EXPECT_NEAR(deficit[1], 0.2, 1e-12);
}

TEST(MatrixQuality, RowsThatDoNotCloseAreFound) {
    const MatrixQuality quality = assessMatrix(twoPatches(0.8, 0.2, 0.3, 0.8), kArea);
    EXPECT_NEAR(quality.closureRms, std::sqrt(0.01 / 2.0), 1e-12);
    EXPECT_NEAR(quality.closureWorst, 0.1, 1e-12);
    EXPECT_EQ(quality.worstRow, 0U);
    EXPECT_NEAR(quality.reciprocityRms, 0.0, 1e-15);
}

} // namespace
} // namespace lambert
