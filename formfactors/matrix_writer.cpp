#include "core/error.h"
#include "core/named.h"
#include "core/text.h"
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

/// What a file will hold.
using Content = std::function<void(BlockWriter&)>;

FileStream fileOf(const fs::path& path, Content write) {
    return {path, [write = std::move(write)](std::ostream& stream) {
                BlockWriter writer(stream);
                write(writer);
                writer.flush();
            }};
}

/// The rows of a matrix on their way to a file: of `columns` columns each.
struct Rows {
    const FormFactorMatrix& matrix;
    std::size_t columns;
    Progress& progress;

    std::size_t size() const { return matrix.size(); }
    template <typename Use>
    void visit(std::size_t i, Use&& use) const {
        progress.throwIfCancelled();
        matrix.visit(i, use);
    }
};

/// How many entries visit() shows: compact storage leaves out what it rounded to 0.
std::uint64_t shownEntries(const Rows& rows) {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) rows.visit(i, [&](std::uint32_t, double) { ++count; });
    return count;
}

/// A row with its zeros.
void fillRow(const Rows& rows, std::size_t i, std::vector<double>& row) {
    row.assign(rows.columns, 0.0);
    rows.visit(i, [&](std::uint32_t j, double factor) { row[j] = factor; });
}

void writeMatrixMarket(BlockWriter& out, const Rows& rows, const std::string& comment) {
    out.text("%%MatrixMarket matrix coordinate real general\n% {}\n", comment);
    out.text("{} {} {}\n", rows.size(), rows.columns, shownEntries(rows));
    for (std::size_t i = 0; i < rows.size(); ++i)
        rows.visit(i, [&](std::uint32_t j, double factor) { out.text("{} {} {}\n", i + 1, j + 1, factor); });
}

void writeCsv(BlockWriter& out, const Rows& rows, const std::string& comment) {
    out.text("# {}\n", comment);
    std::vector<double> row;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        fillRow(rows, i, row);
        for (std::size_t j = 0; j < row.size(); ++j) out.text("{}{:.9g}", j == 0 ? "" : ",", row[j]);
        out.text("\n");
    }
}

/// View3D holds single precision. Its header is a line of 30 characters: program, version, format, whether the surfaces
/// form an enclosure, whether emittances are included in the factors, number of surfaces.
void writeView3D(BlockWriter& out, const PatchMatrix& patches, const Rows& rows) {
    const FormFactorMatrix& matrix = patches.matrix;
    double open = 0.0;
    for (std::size_t i = 0; i < matrix.size(); ++i) open = std::max(open, matrix.out(i) + matrix.back(i));
    out.text("{:<30}\n", fmt::format("View3D 3.2 0 {} 0 {}", open > 1e-3 ? 0 : 1, matrix.size()));
    for (std::size_t i = 0; i < matrix.size(); ++i)
        out.text("{}{}", i == 0 ? "" : " ", static_cast<float>(patches.area[i]));
    out.text("\n");
    std::vector<double> row;
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        fillRow(rows, i, row);
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

void writeDenseNumPy(BlockWriter& out, const Rows& rows) {
    writeNumPyHeader(out, "<f8", fmt::format("{}, {}", rows.size(), rows.columns));
    std::vector<double> row;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        fillRow(rows, i, row);
        for (const double factor : row) out.binary(factor);
    }
}

/// The three arrays of scipy.sparse.csr_matrix.
std::vector<FileStream> sparseNumPy(const std::vector<fs::path>& files, const Rows& rows) {
    const auto array = [&rows](const char* type, auto write) {
        return [=, &rows](BlockWriter& out) {
            writeNumPyHeader(out, type, fmt::format("{},", shownEntries(rows)));
            for (std::size_t i = 0; i < rows.size(); ++i)
                rows.visit(i, [&](std::uint32_t j, double factor) { write(out, j, factor); });
        };
    };
    return {fileOf(files[0], array("<f8", [](BlockWriter& out, std::uint32_t, double factor) { out.binary(factor); })),
            fileOf(files[1], array("<i8", [](BlockWriter& out, std::uint32_t j,
                                             double) { out.binary(static_cast<std::int64_t>(j)); })),
            fileOf(files[2], [&rows](BlockWriter& out) {
                writeNumPyHeader(out, "<i8", fmt::format("{},", rows.size() + 1));
                std::int64_t end = 0;
                out.binary(end);
                for (std::size_t i = 0; i < rows.size(); ++i) {
                    rows.visit(i, [&](std::uint32_t, double) { ++end; });
                    out.binary(end);
                }
            })};
}

void writeAreas(BlockWriter& out, const PatchMatrix& patches) {
    out.text("# area,F_back,F_out\n");
    for (std::size_t i = 0; i < patches.matrix.size(); ++i)
        out.text("{},{},{}\n", patches.area[i], patches.matrix.back(i), patches.matrix.out(i));
}

fs::path appended(const fs::path& path, const char* end) { return fs::path(path.string() + end); }

/// In a format of one file that holds nothing else.
FileStream rowsFile(const fs::path& path, MatrixFormat format, const Rows& rows, const std::string& comment) {
    return fileOf(path, [format, &rows, &comment](BlockWriter& out) {
        if (format == MatrixFormat::MatrixMarket)
            writeMatrixMarket(out, rows, comment);
        else if (format == MatrixFormat::Csv)
            writeCsv(out, rows, comment);
        else
            writeDenseNumPy(out, rows);
    });
}

} // namespace

std::optional<MatrixFormat> matrixFormatOf(const fs::path& path) {
    const std::string extension = lowerCase(path.extension().string());
    static constexpr std::array kKnown{Named{MatrixFormat::MatrixMarket, ".mtx"}, Named{MatrixFormat::NumPy, ".npy"},
                                       Named{MatrixFormat::Csv, ".csv"}, Named{MatrixFormat::View3D, ".txt"}};
    return valueNamed(kKnown, extension);
}

MatrixFormat requireMatrixFormat(const fs::path& path) {
    if (const auto format = matrixFormatOf(path)) return *format;
    throw UsageError(fmt::format("{}: found the extension \"{}\", allowed are .mtx, .npy, .csv and .txt (View3D)",
                                 path.string(), path.extension().string()));
}

std::vector<fs::path> matrixFiles(const fs::path& path, std::size_t patches) {
    const auto format = matrixFormatOf(path);
    std::vector<fs::path> files{path};
    if (format == MatrixFormat::NumPy && patches > kMostDenseNumPy) {
        const fs::path stem = fs::path(path).replace_extension();
        files = {appended(stem, ".data.npy"), appended(stem, ".indices.npy"), appended(stem, ".indptr.npy")};
    }
    files.push_back(appended(path, ".areas.csv"));
    return files;
}

void checkMatrixFile(const fs::path& path, std::size_t patches) {
    if (requireMatrixFormat(path) == MatrixFormat::Csv && patches > kMostDenseCsv)
        throw UsageError(fmt::format("{}: a dense CSV of {} patches is too large, allowed are {}; use .mtx or .npy",
                                     path.string(), patches, kMostDenseCsv));
}

void writeMatrix(const fs::path& path, const PatchMatrix& patches, const std::string& comment, Progress& progress) {
    checkMatrixFile(path, patches.matrix.size());
    const std::vector<fs::path> files = matrixFiles(path, patches.matrix.size());
    const Rows rows{patches.matrix, patches.matrix.size(), progress};
    const MatrixFormat format = requireMatrixFormat(path);
    std::vector<FileStream> streams;
    if (format == MatrixFormat::View3D)
        streams = {fileOf(path, [&](BlockWriter& out) { writeView3D(out, patches, rows); })};
    else if (format == MatrixFormat::NumPy && files.front() != path)
        streams = sparseNumPy(files, rows);
    else
        streams = {rowsFile(path, format, rows, comment)};
    streams.push_back(fileOf(files.back(), [&](BlockWriter& out) { writeAreas(out, patches); }));
    writeWholeFiles(streams);
}

void writePointRows(const fs::path& path, const FormFactorMatrix& matrix, std::size_t columns,
                    const std::string& remainders, const std::string& comment, Progress& progress) {
    const Rows rows{matrix, columns, progress};
    const MatrixFormat format = requireMatrixFormat(path);
    if (format == MatrixFormat::View3D)
        throw UsageError(path.string() + ": View3D's format holds square matrices, not rows of points");
    const FileStream companion =
        fileOf(pointRowFiles(path).back(), [&](BlockWriter& out) { out.text("{}", remainders); });
    writeWholeFiles(std::array{rowsFile(path, format, rows, comment), companion});
}

std::vector<fs::path> pointRowFiles(const fs::path& path) { return {path, appended(path, ".points.csv")}; }

} // namespace lambert
