#pragma once

#include "formfactors/form_factor_matrix.h"
#include "lighting/light_method.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lambert {

struct SolvedScene;

/// Shares of the light that came in, emitted + received (of which much may leave an open scene again; what stays is then off by
/// more than this share of it).
inline constexpr double kImbalanceTold = 0.01;   ///< warned of
inline constexpr double kImbalanceMissed = 0.05; ///< counts as a missed target

/// Whether a bake loses light, or makes some.
struct EnergyCheck {
    /// What the form factors lose of this solution's light (below 0: make) as they were computed, whatever --repair and the solver
    /// made of it: Σ_j B_j (A_j (1 − F_j,back − F_j,out) − Σ_i A_i F_ij) / (emitted + received). None without a matrix.
    std::optional<double> beforeRepair;
    std::string material; //!< whose light that is for the most part
    /// The imbalance that is judged: that before repair, or where there is no matrix that of the solution, without what is left
    /// out on purpose (--bounces, walks that end).
    double judged = 0.0;
    double judgedError = 0.0; //!< its standard error; 0 of deterministic methods

    bool missed() const { return judged > kImbalanceMissed || judged < -kImbalanceMissed; }
};

/// Σ A (B_e (1 − F_back − F_out) − E of emitters), where the light of emitters was found apart from the form factors: what they lack
/// of each other, over the channels; else 0.
double lossOfEmitters(const SolvedScene& solved, const FormFactorMatrix& matrix);

/// Judges a scene that is solved. `deficit`: columnDeficit of the form factors as they were computed; empty without a matrix.
/// `lostByEmitters`: lossOfEmitters of the same.
EnergyCheck checkEnergy(const SolvedScene& solved, std::span<const double> deficit = {}, double lostByEmitters = 0.0);

/// What to tell the user, each in one line: the likely cause and the way out; none if all is well. `method` is what the light was
/// found by.
std::vector<std::string> energyWarnings(const SolvedScene& solved, const LightMethod& method);

} // namespace lambert
