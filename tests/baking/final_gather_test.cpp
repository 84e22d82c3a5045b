// Light gathered at points and vertices: exact where it can be, and as good as it says elsewhere.
#include "baking/bake_scene.h"
#include "baking/vertex_gather.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "formfactors/patch_sampling.h"
#include "meshing/patch_offset.h"
#include "scene/example_scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

namespace lambert {
namespace {

SolvedScene solved(const Scene& scene, std::size_t patches) {
    SolveOptions options;
    options.mesh.patches = patches;
    options.method = FormFactorLight{};
    Progress progress;
    return solveScene(scene, options, progress);
}

LitPatches lit(const SolvedScene& s) { return {s.mesh, s.optics, *s.scene, s.solution}; }

FinalGather gatherOf(const SolvedScene& s, double error, std::uint64_t seed = 1) {
    const LitPatches patches = lit(s);
    return {*s.rays, patches, lightsOf(*s.scene), varianceWithin(patches, reconstructAverage(patches, {})),
            FinalGatherOptions{.error = error, .seed = seed}};
}

/// A point anywhere on each of `count` patches, chosen evenly among those that see more than backs.
std::vector<GatherPoint> pointsOn(const SolvedScene& s, std::size_t count) {
    std::vector<GatherPoint> points;
    for (std::uint32_t k = 0; points.size() < count; ++k) {
        const auto bits = philox({k, 0, 0, 0}, 7);
        const std::size_t patch = bits[0] % s.mesh.size();
        if (s.mesh.isHidden(patch) || s.solution.covered[patch] > 0.01F) continue;
        const glm::dvec2 u(static_cast<double>(uniformFloat(bits[1])), static_cast<double>(uniformFloat(bits[2])));
        points.push_back(
            {PatchPoints(s.mesh, patch).at(u), s.mesh.normal[patch], patchOriginOffset(*s.rays, s.mesh, patch)});
    }
    return points;
}

Scene furnace() {
    const Material wall = greyMaterial("wall", 0.5F, 1.0F);
    return boxScene({2, 1.5F, 1}, {wall, wall, wall, wall, wall, wall});
}

/// As a room with many lights: a sky, a bulb and a lamp.
Scene openRoom() {
    Scene scene = roomWithBoxScene();
    scene.lights.push_back({.name = "bulb", .position = {0.4F, 0.5F, 1.5F}, .intensity = Rgb(0.1F)});
    return scene;
}

TEST(FinalGather, TheFurnaceIsExactAtAnyPoint) {
    const SolvedScene s = solved(furnace(), 200);
    const FinalGather gather = gatherOf(s, 0.01);
    // What rays meet is the same everywhere; left are float rounding, the solver's tolerance (1e-4) and that of row sums.
    for (const GatherPoint& point : pointsOn(s, 50)) {
        const GatheredLight light = gather.at(point, 0);
        EXPECT_NEAR(light.irradiance().x, 2.0, 4e-4);
        EXPECT_LT(light.reflected.variance.x, 1e-10);
        EXPECT_EQ(light.covered, 0.0);
    }
    EXPECT_NEAR(gather.at({{1.0F, 0.7F, 0.5F}, {0, 0, 1}, 1e-5F}, 0).irradiance().x, 2.0, 4e-4); // in the air
}

TEST(FinalGather, TheFurnaceIsExactAtVertices) {
    BakeOptions options;
    options.solve.mesh.patches = 200;
    options.solve.method = FormFactorLight{};
    options.gather.emplace();
    Progress progress;
    const BakedScene baked = bakeScene(furnace(), options, progress);
    for (const Rgb& e : baked.baked.irradiance) EXPECT_NEAR(static_cast<double>(e.x), 2.0, 4e-4);
    for (const Rgb& b : baked.baked.radiosity) EXPECT_NEAR(static_cast<double>(b.x), 2.0, 2e-4);
    EXPECT_EQ(baked.gather->vertices, baked.baked.positions.size());
}

TEST(FinalGather, BetweenSquaresInTheOpenItIsTheClosedForm) {
    // A black floor of 1 x 1 m below a lamp as large, 1 m above: E at the middle is four times that of a
    // corner of a quarter, 0.0598641 (plane element to parallel rectangle).
    const std::array<std::array<glm::vec3, 4>, 2> quads{
        {{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, {{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}}}};
    const SolvedScene s =
        solved(quadScene(quads, std::array{greyMaterial("floor", 0.0F), greyMaterial("lamp", 0.0F, 1.0F)}), 50);
    const GatheredLight light = gatherOf(s, 0.01).at({{0.5F, 0.5F, 0.0F}, {0, 0, 1}, 1e-5F}, 0);
    EXPECT_NEAR(light.irradiance().x, 4.0 * 0.0598641, 1e-5);
    EXPECT_EQ(light.reflected.mean.x, 0.0);
}

TEST(FinalGather, InsideAnObjectThereIsNothingButBacks) {
    const SolvedScene s = solved(roomWithBoxScene(), 300);
    const glm::vec3 middle = [&] {
        glm::vec3 sum(0.0F);
        float count = 0.0F;
        for (std::size_t i = 0; i < s.mesh.size(); ++i) {
            if (s.mesh.material[i] != 6) continue;
            sum += s.mesh.centroid[i];
            count += 1.0F;
        }
        return sum / count;
    }();
    const GatheredLight light = gatherOf(s, 0.01).at({middle, {0, 0, 1}, 1e-5F}, 0);
    EXPECT_EQ(light.covered, 1.0);
    EXPECT_EQ(light.irradiance().x, 0.0);
}

/// The points' values by 16 seeds of a gather that is four times as good: a quarter of .01 / √16 is no part of the error.
std::vector<RgbSum> expectedAt(const SolvedScene& s, const std::vector<GatherPoint>& points) {
    std::vector<RgbSum> sums(points.size(), RgbSum(0.0));
    for (std::uint64_t seed = 100; seed < 116; ++seed) {
        const FinalGather gather = gatherOf(s, 0.0025, seed);
        parallelFor(points.size(), 8, [&](std::size_t begin, std::size_t end, int) {
            for (std::size_t i = begin; i < end; ++i)
                sums[i] += gather.at(points[i], static_cast<std::uint32_t>(i)).irradiance() / 16.0;
        });
    }
    return sums;
}

TEST(FinalGather, ErrorsAreTheStatedOnes) {
    const SolvedScene s = solved(openRoom(), 500);
    const std::vector<GatherPoint> points = pointsOn(s, 250);
    const std::vector<RgbSum> expected = expectedAt(s, points);
    constexpr int kSeeds = 8;
    int within = 0;
    double squares = 0.0, bias = 0.0, total = 0.0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const FinalGather gather = gatherOf(s, 0.01, seed);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const GatheredLight light = gather.at(points[i], static_cast<std::uint32_t>(i));
            const double error = sumOf(light.irradiance() - expected[i]);
            const double stated = sumOf(glm::sqrt(light.reflected.variance + light.directVariance()));
            within += std::abs(error) <= 2.0 * stated ? 1 : 0;
            squares += error * error / (stated * stated);
            bias += error;
            total += sumOf(expected[i]);
        }
    }
    const double count = kSeeds * static_cast<double>(points.size());
    EXPECT_GE(within, 0.95 * count) << within / count;
    EXPECT_LT(squares / count, 1.1);
    EXPECT_GT(squares / count, 0.3); // nor are they stated out of all proportion
    // 2,000 errors of 1 %: .02 % if they are independent.
    EXPECT_LT(std::abs(bias), 1.5e-3 * total) << bias / total;
}

TEST(FinalGather, VerticesAreAsGoodAsTheySay) {
    const SolvedScene s = solved(openRoom(), 1500);
    Progress progress;
    const BakedMesh mesh = reconstructAverage(lit(s), {});
    const VertexPlaces places(*s.rays, s.mesh, mesh, s.solution.covered);
    const std::vector<VertexLight> found = gatherAtVertices(gatherOf(s, 0.01), places, mesh, progress);
    const FinalGather better = gatherOf(s, 0.002, 50);
    int within = 0, count = 0;
    double squares = 0.0, bias = 0.0, total = 0.0;
    std::uint64_t rays = 0;
    for (std::size_t v = 0; v < found.size(); ++v) {
        if (found[v].rays == 0) continue;
        std::vector<VertexPlace> at;
        places.of(v, at);
        RgbSum expected(0.0);
        double covered = 0.0;
        for (const VertexPlace& place : at) {
            const GatheredLight light = better.at(place.point, static_cast<std::uint32_t>(v));
            expected += place.weight * light.irradiance();
            covered += place.weight * light.covered;
        }
        if (covered > 0.01) continue; // gathered elsewhere
        const double light = sumOf(expected);
        const double stated = sumOf(found[v].standardError);
        const double error = sumOf(found[v].irradiance - expected);
        within += std::abs(error) <= 2.0 * stated ? 1 : 0;
        squares += error * error;
        bias += error;
        total += light;
        rays += found[v].rays;
        ++count;
    }
    ASSERT_GT(count, 1500);
    EXPECT_GE(within, 0.95 * count) << within << " of " << count;
    EXPECT_LT(std::sqrt(squares / count), 0.012 * total / count) << std::sqrt(squares / count) / (total / count);
    EXPECT_LT(std::abs(bias), 2e-3 * total) << bias / total;
    EXPECT_LT(rays / static_cast<std::uint64_t>(count), 1000U) << rays / static_cast<std::uint64_t>(count);
}

TEST(FinalGather, GivesTheSameBitsOnAnyNumberOfThreads) {
    BakeOptions options;
    options.solve.mesh.patches = 300;
    options.solve.method = FormFactorLight{};
    options.gather.emplace();
    const auto irradiance = [&](int threads) {
        const ThreadCountScope scope(threads);
        Progress progress;
        return bakeScene(openRoom(), options, progress).baked.irradiance;
    };
    EXPECT_EQ(irradiance(1), irradiance(3));
}

TEST(FinalGather, RefusesWhatMakesNoSense) {
    const SolvedScene s = solved(furnace(), 50);
    EXPECT_THROW(gatherOf(s, 0.0), UsageError);
    EXPECT_THROW(gatherOf(s, 2.0), UsageError);
    EXPECT_THROW(gatherOf(s, std::nan("")), UsageError);
}

} // namespace
} // namespace lambert
