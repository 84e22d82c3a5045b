// Every solver with form factors on the same scenes, against values of independent programs (data/reference).
#include "formfactors/repair.h"
#include "formfactors/transport.h"
#include "meshing/build_patch_mesh.h"
#include "meshing/prepare.h"
#include "scene/scene_reader.h"
#include "solver/solver.h"
#include "solver_case.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <sstream>

namespace lambert {
namespace {

TransportOptions hemicubes(int resolution) {
    TransportOptions options;
    options.resolution = resolution;
    return options;
}

TransportOptions closedForm() {
    TransportOptions options;
    options.method = TransportMethod::ClosedForm;
    return options;
}

/// A scene of data/ with repaired form factors.
struct SceneCase {
    SceneCase(const std::string& name, std::size_t patches, TransportOptions options)
        : scene(prepareScene(readScene(LAMBERT_DATA "/" + name).scene)), rays(scene) {
        Progress progress;
        MeshOptions meshOptions;
        meshOptions.patches = patches;
        mesh = buildPatchMesh(scene, meshOptions, progress);
        options.storage = MatrixStorage::Double;
        TransportMatrix computed = computeMatrix(planTransport(options, mesh, rays, progress), mesh, rays, progress);
        matrix = std::move(computed.matrix);
        repair(matrix, mesh.area, computed.repairWeights);
    }

    /// Area-weighted means over the materials, by name.
    std::map<std::string, RgbSum> means(const std::vector<RgbSum>& values) const {
        std::map<std::string, RgbSum> sums;
        std::map<std::string, double> areas;
        for (std::size_t i = 0; i < mesh.size(); ++i) {
            const std::string& name = scene.materials[mesh.material[i]].name;
            sums[name] += static_cast<double>(mesh.area[i]) * values[i];
            areas[name] += static_cast<double>(mesh.area[i]);
        }
        for (auto& [name, sum] : sums) sum /= areas[name];
        return sums;
    }

    Scene scene;
    RayCaster rays;
    PatchMesh mesh;
    FormFactorMatrix matrix;
};

class SolversOnScenes : public testing::TestWithParam<SolverMethod> {
protected:
    /// The same case for all solvers, made once.
    static const SceneCase& scene(const std::string& name, std::size_t patches, const TransportOptions& options) {
        static std::map<std::string, std::unique_ptr<SceneCase>> cases;
        auto& found = cases[name];
        if (!found) found = std::make_unique<SceneCase>(name, patches, options);
        return *found;
    }

    static RadiositySolution solved(const SceneCase& c) {
        Progress progress;
        StoredRows rows(c.matrix);
        SolverOptions options;
        options.method = GetParam();
        options.tolerance = 1e-7;
        RadiositySolution solution = solve(SolverProblem(c.mesh), rows, options, progress);
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
    const SceneCase& c = scene("furnace_box.obj", 500, hemicubes(64));
    for (const RgbSum& b : solved(c).radiosity) EXPECT_NEAR(b.x, 2.0, 1e-5); // rows are closed to 1e-6
}

// What is left is the error of constant radiosities on so many patches: 0.03 % of n = 12 per edge, from those that the
// reference gives for n = 1 and n = 32.
TEST_P(SolversOnScenes, TheRefinedCubeHasTheContinuousFaceMeans) {
    expectFaces(scene("cube6.obj", 864, closedForm()), "cube6", 1e-3);
}

TEST_P(SolversOnScenes, TheRefinedRoomHasTheContinuousFaceMeans) {
    expectFaces(scene("room432.obj", 864, closedForm()), "room432", 1e-3);
}

TEST_P(SolversOnScenes, TheTetrahedronOfFourPatchesIsExact) {
    const SceneCase& c = scene("tetrahedron.obj", 0, closedForm());
    const std::vector<double> expected = ReferenceCase("tetrahedron", "B").values;
    const RadiositySolution solution = solved(c);
    ASSERT_EQ(solution.radiosity.size(), 4U);
    // Closed forms are good to 1e-6, the tolerance is 1e-7.
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(solution.radiosity[i].x, expected[i], 2e-6);
}

TEST_P(SolversOnScenes, TheCornellBoxHasTheIrradianceOfParticleTracing) {
    const SceneCase& c = scene("cornell_box.obj", 2000, hemicubes(64));
    const auto means = c.means(solved(c).irradiance);
    std::ifstream file(LAMBERT_DATA "/reference/cornell_surfaces.csv");
    int surfaces = 0;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with('#')) continue;
        std::istringstream fields(line);
        std::string name, value;
        std::getline(fields, name, ',');
        for (int channel = 0; channel < 3 && std::getline(fields, value, ','); ++channel) {
            const double expected = std::stod(value);
            // Patches and one hemicube for each are coarse; the reference is good to 0.1 %.
            EXPECT_NEAR(means.at(name)[channel], expected, 0.015 * expected) << name << " " << channel;
        }
        ++surfaces;
    }
    EXPECT_EQ(surfaces, 8);
}

} // namespace
} // namespace lambert
