#include "baking/bake_scene.h"
#include "core/error.h"
#include "core/random.h"
#include "sample_mesh.h"
#include "scene/example_scenes.h"
#include "solver/solution_file.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <cstring>
#include <filesystem>
#include <functional>

namespace lambert {
namespace {

using nlohmann::json;
using test::contentOf;
using test::temporaryFile;

/// A room with a box whose material has two sides, solved with bounces.
const BakedScene& room() {
    static const BakedScene baked = [] {
        Scene scene = roomWithBoxScene();
        for (Material& material : scene.materials) material.twoSided = true;
        BakeOptions options;
        auto& light = std::get<FormFactorLight>(options.solve.method);
        options.solve.mesh.patches = 300;
        light.formFactors.transport.resolution = 16;
        light.solver.method = SolverMethod::Jacobi;
        light.solver.keepBounces = true;
        Progress progress;
        return bakeScene(scene, options, progress);
    }();
    return baked;
}

std::vector<Rgb> someErrors() {
    std::vector<Rgb> errors;
    for (std::size_t k = 0; k < room().mesh.size(); ++k) errors.emplace_back(0.001F * static_cast<float>(k));
    return errors;
}

std::filesystem::path written(const std::string& name, const RadiositySolution& solution) {
    const std::filesystem::path path = temporaryFile(name);
    const std::vector<Rgb> errors = someErrors();
    writeSolution(
        {*room().scene, room().mesh, room().optics, solution, errors, {"room.obj", "hemicube", "jacobi"}, "1.2"}, path);
    return path;
}

TEST(SolutionFile, HoldsWhatWasSolvedInSinglePrecision) {
    const BakedScene& baked = room();
    const StoredSolution read = readSolution(written("solution.glb", baked.solution));
    const PatchMesh& mesh = read.meshed.mesh;
    EXPECT_GT(mesh.size(), mesh.frontCount);
    EXPECT_EQ(mesh.frontCount, baked.mesh.frontCount);
    EXPECT_EQ(mesh.positions, baked.mesh.positions);
    EXPECT_EQ(mesh.corners, baked.mesh.corners);
    EXPECT_EQ(mesh.area, baked.mesh.area);
    EXPECT_EQ(read.meshed.optics.reflectance, baked.optics.reflectance);
    EXPECT_EQ(read.meshed.optics.emittedRadiosity, baked.optics.emittedRadiosity);
    EXPECT_EQ(mesh.material, baked.mesh.material);
    EXPECT_EQ(read.solution.covered, baked.solution.covered);
    EXPECT_EQ(read.solution.bounces, baked.solution.bounces);
    EXPECT_EQ(read.standardError, someErrors());
    for (std::size_t k = 0; k < mesh.size(); ++k) {
        EXPECT_EQ(Rgb(read.solution.radiosity[k]), Rgb(baked.solution.radiosity[k]));
        EXPECT_EQ(Rgb(read.solution.irradiance[k]), Rgb(baked.solution.irradiance[k]));
        // Of the same polygons, by another formula: rounding of the coordinates, which are up to 10.
        EXPECT_LT(glm::distance(mesh.centroid[k], baked.mesh.centroid[k]), 1e-5F);
        EXPECT_LT(glm::distance(mesh.normal[k], baked.mesh.normal[k]), 1e-4F);
    }
    EXPECT_EQ(read.solution.iterations, baked.solution.iterations);
    EXPECT_EQ(read.solution.residual, baked.solution.residual);
    EXPECT_EQ(read.solution.energy.escaped, baked.solution.energy.escaped);
    EXPECT_EQ(read.solution.energy.imbalance(), baked.solution.energy.imbalance());
    ASSERT_EQ(read.solution.history.size(), baked.solution.history.size());
    for (std::size_t k = 0; k < read.solution.history.size(); ++k)
        EXPECT_EQ(read.solution.history[k].residual, baked.solution.history[k].residual);
    EXPECT_EQ(read.origin.scene, "room.obj");
    EXPECT_EQ(read.origin.solver, "jacobi");
}

TEST(SolutionFile, IsTheSameWhenItIsReadAndWrittenAgain) {
    const std::filesystem::path first = written("first.glb", room().solution);
    const StoredSolution read = readSolution(first);
    const std::filesystem::path second = temporaryFile("second.glb");
    writeSolution({*read.meshed.scene, read.meshed.mesh, read.meshed.optics, read.solution, read.standardError,
                   read.origin, "1.2"},
                  second);
    EXPECT_EQ(contentOf(first), contentOf(second));
}

TEST(SolutionFile, FindsPatchesByRaysAsTheMeshDoes) {
    const StoredSolution read = readSolution(written("rays.glb", room().solution));
    const PatchMesh& mesh = read.meshed.mesh;
    const RayCaster rays(*read.meshed.scene);
    for (std::size_t k = 0; k < mesh.size(); ++k) {
        const auto hit = rays.closest({mesh.centroid[k] + 1e-3F * mesh.normal[k], -mesh.normal[k], 1.0F});
        ASSERT_TRUE(hit) << k;
        std::uint32_t patch = mesh.lookup.patchAt(hit->polygon, hit->u, hit->v);
        if (!hit->front) patch = mesh.lookup.backPatch(hit->polygon, patch);
        EXPECT_EQ(patch, k);
    }
}

TEST(SolutionFile, IsNotWrittenWithValuesThatAreNotFinite) {
    RadiositySolution solution = room().solution;
    solution.radiosity[7].y = 1e300;
    EXPECT_THROW(written("infinite.glb", solution), SystemError);
    EXPECT_FALSE(std::filesystem::exists(temporaryFile("infinite.glb")));
}

TEST(SolutionFile, StartsASolverOfTheSamePatchesOnly) {
    const std::filesystem::path path = written("start.glb", room().solution);
    EXPECT_EQ(readStart(path, room().mesh, {}).size(), room().mesh.size());
    PatchMesh moved = room().mesh;
    moved.positions[3].x += 1e-3F;
    EXPECT_THROW(readStart(path, moved, {}), InputError);
    PatchMesh fewer = room().mesh;
    fewer.corners.pop_back();
    EXPECT_THROW(readStart(path, fewer, {}), InputError);
}

/// The file with its JSON part changed.
std::filesystem::path changed(const std::function<void(json&)>& change) {
    const std::string sound = contentOf(written("sound.glb", room().solution));
    std::uint32_t length = 0;
    std::memcpy(&length, sound.data() + 12, 4);
    json document = json::parse(sound.substr(20, length));
    change(document);
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string bytes = sound.substr(0, 20) + text + sound.substr(20 + length);
    const auto put = [&](std::size_t at, std::size_t value) {
        const auto word = static_cast<std::uint32_t>(value);
        std::memcpy(bytes.data() + at, &word, 4);
    };
    put(8, bytes.size());
    put(12, text.size());
    const std::filesystem::path path = temporaryFile("changed.glb");
    std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
    return path;
}

void expectRefused(const std::string& part, const std::function<void(json&)>& change) {
    SCOPED_TRACE(part);
    try {
        readSolution(changed(change));
        ADD_FAILURE() << "was read";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
}

TEST(SolutionFile, ThatContradictsItselfIsRefused) {
    EXPECT_NO_THROW(readSolution(changed([](json&) {})));
    const auto lambert = [](json& document) -> json& { return document["extras"]["lambert"]; };
    expectRefused("not a solution", [](json& d) { d.erase("extras"); });
    expectRefused("not a solution", [](json& d) { d["extras"]["lambert"] = 3; });
    expectRefused("format", [&](json& d) { lambert(d)["format"] = 2; });
    for (const char* name :
         {"format", "scene", "patches", "front_patches", "positions", "corners", "fronts", "material", "area",
          "reflectance", "emitted_radiosity", "irradiance", "radiosity", "covered", "residual", "history", "energy"}) {
        expectRefused(name, [&](json& d) { lambert(d).erase(name); });
        for (const json& wrong : {json("x"), json(-1), json(1.5), json(1e300), json(nullptr), json::array({1})})
            if (!(std::string(name) == "scene" && wrong.is_string()) &&
                !(std::string(name) == "residual" && wrong.is_number()))
                expectRefused(name, [&](json& d) { lambert(d)[name] = wrong; });
    }
    expectRefused("patches", [&](json& d) { lambert(d)["patches"] = 0; });
    expectRefused("corners", [&](json& d) { lambert(d)["patches"] = lambert(d)["patches"].get<int>() - 1; });
    expectRefused("front_patches", [&](json& d) { lambert(d)["front_patches"] = 1; });
    expectRefused("accessors", [&](json& d) { lambert(d)["irradiance"] = 1000; });
    expectRefused("corners", [&](json& d) { lambert(d)["corners"] = lambert(d)["material"]; });
    expectRefused("material", [&](json& d) { d["materials"] = json::array(); });
    expectRefused("bounces/0", [&](json& d) { lambert(d)["bounces"][0] = "x"; });
    // An array named often would take more memory than the file has bytes.
    expectRefused("together", [&](json& d) {
        for (int k = 0; k < 100; ++k) lambert(d)["bounces"].push_back(lambert(d)["bounces"][0]);
    });
}

TEST(SolutionFile, ThatIsCutOffOrNoGltfIsRefused) {
    const std::string sound = contentOf(written("whole.glb", room().solution));
    const std::filesystem::path path = temporaryFile("cut.glb");
    for (const double share : {0.0, 0.001, 0.3, 0.9, 0.9999}) {
        std::ofstream(path, std::ios::binary | std::ios::trunc)
            << sound.substr(0, static_cast<std::size_t>(share * static_cast<double>(sound.size())));
        EXPECT_THROW(readSolution(path), InputError) << share;
    }
    EXPECT_THROW(readSolution(temporaryFile("missing.glb")), InputError);
}

TEST(SolutionFile, WithAnyBytesChangedIsReadOrRefused) {
    const std::string sound = contentOf(written("mutated.glb", room().solution));
    const std::filesystem::path path = temporaryFile("mutated.glb");
    std::uint32_t length = 0;
    std::memcpy(&length, sound.data() + 12, 4);
    int refused = 0;
    for (std::uint32_t run = 0; run < 400; ++run) {
        SCOPED_TRACE(run);
        std::string bytes = sound;
        // Half of the runs change the JSON part alone.
        const double span = static_cast<double>(run % 2 == 0 ? bytes.size() : 20 + length);
        for (std::uint32_t k = 0; k <= run % 5; ++k) {
            const auto random = philox({run, k, 0, 0}, 7);
            const auto at = static_cast<std::size_t>(span * static_cast<double>(uniformFloat(random[0])));
            bytes[std::min(at, bytes.size() - 1)] = static_cast<char>(random[1] & 0xFF);
        }
        std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
        try {
            readSolution(path);
        } catch (const InputError&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 100); // most changes of the JSON part matter
}

} // namespace
} // namespace lambert
