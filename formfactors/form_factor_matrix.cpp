#include "formfactors/form_factor_matrix.h"

namespace lambert {

std::size_t FormFactorMatrix::entryCount() const {
    std::size_t count = 0;
    for (const FormFactorRow& row : rows) count += row.entries.size();
    return count;
}

std::size_t FormFactorMatrix::bytes() const {
    return rows.size() * sizeof(FormFactorRow) + entryCount() * sizeof(FormFactor);
}

} // namespace lambert
