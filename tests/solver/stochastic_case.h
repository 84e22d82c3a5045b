#pragma once

#include "formfactors/closed_form_method.h"
#include "meshing/build_patch_mesh.h"
#include "meshing/prepare.h"
#include "scene/example_scenes.h"
#include "scene/rays/ray_caster.h"
#include "solver/jacobi.h"
#include "solver/stochastic_solution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace lambert {

/// A scene in patches, and the exact solution of this mesh: Jacobi with form factors in closed form.
struct StochasticCase {
    StochasticCase(const Scene& source, std::size_t patches) : scene(prepareScene(source)), rays(scene) {
        MeshOptions options;
        options.patches = patches;
        Progress progress;
        mesh = buildPatchMesh(scene, options, progress);
        optics = patchOptics(scene, mesh);
        const ClosedForm method(mesh, rays, {});
        FormFactorMatrix matrix(mesh.size(), MatrixStorage::Double);
        RowAccumulator accumulator(mesh.size());
        FormFactorRow row;
        for (std::uint32_t i = 0; i < mesh.size(); ++i) {
            method.row(i, accumulator);
            accumulator.take(row);
            matrix.setRow(i, row);
        }
        StoredRows stored(matrix);
        exact = solveJacobi(SolverProblem({mesh, optics}), stored, {.tolerance = 1e-12}, progress);
    }

    StochasticCase(const StochasticCase&) = delete;
    StochasticCase& operator=(const StochasticCase&) = delete;

    Scene scene;
    RayCaster rays;
    PatchMesh mesh;
    PatchOptics optics;
    RadiositySolution exact;
};

inline Material colouredMaterial(std::string name, const Rgb& reflectance, const Rgb& emitted = Rgb(0.0F)) {
    Material material{std::move(name), reflectance, emitted / std::numbers::pi_v<float>, false};
    return material;
}

/// The box of data/reference/analytic.json with colours added: red has the reflectances and the light of `cube6`.
inline Scene colouredBox(const glm::vec3& size) {
    return boxScene(size, {colouredMaterial("a", {0.65F, 0.3F, 0.1F}), colouredMaterial("b", {0.15F, 0.6F, 0.2F}),
                           colouredMaterial("c", {0.5F, 0.5F, 0.5F}),
                           colouredMaterial("d", {0.8F, 0.7F, 0.2F}, {1.0F, 0.5F, 0.1F}),
                           colouredMaterial("e", {0.7F, 0.7F, 0.9F}),
                           colouredMaterial("f", {0.3F, 0.1F, 0.6F}, {0.25F, 0.0F, 0.5F})});
}

inline Scene closedCube() {
    const Material wall = greyMaterial("wall", 0.5F, 1.0F);
    return boxScene(glm::vec3(1.0F), {wall, wall, wall, wall, wall, wall});
}

/// Four equilateral triangles seen from inside: reflectances and light of `tetrahedron` in analytic.json.
inline Scene tetrahedron() {
    Scene scene;
    scene.nodes = {"scene"};
    scene.positions = {{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}};
    constexpr std::array<std::array<std::uint32_t, 3>, 4> kFaces{{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
    constexpr std::array kReflectance{0.2F, 0.4F, 0.6F, 0.8F};
    for (std::uint32_t k = 0; k < 4; ++k) {
        scene.materials.push_back(greyMaterial("face", kReflectance[k], k == 0 ? 1.0F : 0.0F));
        scene.polygons.push_back({{kFaces[k][0], kFaces[k][1], kFaces[k][2], kNone}, k, 0});
    }
    return scene;
}

/// A floor and a wall at right angles, coloured, and a lamp above; half of the light leaves. A screen in between has a black back.
inline Scene openCorner() {
    const std::array<std::array<glm::vec3, 4>, 4> quads{{
        {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}},
        {{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}},
        {{{0.3F, 0.3F, 1.2F}, {0.3F, 0.7F, 1.2F}, {0.7F, 0.7F, 1.2F}, {0.7F, 0.3F, 1.2F}}},
        {{{0.6F, 0.2F, 0.5F}, {0.6F, 0.8F, 0.5F}, {0.9F, 0.8F, 0.7F}, {0.9F, 0.2F, 0.7F}}},
    }};
    const std::array materials{colouredMaterial("floor", {0.8F, 0.6F, 0.4F}),
                               colouredMaterial("wall", {0.5F, 0.7F, 0.9F}),
                               colouredMaterial("lamp", {0.0F, 0.1F, 0.2F}, {8.0F, 6.0F, 4.0F}),
                               colouredMaterial("screen", {0.3F, 0.3F, 0.3F})};
    return quadScene(quads, materials);
}

/// Two-sided quantile: what |t| of Student's distribution exceeds with the given odds.
/// G. W. Hill's expansion about the normal quantile, A&S 26.7.5; good to a percent for 20 degrees and more.
inline double studentQuantile(double odds, double degrees) {
    double low = 0.0, high = 40.0;
    for (int k = 0; k < 100; ++k) {
        const double middle = 0.5 * (low + high);
        (std::erfc(middle / std::numbers::sqrt2) > odds ? low : high) = middle;
    }
    const double z = low;
    return z + (z * z * z + z) / (4.0 * degrees) +
           (5.0 * std::pow(z, 5.0) + 16.0 * z * z * z + 3.0 * z) / (96.0 * degrees * degrees);
}

/// z-tests of the mean over runs of independent seeds, with the standard errors that they state, for every patch and channel and for the
/// area-weighted mean of each channel. For correct code some of these fails once in 10,000 times (Šidák) if errors are normal.
inline void expectUnbiased(const PatchMesh& mesh, const std::vector<RgbSum>& exact,
                           std::span<const StochasticSolution> runs, const std::string& what) {
    const auto count = static_cast<double>(runs.size());
    const double tests = 3.0 * static_cast<double>(mesh.size());
    const double odds = -std::expm1(std::log1p(-1e-4) / tests);
    const double limit = studentQuantile(odds, count * (runs[0].subRuns - 1));
    double worst = 0.0;
    std::size_t worstPatch = 0;
    for (std::size_t i = 0; i < mesh.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            double sum = 0.0, variance = 0.0;
            for (const StochasticSolution& run : runs) {
                sum += run.irradiance[i][c] - exact[i][c];
                variance += std::pow(static_cast<double>(run.standardError[i][c]), 2.0);
            }
            // Below 1e-6 of the value floats are rounded.
            const double z = std::abs(sum) / std::sqrt(variance + std::pow(1e-6 * count * exact[i][c], 2.0) + 1e-30);
            if (z > worst) {
                worst = z;
                worstPatch = i;
            }
        }
    EXPECT_LT(worst, limit) << what << ", patch " << worstPatch << " of " << mesh.size();
}

} // namespace lambert
