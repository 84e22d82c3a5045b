#include "lighting/solve_scene.h"
#include "scene/example_scenes.h"
#include "tests/vpl/statistics.h"

#include <gtest/gtest.h>

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

namespace lambert {
namespace {

const Rgb kReflectance(0.6F, 0.5F, 0.4F);

/// A room turned by an odd angle whose walls all reflect and emit alike: B = B_e / (1 − ρ) everywhere, with B_e = 1.
Scene furnace() {
    Material wall = greyMaterial("wall", 0.0F);
    wall.reflectance = kReflectance;
    wall.emittedRadiance = Rgb(1.0F / std::numbers::pi_v<float>);
    Scene scene = boxScene({4.0F, 3.0F, 2.5F}, {wall, wall, wall, wall, wall, wall});
    const glm::quat turn = glm::angleAxis(0.65F, glm::normalize(glm::vec3(1.0F, 2.0F, 3.0F)));
    for (glm::vec3& position : scene.positions) position = turn * position;
    return scene;
}

/// B / B_exact − 1 of the light that a method finds, over all channels.
struct FurnaceError {
    double worst = 0.0; //!< the largest of any patch, without its sign
    double mean = 0.0;  //!< over the area
};
FurnaceError furnaceError(const LightMethod& method, std::size_t patches) {
    SolveOptions options;
    options.mesh.patches = patches;
    options.method = method;
    Progress progress;
    const SolvedScene solved = solveScene(furnace(), options, progress);
    FurnaceError error;
    double sum = 0.0, weights = 0.0;
    for (std::size_t i = 0; i < solved.mesh.size(); ++i) {
        const auto area = static_cast<double>(solved.mesh.area[i]);
        for (int channel = 0; channel < 3; ++channel) {
            const double found = solved.solution.radiosity[i][channel];
            const double relative = found * (1.0 - static_cast<double>(kReflectance[channel])) - 1.0;
            error.worst = std::max(error.worst, std::abs(relative));
            sum += area * relative;
            weights += area;
        }
    }
    error.mean = sum / weights;
    return error;
}

/// The mean error over `methodOf(seed)` of eight seeds is none but for `bias` and five standard errors: a Student distribution with
/// seven degrees of freedom goes beyond them once in 640 times. A standard error of 1 % would tell nothing.
template <typename MethodOf>
void expectFurnace(MethodOf methodOf, std::size_t patches, double bias) {
    std::vector<double> errors;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) errors.push_back(furnaceError(methodOf(seed), patches).mean);
    const MeanOfRuns mean(errors);
    EXPECT_LT(mean.standardError, 0.01);
    EXPECT_NEAR(mean.mean, 0.0, bias + 5.0 * mean.standardError);
}

/// Letters and digits of a name, as a test's name may have them.
std::string plain(std::string_view name) {
    std::string result;
    for (const char c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) != 0) result += c;
    return result;
}

class FurnaceByFormFactors : public testing::TestWithParam<std::tuple<TransportMethod, SolverMethod, bool>> {};

// With rows that sum to 1 the error of a radiosity is what the solver leaves: its relative residual, 1e-6, over 1 − ρ >= 0.4. But Southwell's shots
// go by the row of the patch that shoots: what they bring is right for every patch where the matrix is reciprocal as well, and in the mean over
// the area where it is not.
TEST_P(FurnaceByFormFactors, HasItsRadiosityOnEveryPatch) {
    const auto [method, solver, stored] = GetParam();
    FormFactorLight light;
    TransportOptions& transport = light.formFactors.transport;
    transport.method = method;
    transport.stored = stored;
    transport.largestResolution = 32;
    transport.mostRays = 4e6;
    light.formFactors.repair = stored && solver == SolverMethod::Southwell;
    light.solver = {.method = solver, .tolerance = 1e-6};
    const FurnaceError error = furnaceError(light, 200);
    EXPECT_NEAR(error.mean, 0.0, 2.5e-6);
    if (solver != SolverMethod::Southwell || stored) {
        EXPECT_LT(error.worst, 2.5e-6);
    }
}

constexpr auto kFormFactorName = [](const auto& one) {
    return plain(nameOf(std::get<0>(one.param))) + "_" + plain(nameOf(std::get<1>(one.param)));
};
const auto kSolvers = testing::Values(SolverMethod::Jacobi, SolverMethod::GaussSeidel, SolverMethod::Southwell,
                                      SolverMethod::ConjugateGradient);
INSTANTIATE_TEST_SUITE_P(Stored, FurnaceByFormFactors,
                         testing::Combine(testing::Values(TransportMethod::Auto, TransportMethod::Hemicube,
                                                          TransportMethod::Hemisphere, TransportMethod::LocalLines,
                                                          TransportMethod::GlobalLines, TransportMethod::ClosedForm),
                                          kSolvers, testing::Values(true)),
                         kFormFactorName);
// Global lines know no single rows.
INSTANTIATE_TEST_SUITE_P(RowByRow, FurnaceByFormFactors,
                         testing::Combine(testing::Values(TransportMethod::Auto, TransportMethod::Hemicube,
                                                          TransportMethod::Hemisphere, TransportMethod::LocalLines,
                                                          TransportMethod::ClosedForm),
                                          kSolvers, testing::Values(false)),
                         kFormFactorName);

class FurnaceByLines : public testing::TestWithParam<std::tuple<LineSolver, RelaxationLines, Sampler>> {};

TEST_P(FurnaceByLines, HasItsRadiosityInTheMean) {
    const auto [solver, lines, sampler] = GetParam();
    LineSolverOptions options{.solver = solver, .rays = 50'000, .lines = lines, .sampler = sampler};
    expectFurnace(
        [&](std::uint64_t seed) {
            options.seed = seed;
            return options;
        },
        200, 0.0);
}

constexpr auto kLineName = [](const auto& one) {
    return plain(nameOf(std::get<0>(one.param))) + (std::get<2>(one.param) == Sampler::Random ? "_random" : "_sobol");
};
const auto kSamplers = testing::Values(Sampler::Sobol, Sampler::Random);
INSTANTIATE_TEST_SUITE_P(Local, FurnaceByLines,
                         testing::Combine(testing::Values(LineSolver::Stochastic, LineSolver::RandomWalk),
                                          testing::Values(RelaxationLines::Local), kSamplers),
                         kLineName);
// Walks have no global lines.
INSTANTIATE_TEST_SUITE_P(Global, FurnaceByLines,
                         testing::Combine(testing::Values(LineSolver::Stochastic),
                                          testing::Values(RelaxationLines::Global), kSamplers),
                         kLineName);

class FurnaceByVirtualLights : public testing::TestWithParam<std::tuple<Walk, Sampler, bool>> {};

// Walks of 16 bounces leave out 0.6^17 of the brightest channel.
TEST_P(FurnaceByVirtualLights, HasItsRadiosityInTheMean) {
    const auto [walk, sampler, compensated] = GetParam();
    InstantRadiosityOptions options;
    options.trace = {.particles = 1024, .walk = walk, .bounces = 16, .sampler = sampler};
    options.gather.bound = compensated ? 10.0 : kUnbounded;
    options.gather.recoveryRays = compensated ? 8 : 0;
    options.points = 8;
    expectFurnace(
        [&](std::uint64_t seed) {
            options.trace.seed = options.gather.seed = seed;
            return options;
        },
        30, walk == Walk::Fixed ? std::pow(0.6, 17) : 0.0);
}

INSTANTIATE_TEST_SUITE_P(Pairs, FurnaceByVirtualLights,
                         testing::Combine(testing::Values(Walk::Quasi, Walk::Roulette, Walk::Fixed),
                                          testing::Values(Sampler::Halton, Sampler::Random), testing::Bool()),
                         [](const auto& one) {
                             return plain(nameOf(std::get<0>(one.param))) +
                                    (std::get<1>(one.param) == Sampler::Random ? "_random" : "_halton") +
                                    (std::get<2>(one.param) ? "_compensated" : "_unbounded");
                         });

} // namespace
} // namespace lambert
