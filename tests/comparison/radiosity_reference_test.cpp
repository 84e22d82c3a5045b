#include "comparison/radiosity_reference.h"

#include "comparison/compare_vpl.h"
#include "vpl/instant_radiosity_method.h"
#include "scene/reading/scene_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace lambert {
namespace {

MeshOptions meshOf(std::size_t patches) {
    MeshOptions options;
    options.patches = patches;
    return options;
}

MeshedScene meshed(const std::string& name, std::size_t patches) {
    Progress progress;
    return meshLitScene(readScene(LAMBERT_DATA "/" + name).scene, meshOf(patches), progress);
}

RadiosityReference referenceOf(const MeshedScene& scene, std::size_t patches) {
    ReferenceOptions options;
    options.mesh = meshOf(patches);
    Progress progress;
    return RadiosityReference(scene, options, progress);
}

/// Points of the Cornell box with path-traced irradiance.
struct PathTraced {
    std::vector<Receiver> receivers;
    std::vector<RgbSum> irradiance;
    std::vector<double> weight; //!< 1 each
    double ownError = 0.0;      //!< RMS of the stated standard errors

    explicit PathTraced(const RayCaster& rays) {
        std::ifstream file(LAMBERT_DATA "/reference/cornell_pcg_irradiance.csv");
        double squares = 0.0;
        for (std::string line; std::getline(file, line);) {
            if (line.empty() || line[0] == '#') continue;
            std::istringstream fields(line);
            double v[12];
            char comma = 0;
            for (double& value : v) fields >> value >> comma;
            receivers.push_back({0.001F * glm::vec3(glm::dvec3(v[0], v[1], v[2])),
                                 glm::vec3(glm::dvec3(v[3], v[4], v[5])), rays.originOffset(0.1F)});
            irradiance.emplace_back(v[6], v[7], v[8]);
            weight.push_back(1.0);
            for (int c = 9; c < 12; ++c) squares += v[c] * v[c];
        }
        ownError = std::sqrt(squares / (3.0 * static_cast<double>(receivers.size())));
    }
};

/// Patch radiosity at those points, found once.
struct Cornell {
    MeshedScene scene = meshed("cornell_box.obj", 1000);
    PathTraced traced{*scene.rays};
    ReferenceLight light;

    Cornell() {
        Progress progress;
        light = referenceOf(scene, 1000).at(traced.receivers, traced.weight, {}, progress);
    }
    static const Cornell& get() {
        static const Cornell cornell;
        return cornell;
    }
};

TEST(RadiosityReference, OwnErrorCoversTheDistanceFromPathTracing) {
    const Cornell& cornell = Cornell::get();
    const PathTraced& traced = cornell.traced;
    ASSERT_EQ(traced.receivers.size(), 408U);
    const LightErrors found = lightErrors(traced.weight, traced.irradiance, cornell.light.irradiance);
    const OwnError& own = cornell.light.rms;
    const double mean = found.overall.mean;
    std::printf("difference %.4f %%, own error %.4f %% (mesh %.4f, transport %.4f, gathering %.4f), the file's %.4f "
                "%%, bias %.4f %%, "
                "order %.2f\n",
                100.0 * found.overall.relativeRms, 100.0 * own.total() / mean, 100.0 * own.mesh / mean,
                100.0 * own.transport / mean, 100.0 * own.gathering / mean, 100.0 * traced.ownError / mean,
                100.0 * found.overall.bias / mean, cornell.light.order);
    // Both errors are independent: squares add up.
    EXPECT_LT(found.overall.rms, std::hypot(own.total(), traced.ownError));
    EXPECT_LT(own.total(), 0.01 * mean); // and says something
}

TEST(RadiosityReference, InstantRadiosityWithCompensationAgreesWithPathTracing) {
    const Cornell& cornell = Cornell::get();
    const PathTraced& traced = cornell.traced;
    const InstantRadiosityMethod method({.compensate = true});
    Progress progress;
    const MethodLight light = method.light(*cornell.scene.rays, {traced.receivers}, 1e5, 1, progress);
    const LightErrors file = lightErrors(traced.weight, traced.irradiance, light.irradiance);
    const LightErrors ours = lightErrors(traced.weight, cornell.light.irradiance, light.irradiance);
    std::printf("from path tracing %.3f %%, from patch radiosity %.3f %%\n", 100.0 * file.overall.relativeRms,
                100.0 * ours.overall.relativeRms);
    EXPECT_LT(file.overall.relativeRms, 0.02);
    EXPECT_LT(ours.overall.relativeRms, 0.02);
}

// Everywhere 2, exactly, in a box whose walls all emit 1 and reflect one half.
TEST(RadiosityReference, FurnaceHasItsExactLight) {
    const MeshedScene scene = meshed("furnace_box.obj", 200);
    std::vector<std::uint32_t> patches;
    const ComparedPoints points = patchCentres(scene.mesh, *scene.rays, patches);
    Progress progress;
    const ReferenceLight light = referenceOf(scene, 200).at(points.receivers, points.weight, {.cells = 32}, progress);
    for (const RgbSum& e : light.irradiance)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(e[c], 2.0, 1e-4); // a ray in a million slips through an edge
    EXPECT_LT(light.rms.total(), 1e-4);
}

} // namespace
} // namespace lambert
