#include "solver/residual.h"

#include <glm/geometric.hpp>

namespace lambert {

double gatherResidual(const SolverProblem& problem, FormFactorRows& rows, RadiositySolution& solution,
                      const Progress& progress) {
    solution.irradiance.resize(problem.size());
    gatherAll(rows, solution.radiosity, solution.irradiance, progress);
    double squares = 0.0;
    for (std::size_t i = 0; i < problem.size(); ++i) {
        solution.irradiance[i] += problem.direct(i);
        const RgbSum residual = problem.radiosity(i, solution.irradiance[i]) - solution.radiosity[i];
        squares += problem.area(i) * glm::dot(residual, residual);
    }
    return problem.relativeNorm(squares);
}

} // namespace lambert
