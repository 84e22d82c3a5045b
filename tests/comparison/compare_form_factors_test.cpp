#include "comparison/compare_form_factors.h"
#include "comparison/patch_picture.h"
#include "core/error.h"
#include "formfactors/matrix_quality.h"
#include "scene/example_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lambert {
namespace {

MeshedScene meshed(const Scene& scene, std::size_t patches) {
    Progress progress;
    MeshOptions options;
    options.patches = patches;
    return meshScene(scene, options, progress);
}

/// Reflectances that differ, and a lamp on one side: what a patch gets from where matters.
Scene litBox(float emitted = 1.0F) {
    const Material dark = greyMaterial("dark", 0.2F);
    const Material light = greyMaterial("light", 0.8F);
    return boxScene({1.0F, 2.0F, 3.0F}, {dark, light, light, greyMaterial("lamp", 0.5F, emitted), dark, light});
}

TEST(ReferenceMatrix, OnlyConvexScenesAreConvex) {
    EXPECT_TRUE(isConvex(litBox()));
    EXPECT_FALSE(isConvex(roomWithBoxScene()));
}

TEST(ReferenceMatrix, ClosedFormsOfABoxKeepAllIdentities) {
    Progress progress;
    const MeshedScene scene = meshed(litBox(), 300);
    const FormFactorMatrix matrix = unoccludedMatrix(scene.mesh, progress);
    const MatrixQuality quality = assessMatrix(matrix, scene.mesh.area);
    // Areas are kept in single precision, exact to 6e-8.
    EXPECT_LT(columnClosure(matrix, scene.mesh.area).rms, 2e-7);
    EXPECT_LT(quality.closureRms, 2e-7);
    EXPECT_LT(quality.reciprocityRms, 2e-7);
}

TEST(ReferenceMatrix, ChoicesAreRead) {
    EXPECT_EQ(parseReference("auto").kind, ReferenceChoice::Kind::Automatic);
    EXPECT_EQ(parseReference("exact").kind, ReferenceChoice::Kind::Exact);
    EXPECT_EQ(parseReference("a:b.mtx").kind, ReferenceChoice::Kind::File);
    const ReferenceChoice lines = parseReference("local-lines:1000");
    EXPECT_EQ(lines.method->name, "local-lines");
    EXPECT_EQ(lines.effort, 1000.0);
    for (const char* bad : {"", "nonsense", "hemicube", "hemicube:", "hemicube:31", "hemicube:2", "local-lines:1e99",
                            "local-lines:nan", "local-lines:0.5", "cube:64"})
        EXPECT_THROW(parseReference(bad), UsageError) << bad;
}

TEST(ReferenceMatrix, ItsOwnErrorIsThatAgainstTheTruth) {
    Progress progress;
    const MeshedScene scene = meshed(litBox(), 200);
    const double threshold = 1e-3;
    const FormFactorMatrix exact = unoccludedMatrix(scene.mesh, progress);
    const ReferenceMatrix lines = makeReference(parseReference("local-lines:4096"), scene, 1, threshold, progress);
    ASSERT_TRUE(lines.ownError);
    const double error = formFactorErrors(lines.matrix, exact, scene.mesh.area, threshold).relativeRms;
    // Both are RMS of tens of thousands of errors, of which a row's share their lines: alike to some percent.
    EXPECT_NEAR(*lines.ownError, error, 0.1 * error);
    EXPECT_GT(error, 1e-3);
}

TEST(ReferenceMatrix, ExactIsRefusedWhereSomethingMayHide) {
    Progress progress;
    const MeshedScene scene = meshed(roomWithBoxScene(), 100);
    EXPECT_THROW(makeReference(parseReference("exact"), scene, 1, 0.0, progress), UsageError);
}

FormFactorComparison compareBox(const Scene& scene, int seeds) {
    Progress progress;
    const MeshedScene meshedScene = meshed(scene, 150);
    FormFactorComparisonOptions options;
    options.ladders = {{&comparedMethod("hemicube"), {32, 64}}, {&comparedMethod("local-lines"), {256, 1024, 4096}}};
    options.seeds = seeds;
    return compareFormFactors(meshedScene, options, progress);
}

TEST(CompareFormFactors, LinesConvergeWithoutBiasAndHemicubesKeepTheirs) {
    const FormFactorComparison comparison = compareBox(litBox(), 4);
    ASSERT_EQ(comparison.methods.size(), 2U);
    EXPECT_EQ(comparison.referenceError, 0.0);
    const MethodResult& hemicube = comparison.methods[0];
    const MethodResult& lines = comparison.methods[1];
    for (const char* key : {"relative_rms", "misdirected", "column_closure", "reciprocity", "radiosity"}) {
        const auto law = lines.law(measure("rays"), measure(key));
        ASSERT_TRUE(law) << key;
        // −1/2 for independent lines; scrambled Sobol points are better, never worse than that by more than noise.
        EXPECT_LT(law->exponent, -0.45) << key;
        EXPECT_GT(law->exponent, -1.1) << key;
    }
    const EffortResult& fine = lines.efforts.back();
    const MeanDeviation bias = fine.of(measure("bias"));
    // Four runs: beyond five standard errors in one of 65 tests of an unbiased method (Student's t, 3 degrees: 1.5 %).
    EXPECT_LT(std::abs(bias.mean), 5.0 * bias.deviation / 2.0);
    // From a patch's centre alone near neighbours are wrong, whatever the resolution.
    EXPECT_GT(hemicube.efforts.back().systematic.value(), 5.0 * fine.systematic.value());
    EXPECT_EQ(fine.of(measure("rays")).mean, 4096.0 * static_cast<double>(lines.misdirectedBy.size()));
    EXPECT_GT(fine.of(measure("bytes")).mean, 0.0);
    EXPECT_FALSE(hemicube.bySize.empty());
}

TEST(CompareFormFactors, WithoutLightRadiosityIsLeftOut) {
    const FormFactorComparison comparison = compareBox(litBox(0.0F), 1);
    EXPECT_FALSE(comparison.lit);
    EXPECT_EQ(comparison.methods[0].efforts[0].runs[0].radiosity, 0.0);
    EXPECT_GT(comparison.methods[0].efforts[0].runs[0].relativeRms, 0.0);
    EXPECT_FALSE(comparison.methods[0].efforts[0].systematic);
}

TEST(PatchPicture, APatchHasTheColourOfItsValue) {
    Progress progress;
    const MeshedScene scene = meshed(litBox(), 6);
    std::vector<float> values(scene.mesh.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = std::pow(10.0F, -static_cast<float>(scene.mesh.material[i]) / 4.0F);
    const ColourScale scale(values, 3);
    Camera camera;
    camera.eye = {0.5F, 1.0F, 2.9F};
    camera.direction = {0.0F, 0.0F, -1.0F};
    const Image image = patchPicture(scene.mesh, *scene.rays, values, scale, camera, {32, 32, 2}, progress);
    EXPECT_EQ(image.content, PixelContent::Display);
    // The camera looks at z = 0, the fifth side.
    const Rgb expected = linearDisplay(scale.colour(std::pow(10.0, -1.0)));
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(image.at(16, 16)[c], expected[c], 1e-5F); // single precision, times and over π
}

} // namespace
} // namespace lambert
