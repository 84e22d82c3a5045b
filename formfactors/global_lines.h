#pragma once

#include "formfactors/global_line_counts.h"
#include "formfactors/isotropic_lines.h"
#include "formfactors/line_spans.h"
#include "meshing/patch_mesh.h"
#include "scene/rays/line_caster.h"

#include <functional>

namespace lambert {

/// Form factors of all pairs at once by lines through the whole scene: the stretches of every line between two crossings
/// connect a front with a front (counted both ways), a black back or the outside. N_ij of the N_i lines that cross i lead to
/// j's front, F_ij ≈ N_ij / N_i. Rows close exactly; N_ij = N_ji, so that the merge of repair() makes them reciprocal. For
/// independent lines every row is unbiased given N_i > 0, with variance F (1 − F) / N_i; X_ij ≈ N_ij 2πR² / N is unbiased always.
///
/// M. Sbert, "An integral geometry based method for fast form-factor computation", Computer Graphics Forum 12(3), 1993.
class GlobalLines {
public:
    /// `mesh` and `caster` (of the same scene) must outlive it. Throws UsageError for options out of range.
    GlobalLines(const PatchMesh& mesh, const LineCaster& caster, const GlobalLineOptions& options);

    /// Traces the lines that `counts` (of this mesh) does not hold yet: all of them, or after an interruption those that
    /// are left, with the same result. After each batch of lines, `afterBatch` may save the counts. Throws Cancelled, with
    /// `counts` as after the last batch, and UsageError if the counts are not of this mesh and these options.
    void trace(GlobalLineCounts& counts, Progress& progress, const std::function<void()>& afterBatch = {}) const;

    const IsotropicLines& lines() const { return lines_; }

private:
    struct Scratch;
    void traceBlock(std::uint64_t block, Scratch& scratch) const;

    const PatchMesh& mesh_;
    GlobalLineOptions options_;
    IsotropicLines lines_;
    LineSpans spans_;
};

} // namespace lambert
