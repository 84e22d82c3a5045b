#include "core/error.h"
#include "prediction/prediction.h"
#include "scene/example_scenes.h"

#include <gtest/gtest.h>

namespace lambert {
namespace {

SolveOptions smallOptions() {
    SolveOptions options;
    auto& light = std::get<FormFactorLight>(options.method);
    options.mesh.patches = 400;
    light.formFactors.transport.method = TransportMethod::Hemicube;
    light.formFactors.transport.resolution = 32;
    return options;
}

TEST(Prediction, PatchesResolutionAndRaysAreThoseOfTheBake) {
    Progress progress;
    const Scene scene = roomWithBoxScene();
    const BakePrediction predicted = predictBake(scene, smallOptions(), progress);
    const SolvedScene baked = solveScene(scene, smallOptions(), progress);
    EXPECT_EQ(predicted.patches, baked.mesh.size());
    EXPECT_EQ(predicted.plan->options.resolution, baked.formFactors()->plan->options.resolution);
    EXPECT_EQ(predicted.rays, baked.rayCount);
}

// From 32 rows at least, which differ by a third or so: three standard errors of their mean.
TEST(Prediction, RaysOfAutoAreAboutThoseOfTheBake) {
    Progress progress;
    const Scene scene = roomWithBoxScene();
    SolveOptions options;
    options.mesh.patches = 400;
    const BakePrediction predicted = predictBake(scene, options, progress);
    const SolvedScene baked = solveScene(scene, options, progress);
    EXPECT_NEAR(static_cast<double>(predicted.rays) / static_cast<double>(baked.rayCount), 1.0, 0.2);
}

TEST(Prediction, MatrixHasAboutThePredictedSize) {
    Progress progress;
    const Scene scene = roomWithBoxScene();
    const BakePrediction predicted = predictBake(scene, smallOptions(), progress);
    const SolvedScene baked = solveScene(scene, smallOptions(), progress);
    // Rows of a room differ by a factor of two, and some dozens are looked at; what the allocator takes is counted too.
    EXPECT_NEAR(static_cast<double>(predicted.matrixBytes) / static_cast<double>(baked.formFactors()->bytes), 1.0, 0.2);
    EXPECT_GT(predicted.peakMemory, predicted.matrixBytes);
}

TEST(Prediction, RowsWithoutRaysTakeTimeToo) {
    Progress progress;
    SolveOptions options = smallOptions();
    auto& light = std::get<FormFactorLight>(options.method);
    options.mesh.patches = 50;
    light.formFactors.transport.resolution.reset();
    light.formFactors.transport.method = TransportMethod::ClosedForm;
    const BakePrediction predicted = predictBake(roomWithBoxScene(), options, progress);
    EXPECT_EQ(predicted.rays, 0U);
    EXPECT_GT(predicted.seconds.formFactors, 0.0);
    EXPECT_GT(predicted.secondsPerRay, 0.0);
    EXPECT_LT(predicted.secondsPerRay, 1e-3);
}

// Factors of 2: the error falls by another power in every scene, and times are those of a busy machine (not tested).
TEST(Prediction, OfRandomLinesHasAboutTheRaysOfTheBake) {
    Progress progress;
    const Scene scene = roomWithBoxScene();
    for (const LineSolver solver : {LineSolver::Stochastic, LineSolver::RandomWalk})
        for (const bool toAnError : {true, false}) {
            SolveOptions options = smallOptions();
            LineSolverOptions lines{.solver = solver};
            if (toAnError)
                lines.targetError = 0.02;
            else
                lines.rays = 1'000'000;
            options.method = lines;
            const BakePrediction predicted = predictBake(scene, options, progress);
            const SolvedScene baked = solveScene(scene, options, progress);
            EXPECT_EQ(predicted.patches, baked.mesh.size());
            EXPECT_FALSE(predicted.plan.has_value());
            const double ratio = static_cast<double>(predicted.rays) / static_cast<double>(baked.rayCount);
            EXPECT_GT(ratio, toAnError ? 0.5 : 0.98);
            EXPECT_LT(ratio, toAnError ? 2.0 : 1.02);
            EXPECT_GT(predicted.seconds.solve, 0.0);
        }
}

TEST(Prediction, OfRowsThatAreNotStoredHasAboutTheRaysOfTheBake) {
    Progress progress;
    const Scene scene = roomWithBoxScene();
    SolveOptions options = smallOptions();
    auto& light = std::get<FormFactorLight>(options.method);
    light.formFactors.transport.stored = false;
    for (const SolverMethod method : {SolverMethod::Southwell, SolverMethod::ConjugateGradient, SolverMethod::Jacobi}) {
        light.solver.method = method;
        const BakePrediction predicted = predictBake(scene, options, progress);
        const SolvedScene baked = solveScene(scene, options, progress);
        const double ratio = static_cast<double>(predicted.rays) / static_cast<double>(baked.rayCount);
        EXPECT_GT(ratio, 0.5) << nameOf(method);
        EXPECT_LT(ratio, 2.0) << nameOf(method);
        EXPECT_EQ(predicted.matrixBytes, 0U);
    }
}

TEST(Prediction, SceneWithoutLightIsRefused) {
    Progress progress;
    const Material wall = greyMaterial("wall", 0.5F);
    EXPECT_THROW(predictBake(boxScene(glm::vec3(1.0F), {wall, wall, wall, wall, wall, wall}), smallOptions(), progress),
                 InputError);
}

TEST(Prediction, RefinementMultipliesThePatchesThatAreAdded) {
    const Scene scene = roomWithBoxScene();
    const std::size_t polygons = scene.polygons.size();
    EXPECT_EQ(defaultPatches(scene), polygons + 5000);
    EXPECT_EQ(defaultPatches(scene, 0.2), polygons + 1000);
}

} // namespace
} // namespace lambert
