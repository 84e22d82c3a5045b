#include "cli/analytic_cases.h"

#include "formfactors/hemicube.h"
#include "lighting/solve_scene.h"
#include "scene/example_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace lambert {

namespace {

using Results = std::vector<AnalyticResult>;

void add(Results& results, std::string name, double expected, double found, double tolerance) {
    results.push_back({std::move(name), expected, found, tolerance});
}

/// By hemicubes, of the default resolution if none is given.
SolvedScene solveCase(const Scene& scene, std::size_t patches, std::optional<int> resolution, std::uint64_t seed,
                      Progress& progress) {
    FormFactorLight method;
    method.formFactors.transport.resolution = resolution;
    method.formFactors.transport.seed = seed;
    method.solver.tolerance = 1e-7;
    SolveOptions options;
    options.mesh.patches = patches;
    options.method = method;
    return solveScene(scene, options, progress);
}

/// B = B_e / (1 − ρ) in a closed box of one material.
void furnace(Results& results, Progress& progress) {
    const Material wall = greyMaterial("wall", 0.5F, 1.0F);
    const Scene box = boxScene({2.0F, 1.5F, 1.0F}, {wall, wall, wall, wall, wall, wall});
    const SolvedScene solved = solveCase(box, 1000, std::nullopt, 1, progress);
    double lowest = 1e30;
    double highest = 0.0;
    for (const RgbSum& b : solved.solution.radiosity) {
        lowest = std::min(lowest, b.x);
        highest = std::max(highest, b.x);
    }
    // Rows sum to 1, so every patch sees the same radiosity whatever the hemicubes' errors: only rounding is left.
    add(results, "furnace box: smallest B", 2.0, lowest, 1e-5);
    add(results, "furnace box: largest B", 2.0, highest, 1e-5);
    add(results, "furnace box: row sums, largest error", 0.0, solved.formFactors()->largestClosureError, 1e-6);
    add(results, "furnace box: energy imbalance", 0.0, solved.solution.energy.imbalance(), 5e-3);
}

/// Means of B over the faces of a cube whose exact continuous solution is known.
void cube6(Results& results, Progress& progress) {
    constexpr std::array faceMean{0.287692, 0.070598, 0.214617, 1.22326, 0.302829, 0.37635};
    constexpr std::array names{"x = 0", "x = 1", "y = 0", "y = 1", "z = 0", "z = 1"};
    constexpr std::array reflectance{0.65F, 0.15F, 0.5F, 0.8F, 0.7F, 0.3F};
    constexpr std::array emitted{0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.25F};
    std::array<Material, 6> materials;
    for (std::size_t i = 0; i < 6; ++i) materials[i] = greyMaterial(fmt::format("f{}", i), reflectance[i], emitted[i]);
    const SolvedScene solved = solveCase(boxScene(glm::vec3(1.0F), materials), 3456, 128, 1, progress);
    std::array<double, 6> sum{};
    std::array<double, 6> area{};
    for (std::size_t i = 0; i < solved.mesh.size(); ++i) {
        const auto a = static_cast<double>(solved.mesh.area[i]);
        sum[solved.mesh.material[i]] += a * solved.solution.radiosity[i].x;
        area[solved.mesh.material[i]] += a;
    }
    for (std::size_t face = 0; face < 6; ++face)
        add(results, fmt::format("cube6: mean B of face {}", names[face]), faceMean[face], sum[face] / area[face],
            0.005 * faceMean[face]);
    add(results, "cube6: row sums, largest error", 0.0, solved.formFactors()->largestClosureError, 1e-6);
}

/// RMS over several turns of the hemicubes.
double energyImbalance(std::size_t patches, int resolution, Progress& progress) {
    constexpr std::uint64_t kSeeds = 6;
    double squares = 0.0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const SolvedScene room = solveCase(roomWithBoxScene(), patches, resolution, seed, progress);
        const double imbalance = room.solution.energy.imbalance();
        squares += imbalance * imbalance;
    }
    return std::sqrt(squares / static_cast<double>(kSeeds));
}

/// Raw hemicube rows are not reciprocal, so energy is not conserved exactly; what is lost must fall with N and R.
void energy(Results& results, Progress& progress) {
    double previous = 1.0;
    for (const auto& [patches, resolution, tolerance] :
         {std::tuple(std::size_t{250}, 32, 0.02), std::tuple(std::size_t{1000}, 64, 5e-3),
          std::tuple(std::size_t{4000}, 128, 5e-3)}) {
        const double found = energyImbalance(patches, resolution, progress);
        add(results, fmt::format("room with box: energy imbalance, N = {}, R = {}", patches, resolution), 0.0, found,
            std::min(tolerance, previous));
        previous = found;
    }
}

/// F from one square to another, averaged over a refined mesh.
double squareToSquare(const std::array<std::array<glm::vec3, 4>, 2>& squares, Progress& progress) {
    const std::array materials{greyMaterial("one", 0.5F, 1.0F), greyMaterial("two", 0.5F)};
    const Scene scene = prepareScene(quadScene(squares, materials));
    const RayCaster rays(scene);
    MeshOptions meshOptions;
    meshOptions.patchLength = 1.0 / 24.0;
    const PatchMesh mesh = buildPatchMesh(scene, meshOptions, progress);
    const Hemicube method(mesh, rays, {.resolution = 256});
    const FormFactorMatrix matrix = computeMatrix(method, MatrixStorage::Double, progress);
    double flux = 0.0;
    double area = 0.0;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        if (mesh.material[i] != 0) continue;
        const auto a = static_cast<double>(mesh.area[i]);
        area += a;
        matrix.visit(i, [&](std::uint32_t j, double factor) { flux += mesh.material[j] == 1 ? a * factor : 0.0; });
    }
    return flux / area;
}

void squares(Results& results, Progress& progress) {
    constexpr double kParallel = 0.1998248957;
    constexpr double kPerpendicular = 0.2000437761;
    const std::array<glm::vec3, 4> floor{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
    const std::array<glm::vec3, 4> ceiling{{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}};
    const std::array<glm::vec3, 4> wall{{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}};
    add(results, "parallel unit squares at distance 1: F", kParallel, squareToSquare({floor, ceiling}, progress),
        0.005 * kParallel);
    add(results, "perpendicular unit squares: F", kPerpendicular, squareToSquare({floor, wall}, progress),
        0.005 * kPerpendicular);
}

} // namespace

bool AnalyticResult::passed() const { return std::abs(found - expected) <= tolerance; }

std::vector<AnalyticResult> runAnalyticCases(Progress& progress) {
    Results results;
    furnace(results, progress);
    cube6(results, progress);
    energy(results, progress);
    squares(results, progress);
    return results;
}

} // namespace lambert
