// Solvers by random lines that are stopped and go on, on any number of threads.
#include "checkpoint_case.h"
#include "solver_case.h"
#include "stochastic_case.h"

#include "solver/line_solvers.h"
#include "solver/random_walks.h"
#include "solver/stochastic_relaxation.h"

#include <functional>
#include <optional>
#include <utility>

namespace lambert {
namespace {

/// A solver with all its options.
struct Variant {
    std::string name;
    std::function<StochasticSolution(const SolverProblem&, const PatchMesh&, const RayCaster&, Progress&,
                                     const SolverContext&)>
        solve;
};

Variant relaxation(std::string name, StochasticRelaxationOptions options) {
    return {std::move(name),
            [options](const auto& problem, const auto& mesh, const auto& rays, auto& progress, const auto& context) {
                return solveStochasticRelaxation(problem, mesh, rays, options, progress, context);
            }};
}

Variant walks(std::string name, RandomWalkOptions options) {
    return {std::move(name),
            [options](const auto& problem, const auto& mesh, const auto& rays, auto& progress, const auto& context) {
                return solveRandomWalks(problem, mesh, rays, options, progress, context);
            }};
}

std::vector<Variant> variants() {
    constexpr auto kGlobal = RelaxationLines::Global;
    return {relaxation("LocalLines", {.rays = 400'000}),
            relaxation("LocalLinesRandom", {.rays = 400'000, .sampler = Sampler::Random}),
            relaxation("LocalLinesToAnError", {.rays = 10'000'000, .targetError = 0.01}),
            relaxation("ShootingOnly", {.rays = 400'000, .shootingShare = 1.0, .unshot = 0.0}),
            relaxation("GlobalChords", {.rays = 400'000, .lines = kGlobal}),
            relaxation("GlobalBundles", {.rays = 400'000, .lines = kGlobal, .lineSet = LineSet::Bundles}),
            relaxation("GlobalChordsToAnError", {.rays = 10'000'000, .targetError = 0.02, .lines = kGlobal}),
            walks("Collision", {.walks = 200'000}),
            walks("Absorption", {.walks = 200'000, .estimator = WalkEstimator::Absorption}),
            walks("Survival", {.walks = 200'000, .estimator = WalkEstimator::Survival, .sampler = Sampler::Random}),
            walks("CollisionToAnError", {.walks = 20'000'000, .targetError = 0.01})};
}

void expectSameBits(const StochasticSolution& a, const StochasticSolution& b) {
    EXPECT_EQ(a.radiosity, b.radiosity);
    EXPECT_EQ(a.irradiance, b.irradiance);
    EXPECT_EQ(a.standardError, b.standardError);
    EXPECT_EQ(a.covered, b.covered);
    EXPECT_EQ(a.rays, b.rays);
    EXPECT_EQ(a.subRuns, b.subRuns);
    EXPECT_EQ(a.unshot, b.unshot);
    EXPECT_EQ(a.relativeError, b.relativeError);
    EXPECT_EQ(a.upperRelativeError, b.upperRelativeError);
    EXPECT_EQ(a.targetReached, b.targetReached);
    EXPECT_EQ(a.imbalanceError, b.imbalanceError);
    EXPECT_EQ(a.energy.absorbed, b.energy.absorbed);
    EXPECT_EQ(a.energy.escaped, b.energy.escaped);
    EXPECT_EQ(a.energy.backFaces, b.energy.backFaces);
    ASSERT_EQ(a.history.size(), b.history.size());
    for (std::size_t k = 0; k < a.history.size(); ++k) EXPECT_EQ(a.history[k].residual, b.history[k].residual);
}

class KeptLineSolver : public testing::TestWithParam<Variant> {
protected:
    /// The open corner: a lamp, colours, black backs and light that escapes.
    static const StochasticCase& scene() {
        static const StochasticCase found(openCorner(), 60);
        return found;
    }
    /// In one go, and how many units of progress it made.
    static std::pair<StochasticSolution, std::uint64_t> solved() {
        Counting progress;
        StochasticSolution solution =
            GetParam().solve(SolverProblem({scene().mesh, scene().optics}), scene().mesh, scene().rays, progress, {});
        return {std::move(solution), progress.units()};
    }
    /// With the state written whenever it can be; nothing if it was cancelled.
    static std::optional<StochasticSolution> solveKept(const std::filesystem::path& path, bool resume,
                                                       Progress& progress) {
        SolverCheckpoint checkpoint({path, resume, 0.0}, "test");
        try {
            return GetParam().solve(SolverProblem({scene().mesh, scene().optics}), scene().mesh, scene().rays, progress,
                                    {{}, &checkpoint});
        } catch (const Cancelled&) {
            return std::nullopt;
        }
    }
};

INSTANTIATE_TEST_SUITE_P(All, KeptLineSolver, testing::ValuesIn(variants()),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(KeptLineSolver, HasTheSameBitsOnAnyNumberOfThreads) {
    const ThreadCountGuard guard;
    setThreadCount(1);
    const StochasticSolution one = solved().first;
    for (const int threads : {2, 8}) {
        SCOPED_TRACE(threads);
        setThreadCount(threads);
        expectSameBits(one, solved().first);
    }
}

TEST_P(KeptLineSolver, EndsWithTheSameBitsWhereverItWasStopped) {
    const auto [whole, units] = solved();
    for (const double share : {0.001, 0.02, 0.13, 0.5, 0.9}) {
        SCOPED_TRACE(share);
        const CheckpointFile file;
        CancelAfter progress(1 + static_cast<std::uint64_t>(share * static_cast<double>(units)));
        EXPECT_FALSE(solveKept(file.path(), true, progress));
        Progress silent;
        const auto resumed = solveKept(file.path(), true, silent);
        ASSERT_TRUE(resumed);
        expectSameBits(whole, *resumed);
    }
}

TEST_P(KeptLineSolver, GoesOnSeveralTimesOnOtherNumbersOfThreads) {
    const ThreadCountGuard guard;
    const auto [whole, units] = solved();
    const CheckpointFile file;
    std::optional<StochasticSolution> last;
    int runs = 0;
    for (; !last && runs < 1000; ++runs) {
        setThreadCount(1 + runs % 3);
        // More than any stretch between two states, which is a sub-run of a fifth of all rays at most: every run gets further.
        CancelAfter progress(units / 4);
        last = solveKept(file.path(), true, progress);
    }
    ASSERT_TRUE(last);
    EXPECT_GE(runs, 3);
    expectSameBits(whole, *last);
}

TEST_P(KeptLineSolver, RefusesADamagedState) {
    const CheckpointFile file;
    CancelAfter progress(solved().second / 3);
    EXPECT_FALSE(solveKept(file.path(), true, progress));
    expectDamageIsRefused(file.path(), [&] {
        Progress silent;
        solveKept(file.path(), true, silent);
    });
}

// Half a million walks and more between two states, so that a sub-run of more has some within it.
TEST(RandomWalks, GoOnWithinASubRun) {
    const StochasticCase c(closedCube(), 24);
    const SolverProblem problem({c.mesh, c.optics});
    const RandomWalkOptions options{.walks = 3'000'000, .subRuns = 3};
    Progress silent;
    const StochasticSolution whole = solveRandomWalks(problem, c.mesh, c.rays, options, silent);
    const CheckpointFile file;
    CancelAfter progress(700'000); // of the first million
    {
        SolverCheckpoint checkpoint({file.path(), true, 0.0}, "test");
        EXPECT_THROW(solveRandomWalks(problem, c.mesh, c.rays, options, progress, {{}, &checkpoint}), Cancelled);
    }
    ASSERT_TRUE(file.exists());
    SolverCheckpoint checkpoint({file.path(), true, 0.0}, "test");
    expectSameBits(whole, solveRandomWalks(problem, c.mesh, c.rays, options, silent, {{}, &checkpoint}));
}

TEST(LineSolverIdentity, TellsApartWhatGivesOtherBits) {
    const StochasticCase c(openCorner(), 12);
    std::vector<LineSolverOptions> all(9);
    all[1].solver = LineSolver::RandomWalk;
    all[2].rays = 1'000'000;
    all[3].targetError = 0.03;
    all[4].lines = RelaxationLines::Global;
    all[5].lines = RelaxationLines::Global;
    all[5].lineSet = LineSet::Bundles;
    all[6].sampler = Sampler::Random;
    all[7].seed = 2;
    all[8].rays = 1'000'000;
    all[8].targetError = 0.03;
    std::vector<std::string> names;
    for (const LineSolverOptions& options : all)
        names.push_back(lineSolverIdentity(SolverProblem({c.mesh, c.optics}), options));
    PatchOptics brighter = c.optics;
    brighter.emittedRadiosity[0].x += 1.0F;
    names.push_back(lineSolverIdentity(SolverProblem({c.mesh, brighter}), {}));
    names.push_back(
        lineSolverIdentity(SolverProblem({c.mesh, c.optics}, std::vector<RgbSum>(c.mesh.size(), RgbSum(1.0))), {}));
    for (std::size_t a = 0; a < names.size(); ++a)
        for (std::size_t b = 0; b < a; ++b) EXPECT_NE(names[a], names[b]);
    EXPECT_EQ(names[0], lineSolverIdentity(SolverProblem({c.mesh, c.optics}), {}));
}

} // namespace
} // namespace lambert
