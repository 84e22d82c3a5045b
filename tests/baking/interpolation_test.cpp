#include "baking/interpolation.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace lambert {
namespace {

PatchMesh onePatch(const std::vector<glm::vec3>& corners) {
    PatchMesh mesh;
    mesh.positions = corners;
    mesh.corners.push_back({0, 1, 2, corners.size() == 4 ? 3 : kNone});
    mesh.frontCount = 1;
    return mesh;
}

/// Turned about no special axis and moved.
glm::vec3 place(const glm::vec2& p) {
    const glm::vec3 x = glm::normalize(glm::vec3(1.0F, 2.0F, -0.5F));
    const glm::vec3 y = glm::normalize(glm::cross(glm::vec3(0.3F, -0.2F, 1.0F), x));
    return glm::vec3(3.0F, -1.0F, 2.0F) + p.x * x + p.y * y;
}

std::vector<glm::vec3> placed(const std::vector<glm::vec2>& corners) {
    std::vector<glm::vec3> result;
    for (const glm::vec2& corner : corners) result.push_back(place(corner));
    return result;
}

const std::vector<std::vector<glm::vec2>> kQuads{
    {{0, 0}, {1, 0}, {1, 1}, {0, 1}},                // square
    {{0, 0}, {4, 0}, {4, 0.01F}, {0, 0.01F}},        // long rectangle
    {{0, 0}, {2, 0.3F}, {2.7F, 1.4F}, {0.7F, 1.1F}}, // parallelogram
    {{0, 0}, {3, 0}, {2, 1}, {1, 1}},                // trapezium, long side first
    {{1, 1}, {0, 1}, {-1, 0}, {3, -0.2F}},           // general
    {{0, 0}, {1, 0}, {1.2F, 1.5F}, {-0.4F, 0.8F}},   // general
    {{0, 0}, {1, 0}, {1, 1}, {0.5F, 0.5F}},          // a corner of almost 180°
    {{0, 0}, {1, 0}, {1.0001F, 1}, {0, 0.9999F}},    // almost a parallelogram
};

glm::vec3 pointAt(const PatchMesh& mesh, const InterpolationWeights& weights) {
    glm::dvec3 sum(0.0);
    for (int k = 0; k < mesh.cornerCount(0); ++k)
        sum += weights[static_cast<std::size_t>(k)] * glm::dvec3(mesh.position(0, k));
    return glm::vec3(sum);
}

void expectPartitionOfUnity(const InterpolationWeights& weights) {
    double sum = 0.0;
    for (const double weight : weights) {
        EXPECT_GE(weight, 0.0);
        EXPECT_LE(weight, 1.0);
        sum += weight;
    }
    EXPECT_NEAR(sum, 1.0, 1e-14); // a few roundings in double
}

// Positions are floats of about 3 m: their last place is 2.4e-7 m, and in a corner that is almost straight
// the map stretches it.
constexpr double kRounding = 1e-6;

TEST(InterpolationWeights, GiveTheCornersOfTriangles) {
    const PatchMesh mesh = onePatch(placed({{0, 0}, {2, 0.5F}, {0.3F, 1}}));
    for (int k = 0; k < 3; ++k) {
        const InterpolationWeights weights = interpolationWeights(mesh, 0, mesh.position(0, k));
        for (std::size_t other = 0; other < 4; ++other)
            EXPECT_NEAR(weights[other], other == static_cast<std::size_t>(k) ? 1.0 : 0.0, 1e-12);
    }
}

TEST(InterpolationWeights, GiveTheCornersOfQuads) {
    for (const auto& quad : kQuads) {
        const PatchMesh mesh = onePatch(placed(quad));
        for (int k = 0; k < 4; ++k) {
            const InterpolationWeights weights = interpolationWeights(mesh, 0, mesh.position(0, k));
            // Rounded corners leave the plane by 1e-7; where the map folds, weights feel its square root.
            EXPECT_NEAR(weights[static_cast<std::size_t>(k)], 1.0, 1e-6);
            expectPartitionOfUnity(weights);
        }
    }
}

TEST(InterpolationWeights, ReproduceLinearFunctionsOnTriangles) {
    const PatchMesh mesh = onePatch(placed({{0, 0}, {2, 0.5F}, {0.3F, 1}}));
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform;
    for (int i = 0; i < 200; ++i) {
        const double u = uniform(random);
        const double v = uniform(random) * (1.0 - u);
        const InterpolationWeights expected{1.0 - u - v, u, v, 0.0};
        const InterpolationWeights found = interpolationWeights(mesh, 0, pointAt(mesh, expected));
        for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(found[k], expected[k], kRounding);
        expectPartitionOfUnity(found);
    }
}

TEST(InterpolationWeights, InvertTheBilinearMapOfQuads) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(0.05, 0.95);
    for (std::size_t q = 0; q < kQuads.size(); ++q) {
        const PatchMesh mesh = onePatch(placed(kQuads[q]));
        // The thin rectangle is 0.01 m wide: rounding weighs 100 times more.
        const double tolerance = (q == 1 ? 100.0 : 10.0) * kRounding;
        for (int i = 0; i < 200; ++i) {
            const double u = uniform(random);
            const double v = uniform(random);
            const InterpolationWeights expected{(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
            const InterpolationWeights found = interpolationWeights(mesh, 0, pointAt(mesh, expected));
            for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(found[k], expected[k], tolerance) << "quad " << q;
            expectPartitionOfUnity(found);
        }
    }
}

TEST(InterpolationWeights, AreLinearAlongEveryEdge) {
    for (const auto& quad : kQuads) {
        const PatchMesh mesh = onePatch(placed(quad));
        for (int k = 0; k < 4; ++k) {
            const int next = (k + 1) % 4;
            const glm::vec3 point = 0.75F * mesh.position(0, k) + 0.25F * mesh.position(0, next);
            const InterpolationWeights weights = interpolationWeights(mesh, 0, point);
            // 2e-5: the rounding above over an edge of 0.01 m, or of a corner that is almost straight.
            EXPECT_NEAR(weights[static_cast<std::size_t>(k)], 0.75, 5e-5);
            EXPECT_NEAR(weights[static_cast<std::size_t>(next)], 0.25, 5e-5);
        }
    }
}

TEST(InterpolationWeights, DoNotDependOnScaleOrFirstCorner) {
    const std::vector<glm::vec2> quad = kQuads[5];
    for (const float scale : {1e-8F, 1.0F, 1e8F}) {
        std::vector<glm::vec3> corners;
        for (const glm::vec2& corner : quad) corners.emplace_back(scale * corner.x, 0.0F, scale * corner.y);
        const glm::vec3 point(scale * 0.4F, 0.0F, scale * 0.6F);
        const InterpolationWeights weights = interpolationWeights(onePatch(corners), 0, point);
        std::rotate(corners.begin(), corners.begin() + 1, corners.end());
        const InterpolationWeights turned = interpolationWeights(onePatch(corners), 0, point);
        for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(weights[(k + 1) % 4], turned[k], kRounding);
    }
}

TEST(InterpolationWeights, StayValidOutsideAndOnDegeneratePatches) {
    for (const auto& quad : kQuads)
        for (const glm::vec2& far : {glm::vec2(-5, -5), glm::vec2(9, 0), glm::vec2(0.5F, 20)})
            expectPartitionOfUnity(interpolationWeights(onePatch(placed(quad)), 0, place(far)));
    expectPartitionOfUnity(interpolationWeights(onePatch({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}), 0, {1, 1, 1}));
    expectPartitionOfUnity(interpolationWeights(onePatch({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}), 0, {1, 1, 1}));
}

} // namespace
} // namespace lambert
