#include "lighting/solve_scene.h"
#include "lighting/factor_diagnosis.h"
#include "scene/example_scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace lambert {
namespace {

/// A closed room with a lamp of two sides near its ceiling: one viewpoint per patch of the ceiling sees far too much of it, or
/// too little.
Scene roomWithNearLamp() {
    const Material wall = greyMaterial("wall", 0.9F);
    Scene scene = boxScene(glm::vec3(2.0F), {wall, wall, wall, wall, wall, wall});
    scene.materials.push_back(greyMaterial("lamp", 0.95F, 1.0F));
    scene.materials.back().twoSided = true;
    addQuad(scene, {{{0.4F, 0.4F, 1.9F}, {1.6F, 0.4F, 1.9F}, {1.6F, 1.6F, 1.9F}, {0.4F, 1.6F, 1.9F}}}, 6);
    return scene;
}

SolveOptions coarse() {
    SolveOptions options;
    auto& light = std::get<FormFactorLight>(options.method);
    options.mesh.patches = 30;
    options.mesh.splitContacts = false;
    light.formFactors.transport.method = TransportMethod::Hemicube;
    light.formFactors.transport.resolution = 8;
    light.solver.tolerance = 1e-6;
    return options;
}

/// What a residual of 1e-6 leaves out at most: it is relative to the RMS of a lamp of 0.08 of 24 m², and what is missing would have been passed on
/// 1 / (1 − 0.6) times.
/// The direct light of the lamp is found apart from its rows, which are those of coarse hemicubes; what of it leaves the room by
/// these, none in truth, is out of balance.
constexpr double kOfEmitters = 0.01;
constexpr double kResidual = 1e-6 * 17.4 * 2.5;

SolvedScene bake(const SolveOptions& options) {
    Progress progress;
    return solveScene(roomWithNearLamp(), options, progress);
}

TEST(EnergyCheck, WithoutRepairIsTheImbalanceOfTheSolution) {
    const SolvedScene baked = bake(coarse());
    ASSERT_TRUE(baked.energyCheck.beforeRepair);
    EXPECT_GT(std::abs(*baked.energyCheck.beforeRepair), kImbalanceMissed);
    // Both are the same sum in another order.
    EXPECT_NEAR(*baked.energyCheck.beforeRepair, baked.solution.energy.imbalance(), kResidual);
    EXPECT_TRUE(baked.energyCheck.missed());
}

TEST(EnergyCheck, SeesThroughARepair) {
    const SolvedScene raw = bake(coarse());
    SolveOptions options = coarse();
    auto& light = std::get<FormFactorLight>(options.method);
    light.formFactors.repair = true;
    const SolvedScene repaired = bake(options);
    EXPECT_NEAR(repaired.solution.energy.imbalance(), 0.0, kOfEmitters);
    EXPECT_TRUE(repaired.energyCheck.missed());
    // Another light, by other factors: of the same sign and size.
    const double before = raw.solution.energy.imbalance();
    EXPECT_NEAR(*repaired.energyCheck.beforeRepair / before, 1.0, 0.5);
    EXPECT_EQ(repaired.energyCheck.material, "lamp");
    ASSERT_EQ(repaired.warnings.size(), 1U);
    for (const char* part : {"before repair", "\"lamp\"", "--hemicubes 4", "--solver stochastic", "exit code 1"})
        EXPECT_NE(repaired.warnings[0].find(part), std::string::npos) << part << ": " << repaired.warnings[0];
}

TEST(EnergyCheck, SeesThroughShooting) {
    SolveOptions options = coarse();
    auto& light = std::get<FormFactorLight>(options.method);
    light.solver.method = SolverMethod::Southwell;
    const SolvedScene baked = bake(options);
    EXPECT_NEAR(baked.solution.energy.imbalance(), 0.0, kOfEmitters);
    EXPECT_TRUE(baked.energyCheck.missed());
}

TEST(EnergyCheck, BouncesThatWereLeftOutAreNoError) {
    SolveOptions options;
    auto& light = std::get<FormFactorLight>(options.method);
    options.mesh.patches = 400;
    light.formFactors.transport.resolution = 64;
    light.solver.method = SolverMethod::Jacobi;
    light.solver.bounces = 1;
    Progress progress;
    const SolvedScene baked = solveScene(roomWithBoxScene(), options, progress);
    EXPECT_GT(baked.solution.energy.imbalance(), 0.1);
    EXPECT_LT(std::abs(baked.energyCheck.judged), kImbalanceTold);
    EXPECT_TRUE(baked.warnings.empty());
}

TEST(EnergyCheck, LinesKeepTheEnergyWhereHemicubesDoNot) {
    SolveOptions options = coarse();
    options.method = LineSolverOptions{};
    const SolvedScene baked = bake(options);
    EXPECT_FALSE(baked.energyCheck.beforeRepair);
    EXPECT_LT(std::abs(baked.energyCheck.judged), kImbalanceTold);
    EXPECT_TRUE(baked.warnings.empty());
}

TEST(EnergyCheck, SaysNothingOfARoomWithoutNearFaces) {
    SolveOptions options = coarse();
    auto& light = std::get<FormFactorLight>(options.method);
    options.mesh.splitContacts = true;
    options.mesh.patches = 1000;
    light.formFactors.transport.resolution = 64;
    Progress progress;
    const SolvedScene baked = solveScene(roomWithBoxScene(), options, progress);
    EXPECT_LT(std::abs(baked.energyCheck.judged), kImbalanceTold);
    EXPECT_TRUE(baked.warnings.empty());
}

TEST(FactorDiagnosis, TellsOfARepairThatMovedMoreThanTheStatedError) {
    TransportPlan plan;
    plan.options.method = TransportMethod::ClosedForm;
    plan.options.error = 1e-4;
    RepairReport report;
    report.rowChange = 0.5e-4;
    EXPECT_TRUE(repairWarnings(plan, report).empty());
    report.rowChange = 0.01;
    ASSERT_EQ(repairWarnings(plan, report).size(), 1U);
    EXPECT_NE(repairWarnings(plan, report)[0].find("--form-factor-error"), std::string::npos);
    plan.options.method = TransportMethod::Hemicube; // states none
    EXPECT_TRUE(repairWarnings(plan, report).empty());
}

TEST(FactorDiagnosis, NamesAWayOutForEveryMethod) {
    TransportPlan plan;
    for (const std::string& name : methodNames()) {
        plan.options.method = methodByName(name).value();
        const std::string text = causeAndRemedy(plan, true);
        EXPECT_NE(text.find("; try "), std::string::npos) << name;
        EXPECT_NE(text.find("--solver stochastic"), std::string::npos) << name;
        EXPECT_EQ(causeAndRemedy(plan, false).find("--solver"), std::string::npos) << name;
    }
}

} // namespace
} // namespace lambert
