#include "comparison/compare_vpl.h"

#include "scene/reading/scene_reader.h"
#include "vpl/instant_radiosity_method.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <fstream>

namespace lambert {
namespace {

struct Choice {
    std::size_t patches = 300;
    double vpls = 512.0;
    int seeds = 8;
    double lines = 2e7; //!< of the reference
    int bounces = 0;    //!< compared by themselves, with the one before
};

VplComparison compared(const std::string& name, const InstantRadiosityChoice& method, const Choice& choice) {
    Progress progress;
    MeshOptions mesh;
    mesh.patches = choice.patches;
    const MeshedScene scene = meshLitScene(readScene(LAMBERT_DATA "/" + name).scene, mesh, progress);
    ReferenceOptions referenceOptions;
    referenceOptions.mesh = mesh;
    referenceOptions.lines = choice.lines;
    referenceOptions.bounces = choice.bounces;
    const RadiosityReference reference(scene, referenceOptions, progress);
    VplComparisonOptions options;
    options.methods = {std::make_shared<InstantRadiosityMethod>(method)};
    options.effort = choice.vpls;
    options.ladder.emplace(); // no other
    options.seeds = choice.seeds;
    options.perBounce = choice.bounces > 0;
    options.gathering.cells = 64;
    return compareVpl(scene, reference, options, progress);
}

const ErrorPart& part(const ErrorAnatomy& anatomy, const std::string& name) {
    for (const ErrorPart& p : anatomy.parts)
        if (p.approximation.part == name) return p;
    throw std::out_of_range(name);
}

void print(const std::string& name, const VplComparison& comparison) {
    const double mean = comparison.meanIrradiance();
    const ErrorAnatomy& anatomy = comparison.methods.front().anatomy;
    std::printf("%s: relative RMS %.4f, own error %.4f\n", name.c_str(), anatomy.rms / mean,
                comparison.reference.rms.total() / mean);
    for (const ErrorPart& p : anatomy.parts)
        std::printf("  %-12s share %.4f +- %.4f, RMS %.4f, bias %.4f +- %.4f\n", p.approximation.part.c_str(), p.share,
                    p.shareError, p.rms / mean, p.bias / mean, p.biasError / mean);
}

/// All parts make the whole, and what is left is within its stated noise: four standard errors.
void expectWhole(const ErrorAnatomy& anatomy) {
    double sum = 0.0;
    for (const ErrorPart& p : anatomy.parts) sum += p.share;
    EXPECT_NEAR(sum, 1.0, 1e-9);
    const ErrorPart& left = anatomy.parts.back();
    EXPECT_LT(std::abs(left.share), 4.0 * left.shareError);
}

// Walks that end after two bounces leave 2 (1 − 1/8) of an irradiance that is exactly 2 everywhere.
TEST(Anatomy, FurnaceLacksExactlyTheBouncesThatAreCutOff) {
    const VplComparison comparison =
        compared("furnace_box.obj", {.walk = Walk::Fixed, .bounces = 2, .bound = kUnbounded}, {.patches = 150});
    print("furnace, two bounces", comparison);
    const ErrorAnatomy& anatomy = comparison.methods.front().anatomy;
    expectWhole(anatomy);
    const ErrorPart& bounces = part(anatomy, "bounces");
    EXPECT_NEAR(bounces.bias, -0.25, 4.0 * bounces.biasError);
    EXPECT_LT(bounces.biasError, 0.02);
    EXPECT_EQ(part(anatomy, "clamping").share, 0.0);
}

// The bound takes from cube6's mean irradiance what the independent table says. The mean is that of 16 × 16 patches' centres on each wall,
// and what the bound takes rises steeply to the edges: the midpoint rule is off by 0.003 at most for these wide bounds.
TEST(Anatomy, ClampingTakesFromCube6WhatTheIndependentTableSays) {
    nlohmann::json analytic;
    std::ifstream(LAMBERT_DATA "/reference/analytic.json") >> analytic;
    const nlohmann::json table = analytic["vpl_clamp: loss of mean irradiance in cube6 for G<=b, infinitely many VPLs"];
    for (const std::string bound : {".5", "1"}) {
        const VplComparison comparison = compared("cube6.obj", {.bound = std::stod(bound), .recoveryRays = 16},
                                                  {.patches = 1500, .vpls = 256, .seeds = 6});
        print("cube6, G <= " + bound, comparison);
        const ErrorAnatomy& anatomy = comparison.methods.front().anatomy;
        expectWhole(anatomy);
        const ErrorPart& clamping = part(anatomy, "clamping");
        const double mean = comparison.meanIrradiance();
        EXPECT_NEAR(-clamping.bias / mean, table[bound].get<double>(), 0.003 + 4.0 * clamping.biasError / mean)
            << bound;
        EXPECT_GT(clamping.share, 0.5);
    }
}

TEST(Anatomy, ClampingOwnsTheErrorOfARoomLitFromACove) {
    const VplComparison comparison = compared("cove_room.gltf", {}, {.patches = 1000});
    print("cove", comparison);
    const ErrorAnatomy& anatomy = comparison.methods.front().anatomy;
    expectWhole(anatomy);
    EXPECT_GT(part(anatomy, "clamping").share, 0.9);
}

// The corridor's light has come through a door; without shadows it comes through the wall.
TEST(Anatomy, VisibilityOwnsTheErrorOfACorridorWithoutIndirectShadows) {
    const VplComparison comparison = compared("corridor.gltf", {.indirectShadows = false}, {});
    print("corridor without indirect shadows", comparison);
    const ErrorAnatomy& anatomy = comparison.methods.front().anatomy;
    expectWhole(anatomy);
    EXPECT_GT(part(anatomy, "visibility").share, 0.5); // more than all others together
}

// In a convex room there is nothing that shadows could be of.
TEST(Anatomy, VisibilityIsNothingInAConvexRoom) {
    const VplComparison comparison = compared("cube6.obj", {.indirectShadows = false}, {.vpls = 256});
    const ErrorAnatomy& anatomy = comparison.methods.front().anatomy;
    expectWhole(anatomy);
    EXPECT_LT(part(anatomy, "visibility").rms, 1e-5 * comparison.meanIrradiance()); // rays slip through an edge
}

TEST(Anatomy, SamplingOwnsTheErrorOfCompensatedLightInTheCornellBox) {
    const VplComparison comparison = compared("cornell_box.obj", {.compensate = true}, {});
    print("Cornell box, compensated", comparison);
    const ErrorAnatomy& anatomy = comparison.methods.front().anatomy;
    expectWhole(anatomy);
    EXPECT_GT(part(anatomy, "sampling").share, 0.8);
    EXPECT_EQ(part(anatomy, "clamping").share, 0.0);
}

TEST(Anatomy, SamplingAndClampingShareTheErrorOfTheCornellBox) {
    const VplComparison comparison = compared("cornell_box.obj", {}, {});
    print("Cornell box", comparison);
    const ErrorAnatomy& anatomy = comparison.methods.front().anatomy;
    expectWhole(anatomy);
    EXPECT_GT(part(anatomy, "sampling").share + part(anatomy, "clamping").share, 0.9);
    EXPECT_GT(part(anatomy, "clamping").share, 0.2);
}

// Of light that was reflected k times each wall of the furnace gets 2^-k, exactly: of 1, a half is reflected.
TEST(Bounces, OfTheFurnaceArePowersOfItsReflectance) {
    const VplComparison comparison = compared("furnace_box.obj", {.bound = kUnbounded}, {.patches = 150, .bounces = 4});
    const std::vector<VplBounce>& bounces = comparison.methods.front().bounces;
    ASSERT_EQ(comparison.referenceBounces.size(), 5U);
    ASSERT_EQ(bounces.size(), 5U);
    for (std::size_t k = 0; k < 5; ++k) {
        const double exact = std::exp2(-static_cast<double>(k));
        for (const RgbSum& e : comparison.referenceBounces[k].irradiance)
            EXPECT_NEAR(e.y, exact, 1e-4 * exact); // a ray in a million slips through an edge
        // The flux of every bounce is exact, but not where it arrives: four standard errors over the seeds.
        const MeanDeviation ratio = bounces[k].of(&FieldErrors::energyRatio);
        EXPECT_NEAR(ratio.mean, 1.0, 4.0 * ratio.deviation / std::sqrt(8.0)) << k;
        EXPECT_LT(ratio.deviation, 0.2) << k;
    }
}

// All light is the sum of its bounces: of the method to rounding; of the reference, each part of which is extrapolated
// by itself, within its own error, which bounds that of the sum where bounces err alike.
TEST(Bounces, OfTheCornellBoxMakeAllLight) {
    constexpr int kMost = 16;
    const InstantRadiosityChoice choice{.walk = Walk::Fixed, .bounces = kMost};
    const VplComparison comparison = compared("cornell_box.obj", choice, {.vpls = 128, .seeds = 3, .bounces = kMost});
    std::vector<RgbSum> sum(comparison.points.receivers.size(), RgbSum(0.0));
    double ownErrors = 0.0;
    for (const ReferenceLight& light : comparison.referenceBounces) {
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += light.irradiance[i];
        ownErrors += light.rms.total();
    }
    const LightErrors off = lightErrors(comparison.points.weight, comparison.reference.irradiance, sum);
    std::printf("sum of bounces: off by %.2e of the mean, own error %.2e, of the bounces %.2e\n",
                off.overall.relativeRms, comparison.reference.rms.total() / off.overall.mean,
                ownErrors / off.overall.mean);
    EXPECT_LT(off.overall.rms, ownErrors);
    EXPECT_LT(ownErrors, 0.02 * off.overall.mean);

    const VplMethodResult& method = comparison.methods.front();
    double bias = 0.0;
    for (std::size_t k = 0; k < method.bounces.size(); ++k) bias += method.bounces[k].runs[0].overall.bias;
    const double all = method.ladder[method.main].runs[0].errors.overall.bias;
    EXPECT_NEAR(bias + off.overall.bias, all, 1e-9 * comparison.meanIrradiance());
}

TEST(Bounces, OfCompensatedLightAreNotKnown) {
    EXPECT_FALSE(InstantRadiosityMethod({.compensate = true}).knowsBounces());
    EXPECT_TRUE(InstantRadiosityMethod({.bound = kUnbounded, .compensate = true}).knowsBounces());
    EXPECT_TRUE(InstantRadiosityMethod({}).knowsBounces());
}

} // namespace
} // namespace lambert
