#include "formfactors/identities.h"

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

TEST(MatrixIdentities, AnExactMatrixKeepsAll) {
    const std::array area{1.0F, 4.0F};
    const MatrixIdentities found = matrixIdentities(twoPatches(0.8, 0.2, 0.2, 0.8), area);
    EXPECT_NEAR(found.rowClosureRms, 0.0, 1e-15);
    EXPECT_NEAR(found.columnClosureRms, 0.0, 1e-15);
    EXPECT_NEAR(found.reciprocity, 0.0, 1e-15);
}

TEST(MatrixIdentities, RowsThatCloseMayStillMissTheColumns) {
    const std::array area{1.0F, 4.0F};
    const MatrixIdentities found = matrixIdentities(twoPatches(0.8, 0.25, 0.2, 0.75), area);
    EXPECT_NEAR(found.rowClosureRms, 0.0, 1e-15);
    // Column 0: 4 · 0.25 / 1 + 0.2 = 1.2; column 1: 0.8 / 4 + 0.75 = 0.95.
    EXPECT_NEAR(static_cast<double>(found.columnClosure[0]), 0.2, 1e-7);
    EXPECT_NEAR(static_cast<double>(found.columnClosure[1]), 0.05, 1e-7);
    EXPECT_NEAR(found.columnClosureRms, std::sqrt((0.04 + 4.0 * 0.0025) / 5.0), 1e-8);
    // A F: 0.8 and 1; difference 0.2, mean 0.9.
    EXPECT_NEAR(found.reciprocity, 0.2 / 0.9, 1e-12);
}

TEST(MatrixIdentities, RowsThatDoNotCloseAreFound) {
    const std::array area{1.0F, 4.0F};
    const MatrixIdentities found = matrixIdentities(twoPatches(0.8, 0.2, 0.3, 0.8), area);
    EXPECT_NEAR(static_cast<double>(found.rowClosure[0]), 0.1, 1e-7);
    EXPECT_NEAR(found.rowClosureRms, std::sqrt(0.01 / 5.0), 1e-8);
    EXPECT_NEAR(found.reciprocity, 0.0, 1e-15);
}

} // namespace
} // namespace lambert
