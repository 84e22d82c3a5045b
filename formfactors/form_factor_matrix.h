#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lambert {

/// One entry of a row: the fraction F_ij of what leaves patch i that reaches patch j.
struct FormFactor {
    std::uint32_t patch; //!< j
    float value;         //!< F_ij, above 0
};

/// All that leaves one patch: Σ_j F_ij + back + out = 1.
struct FormFactorRow {
    std::vector<FormFactor> entries; //!< ascending by patch
    double back = 0.0;               //!< F_i,back: meets a black back face
    double out = 0.0;                //!< F_i,out: leaves the scene

    /// Σ_j F_ij + back + out, in double.
    double sum() const {
        double total = back + out;
        for (const FormFactor& entry : entries) total += static_cast<double>(entry.value);
        return total;
    }
};

/// Sparse form factors, one row per patch, in single precision.
struct FormFactorMatrix {
    std::vector<FormFactorRow> rows; //!< #patches

    std::size_t entryCount() const;
    std::size_t bytes() const;
};

} // namespace lambert
