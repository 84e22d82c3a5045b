#include "solver/jacobi.h"

#include "core/error.h"
#include "core/parallel.h"
#include "core/stopwatch.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace lambert {

namespace {

/// E = F B.
void gather(const FormFactorMatrix& matrix, const std::vector<RgbSum>& radiosity, std::vector<RgbSum>& irradiance) {
    parallelFor(matrix.size(), 64, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t i = begin; i < end; ++i) {
            RgbSum sum(0.0);
            matrix.visit(i, [&](std::uint32_t j, double factor) { sum += factor * radiosity[j]; });
            irradiance[i] = sum;
        }
    });
}

/// Area-weighted, over all channels.
double squaredNorm(const PatchMesh& mesh, const std::vector<RgbSum>& values) {
    double sum = 0.0;
    for (std::size_t i = 0; i < mesh.size(); ++i)
        sum += static_cast<double>(mesh.area[i]) * glm::dot(values[i], values[i]);
    return sum;
}

} // namespace

RadiositySolution solveJacobi(const PatchMesh& mesh, const FormFactorMatrix& matrix, const JacobiOptions& options,
                              Progress& progress) {
    const Stopwatch watch;
    const std::size_t count = mesh.size();
    RadiositySolution solution;
    solution.irradiance.assign(count, RgbSum(0.0));
    for (const Rgb& emitted : mesh.emittedRadiosity) solution.radiosity.emplace_back(emitted);
    const double emittedNorm = std::sqrt(squaredNorm(mesh, solution.radiosity));
    if (!(emittedNorm > 0.0)) throw InputError("the scene has no light: no material emits");

    const int limit = options.bounces > 0 ? std::min(options.bounces, options.maxIterations) : options.maxIterations;
    std::vector<RgbSum> change(count);
    progress.begin("solve", 0);
    for (int iteration = 1; iteration <= limit; ++iteration) {
        gather(matrix, solution.radiosity, solution.irradiance);
        for (std::size_t i = 0; i < count; ++i) {
            const RgbSum next = RgbSum(mesh.emittedRadiosity[i]) + RgbSum(mesh.reflectance[i]) * solution.irradiance[i];
            change[i] = next - solution.radiosity[i];
            solution.radiosity[i] = next;
        }
        solution.iterations = iteration;
        solution.residual = std::sqrt(squaredNorm(mesh, change)) / emittedNorm;
        solution.history.push_back({iteration, solution.residual, watch.seconds()});
        progress.advance();
        if (solution.residual <= options.tolerance) break;
    }
    progress.end();
    for (std::size_t i = 0; i < count; ++i) solution.covered.push_back(static_cast<float>(matrix.back(i)));
    solution.energy = energyBalance(mesh, matrix, solution);
    return solution;
}

EnergyBalance energyBalance(const PatchMesh& mesh, const FormFactorMatrix& matrix, const RadiositySolution& solution) {
    EnergyBalance energy;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        const auto area = static_cast<double>(mesh.area[i]);
        energy.emitted += area * RgbSum(mesh.emittedRadiosity[i]);
        energy.absorbed += area * (RgbSum(1.0) - RgbSum(mesh.reflectance[i])) * solution.irradiance[i];
        energy.backFaces += area * matrix.back(i) * solution.radiosity[i];
        energy.escaped += area * matrix.out(i) * solution.radiosity[i];
    }
    return energy;
}

double EnergyBalance::imbalance() const {
    const RgbSum in = emitted + received;
    const RgbSum lost = absorbed + backFaces + escaped;
    const double total = in.x + in.y + in.z;
    return total > 0.0 ? (total - (lost.x + lost.y + lost.z)) / total : 0.0;
}

} // namespace lambert
