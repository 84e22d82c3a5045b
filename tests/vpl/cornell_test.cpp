#include "scene/reading/scene_reader.h"
#include "vpl_case.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace lambert {
namespace {

/// A point of a reference file with its irradiance.
struct ReferencePoint {
    Receiver receiver;
    glm::dvec3 irradiance;
};

/// Lengths of the file times `unit` are metres.
std::vector<ReferencePoint> readReference(const std::string& path, float unit, float lift) {
    std::ifstream file(path);
    std::vector<ReferencePoint> points;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        std::istringstream fields(line);
        double v[9];
        char comma = 0;
        for (double& value : v) fields >> value >> comma;
        points.push_back(
            {{unit * glm::vec3(glm::dvec3(v[0], v[1], v[2])), glm::vec3(glm::dvec3(v[3], v[4], v[5])), lift},
             {v[6], v[7], v[8]}});
    }
    return points;
}

TEST(InstantRadiosity, AgreesWithPathTracingOfTheCornellBox) {
    const VplCase cornell(readScene(LAMBERT_DATA "/cornell_box.obj").scene);
    const auto reference =
        readReference(LAMBERT_DATA "/reference/cornell_pcg_irradiance.csv", 0.001F, cornell.rays.originOffset(0.1F));
    ASSERT_EQ(reference.size(), 408U);
    std::vector<Receiver> receivers;
    for (const ReferencePoint& point : reference) receivers.push_back(point.receiver);
    const VirtualPointLights lights = cornell.trace({.particles = 100000});
    const Gathered gathered = cornell.gather(lights.lights, receivers, {.recoveryRays = 64});
    double squares = 0.0, total = 0.0, worst = 0.0;
    glm::dvec3 sum(0.0), expected(0.0);
    for (std::size_t i = 0; i < reference.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const double difference = gathered.irradiance[i][c] - reference[i].irradiance[c];
            squares += difference * difference;
            total += reference[i].irradiance[c] * reference[i].irradiance[c];
            worst = std::max(worst, std::abs(difference));
        }
        sum += gathered.irradiance[i];
        expected += reference[i].irradiance;
    }
    std::printf("lights %zu, relative RMS %.4f, worst %.4f, mean %.4f %.4f %.4f of it, rays %.3g\n",
                lights.lights.size(), std::sqrt(squares / total), worst, sum.x / expected.x, sum.y / expected.y,
                sum.z / expected.z, static_cast<double>(gathered.shadowRays));
    EXPECT_LT(std::sqrt(squares / total), 0.02);
}

} // namespace
} // namespace lambert
