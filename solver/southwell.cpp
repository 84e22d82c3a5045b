// M. F. Cohen, S. E. Chen, J. R. Wallace, D. P. Greenberg, A progressive refinement approach to fast radiosity image
//   generation, SIGGRAPH 1988.
// S. Gortler, M. F. Cohen, P. Slusallek, Radiosity and relaxation methods, IEEE CG&A 14(6), 1994: why it is Southwell's.
#include "solver/southwell.h"

#include "solver/energy_balance.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace lambert {

namespace {

constexpr double kMostShotsPerPatch = 10'000; ///< on average

/// The order of shots, also of light that a start had too much of.
double powerOf(double area, const RgbSum& v) { return area * (std::abs(v.x) + std::abs(v.y) + std::abs(v.z)); }

} // namespace

Southwell::Southwell(const SolverProblem& problem, FormFactorRows& rows)
    : problem_(problem), rows_(rows), irradiance_(problem.size()), unshot_(problem.size()), power_(problem.size()) {
    for (std::size_t i = 0; i < problem.size(); ++i) {
        irradiance_[i] = problem.direct(i);
        unshot_[i] = problem.source(i);
        power_[i] = powerOf(problem.area(i), unshot_[i]);
    }
}

std::uint32_t Southwell::brightest() const {
    return static_cast<std::uint32_t>(std::max_element(power_.begin(), power_.end()) - power_.begin());
}

void Southwell::shoot(std::uint32_t patch) {
    if (const std::size_t count = rows_.wanted(patch); count > 0) expect(patch, count);
    const RgbSum shot = std::exchange(unshot_[patch], RgbSum(0.0));
    power_[patch] = 0.0;
    receive(patch, shot);
}

/// All patches receive their share of what one has shot.
void Southwell::receive(std::uint32_t patch, const RgbSum& shot) {
    rows_.row(patch, row_);
    const double area = problem_.area(patch);
    for (const FormFactor& factor : row_.entries) {
        const std::uint32_t j = factor.patch;
        const RgbSum received = factor.value * (area / problem_.area(j)) * shot;
        irradiance_[j] += received;
        unshot_[j] += problem_.reflectance(j) * received;
        power_[j] = powerOf(problem_.area(j), unshot_[j]);
    }
}

void Southwell::startFrom(std::span<const RgbSum> irradiance, const Progress& progress) {
    const std::vector<RgbSum> start = problem_.startRadiosity(irradiance);
    std::vector<std::uint32_t> ahead;
    for (std::uint32_t i = 0; i < start.size(); ++i) {
        progress.throwIfCancelled();
        if (const std::size_t count = rows_.wanted(i); count > 0) {
            ahead.resize(std::min(count, start.size() - i));
            std::iota(ahead.begin(), ahead.end(), i);
            rows_.expect(ahead);
        }
        receive(i, start[i]);
    }
    for (std::size_t i = 0; i < start.size(); ++i) {
        unshot_[i] -= start[i];
        power_[i] = powerOf(problem_.area(i), unshot_[i]);
    }
}

/// Names the patch and those that are most likely to follow it.
void Southwell::expect(std::uint32_t patch, std::size_t count) {
    std::vector<std::uint32_t> patches(problem_.size());
    std::iota(patches.begin(), patches.end(), 0U);
    const auto last = patches.begin() + static_cast<std::ptrdiff_t>(std::min(count, patches.size()));
    std::partial_sort(patches.begin(), last, patches.end(), [&](std::uint32_t a, std::uint32_t b) {
        if ((a == patch) != (b == patch)) return a == patch;
        return power_[a] != power_[b] ? power_[a] > power_[b] : a < b;
    });
    patches.erase(last, patches.end());
    rows_.expect(patches);
}

std::vector<RgbSum> Southwell::radiosity() const {
    std::vector<RgbSum> result(problem_.size());
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = problem_.radiosity(i, irradiance_[i]);
    return result;
}

RadiositySolution solveSouthwell(const SolverProblem& problem, FormFactorRows& rows, const SolverOptions& options,
                                 Progress& progress, const SolverContext& context) {
    const std::size_t count = problem.size();
    // To measure the residual takes as long as to look for the brightest patch, and somewhat more.
    const auto interval = std::clamp<std::size_t>(count / 16, 1, 1024);
    const auto limit = kMostShotsPerPatch * static_cast<double>(count);
    RadiositySolution solution;
    Southwell method(problem, rows);
    const auto state = [&](auto& archive) {
        archive(solution.iterations);
        archive(solution.residual);
        archive(solution.history);
        method.keep(archive);
    };
    progress.begin("solve", 0);
    if (!context.restore(state)) {
        if (!context.start.empty()) {
            method.startFrom(context.start, progress);
            solution.iterations = static_cast<std::int64_t>(count);
        }
        solution.residual = method.residual();
        if (!context.start.empty()) solution.history.push_back({solution.iterations, solution.residual, 0.0});
    }
    const SolverClock clock(solution.history);
    while (solution.residual > options.tolerance && static_cast<double>(solution.iterations) < limit) {
        for (std::size_t k = 0; k < interval; ++k) {
            method.shoot(method.brightest());
            progress.advance();
        }
        solution.iterations += static_cast<std::int64_t>(interval);
        solution.residual = method.residual();
        solution.history.push_back({solution.iterations, solution.residual, clock.seconds()});
        context.offer(state);
    }
    progress.end();
    solution.radiosity = method.radiosity();
    solution.irradiance = method.irradiance();
    settle(problem, rows, solution, progress);
    return solution;
}

} // namespace lambert
