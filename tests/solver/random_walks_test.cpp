#include "stochastic_case.h"

#include "core/error.h"
#include "core/parallel.h"
#include "solver/random_walks.h"

#include <fmt/format.h>

namespace lambert {
namespace {

constexpr int kSeeds = 12;
constexpr std::array kEstimators{WalkEstimator::Collision, WalkEstimator::Absorption, WalkEstimator::Survival};

StochasticSolution solve(const StochasticCase& c, RandomWalkOptions options, std::uint64_t seed = 1) {
    Progress progress;
    options.seed = seed;
    return solveRandomWalks(SolverProblem({c.mesh, c.optics}), c.mesh, c.rays, options, progress);
}

void expectEstimatorsUnbiased(const StochasticCase& c, const std::string& scene) {
    for (const WalkEstimator estimator : kEstimators)
        for (const Sampler sampler : {Sampler::Sobol, Sampler::Random}) {
            std::vector<StochasticSolution> runs;
            for (int seed = 1; seed <= kSeeds; ++seed)
                runs.push_back(solve(c, {.walks = 40'000, .estimator = estimator, .sampler = sampler},
                                     static_cast<std::uint64_t>(seed)));
            expectUnbiased(c.mesh, c.exact.irradiance, runs,
                           fmt::format("{}, estimator {}", scene, static_cast<int>(estimator)));
        }
}

TEST(RandomWalks, AreUnbiasedInTheColouredCube) {
    expectEstimatorsUnbiased({colouredBox(glm::vec3(1.0F)), 24}, "cube6");
}

TEST(RandomWalks, AreUnbiasedAroundABox) { expectEstimatorsUnbiased({roomWithBoxScene(), 30}, "room with a box"); }

TEST(RandomWalks, AreUnbiasedInTheOpenWithBlackBacks) { expectEstimatorsUnbiased({openCorner(), 12}, "open corner"); }

TEST(RandomWalks, AreUnbiasedOnTheTetrahedronOfFourPatches) {
    expectEstimatorsUnbiased({tetrahedron(), 0}, "tetrahedron");
}

// Power is neither made nor lost where walks end: what arrives and is absorbed, by the collision estimator, is what was born less
// what got lost, within its standard error.
TEST(RandomWalks, EnergyBalancesWithinItsStandardError) {
    const StochasticCase c(openCorner(), 60);
    for (const WalkEstimator estimator : kEstimators) {
        int outside = 0;
        for (std::uint64_t seed = 1; seed <= 40; ++seed) {
            const StochasticSolution run = solve(c, {.walks = 40'000, .estimator = estimator}, seed);
            outside += std::abs(run.energy.imbalance()) > 3.0 * run.imbalanceError ? 1 : 0;
            EXPECT_NEAR(run.energy.escaped.x, c.exact.energy.escaped.x, 0.05 * c.exact.energy.emitted.x);
            EXPECT_NEAR(run.energy.backFaces.x, c.exact.energy.backFaces.x, 0.05 * c.exact.energy.emitted.x);
        }
        EXPECT_LE(outside, 5); // of Student's t with 7 degrees 2 % lie outside: once in 7,000 times
    }
}

TEST(RandomWalks, SameBitsOnAnyNumberOfThreads) {
    const StochasticCase c(openCorner(), 60);
    std::vector<StochasticSolution> runs;
    for (const int threads : {1, 2, 8}) {
        setThreadCount(threads);
        runs.push_back(solve(c, {.walks = 200'000}));
    }
    setThreadCount(0);
    for (std::size_t k = 1; k < runs.size(); ++k) {
        EXPECT_EQ(runs[k].radiosity, runs[0].radiosity);
        EXPECT_EQ(runs[k].standardError, runs[0].standardError);
        EXPECT_EQ(runs[k].rays, runs[0].rays);
        EXPECT_EQ(runs[k].energy.escaped, runs[0].energy.escaped);
    }
}

// A walk in the furnace (ρ = 1/2) makes 1 / (1 − ρ) rays; five standard deviations of the mean of a geometric distribution.
TEST(RandomWalks, AreAsLongAsTheReflectanceMakesThem) {
    const StochasticCase c(closedCube(), 24);
    constexpr std::uint64_t kWalks = 100'000;
    const StochasticSolution solution = solve(c, {.walks = kWalks});
    EXPECT_NEAR(static_cast<double>(solution.rays) / kWalks, 2.0, 5.0 * std::sqrt(2.0 / kWalks));
}

TEST(RandomWalks, RefuseWhatMakesNoSense) {
    const StochasticCase c(openCorner(), 0);
    EXPECT_THROW(solve(c, {.walks = 0}), UsageError);
    EXPECT_THROW(solve(c, {.targetError = -1.0}), UsageError);
    EXPECT_THROW(solve(c, {.subRuns = 1}), UsageError);
}

} // namespace
} // namespace lambert
