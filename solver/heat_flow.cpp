#include "solver/heat_flow.h"

#include "core/error.h"
#include "solver/conjugate_gradient.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lambert {

namespace {

double power4(double kelvin) { return kelvin * kelvin * kelvin * kelvin; }

constexpr double kNothing = 1e-150; ///< W/m²: squares of less may be 0

} // namespace

double HeatFlow::imbalance() const { return std::accumulate(flow.begin(), flow.end(), environmentFlow + backFlow); }

HeatFlow solveHeatFlow(const FormFactorMatrix& matrix, std::span<const float> area,
                       std::span<const std::uint32_t> group, std::span<const ThermalSurface> surfaces,
                       const HeatFlowOptions& options, Progress& progress) {
    const std::size_t count = matrix.size();
    const double environment = kStefanBoltzmann * power4(options.environment);
    std::vector<double> reflectance(count, 0.0), emitted(count, 0.0);
    std::vector<RgbSum> fromOutside(count, RgbSum(0.0));
    bool fixed = false, emits = false;
    for (std::size_t i = 0; i < count; ++i) {
        if (group[i] == kNoGroup) continue;
        const ThermalSurface& surface = surfaces[group[i]];
        fixed = fixed || (surface.kelvin && surface.emissivity > 0.0) || matrix.out(i) > 0.0;
        reflectance[i] = surface.kelvin ? 1.0 - surface.emissivity : 1.0;
        emitted[i] = (1.0 - reflectance[i]) * kStefanBoltzmann * power4(surface.kelvin.value_or(0.0));
        fromOutside[i] = RgbSum(matrix.out(i) * environment);
        emits = emits || emitted[i] + fromOutside[i].x > kNothing;
    }
    if (!fixed)
        throw InputError("no surface has a temperature and an emissivity above 0: nothing settles the radiation");

    HeatFlow result;
    result.radiosity.assign(count, 0.0);
    result.irradiance.assign(count, 0.0);
    if (emits) {
        const SolverProblem problem({area, reflectance, emitted}, fromOutside);
        StoredRows rows(matrix);
        const RadiositySolution solution =
            solveConjugateGradient(problem, rows, {.tolerance = options.tolerance}, progress);
        result.iterations = solution.iterations;
        result.residual = solution.residual;
        for (std::size_t i = 0; i < count; ++i) {
            result.radiosity[i] = solution.radiosity[i].x;
            result.irradiance[i] = solution.irradiance[i].x;
        }
    }
    result.flow.assign(surfaces.size(), 0.0);
    std::vector<double> groupArea(surfaces.size(), 0.0), given(surfaces.size(), 0.0);
    for (std::size_t i = 0; i < count; ++i) {
        const auto ai = static_cast<double>(area[i]);
        if (group[i] == kNoGroup) {
            result.backFlow -= ai * result.irradiance[i];
            result.irradiance[i] += matrix.out(i) * environment;
            continue;
        }
        result.flow[group[i]] += ai * (result.radiosity[i] - result.irradiance[i]);
        groupArea[group[i]] += ai;
        given[group[i]] += ai * result.radiosity[i];
        result.environmentFlow += ai * matrix.out(i) * (environment - result.radiosity[i]);
        result.backFlow -= ai * matrix.back(i) * result.radiosity[i];
    }
    for (std::size_t g = 0; g < surfaces.size(); ++g)
        result.kelvin.push_back(surfaces[g].kelvin.value_or(
            groupArea[g] > 0.0 ? std::pow(std::max(0.0, given[g] / groupArea[g]) / kStefanBoltzmann, 0.25) : 0.0));
    return result;
}

} // namespace lambert
