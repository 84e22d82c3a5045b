#include "core/error.h"
#include "core/whole_file.h"
#include "formfactors/matrix_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <ostream>
#include <utility>

namespace lambert {

namespace fs = std::filesystem;

namespace {

/// Collects small pieces into blocks.
class BlockWriter {
public:
    explicit BlockWriter(std::ostream& stream) : stream_(stream) {}

    template <typename... Arguments>
    void text(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
        fmt::format_to(std::back_inserter(block_), format, std::forward<Arguments>(arguments)...);
        if (block_.size() > kBlock) flush();
    }

    /// Little-endian, as NumPy's '<'.
    template <typename Number>
    void binary(Number number) {
        static_assert(std::endian::native == std::endian::little);
        const auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(number);
        block_.append(bytes.data(), bytes.data() + bytes.size());
        if (block_.size() > kBlock) flush();
    }

    void flush() {
        stream_.write(block_.data(), static_cast<std::streamsize>(block_.size()));
        block_.clear();
    }

private:
    static constexpr std::size_t kBlock = 1 << 20;
    std::ostream& stream_;
    fmt::memory_buffer block_;
};

void writeBlocks(const fs::path& path, const std::function<void(BlockWriter&)>& write) {
    writeWholeFile(path, [&](std::ostream& stream) {
        BlockWriter writer(stream);
        write(writer);
        writer.flush();
    });
}

/// A row with its zeros.
void fillRow(const FormFactorMatrix& matrix, std::size_t i, std::vector<double>& row) {
    row.assign(matrix.size(), 0.0);
    matrix.visit(i, [&](std::uint32_t j, double factor) { row[j] = factor; });
}

void writeMatrixMarket(BlockWriter& out, const FormFactorMatrix& matrix, const std::string& comment) {
    out.text("%%MatrixMarket matrix coordinate real general\n% {}\n", comment);
    out.text("{} {} {}\n", matrix.size(), matrix.size(), matrix.entryCount());
    for (std::size_t i = 0; i < matrix.size(); ++i)
        matrix.visit(i, [&](std::uint32_t j, double factor) { out.text("{} {} {}\n", i + 1, j + 1, factor); });
}

void writeCsv(BlockWriter& out, const FormFactorMatrix& matrix, const std::string& comment) {
    out.text("# {}\n", comment);
    std::vector<double> row;
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        fillRow(matrix, i, row);
        for (std::size_t j = 0; j < row.size(); ++j) out.text("{}{:.9g}", j == 0 ? "" : ",", row[j]);
        out.text("\n");
    }
}

/// View3D holds single precision. Its header is a line of 30 characters: program, version, format, whether the surfaces
/// form an enclosure, whether emittances are included in the factors, number of surfaces.
void writeView3D(BlockWriter& out, const PatchMatrix& patches) {
    const FormFactorMatrix& matrix = patches.matrix;
    double open = 0.0;
    for (std::size_t i = 0; i < matrix.size(); ++i) open = std::max(open, matrix.out(i) + matrix.back(i));
    out.text("{:<30}\n", fmt::format("View3D 3.2 0 {} 0 {}", open > 1e-3 ? 0 : 1, matrix.size()));
    for (std::size_t i = 0; i < matrix.size(); ++i)
        out.text("{}{}", i == 0 ? "" : " ", static_cast<float>(patches.area[i]));
    out.text("\n");
    std::vector<double> row;
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        fillRow(matrix, i, row);
        for (std::size_t j = 0; j < row.size(); ++j) out.text("{}{}", j == 0 ? "" : " ", static_cast<float>(row[j]));
        out.text("\n");
    }
    for (std::size_t i = 0; i < matrix.size(); ++i)
        out.text("{}{}", i == 0 ? "" : " ",
                 patches.emissivity.empty() ? 1.0F : static_cast<float>(patches.emissivity[i]));
    out.text("\n");
}

/// Version 1.0 of the .npy format: magic, header length, a Python dictionary padded to a multiple of 64 bytes.
void writeNumPyHeader(BlockWriter& out, std::string_view type, const std::string& shape) {
    std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, shape);
    const std::size_t before = 10;
    header.append(63 - (before + header.size()) % 64, ' ');
    header += '\n';
    out.text("\x93NUMPY\x01");
    out.binary('\0');
    out.binary(static_cast<std::uint16_t>(header.size()));
    out.text("{}", header);
}

void writeDenseNumPy(BlockWriter& out, const FormFactorMatrix& matrix) {
    writeNumPyHeader(out, "<f8", fmt::format("{}, {}", matrix.size(), matrix.size()));
    std::vector<double> row;
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        fillRow(matrix, i, row);
        for (const double factor : row) out.binary(factor);
    }
}

/// The three arrays of scipy.sparse.csr_matrix.
void writeSparseNumPy(const std::vector<fs::path>& files, const FormFactorMatrix& matrix) {
    const std::string entries = fmt::format("{},", matrix.entryCount());
    writeBlocks(files[0], [&](BlockWriter& out) {
        writeNumPyHeader(out, "<f8", entries);
        for (std::size_t i = 0; i < matrix.size(); ++i)
            matrix.visit(i, [&](std::uint32_t, double factor) { out.binary(factor); });
    });
    writeBlocks(files[1], [&](BlockWriter& out) {
        writeNumPyHeader(out, "<i8", entries);
        for (std::size_t i = 0; i < matrix.size(); ++i)
            matrix.visit(i, [&](std::uint32_t j, double) { out.binary(static_cast<std::int64_t>(j)); });
    });
    writeBlocks(files[2], [&](BlockWriter& out) {
        writeNumPyHeader(out, "<i8", fmt::format("{},", matrix.size() + 1));
        std::int64_t end = 0;
        out.binary(end);
        for (std::size_t i = 0; i < matrix.size(); ++i) {
            matrix.visit(i, [&](std::uint32_t, double) { ++end; });
            out.binary(end);
        }
    });
}

void writeAreas(BlockWriter& out, const PatchMatrix& patches) {
    out.text("# area,F_back,F_out\n");
    for (std::size_t i = 0; i < patches.matrix.size(); ++i)
        out.text("{},{},{}\n", patches.area[i], patches.matrix.back(i), patches.matrix.out(i));
}

fs::path appended(const fs::path& path, const char* end) { return fs::path(path.string() + end); }

} // namespace

std::optional<MatrixFormat> matrixFormatOf(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    constexpr std::array<std::pair<std::string_view, MatrixFormat>, 4> known{{{".mtx", MatrixFormat::MatrixMarket},
                                                                              {".npy", MatrixFormat::NumPy},
                                                                              {".csv", MatrixFormat::Csv},
                                                                              {".txt", MatrixFormat::View3D}}};
    for (const auto& [name, format] : known)
        if (name == extension) return format;
    return std::nullopt;
}

std::vector<fs::path> matrixFiles(const fs::path& path, std::size_t patches) {
    const auto format = matrixFormatOf(path);
    std::vector<fs::path> files{path};
    if (format == MatrixFormat::NumPy && patches > kMostDenseNumPy) {
        const fs::path stem = fs::path(path).replace_extension();
        files = {appended(stem, ".data.npy"), appended(stem, ".indices.npy"), appended(stem, ".indptr.npy")};
    }
    if (format != MatrixFormat::View3D) files.push_back(appended(path, ".areas.csv"));
    return files;
}

void writeMatrix(const fs::path& path, const PatchMatrix& patches, const std::string& comment) {
    const auto format = matrixFormatOf(path);
    if (!format)
        throw UsageError(fmt::format("{}: found the extension \"{}\", allowed are .mtx, .npy, .csv and .txt (View3D)",
                                     path.string(), path.extension().string()));
    const FormFactorMatrix& matrix = patches.matrix;
    if (format == MatrixFormat::Csv && matrix.size() > kMostDenseCsv)
        throw UsageError(fmt::format("{}: a dense CSV of {} patches is too large, allowed are {}; use .mtx or .npy",
                                     path.string(), matrix.size(), kMostDenseCsv));
    const std::vector<fs::path> files = matrixFiles(path, matrix.size());
    switch (*format) {
    case MatrixFormat::MatrixMarket:
        writeBlocks(path, [&](BlockWriter& out) { writeMatrixMarket(out, matrix, comment); });
        break;
    case MatrixFormat::Csv:
        writeBlocks(path, [&](BlockWriter& out) { writeCsv(out, matrix, comment); });
        break;
    case MatrixFormat::View3D:
        writeBlocks(path, [&](BlockWriter& out) { writeView3D(out, patches); });
        break;
    case MatrixFormat::NumPy:
        if (files.front() == path)
            writeBlocks(path, [&](BlockWriter& out) { writeDenseNumPy(out, matrix); });
        else
            writeSparseNumPy(files, matrix);
        break;
    }
    if (format != MatrixFormat::View3D) writeBlocks(files.back(), [&](BlockWriter& out) { writeAreas(out, patches); });
}

} // namespace lambert
