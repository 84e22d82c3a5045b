#pragma once

#include "core/state_checkpoint.h"
#include "formfactors/matrix_journal.h"
#include "formfactors/transport.h"

#include <cstdint>
#include <optional>
#include <string>

namespace lambert {

/// An unfinished matrix in a file: the rows that are finished, or of a method without single rows (see hasRows) what was counted of
/// its lines.
class MatrixCheckpoint {
public:
    /// Opens or creates the file. `identity`, one line, names all that the matrix depends on. Throws as MatrixJournal and
    /// StateCheckpoint.
    MatrixCheckpoint(const CheckpointOptions& options, TransportMethod method, const std::string& identity) {
        if (hasRows(method))
            rows.emplace(options, identity);
        else
            lines.emplace(options, "matrix", identity);
    }
    /// Removes the file: the work is done.
    void remove() {
        if (rows) rows->remove();
        if (lines) lines->remove();
    }

    std::optional<MatrixJournal> rows;
    std::optional<StateCheckpoint> lines;
    std::uint64_t restoredLines = 0; //!< set by computeMatrix
};

} // namespace lambert
