#include "tests/instruction_sets.h"

#include "scene_case.h"

#include "formfactors/global_lines.h"
#include "scene/rays/line_caster.h"
#include "solver/stochastic_relaxation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lambert {
namespace {

using Means = std::map<std::string, RgbSum>;

/// The Cornell box: what each kind of ray counts in it, and the light that comes of it.
struct TracedBox {
    SceneCase c{"cornell_box.obj", 300, hemicubes(64)};
    std::vector<std::uint32_t> crossings; ///< of each patch by the same lines
    Means byMatrix, byLines;

    TracedBox() {
        Progress progress;
        const LineCaster lines(c.scene);
        GlobalLineCounts counts(c.mesh.size());
        GlobalLines(c.mesh, lines, {.lines = 50'000}).trace(counts, progress);
        crossings = counts.crossings();
        byMatrix = c.means(c.solved(SolverMethod::ConjugateGradient).irradiance);
        StochasticRelaxationOptions options;
        options.lines = RelaxationLines::Global;
        options.rays = 100'000;
        byLines = c.means(
            solveStochasticRelaxation(SolverProblem({c.mesh, c.optics}), c.mesh, c.rays, options, progress).irradiance);
    }
};

/// The largest Σ_j |ΔF_ij| of a row.
double largestRowDifference(const FormFactorMatrix& a, const FormFactorMatrix& b) {
    double largest = 0.0;
    std::vector<double> difference(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::fill(difference.begin(), difference.end(), 0.0);
        a.visit(i, [&](std::uint32_t j, double f) { difference[j] += f; });
        b.visit(i, [&](std::uint32_t j, double f) { difference[j] -= f; });
        double sum = 0.0;
        for (const double d : difference) sum += std::abs(d);
        largest = std::max(largest, sum);
    }
    return largest;
}

/// The largest difference of a material's light, relative to it.
double largestDifference(const Means& a, const Means& b) {
    double largest = 0.0;
    for (const auto& [name, mean] : a)
        for (int k = 0; k < 3; ++k)
            if (mean[k] > 0.0) largest = std::max(largest, std::abs(b.at(name)[k] / mean[k] - 1.0));
    return largest;
}

// A ray that meets an outline nearer than rounding may meet either side of it. Of a hemicube's 12,288 pixels at most four do, which
// move twice their form factors; of the lines as few. A ray that goes elsewhere moves a material's mean by 1e-5 or less, but shifts
// the random numbers of relaxation: 1e-2 is its noise.
TEST(InstructionSets, AgreeOnFormFactorsAndLight) {
    constexpr double kPixel = 4.0 / (64.0 * 64.0 * std::numbers::pi); // the largest form factor of a pixel
    const auto trace = [] { return TracedBox(); };
    const TracedBox expected = with(instructionSets().front(), trace);
    for (const char* name : instructionSets()) {
        const TracedBox found = with(name, trace);
        ASSERT_EQ(found.c.mesh.size(), expected.c.mesh.size());
        std::size_t crossings = 0, others = 0;
        for (std::size_t i = 0; i < found.crossings.size(); ++i) {
            const auto [fewer, more] = std::minmax(found.crossings[i], expected.crossings[i]);
            others += more - fewer;
            crossings += more;
        }
        EXPECT_LE(largestRowDifference(found.c.matrix, expected.c.matrix), 8.0 * kPixel) << name;
        EXPECT_LE(others, 20U) << name << ", of " << crossings;
        EXPECT_LE(largestDifference(found.byMatrix, expected.byMatrix), 1e-4) << name;
        EXPECT_LE(largestDifference(found.byLines, expected.byLines), 1e-2) << name;
    }
}

} // namespace
} // namespace lambert
