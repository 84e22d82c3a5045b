/// Instant radiosity on the patches of a mesh.
#include "core/error.h"
#include "meshing/build_patch_mesh.h"
#include "vpl/instant_radiosity.h"
#include "vpl_case.h"

#include <gtest/gtest.h>

#include <numbers>

namespace lambert {
namespace {

/// A case with patches.
struct PatchCase : VplCase {
    PatchCase(const Scene& source, std::size_t patches) : VplCase(source) {
        MeshOptions options;
        options.patches = patches;
        Progress progress;
        mesh = buildPatchMesh(scene, options, progress);
        optics = patchOptics(scene, mesh);
    }
    InstantRadiosity solve(const InstantRadiosityOptions& options) const {
        Progress progress;
        return solveInstantRadiosity(SolverProblem({mesh, optics}), mesh, rays, options, progress);
    }
    PatchMesh mesh;
    PatchOptics optics;
};

Scene furnace() {
    std::array<Material, 6> walls;
    walls.fill(greyMaterial("wall", 0.5F, 1.0F));
    return boxScene({4.0F, 3.0F, 2.5F}, walls);
}

// B = B_e / (1 − ρ) = 2, E = 2. By area, the error of 4096 particles' flux is 2^-12 in a room without a way out; that of the points
// at which it is gathered some 0.1 %.
TEST(InstantRadiosity, GivesPatchesOfTheFurnaceTheirRadiosity) {
    const PatchCase c(furnace(), 600);
    const InstantRadiosity found = c.solve({.trace = {.particles = 4096}, .gather = {.recoveryRays = 16}});
    double area = 0.0, sum = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < c.mesh.size(); ++i) {
        const auto a = static_cast<double>(c.mesh.area[i]);
        area += a;
        sum += a * found.radiosity[i].y;
        squares += a * std::pow(found.radiosity[i].y / 2.0 - 1.0, 2.0);
        EXPECT_DOUBLE_EQ(found.radiosity[i].y, 1.0 + 0.5 * found.irradiance[i].y);
        EXPECT_EQ(found.covered[i], 0.0F);
    }
    EXPECT_NEAR(sum / area, 2.0, 0.01);
    EXPECT_LT(std::sqrt(squares / area), 0.02);
    EXPECT_NEAR(found.energy.emitted.x, area, 1e-4 * area);
    EXPECT_NEAR(found.energy.absorbed.x + found.lost.x, area, 1e-4 * area);
    // Both are fluxes to the patches: what was cut comes back, but for noise, as a share of all.
    EXPECT_GT(found.cut.x, 0.02 * 2.0 * area);
    EXPECT_NEAR(found.recovered.x, found.cut.x, 0.01 * 2.0 * area);
}

// What lights without area give is the problem's, and not added again.
TEST(InstantRadiosity, TakesDirectLightFromTheProblem) {
    std::array<Material, 6> walls;
    walls.fill(greyMaterial("wall", 0.0F));
    Scene scene = boxScene(glm::vec3(1.0F), walls);
    scene.lights.emplace_back().position = glm::vec3(0.5F);
    const PatchCase c(scene, 60);
    Progress progress;
    const std::vector<RgbSum> direct(c.mesh.size(), RgbSum(3.0, 2.0, 1.0));
    const InstantRadiosity found = solveInstantRadiosity(SolverProblem({c.mesh, c.optics}, direct), c.mesh, c.rays,
                                                         {.trace = {.particles = 100}}, progress);
    for (const RgbSum& e : found.irradiance) EXPECT_EQ(e, RgbSum(3.0, 2.0, 1.0));
}

// Below a sheet that shows its black back: the form factor of opposed unit squares, from 64 stratified rays per patch.
TEST(InstantRadiosity, KnowsWhatIsCovered) {
    const std::array quads{std::array<glm::vec3, 4>{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}},
                           std::array<glm::vec3, 4>{{{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}}};
    const PatchCase c(quadScene(quads, std::array{greyMaterial("floor", 0.5F, 1.0F), greyMaterial("sheet", 0.5F)}),
                      400);
    const InstantRadiosity found = c.solve({.trace = {.particles = 10}});
    double sum = 0.0, area = 0.0;
    for (std::size_t i = 0; i < c.mesh.size(); ++i) {
        if (c.mesh.polygon[i] != 0) {
            EXPECT_EQ(found.covered[i], 0.0F);
            continue;
        }
        sum += static_cast<double>(c.mesh.area[i] * found.covered[i]);
        area += static_cast<double>(c.mesh.area[i]);
    }
    EXPECT_NEAR(sum / area, 0.199824895698387, 0.005);
}

TEST(InstantRadiosity, GathersAtMorePointsWherePatchesAreFew) {
    EXPECT_EQ(pointsPerPatch({}, 6), 256U);
    EXPECT_EQ(pointsPerPatch({}, 1024), 16U);
    EXPECT_EQ(pointsPerPatch({}, 1000000), 4U);
    EXPECT_EQ(pointsPerPatch({.points = 9}, 6), 9U);
    EXPECT_THROW(checkInstantRadiosity({.points = 0}), UsageError);
    EXPECT_THROW(checkInstantRadiosity({.points = 4097}), UsageError);
    EXPECT_THROW(checkInstantRadiosity({.trace = {.particles = 0}}), UsageError);
    EXPECT_THROW(checkInstantRadiosity({.gather = {.bound = 0.0}}), UsageError);
    EXPECT_THROW(checkInstantRadiosity({.gather = {.skyRays = 1}}), UsageError);
}

} // namespace
} // namespace lambert
