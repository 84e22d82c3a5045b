// The light of what emits, against closed forms, energy and itself.
#include "core/parallel.h"
#include "formfactors/closed_form.h"
#include "meshing/build_patch_mesh.h"
#include "meshing/prepare.h"
#include "scene/example_scenes.h"
#include "scene_case.h"
#include "solver/emitter_light.h"
#include "solver/energy_balance.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <numbers>

namespace lambert {
namespace {

constexpr double kPi = std::numbers::pi;
using Quad = std::array<glm::vec3, 4>;

/// A rotation by an odd angle about an odd axis.
glm::vec3 rotated(const glm::vec3& p) {
    const glm::vec3 axis = glm::normalize(glm::vec3(0.3F, -0.7F, 0.5F));
    const float c = std::cos(0.7F), s = std::sin(0.7F);
    return c * p + s * glm::cross(axis, p) + (1.0F - c) * glm::dot(axis, p) * axis;
}

/// Adds a sphere of 2 · n² triangles of the last material.
void addSphere(Scene& scene, const glm::vec3& centre, float radius, int n) {
    const auto base = static_cast<std::uint32_t>(scene.positions.size());
    const auto material = static_cast<std::uint32_t>(scene.materials.size() - 1);
    const auto index = [&](int ring, int k) { return base + static_cast<std::uint32_t>(ring * 2 * n + k % (2 * n)); };
    for (int ring = 0; ring <= n; ++ring) {
        for (int k = 0; k < 2 * n; ++k) {
            const double theta = kPi * ring / n, phi = kPi * k / n;
            scene.positions.push_back(centre + radius * glm::vec3(std::sin(theta) * std::cos(phi), std::cos(theta),
                                                                  std::sin(theta) * std::sin(phi)));
        }
    }
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        Polygon polygon;
        polygon.vertices = {a, b, c, kNone};
        polygon.material = material;
        scene.polygons.push_back(polygon);
    };
    for (int ring = 0; ring < n; ++ring) {
        for (int k = 0; k < 2 * n; ++k) {
            if (ring > 0) add(index(ring, k), index(ring, k + 1), index(ring + 1, k + 1));
            if (ring + 1 < n) add(index(ring, k), index(ring + 1, k + 1), index(ring + 1, k));
        }
    }
}

struct Lit {
    explicit Lit(const Scene& given, std::size_t patches = 300) : scene(prepareScene(given)), rays(scene) {
        MeshOptions options;
        options.patches = patches;
        mesh = buildPatchMesh(scene, options, progress);
        optics = patchOptics(scene, mesh);
    }
    EmitterLight light(std::uint64_t seed = 1) const { return {rays, mesh, optics, seed}; }

    double power(const std::vector<RgbSum>& irradiance) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < mesh.size(); ++i) sum += static_cast<double>(mesh.area[i]) * irradiance[i].x;
        return sum;
    }
    double emitted() const {
        return power(std::vector<RgbSum>(optics.emittedRadiosity.begin(), optics.emittedRadiosity.end()));
    }

    Progress progress;
    Scene scene;
    RayCaster rays;
    PatchMesh mesh;
    PatchOptics optics;
};

Scene room(float size, const std::vector<Material>& lamp) {
    const Material wall = greyMaterial("wall", 0.5F);
    Scene scene = boxScene(glm::vec3(size), {wall, wall, wall, wall, wall, wall});
    scene.materials.insert(scene.materials.end(), lamp.begin(), lamp.end());
    return scene;
}

/// Σ F B_e in closed form over all triangles, with nothing between.
double unhidden(const EmitterTree& tree, const glm::dvec3& point, const glm::dvec3& normal) {
    double sum = 0.0;
    for (const EmitterTriangle& t : tree.triangles()) sum += pointToPolygon(point, normal, t.corners) * t.radiosity.x;
    return sum;
}

class LampSizes : public testing::TestWithParam<float> {};
INSTANTIATE_TEST_SUITE_P(Radii, LampSizes, testing::Values(0.0005F, 0.005F, 0.015F, 0.1F));

TEST_P(LampSizes, SphereShinesAsFarAndAsNearAsItsTriangles) {
    Scene scene = room(2.0F, {greyMaterial("lamp", 0.0F, 1.0F)});
    const float radius = GetParam();
    addSphere(scene, {1.0F, 1.0F, 1.0F}, radius, 16);
    for (glm::vec3& p : scene.positions) p = rotated(p);
    const Lit lit(scene);
    const EmitterLight light = lit.light();
    const EmitterTree tree(lit.rays, lit.mesh, lit.optics);
    EXPECT_EQ(tree.triangles().size(), 2U * 32U * 15U); // 32 around, 16 rings, of which the two at the poles have half
    std::uint32_t index = 0;
    for (const glm::vec3 place :
         {glm::vec3(1.0F, 0.0F, 1.0F), glm::vec3(1.6F, 0.0F, 1.3F), glm::vec3(0.1F, 0.7F, 0.4F),
          glm::vec3(1.0F, 1.0F - 1.5F * radius, 1.0F), glm::vec3(1.0F + radius, 1.0F - 2.0F * radius, 1.0F)}) {
        const glm::vec3 point = rotated(place), normal = rotated({0, 1, 0});
        const double expected = unhidden(tree, glm::dvec3(point), glm::dvec3(normal));
        const EstimatedLight found = light.irradiance(point, normal, lit.rays.originOffset(0.0F), index++, 1024);
        // The cut is to a thousandth; near a sphere, triangles behind its horizon are drawn at random too.
        EXPECT_NEAR(found.irradiance.x, expected, 5e-3 * expected + 3.0 * found.standardError.x) << place.y;
        EXPECT_LE(found.standardError.x, 0.01 * expected) << place.y;
    }
}

TEST_P(LampSizes, ClosedRoomReceivesWhatASphereEmits) {
    for (const bool millimetres : {false, true}) {
        Scene scene = room(2.0F, {greyMaterial("lamp", 0.0F, 1.0F)});
        addSphere(scene, {0.9F, 1.5F, 1.2F}, GetParam(), 12);
        for (glm::vec3& p : scene.positions) p = (millimetres ? 1e-3F : 1.0F) * rotated(p);
        Lit lit(scene);
        const double emitted = lit.emitted();
        ASSERT_GT(emitted, 0.0);
        // Of a few hundred patches each is right to a few thousandths, independently.
        EXPECT_NEAR(lit.power(lit.light().irradiance(lit.mesh, lit.progress)), emitted, 2e-3 * emitted);
    }
}

TEST(EmitterLight, HalfHiddenLampShinesWithItsOtherHalf) {
    // A lamp of 1 m² 2 m above the floor, and a screen just below it that hides the half of x > 0.
    const std::array<Quad, 3> quads{{{{{-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}}},
                                     {{{-0.5F, 2, -0.5F}, {0.5F, 2, -0.5F}, {0.5F, 2, 0.5F}, {-0.5F, 2, 0.5F}}},
                                     {{{0, 1.999F, -1}, {1, 1.999F, -1}, {1, 1.999F, 1}, {0, 1.999F, 1}}}}};
    const std::array materials{greyMaterial("floor", 0.5F), greyMaterial("lamp", 0.0F, 1.0F),
                               greyMaterial("screen", 0.0F)};
    const Lit lit(quadScene(quads, materials));
    const std::array<glm::dvec3, 4> half{glm::dvec3(-0.5, 2, -0.5), {0, 2, -0.5}, {0, 2, 0.5}, {-0.5, 2, 0.5}};
    const double expected = pointToPolygon({0, 0, 0}, {0, 1, 0}, half);
    const EstimatedLight found = lit.light().irradiance({0, 0, 0}, {0, 1, 0}, lit.rays.originOffset(0.0F), 0, 1024);
    EXPECT_NEAR(found.irradiance.x, expected,
                4.0 * found.standardError.x + 1e-3 * expected); // the screen is a bit lower
    EXPECT_GT(found.standardError.x, 0.0);
    EXPECT_LT(found.standardError.x, 0.02 * expected);
}

TEST(EmitterLight, FloorInTheCornerOfALuminousWallIsExact) {
    // At distance h from a wall of B = 1, wide and high: F = (1 − h / sqrt(h² + H²)) / 2.
    const std::array<Quad, 2> quads{
        {{{{0, 0, 50}, {2, 0, 50}, {2, 0, -50}, {0, 0, -50}}}, {{{0, 0, 50}, {0, 0, -50}, {0, 1, -50}, {0, 1, 50}}}}};
    const std::array materials{greyMaterial("floor", 0.5F), greyMaterial("wall", 0.5F, 1.0F)};
    const Lit lit(quadScene(quads, materials));
    std::uint32_t index = 0;
    for (const double h : {0.002, 0.01, 0.1, 1.0}) {
        const EstimatedLight found = lit.light().irradiance({h, 0, 0}, {0, 1, 0}, 1e-5F, index++, 256);
        const double expected = 0.5 * (1.0 - h / std::sqrt(h * h + 1.0));
        EXPECT_NEAR(found.irradiance.x, expected, 1e-3 * expected) << h; // the wall has ends
    }
}

TEST(EmitterLight, MaterialsAddUpAndThreadsChangeNothing) {
    const ThreadCountGuard guard;
    Scene scene = room(2.0F, {greyMaterial("left", 0.0F, 1.0F), greyMaterial("right", 0.0F, 2.0F)});
    addSphere(scene, {0.5F, 1.2F, 1.0F}, 0.1F, 8);
    for (Polygon& p : scene.polygons)
        if (p.material == 7) p.material = 6;
    addSphere(scene, {1.5F, 1.2F, 1.0F}, 0.1F, 8);
    Lit lit(scene);
    std::vector<std::vector<RgbSum>> parts;
    setThreadCount(1);
    const auto whole = lit.light().irradiance(lit.mesh, lit.progress, &parts);
    setThreadCount(3);
    EXPECT_EQ(lit.light().irradiance(lit.mesh, lit.progress), whole);
    ASSERT_EQ(parts.size(), 2U);
    for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_EQ(parts[0][i] + parts[1][i], whole[i]);
    EXPECT_GT(lit.power(parts[1]), 1.5 * lit.power(parts[0]));
}

TEST(EmitterLight, ContactWithALampIsDark) {
    // A lamp that lies on the floor, face down.
    const std::array<Quad, 2> quads{{{{{0, 0, 2}, {2, 0, 2}, {2, 0, 0}, {0, 0, 0}}},
                                     {{{0.5F, 1e-7F, 0.5F}, {1, 1e-7F, 0.5F}, {1, 1e-7F, 1}, {0.5F, 1e-7F, 1}}}}};
    const std::array materials{greyMaterial("floor", 0.5F), greyMaterial("lamp", 0.0F, 1.0F)};
    const Scene scene = quadScene(quads, materials);
    const RayCaster rays(scene);
    Progress progress;
    const PatchMesh mesh = buildPatchMesh(scene, {}, progress);
    const EmitterLight light(rays, mesh, patchOptics(scene, mesh), 1);
    EXPECT_EQ(light.irradiance({0.7F, 0, 0.7F}, {0, 1, 0}, rays.originOffset(0.1F), 0, 256).irradiance.x, 0.0);
}

class EmittersApart : public testing::TestWithParam<SolverMethod> {};
INSTANTIATE_TEST_SUITE_P(All, EmittersApart, deterministicSolvers(), solverTestName);

TEST_P(EmittersApart, SolutionIsThatOfTheFormFactors) {
    const SceneCase& c = sceneCase("cornell_box.obj", 500, hemicubes(64));
    Progress progress;
    const auto emitted = EmitterLight(c.rays, c.mesh, c.optics, 1).irradiance(c.mesh, progress);
    StoredRows rows(c.matrix);
    SolverOptions options;
    options.method = GetParam();
    options.tolerance = 1e-7;
    const RadiositySolution apart = solve(SolverProblem({c.mesh, c.optics}, {}, emitted), rows, options, progress);
    const RadiositySolution whole = c.solved(GetParam());
    // What the lamp emits is the same; direct light is that of points instead of one hemicube of so few pixels.
    EXPECT_EQ(apart.energy.emitted, whole.energy.emitted);
    EXPECT_EQ(apart.energy.received, RgbSum(0.0));
    EXPECT_NEAR(apart.energy.imbalance(), 0.0, 3e-3);
    const auto found = c.means(apart.irradiance);
    for (const auto& [name, expected] : cornellSurfaces())
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(found.at(name)[channel], expected[channel], 0.01 * expected[channel]) << name;
    for (std::size_t i = 0; i < c.mesh.size(); ++i) {
        const RgbSum expected =
            RgbSum(c.optics.emittedRadiosity[i]) + RgbSum(c.optics.reflectance[i]) * apart.irradiance[i];
        EXPECT_NEAR(apart.radiosity[i].x, expected.x, 1e-9 * expected.x + 1e-12);
    }
}

TEST(EmittersApartByJacobi, FirstBounceIsTheReflectedDirectLight) {
    const SceneCase& c = sceneCase("cornell_box.obj", 500, hemicubes(64));
    Progress progress;
    const auto emitted = EmitterLight(c.rays, c.mesh, c.optics, 1).irradiance(c.mesh, progress);
    StoredRows rows(c.matrix);
    SolverOptions options;
    options.method = SolverMethod::Jacobi;
    options.bounces = 2;
    options.keepBounces = true;
    const RadiositySolution solution = solve(SolverProblem({c.mesh, c.optics}, {}, emitted), rows, options, progress);
    ASSERT_EQ(solution.bounces.size(), 2U);
    for (std::size_t i = 0; i < c.mesh.size(); ++i) {
        const RgbSum first = RgbSum(c.optics.reflectance[i]) * emitted[i];
        EXPECT_NEAR(static_cast<double>(solution.bounces[0][i].x), first.x, 1e-6 * first.x); // floats
    }
}

} // namespace
} // namespace lambert
