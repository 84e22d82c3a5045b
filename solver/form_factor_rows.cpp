#include "solver/form_factor_rows.h"

#include "core/parallel.h"

namespace lambert {

void gatherAll(FormFactorRows& rows, std::span<const RgbSum> radiosity, std::span<RgbSum> irradiance,
               const Progress& progress) {
    parallelFor(rows.size(), 64, [&](std::size_t begin, std::size_t end, int) {
        progress.throwIfCancelled();
        for (std::size_t i = begin; i < end; ++i) irradiance[i] = rows.gather(static_cast<std::uint32_t>(i), radiosity);
    });
}

void StoredRows::row(std::uint32_t patch, FormFactorRow& row) {
    row.entries.clear();
    matrix_.visit(patch, [&](std::uint32_t j, double factor) { row.entries.push_back({j, factor}); });
    row.back = matrix_.back(patch);
    row.out = matrix_.out(patch);
}

RgbSum StoredRows::gather(std::uint32_t patch, std::span<const RgbSum> radiosity) {
    RgbSum sum(0.0);
    matrix_.visit(patch, [&](std::uint32_t j, double factor) { sum += factor * radiosity[j]; });
    return sum;
}

RgbSum StoredRows::gather(std::uint32_t patch, std::span<const RgbSum> radiosity, PatchRange aside,
                          std::vector<FormFactor>& inside) {
    // No call that could grow the vector inside the loop: it would keep the sum out of the registers.
    inside.resize(aside.end - aside.begin);
    FormFactor* next = inside.data();
    RgbSum sum(0.0);
    matrix_.visit(patch, [&](std::uint32_t j, double factor) {
        if (aside.contains(j))
            *next++ = {j, factor};
        else
            sum += factor * radiosity[j];
    });
    inside.resize(static_cast<std::size_t>(next - inside.data()));
    return sum;
}

} // namespace lambert
