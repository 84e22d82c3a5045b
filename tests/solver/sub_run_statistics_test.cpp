#include "core/random.h"
#include "core/sample_points.h"
#include "solver/sub_run_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lambert {
namespace {

struct Patches {
    std::vector<float> area;
    PatchOptics optics;
    operator PatchViews() const { return {area, optics}; }
};

Patches patches(std::size_t count) {
    return {std::vector<float>(count, 2.0F), {std::vector<Rgb>(count, Rgb(0.5F)), std::vector<Rgb>(count, Rgb(1.0F))}};
}

/// Independent numbers of the normal distribution, by Box and Muller.
double normal(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const auto bits = philox({a, b, c, 1}, 99);
    const double u = (static_cast<double>(bits[0]) + 0.5) * 0x1p-32;
    const double v = (static_cast<double>(bits[1]) + 0.5) * 0x1p-32;
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}

TEST(SubRunStatistics, MeanAndStandardErrorOfThreeRuns) {
    const Patches given = patches(1);
    const SolverProblem problem(given);
    SubRunStatistics statistics(problem);
    for (const float e : {1.0F, 2.0F, 6.0F}) statistics.add(std::array{Rgb(e, 2.0F * e, 0.0F)}, {}, 100);
    // Mean 3, squares 4 + 1 + 9 = 14, variance of the mean 14 / 2 / 3.
    EXPECT_FLOAT_EQ(statistics.standardError(0).x, static_cast<float>(std::sqrt(14.0 / 6.0)));
    EXPECT_FLOAT_EQ(statistics.standardError(0).y, static_cast<float>(2.0 * std::sqrt(14.0 / 6.0)));
    EXPECT_EQ(statistics.standardError(0).z, 0.0F);
    EXPECT_NEAR(statistics.relativeError(), std::sqrt(14.0 / 6.0) / 3.0, 1e-7);
    StochasticSolution solution;
    statistics.finish(solution);
    EXPECT_NEAR(solution.irradiance[0].x, 3.0, 1e-6);
    EXPECT_NEAR(solution.irradiance[0].y, 6.0, 1e-6);
    EXPECT_NEAR(solution.radiosity[0].x, 2.5, 1e-6);
    EXPECT_EQ(solution.rays, 300U);
    EXPECT_NEAR(solution.energy.absorbed.x, 3.0, 1e-6); // A (1 − ρ) E
}

TEST(SubRunStatistics, RaysAreWeights) {
    const Patches given = patches(1);
    const SolverProblem problem(given);
    SubRunStatistics statistics(problem);
    statistics.add(std::array{Rgb(1.0F)}, {}, 100);
    statistics.add(std::array{Rgb(2.0F)}, {}, 300);
    statistics.add(std::array{Rgb(2.0F)}, {}, 600);
    StochasticSolution solution;
    // σ² = (100 · 0.9² + 900 · 0.1²) / 2, and that of the mean σ² / 1000.
    EXPECT_NEAR(statistics.standardError(0).x, std::sqrt(45.0 / 1000.0), 1e-6);
    statistics.finish(solution);
    EXPECT_NEAR(solution.irradiance[0].x, 1.9, 1e-6);
}

// Whether patches err together or each for itself. Of 1000 cases 5 % should lie above the bound: 7 % are three standard deviations more;
// with one degree of freedom for all, known from seven numbers, the bound is coarse, and 8 % are allowed.
TEST(SubRunStatistics, UpperErrorIsExceededOnceInTwentyTimes) {
    for (const auto& [count, parts] : {std::pair{1, 1}, std::pair{60, 1}, std::pair{60, 60}, std::pair{600, 20}}) {
        const Patches given = patches(static_cast<std::size_t>(count));
        int exceeded = 0;
        constexpr int kCases = 1000;
        for (int k = 0; k < kCases; ++k) {
            const SolverProblem problem(given);
            SubRunStatistics statistics(problem);
            for (std::uint32_t run = 0; run < 8; ++run) {
                std::vector<Rgb> e;
                for (int i = 0; i < count; ++i)
                    e.emplace_back(static_cast<float>(
                        1.0 + 0.1 * normal(static_cast<std::uint32_t>(k), run, static_cast<std::uint32_t>(i % parts))));
                statistics.add(e, {}, 1000);
            }
            const double upper = statistics.upperRelativeError();
            StochasticSolution solution;
            statistics.finish(solution);
            double squares = 0.0, all = 0.0;
            for (const RgbSum& e : solution.irradiance) {
                squares += (e.x - 1.0) * (e.x - 1.0);
                all += e.x * e.x;
            }
            exceeded += std::sqrt(squares / all) > upper ? 1 : 0;
        }
        EXPECT_LE(exceeded, parts == 1 ? 80 : 70) << count << " patches in " << parts << " parts";
    }
}

TEST(SubRunSchedule, WithoutATargetTheRaysAreShared) {
    const Patches given = patches(1);
    const SolverProblem problem(given);
    SubRunStatistics statistics(problem);
    const SubRunSchedule schedule(1000, 0.0, 4, 1);
    for (int k = 0; k < 4; ++k) {
        EXPECT_EQ(schedule.next(statistics), 250U);
        statistics.add(std::array{Rgb(1.0F)}, {}, 250);
    }
    EXPECT_EQ(schedule.next(statistics), 0U);
}

TEST(SubRunSchedule, WithATargetItEndsAtTheRaysAllowed) {
    const Patches given = patches(1);
    const SolverProblem problem(given);
    SubRunStatistics statistics(problem);
    const SubRunSchedule schedule(1'000'000, 1e-9, 8, 1);
    std::uint64_t total = 0;
    std::uint32_t runs = 0;
    while (const std::uint64_t rays = schedule.next(statistics)) {
        EXPECT_LE(rays, std::max<std::uint64_t>(total / 4, 4096)) << runs;
        statistics.add(std::array{Rgb(static_cast<float>(2.0 + normal(0, runs, 0)))}, {}, rays);
        total += rays;
        ++runs;
    }
    EXPECT_LE(total, 1'000'000U);
    EXPECT_GT(total, 1'000'000U - 4096U);
    EXPECT_LT(runs, 40U);
}

TEST(SubRunSchedule, RunsThatDrawNoRaysComeToAnEnd) {
    const Patches given = patches(1);
    const SolverProblem problem(given);
    SubRunStatistics statistics(problem);
    const SubRunSchedule schedule(20'000, 1e-3, 8, 1);
    int runs = 0;
    while (const std::uint64_t rays = schedule.next(statistics)) {
        ASSERT_LT(++runs, 20);
        statistics.add(std::array{Rgb(1.0F)}, {}, rays - 1); // a run's number of rays is random
    }
    EXPECT_EQ(runs, 8);
}

} // namespace
} // namespace lambert
