#pragma once

#include "core/checkpoint.h"
#include "core/locked_file.h"
#include "core/stopwatch.h"
#include "formfactors/form_factor_matrix.h"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

namespace lambert {

/// The rows of an unfinished matrix in a file: what was written stays valid whatever happens to the process later.
///
/// The file begins with a line that tells whose rows it holds; then each row stands as it is in memory, with its own check
/// sum. Rows are appended as they are finished, so that writing costs as much as there is new. An end torn by a crash is
/// cut off when the file is opened again.
class MatrixJournal {
public:
    /// Opens or creates the file and locks it. `identity`, one line, names all that the rows depend on. Throws UsageError if
    /// the file is there without `resume`, in use by another run or another computation's, SystemError.
    MatrixJournal(const CheckpointOptions& options, const std::string& identity);

    /// Puts the rows of the file into the matrix; which they are, #patches. To be called once, before anything is added.
    /// Throws SystemError.
    std::vector<bool> restore(FormFactorMatrix& matrix);
    std::size_t restoredRows() const { return restored_; }

    /// Says that a row is finished; from any thread. Now and then writes what is new. Throws SystemError.
    void add(const FormFactorMatrix& matrix, std::size_t patch);
    /// Writes all that is new and waits until it is on the disk. Throws SystemError.
    void flush(const FormFactorMatrix& matrix);
    /// Removes the file: the work is done.
    void remove() { file_.remove(); }

private:
    [[noreturn]] void fail(int error) const;
    void readHeader(const std::string& identity);
    void writeHeader(const std::string& identity);
    void writeAll(const std::vector<std::byte>& bytes);

    std::filesystem::path path_;
    double interval_;
    LockedFile file_;
    std::uint64_t firstRow_ = 0; ///< where in the file
    std::size_t restored_ = 0;

    std::mutex pendingMutex_, fileMutex_;
    std::vector<std::uint32_t> pending_; ///< finished and not written
    std::atomic<double> nextWrite_;      ///< seconds of watch_
    Stopwatch watch_;
};

} // namespace lambert
