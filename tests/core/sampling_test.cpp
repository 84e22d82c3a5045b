#include "discrepancy.h"

#include "core/low_discrepancy.h"
#include "core/sample_points.h"
#include "core/vector_warps.h"
#include "core/warps.h"

#include <boost/random/sobol.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

namespace lambert {
namespace {

constexpr std::array kSamplers{Sampler::Random, Sampler::Stratified, Sampler::Halton, Sampler::Sobol};

/// χ² of counts against equal expectations.
double chiSquared(const std::vector<int>& counts, double expected) {
    double sum = 0.0;
    for (const int count : counts) sum += (count - expected) * (count - expected) / expected;
    return sum;
}

TEST(RadicalInverse, MirrorsTheDigits) {
    EXPECT_EQ(radicalInverse(2, 6), 0.375);            // 110 -> .011
    EXPECT_DOUBLE_EQ(radicalInverse(3, 5), 7.0 / 9.0); // 12 -> .21
    EXPECT_EQ(radicalInverse(10, 123), 0.321);
    EXPECT_EQ(radicalInverse(2, 0), 0.0);
    EXPECT_LT(radicalInverse(7, ~std::uint64_t{0}), 1.0);
}

TEST(Halton, BeginsAtOneHalfAndOneThird) {
    EXPECT_EQ(halton(1, 0), 0.5);
    EXPECT_DOUBLE_EQ(halton(1, 1), 1.0 / 3.0);
    EXPECT_DOUBLE_EQ(halton(1, kPrimes - 1), 1.0 / 1619.0);
}

TEST(Sobol, FourDimensionsAtOnceAreTheSame) {
    for (const std::uint32_t index : {0U, 1U, 2U, 255U, 256U, 0x12345678U, 0xFFFF0000U, 0xFFFFFFFFU})
        for (std::uint32_t d = 0; d < 4; ++d) EXPECT_EQ(sobol4(index)[d], sobol(index, d)) << index;
}

// Boost's generator leaves the origin out and walks in Gray-code order: its k-th point is the point gray(k).
TEST(Sobol, AgreesWithBoost) {
    boost::random::sobol_engine<std::uint32_t, 32> engine(kSobolDimensions);
    for (std::uint32_t k = 1; k < 1000; ++k) {
        const std::uint32_t gray = k ^ (k >> 1);
        for (std::uint32_t d = 0; d < kSobolDimensions; ++d) ASSERT_EQ(engine(), sobol(gray, d)) << k << " " << d;
    }
}

// A (0, m, 2)-net in base 2: every elementary box of area 2^-m holds one point, scrambled or not.
TEST(Sobol, HasOnePointInEveryElementaryBox) {
    constexpr int kBits = 8;
    for (const std::uint32_t seed : {0U, 17U, 0xDEADBEEFU}) {
        for (int xBits = 0; xBits <= kBits; ++xBits) {
            std::set<std::uint64_t> boxes;
            for (std::uint32_t i = 0; i < (1U << kBits); ++i) {
                const std::uint64_t x = seed == 0 ? sobol(i, 0) : owenScrambled(sobol(i, 0), seed);
                const std::uint64_t y = seed == 0 ? sobol(i, 1) : owenScrambled(sobol(i, 1), seed * 31 + 7);
                boxes.insert((x >> (32 - xBits)) << 32 | (y >> (32 - kBits + xBits)));
            }
            EXPECT_EQ(boxes.size(), 1U << kBits) << "seed " << seed << ", x bits " << xBits;
        }
    }
}

TEST(Permuted, IsAPermutation) {
    for (const std::uint32_t count : {1U, 2U, 3U, 7U, 64U, 1000U}) {
        std::set<std::uint32_t> places;
        for (std::uint32_t i = 0; i < count; ++i) places.insert(permuted(i, count, 42));
        EXPECT_EQ(places.size(), count);
        EXPECT_EQ(*places.rbegin(), count - 1);
    }
}

// Every place is equally likely over the seeds. 99.9 % of χ²(15) lie below 37.7; four tests: odds of 1 in 250.
TEST(Permuted, PutsAnIndexAnywhere) {
    for (const std::uint32_t index : {0U, 1U, 7U, 15U}) {
        std::vector<int> counts(16, 0);
        for (std::uint64_t seed = 0; seed < 16000; ++seed) ++counts[permuted(index, 16, seed)];
        EXPECT_LT(chiSquared(counts, 1000.0), 37.7) << index;
    }
}

// A single point of the set, over many seeds, is uniform: 99.99 % of χ²(63) lie below 113.
// 4 samplers × 4 indices × 2 pairs of dimensions: odds of 1 in 300.
TEST(SamplePoints, EverySinglePointIsUniformOverTheSeeds) {
    constexpr int kSeeds = 12800;
    for (const Sampler sampler : kSamplers) {
        for (const std::uint32_t index : {0U, 1U, 10U, 99U}) {
            for (const std::uint32_t d : {0U, 2U}) {
                std::vector<int> counts(64, 0);
                for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
                    const SamplePoints points(sampler, 100, 4, seed);
                    const auto x = static_cast<std::size_t>(8.0 * points.at(index, d));
                    const auto y = static_cast<std::size_t>(8.0 * points.at(index, d + 1));
                    ++counts.at(8 * x + y);
                }
                EXPECT_LT(chiSquared(counts, kSeeds / 64.0), 113.0)
                    << "sampler " << static_cast<int>(sampler) << " index " << index << " dimension " << d;
            }
        }
    }
}

TEST(SamplePoints, EveryPairOfSeedsIsUncorrelated) {
    // Mean of (x − 1/2)(y − 1/2) over 10,000 pairs: standard deviation 1 / (12 · 100); 4.5 of them.
    for (const Sampler sampler : kSamplers) {
        double sum = 0.0;
        for (std::uint64_t seed = 0; seed < 10000; ++seed)
            sum += (SamplePoints(sampler, 64, 4, seed).at(5, 1) - 0.5) *
                   (SamplePoints(sampler, 64, 4, seed + 1).at(5, 1) - 0.5);
        EXPECT_LT(std::abs(sum / 10000.0), 4.5 / 1200.0) << static_cast<int>(sampler);
    }
}

// The error of ∫ x² y dx dy over 32 seeds: better than random by far, at the same number of points.
TEST(SamplePoints, SpreadBetterThanRandomOnes) {
    const auto rmsError = [](Sampler sampler) {
        double squares = 0.0;
        for (std::uint64_t seed = 0; seed < 32; ++seed) {
            const SamplePoints points(sampler, 1024, 4, seed);
            double sum = 0.0;
            for (std::uint32_t i = 0; i < 1024; ++i) sum += std::pow(points.at(i, 2), 2.0) * points.at(i, 3);
            squares += std::pow(sum / 1024.0 - 1.0 / 6.0, 2.0);
        }
        return std::sqrt(squares / 32.0);
    };
    const double random = rmsError(Sampler::Random);
    EXPECT_NEAR(random, std::sqrt(1.0 / 15.0 - 1.0 / 36.0) / 32.0, 0.3 * random); // σ/√N; 32 seeds tell it to 12 %
    EXPECT_LT(rmsError(Sampler::Stratified), random / 8.0);
    EXPECT_LT(rmsError(Sampler::Halton), random / 8.0);
    EXPECT_LT(rmsError(Sampler::Sobol), random / 20.0);
}

TEST(SamplePoints, HaveNames) {
    EXPECT_EQ(samplerByName("sobol"), Sampler::Sobol);
    EXPECT_EQ(samplerByName("Sobol"), std::nullopt);
}

TEST(Warps, ConcentricDiskKeepsAreas) {
    // An 8 × 8 grid of cells becomes rings and sectors of the same area: 64 sectors of the disk hold what they should.
    constexpr std::uint32_t kSide = 512;
    std::vector<int> rings(8, 0), sectors(8, 0);
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
        const glm::dvec2 p = concentricDisk((glm::dvec2(i % kSide, i / kSide) + 0.5) / static_cast<double>(kSide));
        ASSERT_LE(glm::dot(p, p), 1.0 + 1e-12);
        ++rings.at(std::min<std::size_t>(7, static_cast<std::size_t>(8.0 * glm::dot(p, p))));
        const double turn = std::atan2(p.y, p.x) / (2.0 * std::numbers::pi) + 0.5;
        ++sectors.at(std::min<std::size_t>(7, static_cast<std::size_t>(8.0 * turn)));
    }
    // Cells on a ring's border fall to one side: at most a perimeter's worth, 4 · 512 of 32,768.
    for (const int count : rings) EXPECT_NEAR(count, kSide * kSide / 8, 4 * kSide);
    for (const int count : sectors) EXPECT_NEAR(count, kSide * kSide / 8, 4 * kSide);
    EXPECT_EQ(concentricDisk(glm::dvec2(0.5)), glm::dvec2(0.0));
}

/// Means of the moments of a warp over a fine grid of midpoints.
template <typename Warp, typename Moment>
double gridMean(Warp&& warp, Moment&& moment) {
    constexpr int kSide = 1000;
    double sum = 0.0;
    for (int i = 0; i < kSide * kSide; ++i)
        sum += moment(warp((glm::dvec2(i % kSide, i / kSide) + 0.5) / static_cast<double>(kSide)));
    return sum / (kSide * kSide);
}

// Tolerances: the midpoint rule of 1000² points with kinks along lines is good to about 1e-6.
TEST(Warps, CosineHemisphereHasTheMomentsOfACosine) {
    EXPECT_NEAR(gridMean(cosineHemisphere, [](const auto& d) { return d.z; }), 2.0 / 3.0, 2e-5); // edge: square root
    EXPECT_NEAR(gridMean(cosineHemisphere, [](const auto& d) { return d.z * d.z; }), 0.5, 2e-6);
    EXPECT_NEAR(gridMean(cosineHemisphere, [](const auto& d) { return d.x * d.x; }), 0.25, 2e-6);
    EXPECT_NEAR(gridMean(cosineHemisphere, [](const auto& d) { return d.x * d.y; }), 0.0, 2e-6);
    EXPECT_NEAR(gridMean(cosineHemisphere, [](const auto& d) { return glm::length(d); }), 1.0, 1e-12);
}

TEST(Warps, UniformSphereHasTheMomentsOfASphere) {
    for (int a = 0; a < 3; ++a) {
        EXPECT_NEAR(gridMean(uniformSphere, [a](const auto& d) { return d[a]; }), 0.0, 2e-6);
        EXPECT_NEAR(gridMean(uniformSphere, [a](const auto& d) { return d[a] * d[a]; }), 1.0 / 3.0, 2e-6);
    }
}

TEST(Warps, UniformTriangleHasItsCentroidAndSpread) {
    for (int a = 0; a < 3; ++a) {
        EXPECT_NEAR(gridMean(uniformTriangle, [a](const auto& w) { return w[a]; }), 1.0 / 3.0, 2e-5);
        EXPECT_NEAR(gridMean(uniformTriangle, [a](const auto& w) { return w[a] * w[a]; }), 1.0 / 6.0, 2e-5);
    }
}

TEST(Warps, UniformQuadIsUniformOnATrapezoid) {
    // Corners (0,0) (4,0) (2,1) (0,1): area 3, centroid by parts (triangles of area 2 and 1).
    const std::array<glm::dvec2, 4> corners{{{0, 0}, {4, 0}, {2, 1}, {0, 1}}};
    const auto point = [&](const glm::dvec2& u) {
        const auto w = uniformQuad(u, 2.0, 1.0);
        return w[0] * corners[0] + w[1] * corners[1] + w[2] * corners[2] + w[3] * corners[3];
    };
    const glm::dvec2 centroid = (2.0 * glm::dvec2(2.0, 1.0 / 3.0) + glm::dvec2(2.0 / 3.0, 2.0 / 3.0)) / 3.0;
    EXPECT_NEAR(gridMean(point, [](const auto& p) { return p.x; }), centroid.x, 2e-3); // one column of cells across
    EXPECT_NEAR(gridMean(point, [](const auto& p) { return p.y; }), centroid.y, 2e-3); // the seam of the triangles
    EXPECT_NEAR(gridMean(point, [](const auto& p) { return p.y > 0.5 ? 1.0 : 0.0; }), 1.25 / 3.0, 2e-3);
}

TEST(StarDiscrepancy, OfKnownSets) {
    const std::array centre{glm::dvec2(0.5)};
    EXPECT_DOUBLE_EQ(starDiscrepancy(centre), 0.75); // closed box (1/2)² holds everything
    const std::array corner{glm::dvec2(0.0)};
    EXPECT_DOUBLE_EQ(starDiscrepancy(corner), 1.0);
    // Along a line: the regular set (2i − 1) / 2n has the smallest one, 1 / 2n.
    std::vector<glm::dvec2> regular;
    for (int i = 0; i < 10; ++i) regular.emplace_back((i + 0.5) / 10.0, 0.0);
    EXPECT_NEAR(starDiscrepancy(regular), 1.0, 1e-12); // boxes of no height hold points
}

TEST(StarDiscrepancy, MatchesTheSearchOverAllBoxes) {
    const SamplePoints random(Sampler::Random, 40, 2, 3);
    std::vector<glm::dvec2> points;
    for (std::uint32_t i = 0; i < 40; ++i) points.emplace_back(random.at(i, 0), random.at(i, 1));
    double worst = 0.0;
    std::vector<double> xs{1.0}, ys{1.0};
    for (const auto& p : points) {
        xs.push_back(p.x);
        ys.push_back(p.y);
    }
    for (const double x : xs) {
        for (const double y : ys) {
            int open = 0, closed = 0;
            for (const auto& p : points) {
                open += p.x < x && p.y < y ? 1 : 0;
                closed += p.x <= x && p.y <= y ? 1 : 0;
            }
            worst = std::max({worst, x * y - open / 40.0, closed / 40.0 - x * y});
        }
    }
    EXPECT_NEAR(starDiscrepancy(points), worst, 1e-12);
}

TEST(Discrepancy, OfHaltonAndSobolFallsFasterThanRandom) {
    const auto both = [](Sampler sampler) {
        const SamplePoints points(sampler, 1024, 2, 11);
        std::vector<glm::dvec2> plane;
        std::vector<double> flat;
        for (std::uint32_t i = 0; i < 1024; ++i) {
            plane.emplace_back(points.at(i, 0), points.at(i, 1));
            flat.insert(flat.end(), {plane.back().x, plane.back().y});
        }
        return std::array{starDiscrepancy(plane), l2StarDiscrepancy(flat, 2)};
    };
    const auto random = both(Sampler::Random);
    // Expected L2 of random points: √((2^-d − 3^-d) / n) = .0116; one set is within a factor of 3.
    EXPECT_NEAR(std::log(random[1] / 0.01164), 0.0, std::log(3.0));
    for (const Sampler sampler : {Sampler::Halton, Sampler::Sobol}) {
        EXPECT_LT(both(sampler)[0], random[0] / 4.0);
        EXPECT_LT(both(sampler)[1], random[1] / 4.0);
    }
}

TEST(SamplePoints, FilledAreThoseAskedForOneByOne) {
    for (const Sampler sampler : {Sampler::Random, Sampler::Stratified, Sampler::Halton, Sampler::Sobol}) {
        const SamplePoints points(sampler, 5000, 4, 3);
        for (std::uint32_t dimension = 0; dimension < 4; ++dimension) {
            for (const std::uint32_t first : {0U, 255U, 1000U}) { // within, before and across runs of 256
                std::vector<float> coordinates(777);
                points.fill(first, dimension, coordinates);
                for (std::uint32_t k = 0; k < coordinates.size(); ++k)
                    EXPECT_EQ(static_cast<double>(coordinates[k]),
                              std::floor(points.at(first + k, dimension) * 0x1p24) * 0x1p-24);
            }
        }
    }
}

// 4e-7: a few roundings of numbers up to 1 and of angles up to π.
TEST(VectorWarps, AreTheWarpsInSinglePrecision) {
    for (int i = 0; i <= 64; ++i) {
        for (int j = 0; j <= 64; ++j) {
            const auto u = static_cast<float>(i) / 64.0F;
            const auto v = static_cast<float>(j) / 64.0F;
            const glm::dvec2 both(static_cast<double>(u), static_cast<double>(v));
            const DiskPoint disk(u, v);
            const glm::dvec2 exactDisk = concentricDisk(both);
            EXPECT_NEAR(static_cast<double>(disk.x), exactDisk.x, 4e-7);
            EXPECT_NEAR(static_cast<double>(disk.y), exactDisk.y, 4e-7);
            EXPECT_NEAR(static_cast<double>(disk.squaredRadius), glm::dot(exactDisk, exactDisk), 4e-7);
            const SpherePoint sphere(u, v);
            const glm::dvec3 exactSphere = uniformSphere(both);
            EXPECT_NEAR(static_cast<double>(sphere.x), exactSphere.x, 4e-7);
            EXPECT_NEAR(static_cast<double>(sphere.y), exactSphere.y, 4e-7);
            EXPECT_NEAR(static_cast<double>(sphere.z), exactSphere.z, 4e-7);
        }
    }
}

} // namespace
} // namespace lambert
