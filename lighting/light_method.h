#pragma once

#include "formfactors/matrix_source.h"
#include "solver/line_solvers.h"
#include "solver/solver.h"
#include "vpl/instant_radiosity.h"

#include <filesystem>
#include <variant>

namespace lambert {

/// Light by form factors and a solver.
struct FormFactorLight {
    MatrixSource formFactors; //!< with transport.stored a matrix; else rows are computed as the solver asks for them
    SolverOptions solver;
    std::filesystem::path warmStart{}; //!< a solution of the same patches that the solver begins from; empty: none
};

/// The ways to find light: by form factors, by lines, by virtual point lights.
using LightMethod = std::variant<FormFactorLight, LineSolverOptions, InstantRadiosityOptions>;

} // namespace lambert
