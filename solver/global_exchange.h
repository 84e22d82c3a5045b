#pragma once

#include "core/progress.h"
#include "formfactors/isotropic_lines.h"
#include "formfactors/line_spans.h"
#include "solver/exchange.h"

#include <optional>

namespace lambert {

/// Exchange by global lines: of N uniform, isotropic lines through the sphere of radius R around the scene, one that leads from i
/// to j stands for 2πR²/N of the exchange area X_ij, both ways, whatever the patches send.
///
/// M. Sbert, "The use of global random directions to compute radiosity", PhD thesis, UPC Barcelona 1997.
class GlobalExchange {
public:
    /// `mesh` and `caster` (of the same scene) must outlive it.
    GlobalExchange(const PatchMesh& mesh, const LineCaster& caster, LineSet set, Sampler sampler);

    /// Starts a sequence of lines, of which about `lines` will be wanted.
    void restart(std::uint64_t seed, double lines);
    /// How many lines exchange() will take: whole blocks of 1024 chords or more, if more are wanted, or bundles of 1024; at least one;
    /// none once the sequence has ended, after 2^32.
    double linesFor(double wanted) const;
    /// 2πR²: a patch of area A is crossed by A / 2πR² of the lines.
    double measure() const;
    /// Uses the sequence's next linesFor(lines) lines. The rest as LocalExchange::exchange; densities do not count.
    void exchange(const ExchangeInput& input, double lines, FixedPointSums& received, Losses& losses,
                  LineCounts& counts, Progress& progress);

private:
    struct Scratch;
    std::uint64_t blocksFor(double wanted) const;
    void deposit(const ExchangeInput& input, std::uint32_t a, std::uint32_t b, float weight, FixedPointSums& received,
                 Scratch& scratch, LineCounts& counts) const;

    const PatchMesh& mesh_;
    Bounds bounds_;
    GlobalLineOptions options_;
    std::optional<IsotropicLines> lines_;
    LineSpans spans_;
    std::uint64_t nextBlock_ = 0;
};

} // namespace lambert
