#include "core/random.h"
#include "formfactors/form_factor_matrix.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lambert {
namespace {

constexpr std::array kStorages{MatrixStorage::Double, MatrixStorage::Float, MatrixStorage::Compact};

double number(std::uint32_t k, std::uint32_t what) { return (philox({k, what, 0, 0}, 7)[0] + 0.5) * 0x1p-32; }

/// A row whose factors span 24 octaves, as a hemicube's do, with neighbouring and far patches.
FormFactorRow wideRow() {
    FormFactorRow row;
    std::uint32_t patch = 0;
    double sum = 0.0;
    for (std::uint32_t k = 0; k < 3000; ++k) {
        patch += k % 100 == 99 ? 1000 + k : 1 + static_cast<std::uint32_t>(3.0 * number(k, 0));
        row.entries.push_back({patch - 1, std::exp2(-24.0 * number(k, 1))});
        sum += row.entries.back().value;
    }
    for (FormFactor& entry : row.entries) entry.value *= 0.9 / sum;
    row.back = 0.04;
    row.out = 0.06;
    return row;
}

FormFactorRow stored(const FormFactorRow& row, MatrixStorage storage, double* bytesPerEntry = nullptr) {
    FormFactorMatrix matrix(3, storage);
    matrix.setRow(1, row);
    if (bytesPerEntry != nullptr)
        *bytesPerEntry = static_cast<double>(matrix.bytes()) / static_cast<double>(matrix.entryCount());
    return matrix.row(1);
}

TEST(FormFactorMatrix, GivesBackWhatWasStored) {
    const FormFactorRow row = wideRow();
    // Half a unit of the last place, or half a step of 2^(−1/2048) and what the scale moves to set the sum right.
    const std::array<double, 3> tolerance{0.0, 6e-8, 1.8e-4};
    for (std::size_t s = 0; s < 3; ++s) {
        const FormFactorRow found = stored(row, kStorages[s]);
        ASSERT_EQ(found.entries.size(), row.entries.size());
        for (std::size_t k = 0; k < row.entries.size(); ++k) {
            EXPECT_EQ(found.entries[k].patch, row.entries[k].patch);
            EXPECT_NEAR(found.entries[k].value / row.entries[k].value, 1.0, tolerance[s]);
        }
        EXPECT_EQ(found.back, row.back);
        EXPECT_EQ(found.out, row.out);
        EXPECT_NEAR(found.sum(), 1.0, 1e-6);
    }
}

TEST(FormFactorMatrix, CompactTakesThreeBytesPerFactor) {
    double bytes = 0.0;
    stored(wideRow(), MatrixStorage::Compact, &bytes);
    EXPECT_LT(bytes, 3.2); // 1 % of the steps need five bytes here, and there are the rows themselves
    stored(wideRow(), MatrixStorage::Float, &bytes);
    EXPECT_LT(bytes, 8.1);
}

TEST(FormFactorMatrix, CompactKeepsNumbersOfLinesExactly) {
    FormFactorRow row;
    row.lines = 70'001;
    for (std::uint32_t k = 0; k < 100; ++k) row.entries.push_back({7 * k, (1.0 + 13.0 * k) / row.lines});
    const FormFactorRow found = stored(row, MatrixStorage::Compact);
    ASSERT_EQ(found.entries.size(), row.entries.size());
    for (std::size_t k = 0; k < row.entries.size(); ++k)
        EXPECT_NEAR(found.entries[k].value / row.entries[k].value, 1.0, 1e-15);
    EXPECT_EQ(found.lines, row.lines);
    // One factor of more lines than a code holds: the row falls back to logarithms.
    row.entries.back().value = 66'000.0 / row.lines;
    EXPECT_NEAR(stored(row, MatrixStorage::Compact).entries.back().value / row.entries.back().value, 1.0, 1.8e-4);
}

TEST(FormFactorMatrix, HoldsTheFirstAndTheLastPatch) {
    FormFactorRow row;
    row.entries = {{0, 0.25}, {1, 0.125}, {256, 0.125}, {512, 0.25}, {0xFFFFFFF0, 0.25}};
    for (const MatrixStorage storage : kStorages) {
        const FormFactorRow found = stored(row, storage);
        ASSERT_EQ(found.entries.size(), row.entries.size());
        for (std::size_t k = 0; k < row.entries.size(); ++k) {
            EXPECT_EQ(found.entries[k].patch, row.entries[k].patch);
            EXPECT_NEAR(found.entries[k].value, row.entries[k].value, 1e-12); // powers of two have exact codes
        }
    }
}

TEST(FormFactorMatrix, EmptyRowsAreEmpty) {
    for (const MatrixStorage storage : kStorages) {
        const FormFactorMatrix matrix(2, storage);
        EXPECT_TRUE(matrix.row(0).entries.empty());
        FormFactorRow row;
        row.out = 1.0;
        EXPECT_EQ(stored(row, storage).sum(), 1.0);
    }
}

TEST(FormFactorMatrix, RowsSurviveAsBytes) {
    for (const MatrixStorage storage : kStorages) {
        FormFactorMatrix matrix(2, storage);
        matrix.setRow(0, wideRow());
        std::vector<std::byte> bytes;
        matrix.appendBytes(0, bytes);
        ASSERT_TRUE(matrix.setBytes(1, bytes));
        EXPECT_EQ(matrix.row(1), matrix.row(0));
        EXPECT_FALSE(matrix.setBytes(1, std::span(bytes).first(20)));
        EXPECT_FALSE(matrix.setBytes(1, std::span(bytes).first(bytes.size() / 2)));
    }
}

TEST(FormFactorMatrix, StoragesHaveNames) {
    EXPECT_EQ(storageByName("compact"), MatrixStorage::Compact);
    EXPECT_EQ(storageByName("half"), std::nullopt);
}

} // namespace
} // namespace lambert
