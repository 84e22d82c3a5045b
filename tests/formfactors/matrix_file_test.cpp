#include "core/error.h"
#include "core/random.h"
#include "formfactors/matrix_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

namespace lambert {
namespace {

namespace fs = std::filesystem;

double number(std::uint32_t i, std::uint32_t j) { return (philox({i, j, 0, 0}, 3)[0] + 0.5) * 0x1p-32; }

/// Some pairs see each other, rows sum to 0.9 and lose 0.04 to backs.
PatchMatrix sample(std::size_t count) {
    PatchMatrix result{FormFactorMatrix(count, MatrixStorage::Double), {}, {}};
    for (std::uint32_t i = 0; i < count; ++i) {
        FormFactorRow row;
        double sum = 0.0;
        for (std::uint32_t j = 0; j < count; ++j) {
            if (number(i, j) < 0.3) continue;
            row.entries.push_back({j, number(j, i) / 3.0});
            sum += row.entries.back().value;
        }
        for (FormFactor& entry : row.entries) entry.value *= 0.9 / sum;
        row.back = 0.04;
        row.out = 0.06;
        result.matrix.setRow(i, row);
        result.area.push_back(0.5 + number(i, i));
    }
    return result;
}

class MatrixFile : public testing::Test {
protected:
    MatrixFile() { fs::create_directories(folder_); }
    ~MatrixFile() override { fs::remove_all(folder_); }

    Progress progress_;

    fs::path path(const std::string& name) const { return folder_ / name; }

    void write(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }

    std::string refusal(const std::string& name, const std::string& text) const {
        write(name, text);
        try {
            readMatrix(path(name));
        } catch (const InputError& error) {
            return error.what();
        }
        return "read";
    }

private:
    fs::path folder_ = fs::temp_directory_path() /
                       ("lambert-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(MatrixFile, ExactFormatsGiveBackTheSameBits) {
    const PatchMatrix original = sample(37);
    for (const char* name : {"m.mtx", "m.npy", "M.NPY"}) {
        writeMatrix(path(name), original, "a test", progress_);
        const PatchMatrix found = readMatrix(path(name));
        ASSERT_EQ(found.matrix.size(), 37U) << name;
        EXPECT_EQ(found.area, original.area) << name;
        for (std::size_t i = 0; i < 37; ++i) EXPECT_EQ(found.matrix.row(i), original.matrix.row(i)) << name;
    }
}

TEST_F(MatrixFile, CsvKeepsNineDigits) {
    const PatchMatrix original = sample(12);
    writeMatrix(path("m.csv"), original, "a test", progress_);
    const PatchMatrix found = readMatrix(path("m.csv"));
    for (std::size_t i = 0; i < 12; ++i) {
        const FormFactorRow a = original.matrix.row(i), b = found.matrix.row(i);
        ASSERT_EQ(a.entries.size(), b.entries.size());
        for (std::size_t k = 0; k < a.entries.size(); ++k)
            EXPECT_NEAR(b.entries[k].value / a.entries[k].value, 1.0, 5e-9);
        EXPECT_EQ(a.back, b.back);
    }
}

TEST_F(MatrixFile, View3DKeepsSinglePrecisionAndEmissivities) {
    PatchMatrix original = sample(9);
    original.emissivity.assign(9, 0.8F);
    // In single precision from the start, it must come back to the bit.
    for (double& area : original.area) area = static_cast<float>(area);
    for (std::size_t i = 0; i < 9; ++i) {
        FormFactorRow row = original.matrix.row(i);
        for (FormFactor& entry : row.entries) entry.value = static_cast<float>(entry.value);
        row.back = 0.0; // View3D knows no remainders: what is missing left the scene
        row.out = 0.0;
        row.out = 1.0 - row.sum();
        original.matrix.setRow(i, row);
    }
    writeMatrix(path("m.txt"), original, "a test", progress_);
    const auto floats = [](double value) { return static_cast<float>(value); };
    const PatchMatrix found = readMatrix(path("m.txt"));
    ASSERT_EQ(found.matrix.size(), 9U);
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_EQ(floats(found.area[i]), floats(original.area[i]));
        EXPECT_EQ(floats(found.emissivity[i]), 0.8F);
        const FormFactorRow a = original.matrix.row(i), b = found.matrix.row(i);
        ASSERT_EQ(a.entries.size(), b.entries.size());
        for (std::size_t k = 0; k < a.entries.size(); ++k)
            EXPECT_EQ(floats(a.entries[k].value), floats(b.entries[k].value));
    }
    std::ifstream file(path("m.txt"));
    std::string header;
    std::getline(file, header);
    EXPECT_EQ(header, "View3D 3.2 0 0 0 9            ");
}

TEST_F(MatrixFile, View3DNumbersMayBreakIntoLinesAnywhere) {
    write("v.txt", "View3D 3.2 0 1 0 2\n 1.0\n2.0\n0 1\n0.5\n\n0\n0.9 0.7\n");
    const PatchMatrix found = readMatrix(path("v.txt"));
    EXPECT_EQ(found.area, (std::vector<double>{1.0, 2.0}));
    EXPECT_EQ(found.matrix.row(1).entries, (std::vector<FormFactor>{{0, 0.5}}));
    EXPECT_EQ(found.matrix.out(1), 0.5);
    EXPECT_EQ(found.emissivity, (std::vector<double>{0.9, 0.7}));
}

TEST_F(MatrixFile, MatrixMarketEntriesMayComeInAnyOrder) {
    write("m.mtx", "%%MatrixMarket matrix coordinate real general\n% note\n2 2 2\n2 1 0.25\n1 2 0.5\n");
    const PatchMatrix found = readMatrix(path("m.mtx"));
    EXPECT_EQ(found.matrix.row(0).entries, (std::vector<FormFactor>{{1, 0.5}}));
    EXPECT_EQ(found.matrix.out(1), 0.75);
    EXPECT_TRUE(found.area.empty());
}

TEST_F(MatrixFile, RefusalsNameFileLineAndWhatIsAllowed) {
    const std::string head = "%%MatrixMarket matrix coordinate real general\n";
    const auto expectIn = [](const std::string& message, const std::string& part) {
        EXPECT_NE(message.find(part), std::string::npos) << message;
    };
    expectIn(refusal("a.mtx", "hello\n"), "a.mtx:1: found \"hello\"");
    expectIn(refusal("a.mtx", head + "2 3 1\n1 1 .5\n"), "a square matrix");
    expectIn(refusal("a.mtx", head + "2 2 9\n1 1 .5\n"), "at most rows times columns");
    expectIn(refusal("a.mtx", head + "2 2 2\n1 1 .5\n"), "the file's end, expected 2 entries");
    expectIn(refusal("a.mtx", head + "2 2 1\n1 3 .5\n"), ":3: found \"3\", expected a column's number");
    expectIn(refusal("a.mtx", head + "2 2 1\n1 1 nan\n"), "found \"nan\", expected a form factor");
    expectIn(refusal("a.mtx", head + "2 2 1\n1 1 -0.5\n"), "found \"-0.5\"");
    expectIn(refusal("a.mtx", head + "4000000000 4000000000 3\n"), "expected a form-factor matrix");
    expectIn(refusal("a.csv", "0,1\n1,0,0\n"), "more columns");
    expectIn(refusal("a.csv", "0,1\n"), "expected 2 rows");
    expectIn(refusal("a.txt", "View3D 3.2 0 1 0 4000000000\n"), "a header like");
    expectIn(refusal("a.txt", "View3D 3.2 0 1 0 2\n1 1\n0 1\n"), "more numbers");
    expectIn(refusal("a.npy", "not numpy at all"), "no NumPy file");
    EXPECT_THROW(readMatrix(path("missing.mtx")), InputError);
    EXPECT_THROW(readMatrix(path("m.xyz")), UsageError);
}

TEST_F(MatrixFile, ADenseCsvOfManyPatchesIsRefused) {
    PatchMatrix large{FormFactorMatrix(kMostDenseCsv + 1), std::vector<double>(kMostDenseCsv + 1, 1.0), {}};
    EXPECT_THROW(writeMatrix(path("m.csv"), large, "", progress_), UsageError);
    EXPECT_FALSE(fs::exists(path("m.csv")));
}

TEST_F(MatrixFile, LargeNumPyMatricesAreThreeSparseArrays) {
    PatchMatrix large{FormFactorMatrix(kMostDenseNumPy + 1), {}, {}};
    for (std::uint32_t i = 0; i < large.matrix.size(); ++i) {
        FormFactorRow row;
        row.entries = {{i / 2, 0.25F}, {i / 2 + 7, 0.5F}};
        row.out = 0.25;
        large.matrix.setRow(i, row);
        large.area.push_back(1.0);
    }
    writeMatrix(path("m.npy"), large, "", progress_);
    EXPECT_FALSE(fs::exists(path("m.npy")));
    for (const fs::path& file : matrixFiles(path("m.npy"), large.matrix.size())) EXPECT_TRUE(fs::exists(file)) << file;
    const PatchMatrix found = readMatrix(path("m.npy"));
    ASSERT_EQ(found.matrix.size(), large.matrix.size());
    for (const std::size_t i : {std::size_t{0}, std::size_t{777}, kMostDenseNumPy})
        EXPECT_EQ(found.matrix.row(i), large.matrix.row(i));
}

} // namespace
} // namespace lambert
