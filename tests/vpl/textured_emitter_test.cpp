/// Particles leave where an image emits.
#include "scene/surface.h"
#include "vpl_case.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <memory>
#include <numbers>
#include <numeric>

namespace lambert {
namespace {

constexpr double kPi = std::numbers::pi;

double redFlux(std::span<const VirtualPointLight> lights) {
    return std::accumulate(lights.begin(), lights.end(), 0.0, [](double sum, const VirtualPointLight& light) {
        return sum + static_cast<double>(light.flux.x);
    });
}

/// A lamp of one polygon in the plane z = 0 that shines up by a texture, and nothing else.
Scene lamp(const std::vector<glm::vec3>& corners, int width, int height, const std::vector<glm::vec4>& texels,
           float repeats = 1.0F) {
    Scene scene;
    Material material = greyMaterial("lamp", 0.0F, 1.0F); // radiosity 1 where the texture is 1
    material.emissionTexture.texture = 0;
    scene.materials = {material};
    scene.nodes = {"lamp"};
    scene.positions = corners;
    Polygon polygon;
    for (std::uint32_t k = 0; k < corners.size(); ++k) polygon.vertices[k] = k;
    polygon.surface = 0;
    scene.polygons = {polygon};
    SurfaceCorners surface;
    for (std::size_t k = 0; k < corners.size(); ++k)
        surface.uv[k] = surface.emissionUv[k] = repeats * glm::vec2(corners[k].x, corners[k].y);
    scene.surfaces = {surface};
    scene.textures = {std::make_shared<Texture>("image", width, height, texels)};
    return scene;
}

const std::vector<glm::vec3> kSquare{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
const std::vector<glm::vec3> kSkew{{0.1F, 0, 0}, {1, 0.2F, 0}, {0.7F, 1, 0}, {0, 0.6F, 0}};
const std::vector<glm::vec3> kTriangle{{0.1F, 0, 0}, {1, 0.2F, 0}, {0.3F, 0.9F, 0}};

/// Texels of all brightnesses, a third of them black.
std::vector<glm::vec4> patternOf(int count) {
    std::vector<glm::vec4> texels;
    for (int k = 0; k < count; ++k) {
        const float value = k % 3 == 0 ? 0.0F : static_cast<float>((k * k * 7 + 3 * k) % 11) / 10.0F;
        texels.emplace_back(value, 0.5F * value, 0.25F, 1.0F);
    }
    return texels;
}

TEST(TexturedLamp, SendsNoParticlesFromBlackTexels) {
    std::vector<glm::vec4> texels(256, glm::vec4(0, 0, 0, 1));
    texels[16 * 5 + 9] = glm::vec4(1, 2, 4, 1);
    const VirtualPointLights lights = VplCase(lamp(kSquare, 16, 16, texels)).trace({.particles = 1000});
    ASSERT_EQ(lights.lights.size(), 1000U);
    glm::dvec3 flux(0.0);
    for (const VirtualPointLight& light : lights.lights) {
        EXPECT_EQ(static_cast<int>(light.position.x * 16.0F), 9);
        EXPECT_EQ(static_cast<int>(light.position.y * 16.0F), 5);
        flux += glm::dvec3(light.flux);
    }
    // In single precision.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(flux[c], std::pow(2.0, c) / 256.0, 1e-5 * std::pow(2.0, c) / 256.0);
}

// Grey: with the chance to start there in proportion to the brightness, all particles carry the same.
TEST(TexturedLamp, GivesAllParticlesTheSameFlux) {
    std::vector<glm::vec4> texels;
    for (const glm::vec4& texel : patternOf(64)) texels.emplace_back(glm::vec3(texel.x), 1.0F);
    const VirtualPointLights lights = VplCase(lamp(kSquare, 8, 8, texels)).trace({.particles = 4096});
    ASSERT_EQ(lights.lights.size(), 4096U);
    const double mean = redFlux(lights.lights) / 4096.0;
    for (const VirtualPointLight& light : lights.lights)
        EXPECT_NEAR(static_cast<double>(light.flux.x), mean, 1e-5 * mean);
}

/// Irradiance of a point above the lamp that looks down, by sums over many small parts of its chart.
glm::dvec3 expectedAt(const VplCase& c, const glm::dvec3& point) {
    constexpr int kParts = 1200;
    const Polygon& polygon = c.scene.polygons[0];
    const SurfaceSide side = sideOf(c.scene, polygon, true);
    const auto corner = [&](std::size_t k) { return glm::dvec3(c.scene.positions[polygon.vertices[k]]); };
    const bool quad = polygon.isQuad();
    const double lower = glm::length(glm::cross(corner(1) - corner(0), corner(quad ? 3 : 2) - corner(0)));
    const double upper = quad ? glm::length(glm::cross(corner(3) - corner(2), corner(1) - corner(2))) : 0.0;
    glm::dvec3 sum(0.0);
    for (int y = 0; y < kParts; ++y) {
        for (int x = 0; x < kParts; ++x) {
            // Each part's lower or upper half alone lies on one side of the diagonal.
            for (const double third : {1.0 / 3.0, 2.0 / 3.0}) {
                const auto u = static_cast<float>((x + third) / kParts), v = static_cast<float>((y + third) / kParts);
                const double area = 0.5 * (u + v <= 1.0F ? lower : upper) / kParts / kParts;
                if (area == 0.0) continue;
                const glm::dvec3 way = point - glm::dvec3(polygonPoint(c.scene, 0, u, v));
                const double squared = glm::dot(way, way);
                sum += area * way.z * way.z / (squared * squared) *
                       glm::dvec3(emittedRadianceAt(c.scene, polygon, side, u, v));
            }
        }
    }
    return sum;
}

// 16384 Halton points. Texels do not end where cells do on skew polygons, so that particles there carry more or less: 1 % of
// the light where the point is near. Repeats of the image are more texels than cells.
TEST(TexturedLamp, GivesTheLightOfItsImage) {
    for (const auto& corners : {kSquare, kSkew, kTriangle}) {
        for (const float repeats : {1.0F, 3.0F, 60.0F}) {
            const VplCase c(lamp(corners, 8, 8, patternOf(64), repeats));
            const VirtualPointLights lights = c.trace({.particles = 16384});
            for (const glm::vec3 point : {glm::vec3(0.4F, 0.4F, 0.3F), glm::vec3(0.1F, 0.8F, 0.5F)}) {
                const std::array receiver{Receiver{point, {0, 0, -1}, 0.0F}};
                const Gathered found = c.gather(lights.lights, receiver, {.bound = kUnbounded});
                const glm::dvec3 expected = expectedAt(c, glm::dvec3(point));
                for (int channel = 0; channel < 3; ++channel)
                    EXPECT_NEAR(found.irradiance[0][channel], expected[channel], 0.01 * expected[channel])
                        << corners.size() << " corners, repeats " << repeats << ", channel " << channel;
            }
        }
    }
}

} // namespace
} // namespace lambert
