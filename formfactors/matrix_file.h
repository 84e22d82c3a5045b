#pragma once

#include "core/progress.h"
#include "formfactors/form_factor_matrix.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lambert {

/// The files that matrices are exchanged in. Row i, column j holds F_ij.
enum class MatrixFormat {
    MatrixMarket, ///< .mtx: coordinate real general, indices from 1
    NumPy, ///< .npy: dense float64; above kMostDenseNumPy patches a CSR triple NAME.data.npy, .indices.npy, .indptr.npy
    Csv,   ///< .csv: dense, 9 significant digits, lines beginning with # are comments
    View3D ///< .txt: G. N. Walton's View3D, text format 0: header, areas, rows, emissivities
};

inline constexpr std::size_t kMostDenseCsv = 5'000;
inline constexpr std::size_t kMostDenseNumPy = 20'000;

/// By the name's extension (any case); nothing for any other.
std::optional<MatrixFormat> matrixFormatOf(const std::filesystem::path& path);
/// Throws UsageError for any other.
MatrixFormat requireMatrixFormat(const std::filesystem::path& path);

/// A matrix with what solving it needs.
struct PatchMatrix {
    FormFactorMatrix matrix;
    std::vector<double> area{};       //!< #patches, m²
    std::vector<double> emissivity{}; //!< #patches, or empty; only View3D's files hold it
};

/// Every file that writeMatrix writes for `path`: the matrix, and last `NAME.EXT.areas.csv` with one line
/// "area,F_back,F_out" per patch.
std::vector<std::filesystem::path> matrixFiles(const std::filesystem::path& path, std::size_t patches);

/// Throws UsageError for an unknown extension and for a CSV of more than kMostDenseCsv patches.
void checkMatrixFile(const std::filesystem::path& path, std::size_t patches);

/// Writes a matrix: all files whole, or none. `comment` (scene, method, N; one line) heads the formats that have
/// comments. Without emissivities View3D's are 1. Throws what checkMatrixFile throws, SystemError, Cancelled.
void writeMatrix(const std::filesystem::path& path, const PatchMatrix& patches, const std::string& comment,
                 Progress& progress);

/// The same for rows of points, `matrix` being the points' rows, of `columns` columns each: no areas but a file
/// `NAME.EXT.points.csv` with the text `remainders`. Not in View3D's format.
void writePointRows(const std::filesystem::path& path, const FormFactorMatrix& matrix, std::size_t columns,
                    const std::string& remainders, const std::string& comment, Progress& progress);
std::vector<std::filesystem::path> pointRowFiles(const std::filesystem::path& path);

/// Reads a matrix that writeMatrix or another program wrote. Without areas file F_out is what a row lacks of 1, and the areas
/// are empty. Throws InputError with file and line: numbers that are not finite, factors outside [0, 1.01], a matrix that
/// is not square, a file that ends early.
PatchMatrix readMatrix(const std::filesystem::path& path, MatrixStorage storage = MatrixStorage::Double);

} // namespace lambert
