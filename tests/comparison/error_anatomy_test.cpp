#include "comparison/error_anatomy.h"

#include "core/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace lambert {
namespace {

using Field = std::vector<RgbSum>;
constexpr std::size_t kReceivers = 200;

/// Standard normal numbers, one per receiver, channel and purpose.
double normal(std::uint32_t i, std::uint32_t c, std::uint32_t run, std::uint32_t purpose) {
    const auto bits = philox({i, c, run, purpose}, 20);
    const double u = (bits[0] + 0.5) * 0x1p-32;
    const double v = (bits[1] + 0.5) * 0x1p-32;
    return std::sqrt(-2.0 * std::log(u)) * std::cos(6.283185307179586 * v);
}

/// A method whose parts are known: noise of deviation `noise`, and two errors that it can exchange.
struct KnownCase {
    Field reference, first, second;
    std::vector<double> weight;
    std::vector<std::vector<Field>> runs;

    KnownCase(std::size_t count, double noise, double differenceNoise) {
        for (std::uint32_t i = 0; i < kReceivers; ++i) {
            weight.push_back(1.0 + i % 3);
            reference.emplace_back(2.0, 1.0, 0.5);
            first.emplace_back(0.1 * (i % 2), 0.2, 0.0);
            second.emplace_back(0.05, -0.1, 0.1 * (i % 5));
        }
        for (std::uint32_t s = 0; s < count; ++s) {
            std::vector<Field> run(3, reference);
            for (std::uint32_t i = 0; i < kReceivers; ++i) {
                for (std::uint32_t c = 0; c < 3; ++c) {
                    const double shared = noise * normal(i, static_cast<std::uint32_t>(c), s, 0);
                    const double own = differenceNoise * normal(i, static_cast<std::uint32_t>(c), s, 1);
                    const auto channel = static_cast<int>(c);
                    run[2][i][channel] += shared;
                    run[1][i][channel] += shared + own + second[i][channel];
                    run[0][i][channel] += shared + own + second[i][channel] + first[i][channel];
                }
            }
            runs.push_back(std::move(run));
        }
    }
    double product(const Field& a, const Field& b) const {
        double sum = 0.0, total = 0.0;
        for (std::size_t i = 0; i < kReceivers; ++i) {
            sum += weight[i] * (a[i].x * b[i].x + a[i].y * b[i].y + a[i].z * b[i].z);
            total += 3.0 * weight[i];
        }
        return sum / total;
    }
    ErrorAnatomy anatomy() const {
        const std::vector<Approximation> approximations{{"first", "", ""}, {"second", "", ""}};
        return errorAnatomy(weight, reference, 0.0, runs, approximations, {"sampling", "", ""});
    }
};

double sumOfShares(const ErrorAnatomy& anatomy) {
    double sum = 0.0;
    for (const ErrorPart& part : anatomy.parts) sum += part.share;
    return sum;
}

TEST(ErrorAnatomy, SharesAddUpToOneWhateverTheParts) {
    for (const double noise : {0.0, 0.1, 3.0})
        EXPECT_NEAR(sumOfShares(KnownCase(5, noise, noise).anatomy()), 1.0, 1e-12) << noise; // rounding
}

TEST(ErrorAnatomy, WithoutNoiseSharesAreInnerProducts) {
    const KnownCase c(3, 0.0, 0.0);
    const ErrorAnatomy anatomy = c.anatomy();
    Field error = c.first;
    for (std::size_t i = 0; i < kReceivers; ++i) error[i] += c.second[i];
    const double whole = c.product(error, error);
    EXPECT_NEAR(anatomy.rms, std::sqrt(whole), 1e-12);
    EXPECT_NEAR(anatomy.parts[0].share, 0.0, 1e-12);
    EXPECT_NEAR(anatomy.parts[1].share, c.product(error, c.first) / whole, 1e-12);
    EXPECT_NEAR(anatomy.parts[2].share, c.product(error, c.second) / whole, 1e-12);
    EXPECT_NEAR(anatomy.parts.back().share, 0.0, 1e-12);
    EXPECT_NEAR(anatomy.parts[1].rms, std::sqrt(c.product(c.first, c.first)), 1e-12);
    EXPECT_NEAR(anatomy.parts[1].rmsWithout, std::sqrt(c.product(c.second, c.second)), 1e-12);
}

// Four standard errors each, which are small: 600 values per run make the noise's square known to √(2 / 600 / 16) = 1.4 % of itself.
// Of four such figures one is further off by chance in 4,000 choices of the random numbers.
TEST(ErrorAnatomy, NoiseIsSamplingsAndNobodyElses) {
    const KnownCase c(16, 0.2, 0.05);
    const ErrorAnatomy anatomy = c.anatomy();
    Field error = c.first;
    for (std::size_t i = 0; i < kReceivers; ++i) error[i] += c.second[i];
    const double noise = 0.2 * 0.2 + 0.05 * 0.05;
    const double whole = c.product(error, error) + noise;
    const double expected[]{noise / whole, c.product(error, c.first) / whole, c.product(error, c.second) / whole};
    for (std::size_t k = 0; k < 3; ++k) {
        std::printf("%s: %.4f +- %.4f, expected %.4f\n", anatomy.parts[k].approximation.part.c_str(),
                    anatomy.parts[k].share, anatomy.parts[k].shareError, expected[k]);
        EXPECT_NEAR(anatomy.parts[k].share, expected[k], 4.0 * anatomy.parts[k].shareError) << k;
        EXPECT_LT(anatomy.parts[k].shareError, 0.02);
    }
    EXPECT_NEAR(anatomy.parts.back().share, 0.0, 4.0 * anatomy.parts.back().shareError);
}

// The jackknife's standard error against the scatter of 64 repetitions, which is known to 1/√126 = 9 %; the jackknife of 16 runs
// itself scatters by about 1/√30 = 18 %, its mean over 64 cases by 2 %.
TEST(ErrorAnatomy, StandardErrorsAreTheScatterOfRepetitions) {
    const std::size_t repetitions = 64, count = 16;
    const KnownCase all(repetitions * count, 0.2, 0.1);
    double mean = 0.0, squares = 0.0, stated = 0.0;
    std::vector<double> shares;
    for (std::size_t r = 0; r < repetitions; ++r) {
        KnownCase c(0, 0.0, 0.0);
        c.runs.assign(all.runs.begin() + static_cast<std::ptrdiff_t>(r * count),
                      all.runs.begin() + static_cast<std::ptrdiff_t>((r + 1) * count));
        const ErrorAnatomy anatomy = c.anatomy();
        shares.push_back(anatomy.parts[1].share);
        stated += anatomy.parts[1].shareError * anatomy.parts[1].shareError / repetitions;
    }
    for (const double s : shares) mean += s / repetitions;
    for (const double s : shares) squares += (s - mean) * (s - mean) / (repetitions - 1);
    std::printf("scatter %.5f, stated %.5f\n", std::sqrt(squares), std::sqrt(stated));
    EXPECT_NEAR(std::sqrt(stated / squares), 1.0, 0.36); // four times 9 %
}

TEST(ErrorAnatomy, AMethodWithoutChanceHasNoSampling) {
    const KnownCase c(1, 0.3, 0.0);
    const ErrorAnatomy anatomy = c.anatomy();
    EXPECT_EQ(anatomy.parts[0].share, 0.0);
    EXPECT_NEAR(sumOfShares(anatomy), 1.0, 1e-12);
}

} // namespace
} // namespace lambert
