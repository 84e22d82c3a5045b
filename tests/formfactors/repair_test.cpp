#include "formfactors/repair.h"

#include "core/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace lambert {
namespace {

double number(std::uint32_t i, std::uint32_t j) { return (philox({i, j, 0, 0}, 5)[0] + 0.5) * 0x1p-32; }

struct Case {
    FormFactorMatrix matrix;
    std::vector<float> area;
    std::vector<double> weight;
};

/// A reciprocal matrix whose rows sum to 1 − remainder, with every factor then off by up to `noise`.
Case noisy(std::uint32_t count, double noise, double remainder) {
    Case result{FormFactorMatrix(count, MatrixStorage::Double), {}, {}};
    // Any symmetric positive X gives areas for which rows close: A_i = Σ_j X_ij / (1 − remainder).
    const auto exchange = [](std::uint32_t i, std::uint32_t j) {
        return i == j || (i + j) % 3 == 0 ? 0.0 : 0.1 + number(std::min(i, j), std::max(i, j));
    };
    for (std::uint32_t i = 0; i < count; ++i) {
        double area = 0.0;
        for (std::uint32_t j = 0; j < count; ++j) area += exchange(i, j) / (1.0 - remainder);
        result.area.push_back(static_cast<float>(area));
        result.weight.push_back(1.0 / area);
        FormFactorRow row;
        for (std::uint32_t j = 0; j < count; ++j)
            if (const double x = exchange(i, j); x > 0.0)
                row.entries.push_back({j, x / area * (1.0 + noise * (2.0 * number(i + 100, j) - 1.0))});
        row.out = remainder;
        result.matrix.setRow(i, row);
    }
    return result;
}

void expectReciprocalAndClosed(const Case& c, double tolerance) {
    for (std::uint32_t i = 0; i < c.matrix.size(); ++i) {
        EXPECT_NEAR(c.matrix.row(i).sum(), 1.0, tolerance);
        c.matrix.visit(i, [&](std::uint32_t j, double factor) {
            double mirrored = 0.0;
            c.matrix.visit(j, [&](std::uint32_t k, double f) { mirrored += k == i ? f : 0.0; });
            const double ours = static_cast<double>(c.area[i]) * factor;
            EXPECT_NEAR(static_cast<double>(c.area[j]) * mirrored / ours, 1.0, 1e-12);
        });
    }
}

TEST(Repair, MakesRowsReciprocalAndClosed) {
    for (const double remainder : {0.0, 0.3}) {
        Case c = noisy(40, 0.2, remainder);
        const RepairReport report = repair(c.matrix, c.area, c.weight);
        EXPECT_TRUE(report.failed.empty());
        EXPECT_LE(report.remainingError, 1e-6);
        EXPECT_GT(report.largestCorrection, 1e-4);
        EXPECT_LT(report.largestCorrection, 0.2); // no factor moves farther than the noise
        EXPECT_GT(report.reciprocityError, 0.05);
        EXPECT_GT(report.rowChange, 0.01);
        EXPECT_LT(report.rowChange, 0.2);
        expectReciprocalAndClosed(c, 1.1e-6);
    }
}

TEST(Repair, LeavesARightMatrixAlone) {
    Case c = noisy(20, 0.0, 0.1);
    const FormFactorMatrix& matrix = c.matrix;
    std::vector<FormFactorRow> before;
    for (std::size_t i = 0; i < matrix.size(); ++i) before.push_back(matrix.row(i));
    const RepairReport report = repair(c.matrix, c.area, c.weight);
    EXPECT_EQ(report.iterations, 0);
    EXPECT_LT(report.reciprocityError, 1e-6); // the areas are floats
    EXPECT_LT(report.rowChange, 1e-6);
    for (std::size_t i = 0; i < before.size(); ++i)
        for (std::size_t k = 0; k < before[i].entries.size(); ++k)
            EXPECT_NEAR(matrix.row(i).entries[k].value / before[i].entries[k].value, 1.0, 1e-6);
}

/// Two patches of which each sees the other or leaves the scene.
FormFactorMatrix twoPatches(double f01, double f10) {
    FormFactorMatrix matrix(2, MatrixStorage::Double);
    const auto set = [&](std::size_t i, std::uint32_t j, double value) {
        FormFactorRow row;
        if (value > 0.0) row.entries = {{j, value}};
        row.out = 1.0 - value;
        matrix.setRow(i, row);
    };
    set(0, 1, f01);
    set(1, 0, f10);
    return matrix;
}

// X = (N_ij + N_ji) / (N_i/A_i + N_j/A_j): two patches, 30 of 100 lines and 10 of 50.
TEST(Repair, MergesLinesByTheirNumber) {
    FormFactorMatrix matrix = twoPatches(0.3, 0.2);
    const std::vector<float> area{2.0F, 4.0F};
    const std::vector<double> weight{100.0 / 2.0, 50.0 / 4.0};
    const RepairReport report = repair(matrix, area, weight, {.maxIterations = 0});
    const double exchange = (30.0 + 10.0) / (100.0 / 2.0 + 50.0 / 4.0);
    EXPECT_NEAR(matrix.row(0).entries[0].value, exchange / 2.0, 1e-15);
    EXPECT_NEAR(matrix.row(1).entries[0].value, exchange / 4.0, 1e-15);
    const double changed = 2.0 * std::abs(exchange / 2.0 - 0.3) + 4.0 * std::abs(exchange / 4.0 - 0.2);
    EXPECT_NEAR(report.rowChange, changed / 6.0, 1e-15);
}

TEST(Repair, APairSeenFromOneSideOnlyIsSeenFromBoth) {
    FormFactorMatrix matrix = twoPatches(0.5, 0.0);
    const std::vector<float> area{1.0F, 1.0F};
    const std::vector<double> weight{1.0, 1.0};
    const RepairReport report = repair(matrix, area, weight, {.maxIterations = 0});
    ASSERT_EQ(matrix.row(1).entries.size(), 1U);
    EXPECT_EQ(matrix.row(1).entries[0].value, matrix.row(0).entries[0].value);
    EXPECT_NEAR(report.rowChange, 0.25, 1e-15); // of each: half of 0.5 more or less
}

TEST(Repair, ReportsRowsThatCannotClose) {
    // Patch 2 sees nothing although nothing leaves it either.
    Case c = noisy(5, 0.1, 0.0);
    FormFactorMatrix matrix(6, MatrixStorage::Double);
    for (std::size_t i = 0; i < 5; ++i) matrix.setRow(i, c.matrix.row(i));
    c.area.push_back(1.0F);
    c.weight.push_back(1.0);
    const RepairReport report = repair(matrix, c.area, c.weight, {.maxIterations = 300});
    EXPECT_EQ(report.failed, (std::vector<std::size_t>{5}));
}

} // namespace
} // namespace lambert
