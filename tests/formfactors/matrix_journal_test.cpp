#include "core/error.h"
#include "formfactors/matrix_journal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <memory>

namespace lambert {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPatches = 40;

FormFactorRow sampleRow(std::size_t i) {
    FormFactorRow row;
    for (std::uint32_t j = 0; j < kPatches; j += 1 + static_cast<std::uint32_t>(i) % 3)
        row.entries.push_back({j, 0.5 / static_cast<double>(kPatches + i + j)});
    row.back = 0.01 * static_cast<double>(i);
    row.out = 1.0 - row.sum();
    return row;
}

class Journal : public testing::TestWithParam<MatrixStorage> {
protected:
    Journal() { fs::remove(path_); }
    ~Journal() override { fs::remove(path_); }

    std::unique_ptr<MatrixJournal> open(bool resume, const std::string& identity = "one") const {
        return std::make_unique<MatrixJournal>(CheckpointOptions{path_, resume, 1e6}, identity);
    }
    /// Enters the even rows.
    void writeHalf() const {
        FormFactorMatrix matrix(kPatches, GetParam());
        const auto journal = open(false);
        for (std::size_t i = 0; i < kPatches; i += 2) {
            matrix.setRow(i, sampleRow(i));
            journal->add(matrix, i);
        }
        journal->flush(matrix);
    }
    /// Rows that a journal restores, all of which are as they were.
    std::size_t restoredRows() const {
        FormFactorMatrix expected(kPatches, GetParam());
        FormFactorMatrix matrix(kPatches, GetParam());
        const std::vector<bool> restored = open(true)->restore(matrix);
        for (std::size_t i = 0; i < kPatches; ++i) {
            expected.setRow(i, sampleRow(i));
            if (restored[i]) {
                EXPECT_EQ(matrix.row(i), expected.row(i)) << i;
            }
        }
        return static_cast<std::size_t>(std::count(restored.begin(), restored.end(), true));
    }

    const fs::path path_ =
        fs::temp_directory_path() / ("lambert-journal-" + std::to_string(static_cast<int>(GetParam())) + "-" +
                                     testing::UnitTest::GetInstance()->current_test_info()->test_suite_name()[0]);
};

TEST_P(Journal, GivesBackTheRowsThatWereWritten) {
    writeHalf();
    EXPECT_EQ(restoredRows(), kPatches / 2);
}

TEST_P(Journal, AnEndCutAnywhereLosesOnlyWhatStandsAfterTheCut) {
    writeHalf();
    const auto size = fs::file_size(path_);
    std::size_t before = kPatches / 2;
    for (auto cut = size; cut-- > 0;) {
        if (cut % 7 != 0 && cut > 100) continue; // every seventh byte, and every one of the header
        fs::resize_file(path_, cut);
        const std::size_t rows = restoredRows();
        EXPECT_LE(rows, before);
        before = rows;
    }
    EXPECT_EQ(before, 0U);
}

TEST_P(Journal, AChangedByteIsNoRow) {
    writeHalf();
    std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
    const auto middle = static_cast<std::streamoff>(fs::file_size(path_) / 2);
    file.seekg(middle);
    const char byte = static_cast<char>(file.get() ^ 1);
    file.seekp(middle);
    file.put(byte);
    file.close();
    const std::size_t rows = restoredRows();
    EXPECT_GT(rows, 0U);
    EXPECT_LT(rows, kPatches / 2);
}

TEST_P(Journal, RefusesWhatIsAnothers) {
    writeHalf();
    EXPECT_THROW(open(false), UsageError);         // nothing is overwritten
    EXPECT_THROW(open(true, "other"), UsageError); // of another computation
    EXPECT_THROW(open(true, "on"), UsageError);
    const auto held = open(true);
    EXPECT_THROW(open(true), UsageError); // in use
    held->remove();
    EXPECT_FALSE(fs::exists(path_));
}

INSTANTIATE_TEST_SUITE_P(Storages, Journal,
                         testing::Values(MatrixStorage::Double, MatrixStorage::Float, MatrixStorage::Compact));

} // namespace
} // namespace lambert
