#pragma once

#include "core/error.h"
#include "lighting/solve_scene.h"

#include <string>
#include <vector>

namespace lambert {

/// What a bake aims at and has not reached.
struct BakeVerdict {
    ExitCode exitCode = ExitCode::Ok;  //!< or TargetMissed
    std::vector<std::string> warnings; //!< one line each, beside those of the bake itself
};

/// Judges the solver's target, and the energy's imbalance, which the bake's own warnings tell of.
BakeVerdict judge(const LightMethod& method, const SolvedScene& solved);

/// "energy imbalance 0.0012", with that before repair where there was one.
std::string imbalanceText(const SolvedScene& solved);

/// The one that a table has room for: the worse of both.
double worseImbalance(const SolvedScene& solved);

} // namespace lambert
