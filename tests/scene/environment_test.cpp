#include "core/error.h"
#include "core/random.h"
#include "picture/image.h"
#include "scene/environment.h"
#include "scene/sky.h"
#include "tests/core/temporary_folder.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace lambert {
namespace {

constexpr double kPi = std::numbers::pi;

/// ∫ value dω over the sphere, by the midpoint rule on cells of equal solid angle.
template <typename Value>
double overSphere(Value&& value) {
    constexpr int kRows = 1000, kColumns = 1000;
    double sum = 0.0;
    for (int row = 0; row < kRows; ++row) {
        const double height = 1.0 - 2.0 * (row + 0.5) / kRows;
        for (int column = 0; column < kColumns; ++column) {
            const double elevation = std::asin(height) * 180.0 / kPi;
            sum += value(skyDirection(360.0 * (column + 0.5) / kColumns, elevation));
        }
    }
    return 4.0 * kPi * sum / (kRows * kColumns);
}

double level(const Environment& sky) {
    return overSphere(
        [&](const glm::dvec3& d) { return d.y > 0.0 ? static_cast<double>(sky.radiance(d).y) * d.y : 0.0; });
}

TEST(SkyDirection, NorthIsBackAndEastIsRightOfWhoLooksThere) {
    const auto expect = [](const glm::dvec3& found, const glm::dvec3& expected) {
        EXPECT_NEAR(glm::distance(found, expected), 0.0, 1e-15); // sines in double precision
    };
    expect(skyDirection(0.0, 0.0), {0, 0, -1});
    expect(skyDirection(90.0, 0.0), {1, 0, 0});
    expect(skyDirection(180.0, 0.0), {0, 0, 1});
    expect(skyDirection(270.0, 0.0), {-1, 0, 0});
    expect(skyDirection(123.0, 90.0), {0, 1, 0});
}

TEST(SkyMapDistribution, SamplesFollowTheirDensityAndMissCellsWithoutWeight) {
    constexpr std::size_t kColumns = 5, kRows = 4;
    const double weights[kRows][kColumns] = {{0, 1, 0, 2, 0}, {0, 0, 0, 0, 0}, {7, 0, 0, 1, 3}, {0, 0, 0.1, 0, 0}};
    const SkyMapDistribution map(kColumns, kRows, [&](auto column, auto row) { return weights[row][column]; });
    EXPECT_NEAR(overSphere([&](const auto& d) { return map.density(d); }), 1.0, 2e-3); // cells' edges between midpoints
    constexpr int kSamples = 100000;
    double counts[kRows][kColumns] = {};
    for (int k = 0; k < kSamples; ++k) {
        const auto bits = philox({static_cast<std::uint32_t>(k), 0, 0, 0}, 1);
        const auto sample =
            map.sample({static_cast<double>(uniformFloat(bits[0])), static_cast<double>(uniformFloat(bits[1]))});
        EXPECT_NEAR(glm::length(sample.direction), 1.0, 1e-12);
        const auto cell = SkyMapDistribution::cellOf(sample.direction, kColumns, kRows);
        counts[cell.row][cell.column] += 1.0;
        ASSERT_GT(weights[cell.row][cell.column], 0.0);
        ASSERT_NEAR(sample.density, map.density(sample.direction), 1e-9 * sample.density);
    }
    double chiSquare = 0.0;
    for (std::size_t row = 0; row < kRows; ++row)
        for (std::size_t column = 0; column < kColumns; ++column) {
            const double share =
                weights[row][column] * SkyMapDistribution::solidAngle(row, kColumns, kRows) / map.total();
            if (share > 0.0) chiSquare += std::pow(counts[row][column] - kSamples * share, 2) / (kSamples * share);
        }
    EXPECT_LT(chiSquare, 20.5); // 5 degrees of freedom: 1 in 1000 would be above; seed 1
}

TEST(SkyMapDistribution, TheLastNumberBelowOneStaysInsideTheMap) {
    const SkyMapDistribution map(3, 3, [](auto column, auto row) { return column == 1 && row == 1 ? 1.0 : 0.0; });
    for (const double u : {0.0, 0x1p-24, 1.0 - 0x1p-24, 1.0 - 0x1p-53}) {
        const auto cell = SkyMapDistribution::cellOf(map.sample({u, u}).direction, 3, 3);
        EXPECT_LE(cell.row, 2U) << u;
        EXPECT_GT(map.sample({u, u}).density, 0.0) << u;
    }
}

TEST(Environment, RowsOfAPictureGoDownAndColumnsClockwiseFromSouth) {
    std::vector<glm::vec4> texels(8, glm::vec4(0.0F));
    for (int k = 0; k < 8; ++k) texels[static_cast<std::size_t>(k)].x = static_cast<float>(k);
    const Environment sky = Environment::image(std::make_shared<Texture>("sky", 4, 2, std::move(texels)));
    const auto at = [&](double azimuth, double elevation) { return sky.radiance(skyDirection(azimuth, elevation)).x; };
    EXPECT_EQ(at(181.0, 1.0), 0.0F);
    EXPECT_EQ(at(271.0, 1.0), 1.0F);
    EXPECT_EQ(at(1.0, 89.0), 2.0F);
    EXPECT_EQ(at(91.0, 1.0), 3.0F);
    EXPECT_EQ(at(181.0, -1.0), 4.0F);
    EXPECT_EQ(at(179.0, -89.0), 7.0F);
}

TEST(Sky, OvercastIsThreeTimesAsBrightAboveAsAtTheHorizon) {
    const Environment sky = overcastSky(10000.0);
    const auto at = [&](double elevation) {
        return static_cast<double>(sky.radiance(skyDirection(77.0, elevation)).x);
    };
    EXPECT_NEAR(at(90.0) / at(1e-6), 3.0, 1e-6);
    EXPECT_EQ(at(-1e-6), 0.0);
    EXPECT_NEAR(level(sky), 7.0 * kPi / 9.0 * at(90.0), 1e-4 * level(sky)); // midpoint rule
    EXPECT_NEAR(level(sky), 10000.0, 1.0);
}

TEST(Sky, ClearFollowsTheStandardAndItsIlluminance) {
    for (const double elevation : {5.0, 35.0, 60.0, 90.0}) {
        const Environment sky = clearSky(135.0, elevation);
        EXPECT_NEAR(level(sky), clearSkyIlluminance(elevation), 1e-4 * level(sky)); // midpoint rules
        // Kittler's formula of 1967, which the standard repeats: 0.91 stands for 1 − 10 e^(−3π/2), which is 0.910167.
        const auto kittler = [](double angle) {
            return 0.91 + 10.0 * std::exp(-3.0 * angle) + 0.45 * std::pow(std::cos(angle), 2);
        };
        const glm::dvec3 toSun = skyDirection(135.0, elevation);
        for (const double at : {3.0, 20.0, 50.0, 85.0}) {
            const glm::dvec3 d = skyDirection(200.0, at);
            const double expected = kittler(std::acos(glm::dot(d, toSun))) * (1.0 - std::exp(-0.32 / d.y)) /
                                    (kittler(kPi / 2.0 - elevation * kPi / 180.0) * (1.0 - std::exp(-0.32)));
            EXPECT_NEAR(clearSkyPattern(d, toSun), expected, 3e-4 * expected); // 0.91 for 0.910167
        }
    }
}

TEST(Sky, TheSunIsAsBrightAsTheAirIsThin) {
    EXPECT_NEAR(sunIlluminance(90.0), 127500.0 * std::exp(-0.21), 30.0);  // air mass 0.99971
    EXPECT_NEAR(sunIlluminance(30.0), 127500.0 * std::exp(-0.42), 200.0); // air mass 1.9939 rather than 2
    EXPECT_LT(sunIlluminance(0.0), 200.0);                                // air mass 38
    EXPECT_GT(sunIlluminance(0.0), 10.0);
}

TEST(ReadEnvironment, ReadsExrAndNamesWhatIsMissingOrBroken) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "sky.exr";
    writeImage({2, 2, {Rgb(0.0F), Rgb(0.0F), Rgb(1, 2, 50000), Rgb(0.0F)}}, path, 0.0F);
    const Environment sky = readEnvironment(path);
    EXPECT_EQ(sky.radiance(skyDirection(270.0, -45.0)), Rgb(1, 2, 50000));
    EXPECT_FALSE(sky.isDark());

    const auto expectError = [](const std::filesystem::path& file, const std::string& reason) {
        try {
            readEnvironment(file);
            FAIL() << "no error";
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(file.string() + ": "), std::string::npos) << error.what();
            EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
        }
    };
    expectError(folder.path() / "missing.exr", "no such file");
    expectError(folder.write("broken.exr", "no picture"), "not a picture");
}

} // namespace
} // namespace lambert
