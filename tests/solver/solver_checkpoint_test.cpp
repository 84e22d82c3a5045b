#include "checkpoint_case.h"
#include "solver_case.h"

#include "core/error.h"
#include "solver/computed_rows.h"

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

namespace lambert {
namespace {

SolverOptions optionsFor(SolverMethod method) {
    SolverOptions options;
    options.method = method;
    options.tolerance = 1e-9;
    options.keepBounces = method == SolverMethod::Jacobi;
    return options;
}

/// Solves with the state written after every iteration; nothing if it was cancelled.
std::optional<RadiositySolution> solveKept(const RandomMatrix& scene, const SolverOptions& options,
                                           const std::filesystem::path& path, bool resume, Progress& progress) {
    const SolverProblem problem(scene.patches);
    SolverCheckpoint checkpoint({path, resume, 0.0}, solverIdentity(problem, options, {}));
    StoredRows rows(scene.matrix);
    try {
        return solve(problem, rows, options, progress, {{}, &checkpoint});
    } catch (const Cancelled&) {
        return std::nullopt;
    }
}

void expectSameBits(const RadiositySolution& a, const RadiositySolution& b) {
    EXPECT_EQ(a.radiosity, b.radiosity);
    EXPECT_EQ(a.irradiance, b.irradiance);
    EXPECT_EQ(a.bounces, b.bounces);
    EXPECT_EQ(a.iterations, b.iterations);
    EXPECT_EQ(a.residual, b.residual);
    ASSERT_EQ(a.history.size(), b.history.size());
    for (std::size_t k = 0; k < a.history.size(); ++k) {
        EXPECT_EQ(a.history[k].iteration, b.history[k].iteration);
        EXPECT_EQ(a.history[k].residual, b.history[k].residual);
    }
}

class CheckpointedSolver : public testing::TestWithParam<SolverMethod> {};

TEST_P(CheckpointedSolver, EndsWithTheSameBitsWhereverItWasStopped) {
    const RandomMatrix scene(200, 3);
    const SolverOptions options = optionsFor(GetParam());
    StoredRows rows(scene.matrix);
    Progress silent;
    const RadiositySolution whole = solve(SolverProblem(scene.patches), rows, options, silent);
    const auto last = static_cast<std::uint64_t>(whole.iterations);
    for (const std::uint64_t units : {std::uint64_t{1}, std::uint64_t{2}, last / 3, last / 2, last - 2, last - 1}) {
        SCOPED_TRACE(units);
        const CheckpointFile file;
        CancelAfter progress(units);
        EXPECT_FALSE(solveKept(scene, options, file.path(), false, progress));
        const auto resumed = solveKept(scene, options, file.path(), true, silent);
        ASSERT_TRUE(resumed);
        expectSameBits(whole, *resumed);
    }
}

TEST_P(CheckpointedSolver, GoesOnSeveralTimes) {
    const RandomMatrix scene(200, 4);
    const SolverOptions options = optionsFor(GetParam());
    StoredRows rows(scene.matrix);
    Progress silent;
    const RadiositySolution whole = solve(SolverProblem(scene.patches), rows, options, silent);
    const CheckpointFile file;
    std::optional<RadiositySolution> last;
    for (int run = 0; !last && run < 1000; ++run) {
        CancelAfter progress(GetParam() == SolverMethod::Southwell ? 500 : 4);
        last = solveKept(scene, options, file.path(), true, progress);
    }
    ASSERT_TRUE(last);
    expectSameBits(whole, *last);
}

TEST_P(CheckpointedSolver, NeedsFewerIterationsFromAWarmStart) {
    const RandomMatrix scene(200, 5, true); // closed: bright enough for many iterations
    SolverOptions options = optionsFor(GetParam());
    options.keepBounces = false;
    StoredRows rows(scene.matrix);
    Progress silent;
    const SolverProblem problem(scene.patches);
    const RadiositySolution cold = solve(problem, rows, options, silent);
    std::vector<RgbSum> start;
    for (const RgbSum& e : cold.irradiance) start.emplace_back(Rgb(e)); // as a file holds it
    const RadiositySolution warm = solve(problem, rows, options, silent, {start});
    EXPECT_LT(warm.iterations, cold.iterations / 2);
    EXPECT_LE(warm.residual, options.tolerance);
    // Both are within residual / (1 − ρ) of the solution, ρ <= 0.95.
    std::vector<RgbSum> difference(problem.size());
    for (std::size_t i = 0; i < problem.size(); ++i) difference[i] = warm.radiosity[i] - cold.radiosity[i];
    EXPECT_LE(problem.relativeNorm(difference), 2.0 * options.tolerance / 0.05);
}

TEST_P(CheckpointedSolver, TakesAStartThatIsTooBright) {
    const RandomMatrix scene(200, 6);
    SolverOptions options = optionsFor(GetParam());
    options.keepBounces = false;
    StoredRows rows(scene.matrix);
    Progress silent;
    const SolverProblem problem(scene.patches);
    const RadiositySolution cold = solve(problem, rows, options, silent);
    std::vector<RgbSum> start = cold.irradiance;
    for (RgbSum& e : start) e *= 3.0;
    const RadiositySolution warm = solve(problem, rows, options, silent, {start});
    EXPECT_LE(warm.residual, options.tolerance);
    std::vector<RgbSum> difference(problem.size());
    for (std::size_t i = 0; i < problem.size(); ++i) difference[i] = warm.radiosity[i] - cold.radiosity[i];
    EXPECT_LE(problem.relativeNorm(difference), 2.0 * options.tolerance / 0.05);
}

INSTANTIATE_TEST_SUITE_P(Solvers, CheckpointedSolver, deterministicSolvers(), solverTestName);

TEST(SolverCheckpoint, OfAnotherSolveIsRefused) {
    const RandomMatrix scene(50, 7);
    const CheckpointFile file;
    CancelAfter progress(2);
    SolverOptions options = optionsFor(SolverMethod::Jacobi);
    EXPECT_FALSE(solveKept(scene, options, file.path(), false, progress));
    Progress silent;
    EXPECT_THROW(solveKept(scene, options, file.path(), false, silent), UsageError); // without resume
    options.tolerance = 1e-8;
    EXPECT_THROW(solveKept(scene, options, file.path(), true, silent), UsageError);
    EXPECT_THROW(solveKept(RandomMatrix(50, 8), optionsFor(SolverMethod::Jacobi), file.path(), true, silent),
                 UsageError);
}

TEST(SolverCheckpoint, ThatIsDamagedIsRefused) {
    const RandomMatrix scene(50, 7);
    const SolverOptions options = optionsFor(SolverMethod::ConjugateGradient);
    const CheckpointFile file;
    CancelAfter progress(3);
    EXPECT_FALSE(solveKept(scene, options, file.path(), false, progress));
    expectDamageIsRefused(file.path(), [&] {
        Progress silent;
        solveKept(scene, options, file.path(), true, silent);
    });
}

TEST(SolverCheckpoint, InUseByAnotherRunIsRefused) {
    const CheckpointFile file;
    const auto refusal = [&]() -> std::string {
        try {
            const SolverCheckpoint second({file.path(), true, 0.0}, "one");
        } catch (const UsageError& error) {
            return error.what();
        }
        return {};
    };
    const std::string expected = "--checkpoint: " + file.path().string() + " is in use by another run";
    {
        SolverCheckpoint first({file.path(), false, 0.0}, "one");
        EXPECT_EQ(refusal(), expected); // before it has written anything
        const auto state = [](auto& archive) { archive(1); };
        first.keep(state);
        first.keep(state); // in a new file of the same name
        EXPECT_EQ(refusal(), expected);
        EXPECT_EQ(refusal(), expected); // the refused one has unlocked nothing
    }
    EXPECT_EQ(refusal(), "");
    EXPECT_FALSE(std::filesystem::exists(file.path().string() + ".lock"));
}

TEST(SolverCheckpoint, ThatIsNotThereIsABeginning) {
    const RandomMatrix scene(50, 9);
    const CheckpointFile file;
    Progress silent;
    EXPECT_TRUE(solveKept(scene, optionsFor(SolverMethod::GaussSeidel), file.path(), true, silent));
    EXPECT_TRUE(file.exists()); // until the caller removes it
}

} // namespace
} // namespace lambert
