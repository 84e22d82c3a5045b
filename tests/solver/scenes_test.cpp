// Every solver with form factors on the same scenes, against values of independent programs (data/reference).
#include "scene_case.h"

#include <gtest/gtest.h>

#include <array>

namespace lambert {
namespace {

class SolversOnScenes : public testing::TestWithParam<SolverMethod> {
protected:
    static RadiositySolution solved(const SceneCase& c) {
        RadiositySolution solution = c.solved(GetParam());
        EXPECT_LE(solution.residual, 1e-7);
        EXPECT_NEAR(solution.energy.imbalance(), 0.0, 1e-5); // rows are closed to 1e-6
        return solution;
    }

    /// Mean radiosities of the six faces x0 … z1 of a box, and the one key that has them.
    static void expectFaces(const SceneCase& c, const std::string& reference, double tolerance) {
        const std::vector<double> expected = ReferenceCase(reference, "B_face_mean_limit_approx").values;
        const auto means = c.means(solved(c).radiosity);
        const std::array<std::string, 6> names{"x0", "x1", "y0", "y1", "z0", "z1"};
        for (std::size_t face = 0; face < 6; ++face)
            EXPECT_NEAR(means.at(names[face]).x, expected[face], tolerance * expected[face]) << names[face];
    }
};

INSTANTIATE_TEST_SUITE_P(All, SolversOnScenes, deterministicSolvers(), solverTestName);

TEST_P(SolversOnScenes, TheFurnaceIsUniform) {
    const SceneCase& c = sceneCase("furnace_box.obj", 500, hemicubes(64));
    for (const RgbSum& b : solved(c).radiosity) EXPECT_NEAR(b.x, 2.0, 1e-5); // rows are closed to 1e-6
}

// What is left is the error of constant radiosities on so many patches: 0.03 % of n = 12 per edge, from those that the
// reference gives for n = 1 and n = 32.
TEST_P(SolversOnScenes, TheRefinedCubeHasTheContinuousFaceMeans) {
    expectFaces(sceneCase("cube6.obj", 864, closedForm()), "cube6", 1e-3);
}

TEST_P(SolversOnScenes, TheRefinedRoomHasTheContinuousFaceMeans) {
    expectFaces(sceneCase("room432.obj", 864, closedForm()), "room432", 1e-3);
}

TEST_P(SolversOnScenes, TheTetrahedronOfFourPatchesIsExact) {
    const SceneCase& c = sceneCase("tetrahedron.obj", 0, closedForm());
    const std::vector<double> expected = ReferenceCase("tetrahedron", "B").values;
    const RadiositySolution solution = solved(c);
    ASSERT_EQ(solution.radiosity.size(), 4U);
    // Closed forms are good to 1e-6, the tolerance is 1e-7.
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(solution.radiosity[i].x, expected[i], 2e-6);
}

TEST_P(SolversOnScenes, TheCornellBoxHasTheIrradianceOfParticleTracing) {
    const SceneCase& c = sceneCase("cornell_box.obj", 2000, hemicubes(64));
    const auto means = c.means(solved(c).irradiance);
    const auto surfaces = cornellSurfaces();
    EXPECT_EQ(surfaces.size(), 8U);
    // Patches and one hemicube for each are coarse; the reference is good to 0.1 %.
    for (const auto& [name, expected] : surfaces)
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(means.at(name)[channel], expected[channel], 0.015 * expected[channel])
                << name << " " << channel;
}

} // namespace
} // namespace lambert
