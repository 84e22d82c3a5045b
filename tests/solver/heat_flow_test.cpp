#include "core/error.h"
#include "solver/heat_flow.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace lambert {
namespace {

/// Surface 0 lies within surface 1 and sees nothing else; surface 1 sees itself by the rest. Exact for uniform radiosities,
/// as between concentric spheres or infinite cylinders.
FormFactorMatrix concentric(double innerArea, double outerArea) {
    FormFactorMatrix matrix(2, MatrixStorage::Double);
    FormFactorRow row;
    row.entries = {{1, 1.0}};
    matrix.setRow(0, row);
    row.entries = {{0, innerArea / outerArea}, {1, 1.0 - innerArea / outerArea}};
    matrix.setRow(1, row);
    return matrix;
}

constexpr std::array<std::uint32_t, 2> kGroups{0, 1};

double black(double kelvin) { return kStefanBoltzmann * std::pow(kelvin, 4); }

TEST(HeatFlow, ConcentricSpheresExchangeWhatTextbooksSay) {
    // Q = A1 σ (T1⁴ − T2⁴) / (1/ε1 + A1/A2 (1/ε2 − 1)), for emissivities down to polished metal.
    const std::array<float, 2> area{2.0F, 5.0F};
    Progress progress;
    for (const double one : {1.0, 0.5, 0.02}) {
        for (const double two : {1.0, 0.3, 0.01}) {
            const std::array<ThermalSurface, 2> surfaces{ThermalSurface{700.0, one}, ThermalSurface{300.0, two}};
            const HeatFlow heat = solveHeatFlow(concentric(2.0, 5.0), area, kGroups, surfaces, {}, progress);
            const double exact = 2.0 * (black(700) - black(300)) / (1 / one + 2.0 / 5.0 * (1 / two - 1));
            // The residual of J is 1e-10, the flow its difference times up to 1/ε.
            EXPECT_NEAR(heat.flow[0] / exact, 1.0, 1e-7) << one << " " << two;
            EXPECT_NEAR(heat.flow[1] / exact, -1.0, 1e-7);
            EXPECT_LT(std::abs(heat.imbalance()), 1e-7 * exact);
            EXPECT_LE(heat.residual, 1e-10);
        }
    }
}

TEST(HeatFlow, AnAdiabaticSurfaceTakesTheOthersTemperature) {
    const std::array<float, 2> area{2.0F, 5.0F};
    const std::array<ThermalSurface, 2> surfaces{ThermalSurface{700.0, 0.2}, ThermalSurface{std::nullopt, 1.0}};
    Progress progress;
    const HeatFlow heat = solveHeatFlow(concentric(2.0, 5.0), area, kGroups, surfaces, {}, progress);
    EXPECT_NEAR(heat.kelvin[1], 700.0, 1e-6);
    EXPECT_NEAR(heat.flow[0], 0.0, 1e-6);
}

TEST(HeatFlow, ALoneSurfaceLosesToTheEnvironmentWhatItEmits) {
    FormFactorMatrix matrix(1, MatrixStorage::Double);
    FormFactorRow row;
    row.out = 1.0;
    matrix.setRow(0, row);
    const std::array<float, 1> area{3.0F};
    const std::array<std::uint32_t, 1> group{0};
    const std::array<ThermalSurface, 1> surfaces{ThermalSurface{400.0, 0.6}};
    Progress progress;
    const HeatFlow heat = solveHeatFlow(matrix, area, group, surfaces, {.environment = 300.0}, progress);
    const double exact = 3.0 * 0.6 * (black(400) - black(300));
    EXPECT_NEAR(heat.flow[0], exact, 1e-9 * exact);
    EXPECT_NEAR(heat.environmentFlow, -exact, 1e-9 * exact);
}

TEST(HeatFlow, NeedsATemperature) {
    const std::array<float, 2> area{2.0F, 5.0F};
    const std::array<ThermalSurface, 2> surfaces{ThermalSurface{std::nullopt, 1.0}, ThermalSurface{300.0, 0.0}};
    Progress progress;
    EXPECT_THROW(solveHeatFlow(concentric(2.0, 5.0), area, kGroups, surfaces, {}, progress), InputError);
}

} // namespace
} // namespace lambert
