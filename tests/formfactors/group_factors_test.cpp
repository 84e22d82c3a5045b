#include "formfactors/group_factors.h"

#include <gtest/gtest.h>

#include <array>

namespace lambert {
namespace {

/// Two patches of 1 and 4 m², each a group: A F is 0.8 m² one way and 4 · f10 the other.
GroupFactors twoGroups(double f10, double out1) {
    FormFactorMatrix matrix(2, MatrixStorage::Double);
    matrix.setRow(0, {{{1, 0.8}}, 0.0, 0.2, 0});
    matrix.setRow(1, {{{0, f10}}, 0.0, out1, 0});
    return groupFactors(matrix, std::array{1.0F, 4.0F}, std::array{0U, 1U}, 2);
}

TEST(GroupFactors, OfAnExactMatrixSumToOneAndAreReciprocal) {
    const GroupFactors factors = twoGroups(0.2, 0.8);
    const GroupReciprocity reciprocity = groupReciprocity(factors);
    for (std::size_t group = 0; group < 2; ++group) {
        EXPECT_NEAR(factors.rowSum(group), 1.0, 1e-15);
        EXPECT_NEAR(reciprocity.largest[group], 0.0, 1e-15);
    }
    EXPECT_NEAR(reciprocity.rms, 0.0, 1e-15);
}

TEST(GroupFactors, TellWhichRowDoesNotSumToOne) {
    const GroupFactors factors = twoGroups(0.2, 0.7);
    EXPECT_NEAR(factors.rowSum(0), 1.0, 1e-15);
    EXPECT_NEAR(factors.rowSum(1), 0.9, 1e-15);
}

TEST(GroupFactors, TellWhichPairIsNotReciprocal) {
    const GroupFactors factors = twoGroups(0.25, 0.75);
    const GroupReciprocity reciprocity = groupReciprocity(factors);
    const double error = 0.2 / 0.9; // 0.8 and 1 m²
    EXPECT_NEAR(factors.reciprocityError(0, 1), error, 1e-15);
    EXPECT_NEAR(reciprocity.largest[0], error, 1e-15);
    EXPECT_NEAR(reciprocity.largest[1], error, 1e-15);
    EXPECT_NEAR(reciprocity.rms, error, 1e-15);
    EXPECT_NE(reciprocity.a, reciprocity.b);
}

TEST(GroupFactors, WithoutAreaHaveNoSum) {
    FormFactorMatrix matrix(1, MatrixStorage::Double);
    matrix.setRow(0, {{}, 0.0, 1.0, 0});
    const GroupFactors factors = groupFactors(matrix, std::array{1.0F}, std::array{kNoGroup}, 1);
    EXPECT_EQ(factors.rowSum(0), 0.0);
    EXPECT_EQ(groupReciprocity(factors).rms, 0.0);
}

} // namespace
} // namespace lambert
