#include "solver/energy_balance.h"

namespace lambert {

EnergyBalance energyBalance(const SolverProblem& problem, const FormFactorRows& rows,
                            const RadiositySolution& solution) {
    EnergyBalance energy;
    energy.received = problem.received();
    for (std::size_t i = 0; i < problem.size(); ++i) {
        const double area = problem.area(i);
        const auto patch = static_cast<std::uint32_t>(i);
        energy.emitted += area * problem.allEmitted(i);
        energy.absorbed += area * (RgbSum(1.0) - problem.reflectance(i)) * solution.irradiance[i];
        energy.backFaces += area * rows.back(patch) * solution.radiosity[i];
        energy.escaped += area * rows.out(patch) * solution.radiosity[i];
    }
    return energy;
}

void settle(const SolverProblem& problem, FormFactorRows& rows, RadiositySolution& solution, Progress& progress) {
    rows.complete(progress);
    solution.covered.resize(problem.size());
    for (std::size_t i = 0; i < problem.size(); ++i)
        solution.covered[i] = static_cast<float>(rows.back(static_cast<std::uint32_t>(i)));
    if (problem.emittersApart())
        for (std::size_t i = 0; i < problem.size(); ++i) solution.radiosity[i] += problem.allEmitted(i);
    solution.energy = energyBalance(problem, rows, solution);
}

double EnergyBalance::imbalance() const {
    const double in = sumOf(emitted + received);
    return in > 0.0 ? (in - sumOf(absorbed + backFaces + escaped)) / in : 0.0;
}

} // namespace lambert
