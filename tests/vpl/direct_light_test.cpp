/// The lights on an emitter against the closed form of what it gives to a point.
#include "core/parallel.h"
#include "formfactors/closed_form.h"
#include "tests/formfactors/exact_case.h"
#include "vpl_case.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

namespace lambert {
namespace {

const std::array<glm::vec3, 4> kLamp{{{0.2F, 0.1F, 1}, {0.1F, 0.9F, 1}, {1.1F, 0.8F, 1}, {0.9F, 0, 1}}};
constexpr double kEmitted = 3.0;

/// A skew lamp that looks down on a black floor.
Scene lampOverFloor() {
    const std::array quads{kLamp, std::array<glm::vec3, 4>{{{-1, -1, 0}, {2, -1, 0}, {2, 2, 0}, {-1, 2, 0}}}};
    return quadScene(quads, std::array{greyMaterial("lamp", 0.0F, kEmitted), greyMaterial("floor", 0.0F)});
}

double exactIrradiance(const Receiver& receiver) {
    std::array<glm::dvec3, 4> corners;
    for (std::size_t k = 0; k < 4; ++k) corners[k] = glm::dvec3(kLamp[k]);
    return kEmitted * pointToPolygon(glm::dvec3(receiver.position), glm::dvec3(receiver.normal), corners);
}

/// Exponent of the RMS relative error in the number of lights, over 64 points of the floor and 16 seeds.
double convergence(Sampler sampler) {
    const VplCase c(lampOverFloor());
    std::vector<Receiver> receivers;
    for (int k = 0; k < 64; ++k)
        receivers.push_back(
            c.receiver(1, (static_cast<float>(k % 8) + 0.4F) / 8, (static_cast<float>(k / 8) + 0.6F) / 8));
    std::vector<double> counts, errors;
    for (std::uint32_t n = 64; n <= 16384; n *= 4) {
        double squares = 0.0;
        for (std::uint64_t seed = 1; seed <= 16; ++seed) {
            const VirtualPointLights lights = c.trace({.particles = n, .sampler = sampler, .seed = seed});
            const Gathered gathered = c.gather(lights.lights, receivers, {.bound = kUnbounded});
            for (std::size_t i = 0; i < receivers.size(); ++i)
                squares += std::pow(gathered.irradiance[i].x / exactIrradiance(receivers[i]) - 1.0, 2.0);
        }
        counts.push_back(n);
        errors.push_back(std::sqrt(squares / static_cast<double>(16 * receivers.size())));
    }
    const double slope = logarithmicSlope(counts, errors);
    std::printf("%s: error %.2e at 64 lights, %.2e at 16384, slope %.3f\n", std::string(nameOf(sampler)).c_str(),
                errors.front(), errors.back(), slope);
    return slope;
}

// 16 seeds × 64 correlated points: an RMS error is known to some 10 %, the slope over a factor of 256 to about 0.03.
TEST(DirectLight, OfRandomLightsConvergesAsTheRootOfTheirNumber) {
    EXPECT_NEAR(convergence(Sampler::Random), -0.5, 0.06);
}

// The integrand is smooth: of points of discrepancy log² N / N more than N^-3/4 is to be had.
TEST(DirectLight, OfHaltonLightsConvergesFaster) { EXPECT_LT(convergence(Sampler::Halton), -0.75); }

// The plain sequence, as Keller uses it: 10^4 of its points are as good as the scrambled ones above, to 0.1 %.
TEST(DirectLight, OfThePlainSequenceIsTheClosedForm) {
    const VplCase c(lampOverFloor());
    const VirtualPointLights lights = c.trace({.particles = 10000});
    ASSERT_EQ(lights.lights.size(), 10000U); // the floor is black
    const std::vector<Receiver> receivers{c.receiver(1, 0.5F, 0.5F), c.receiver(1, 0.1F, 0.7F)};
    const Gathered gathered = c.gather(lights.lights, receivers, {.bound = kUnbounded});
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        const double exact = exactIrradiance(receivers[i]);
        EXPECT_NEAR(gathered.irradiance[i].y, exact, 1e-3 * exact);
    }
    // The same bits from one thread and from more.
    setThreadCount(1);
    const Gathered again = c.gather(c.trace({.particles = 10000}).lights, receivers, {.bound = kUnbounded});
    setThreadCount(0);
    EXPECT_EQ(gathered.irradiance, again.irradiance);
}

} // namespace
} // namespace lambert
