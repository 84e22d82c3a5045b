/// What every method based on rays must keep, on scenes with exact factors.
#include "exact_case.h"
#include "formfactors/hemicube.h"
#include "formfactors/hemisphere.h"
#include "formfactors/local_lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace lambert {
namespace {

constexpr std::array kSamplers{Sampler::Random, Sampler::Stratified, Sampler::Halton, Sampler::Sobol};

// z-test of the mean over seeds, per pair, with the seeds' own standard error. Two scenes × 30 pairs × 4 samplers = 240
// tests at once: to fail by chance once in 1000 (Šidák), each must fail once in 240,000: 4.6 standard errors of a normal
// distribution; of Student's t with 63 degrees of freedom, 5.0.
TEST(LocalLines, AreUnbiasedForEveryPair) {
    constexpr int kSeeds = 64;
    for (const glm::vec3& size : {kCube6, kRoom432}) {
        const ExactCase exact(closedBox(size));
        for (const Sampler sampler : kSamplers) {
            std::vector<std::vector<double>> sum(6, std::vector<double>(6, 0.0)), squares = sum;
            for (int seed = 0; seed < kSeeds; ++seed) {
                const LocalLines lines(exact.mesh, exact.rays,
                                       {.lines = 500, .sampler = sampler, .seed = static_cast<std::uint64_t>(seed)});
                for (std::uint32_t i = 0; i < 6; ++i) {
                    const FormFactorRow row = rowOf(lines, i);
                    for (std::uint32_t j = 0; j < 6; ++j) {
                        sum[i][j] += entry(row, j);
                        squares[i][j] += std::pow(entry(row, j), 2.0);
                    }
                }
            }
            for (std::size_t i = 0; i < 6; ++i) {
                for (std::size_t j = 0; j < 6; ++j) {
                    const double mean = sum[i][j] / kSeeds;
                    if (i == j) {
                        EXPECT_EQ(mean, 0.0);
                        continue;
                    }
                    const double variance = (squares[i][j] / kSeeds - mean * mean) / (kSeeds - 1);
                    EXPECT_LT(std::abs(mean - exact.factor[i][j]), 5.0 * std::sqrt(variance))
                        << "sampler " << static_cast<int>(sampler) << " pair " << i << " " << j << " mean " << mean
                        << " exact " << exact.factor[i][j];
                }
            }
        }
    }
}

TEST(LocalLines, VarianceOfIndependentLinesIsBinomial) {
    const ExactCase exact(closedBox(kCube6));
    constexpr int kSeeds = 400;
    constexpr std::uint32_t kLines = 200;
    double sum = 0.0, squares = 0.0;
    for (int seed = 0; seed < kSeeds; ++seed) {
        const LocalLines lines(exact.mesh, exact.rays,
                               {.lines = kLines, .sampler = Sampler::Random, .seed = static_cast<std::uint64_t>(seed)});
        const double f = entry(rowOf(lines, 0), 1);
        sum += f;
        squares += f * f;
    }
    const double variance = squares / kSeeds - std::pow(sum / kSeeds, 2.0);
    const double expected = exact.factor[0][1] * (1.0 - exact.factor[0][1]) / kLines;
    EXPECT_NEAR(variance / expected, 1.0, 0.35); // its standard deviation is √(2/400) = 7 %: five of them
}

/// Error exponent: RMS over pairs and seeds of factors at efforts that grow fourfold, fitted by least squares in logarithms.
double
errorSlope(const ExactCase& exact, int seeds, std::span<const std::uint32_t> efforts,
           const std::function<std::unique_ptr<FormFactorMethod>(std::uint32_t effort, std::uint64_t seed)>& make) {
    std::vector<double> rays, error;
    for (const std::uint32_t effort : efforts) {
        double squares = 0.0;
        double raysPerRow = 0.0;
        for (int seed = 0; seed < seeds; ++seed) {
            const auto method = make(effort, static_cast<std::uint64_t>(seed));
            raysPerRow = static_cast<double>(method->raysPerRow());
            for (std::uint32_t i = 0; i < exact.mesh.size(); ++i) {
                const FormFactorRow row = rowOf(*method, i);
                for (std::uint32_t j = 0; j < exact.mesh.size(); ++j)
                    squares += std::pow(entry(row, j) - exact.factor[i][j], 2.0);
            }
        }
        rays.push_back(raysPerRow);
        error.push_back(std::sqrt(squares));
    }
    return logarithmicSlope(rays, error);
}

// Random lines: −1/2. Two jittered grids that are shuffled against each other lower the error, not its rate. Points that are
// spread in all four dimensions gain 1 / (2 · 4) at least, with edges for discontinuities: −5/8. Six faces × 5 pairs × 8 seeds tell an RMS to 5 %, a slope over a factor of 64 to 0.02.
TEST(LocalLines, ErrorFallsAtItsRate) {
    const ExactCase exact(closedBox(kRoom432));
    constexpr std::array<std::uint32_t, 4> efforts{64, 256, 1024, 4096};
    const auto slope = [&](Sampler sampler) {
        return errorSlope(exact, 8, efforts, [&](std::uint32_t n, std::uint64_t seed) {
            return std::make_unique<LocalLines>(exact.mesh, exact.rays,
                                                LocalLinesOptions{.lines = n, .sampler = sampler, .seed = seed});
        });
    };
    EXPECT_NEAR(slope(Sampler::Random), -0.5, 0.08);
    EXPECT_NEAR(slope(Sampler::Stratified), -0.5, 0.08);
    EXPECT_LT(slope(Sampler::Halton), -0.6);
    EXPECT_LT(slope(Sampler::Sobol), -0.6);
}

TEST(AllRayMethods, RowsCloseInAClosedBoxAndTwoSidesAreFound) {
    Scene scene = closedBox(kRoom432);
    const ExactCase exact(scene);
    const std::array<std::unique_ptr<FormFactorMethod>, 3> methods{
        std::make_unique<Hemicube>(exact.mesh, exact.rays, ViewOptions{.resolution = 32, .perPatch = 3}),
        std::make_unique<Hemisphere>(exact.mesh, exact.rays, ViewOptions{.resolution = 32, .perPatch = 2}),
        std::make_unique<LocalLines>(exact.mesh, exact.rays, LocalLinesOptions{.lines = 1001})};
    for (const auto& method : methods) {
        for (std::uint32_t i = 0; i < 6; ++i) {
            const FormFactorRow row = rowOf(*method, i);
            EXPECT_NEAR(row.sum(), 1.0, 1e-6);
            EXPECT_EQ(row.back, 0.0);
            EXPECT_EQ(row.out, 0.0);
        }
    }
}

TEST(AllRayMethods, AScaleOfAPowerOfTwoChangesNoDigit) {
    const auto rows = [](float scale) {
        const ExactCase c(closedBox(scale * kRoom432));
        const std::array<std::unique_ptr<FormFactorMethod>, 3> methods{
            std::make_unique<Hemicube>(c.mesh, c.rays, ViewOptions{.resolution = 32}),
            std::make_unique<Hemisphere>(c.mesh, c.rays, ViewOptions{.resolution = 32}),
            std::make_unique<LocalLines>(c.mesh, c.rays, LocalLinesOptions{.lines = 1000})};
        std::vector<FormFactorRow> result;
        for (const auto& method : methods)
            for (std::uint32_t i = 0; i < 6; ++i) result.push_back(rowOf(*method, i));
        return result;
    };
    const std::vector<FormFactorRow> metres = rows(1.0F);
    for (const int exponent : {-34, -20, 40}) EXPECT_EQ(rows(std::ldexp(1.0F, exponent)), metres) << exponent;
}

// Point and patch averages: from the centre of the floor the factors are those of a point, with many points those of the
// patch. 5e-3: 64 stratified points of a smooth integrand.
TEST(Hemisphere, ManyPerPatchGiveThePatchAverage) {
    const ExactCase exact(closedBox(kCube6));
    for (std::uint32_t i = 0; i < 6; ++i) {
        const Hemisphere one(exact.mesh, exact.rays, {.resolution = 64});
        const Hemisphere many(exact.mesh, exact.rays, {.resolution = 32, .perPatch = 64});
        const std::uint32_t opposite = i ^ 1U;
        EXPECT_NEAR(entry(rowOf(one, i), opposite), 0.2394564705, 3e-3) << i; // point to the square at distance 1
        EXPECT_NEAR(entry(rowOf(many, i), opposite), exact.factor[i][opposite], 5e-3) << i;
    }
}

TEST(Hemicube, ManyPerPatchGiveThePatchAverage) {
    const ExactCase exact(closedBox(kCube6));
    const Hemicube many(exact.mesh, exact.rays, {.resolution = 32, .perPatch = 64});
    EXPECT_NEAR(entry(rowOf(many, 0), 1), exact.factor[0][1], 5e-3);
}

TEST(LocalLines, CompactStorageKeepsThemExactly) {
    const ExactCase exact(closedBox(kCube6));
    const LocalLines lines(exact.mesh, exact.rays, {.lines = 3000});
    Progress progress;
    const FormFactorMatrix compact = computeMatrix(lines, MatrixStorage::Compact, progress);
    for (std::uint32_t i = 0; i < 6; ++i) {
        const FormFactorRow row = rowOf(lines, i);
        EXPECT_EQ(row.lines, 3000U);
        for (std::uint32_t j = 0; j < 6; ++j) EXPECT_NEAR(entry(compact.row(i), j), entry(row, j), 1e-15);
    }
}

} // namespace
} // namespace lambert
