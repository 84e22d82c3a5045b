#pragma once

#include "solver/solver.h"

#include <cstdint>
#include <vector>

namespace lambert {

/// Progressive radiosity, shot by shot. Light that a patch has received and not yet passed on is its unshot radiosity ΔB; at
/// first that is B_e + ρ E_0.
///
/// F_ji = F_ij A_i / A_j is taken from the row of the patch that shoots: where rows are not reciprocal, the radiosities are
/// those that go with the transposed rows.
class Southwell {
public:
    /// Both must outlive this.
    Southwell(const SolverProblem& problem, FormFactorRows& rows);

    /// Before the first shot: takes B_e + ρ E of these irradiances (#patches) for what has been shot. What is unshot then is
    /// what they lack, which may be below 0. Takes one row per patch.
    void startFrom(std::span<const RgbSum> irradiance, const Progress& progress);

    /// The patch with the most unshot power, Σ_c A |ΔB^c|; the first of several.
    std::uint32_t brightest() const;
    /// Passes its unshot radiosity on to all patches: ΔB_j += ρ_j F_ji ΔB_i.
    void shoot(std::uint32_t patch);

    /// sqrt(Σ A |ΔB|²), relative: the residual of the radiosities that have been shot.
    double residual() const { return problem_.relativeNorm(unshot_); }

    const std::vector<RgbSum>& irradiance() const { return irradiance_; } //!< #patches, E by what was shot
    std::vector<RgbSum> radiosity() const; //!< #patches, B_e + ρ E, unshot light included

    /// Passes all that the next shot depends on to an archive, see SolverCheckpoint.
    template <typename Archive>
    void keep(Archive& archive) {
        archive(irradiance_);
        archive(unshot_);
        archive(power_);
    }

private:
    void receive(std::uint32_t patch, const RgbSum& shot);
    void expect(std::uint32_t patch, std::size_t count);

    const SolverProblem& problem_;
    FormFactorRows& rows_;
    std::vector<RgbSum> irradiance_;
    std::vector<RgbSum> unshot_; ///< ΔB
    std::vector<double> power_;  ///< Σ_c A |ΔB^c|
    FormFactorRow row_;
};

/// Solves the problem by Southwell's method: the patch with the most unshot power shoots next. With computed rows no matrix
/// is stored. The history has a step every so many shots.
///
/// 10,000 shots per patch without reaching the tolerance are not an error; see `residual`. Throws Cancelled, and what a checkpoint throws.
RadiositySolution solveSouthwell(const SolverProblem& problem, FormFactorRows& rows, const SolverOptions& options,
                                 Progress& progress, const SolverContext& context = {});

} // namespace lambert
