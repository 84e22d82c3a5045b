#include "scene/texel_average.h"

#include "scene/surface.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace lambert {
namespace {

using Polygon2 = std::vector<glm::dvec2>;

constexpr std::array kWraps{TextureWrap::Repeat, TextureWrap::Mirror, TextureWrap::Clamp};
constexpr int kWidth = 45; // more than a block of stored sums, and no multiple of one
constexpr int kHeight = 13;

/// Some values that no symmetry makes equal.
glm::dvec4 sample(int x, int y) {
    const auto value = [&](int k) { return std::fmod(0.37 * (x + 1) * (y + 3) + 0.11 * k * x + 0.29 * y, 1.0); };
    return {value(0), value(1), value(2), (x * 7 + y * 3) % 5 < 2 ? 1.0 : 0.0};
}

/// The mean by looking up many points of the polygon, a fan of triangles, spread evenly but for a jitter.
glm::dvec4 bruteForce(const Polygon2& uv, TextureWrap wrapU, TextureWrap wrapV, int steps) {
    std::vector<glm::dvec4> texels;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) texels.push_back(sample(x, y));
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    glm::dvec4 sum(0.0);
    double area = 0.0;
    for (std::size_t k = 2; k < uv.size(); ++k) {
        const glm::dvec2 a = uv[k - 1] - uv[0];
        const glm::dvec2 b = uv[k] - uv[0];
        const double triangle = std::abs(a.x * b.y - a.y * b.x);
        glm::dvec4 mean(0.0);
        for (int i = 0; i < steps; ++i)
            for (int j = 0; j < steps; ++j) {
                double s = (i + uniform(random)) / steps;
                double t = (j + uniform(random)) / steps;
                if (s + t > 1.0) s = 1.0 - s, t = 1.0 - t;
                const glm::dvec2 p = uv[0] + s * a + t * b;
                const int x = texelAt(static_cast<float>(p.x), kWidth, wrapU);
                const int y = texelAt(static_cast<float>(p.y), kHeight, wrapV);
                mean += texels[static_cast<std::size_t>(y * kWidth + x)];
            }
        sum += triangle / (steps * static_cast<double>(steps)) * mean;
        area += triangle;
    }
    return sum / area;
}

double difference(const glm::dvec4& a, const glm::dvec4& b) {
    const glm::dvec4 d = glm::abs(a - b);
    return std::max({d.x, d.y, d.z, d.w});
}

TEST(TexelAverage, OfPolygonsIsTheirAreaAverage) {
    const std::vector<Polygon2> polygons{
        {{0, 0}, {1, 0}, {1, 1}, {0, 1}},                         // the whole image
        {{0.2, 0.1}, {0.7, 0.3}, {0.6, 0.9}, {0.1, 0.7}},         // turned
        {{0.31, 0.42}, {0.3105, 0.4205}, {0.3102, 0.4211}},       // inside a texel
        {{-1.3, -0.4}, {1.9, -2.1}, {2.6, 1.7}},                  // over several images
        {{0.2, 5.3}, {0.2, 3.1}, {4.4, 3.1}, {4.4, 5.3}},         // clockwise
        {{-3.0, 0.5}, {-2.0, 0.2}, {-1.5, 0.5}, {-2.2, 0.9}},     // left of the image
        {{0.5, 0.25}, {0.75, 0.25}, {0.75, 0.5}, {0.5, 0.5}},     // its edges on lines between texels
        {{0.01, 0.3}, {0.99, 0.31}, {0.99, 0.32}, {0.01, 0.305}}, // long
    };
    for (const TextureWrap wrapU : kWraps)
        for (const TextureWrap wrapV : kWraps) {
            const TexelAverage average(kWidth, kHeight, wrapU, wrapV, sample);
            for (std::size_t k = 0; k < polygons.size(); ++k)
                // 160,000 points per triangle, whose mean is off by 1/1000 at most one time in a hundred.
                EXPECT_LT(difference(average.over(polygons[k]), bruteForce(polygons[k], wrapU, wrapV, 400)),
                          1.0 / 255.0)
                    << "polygon " << k;
        }
}

TEST(TexelAverage, IsThatOfThePartsWeightedByArea) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-2.0, 3.0);
    for (const TextureWrap wrap : kWraps) {
        const TexelAverage average(kWidth, kHeight, wrap, wrap, sample);
        for (int k = 0; k < 200; ++k) {
            const glm::dvec2 a(uniform(random), uniform(random));
            const glm::dvec2 b(uniform(random), uniform(random));
            const glm::dvec2 c(uniform(random), uniform(random));
            const double share = 0.3;
            const glm::dvec2 middle = a + share * (b - a);
            const glm::dvec4 parts =
                share * average.over(Polygon2{a, middle, c}) + (1.0 - share) * average.over(Polygon2{middle, b, c});
            EXPECT_LT(difference(average.over(Polygon2{a, b, c}), parts), 1e-9); // the flattest loses six digits
        }
    }
}

TEST(TexelAverage, OfAConstantIsTheConstantWhereverThePolygonLies) {
    for (const TextureWrap wrap : kWraps) {
        const TexelAverage average(33, 21, wrap, wrap, [](int, int) { return glm::dvec4(0.25, 0.5, 0.75, 1.0); });
        for (const double size : {1e-9, 1e-3, 1.0, 100.0, 1e6, 1e30})
            for (const double place : {0.0, -0.3, 1e4, -1e30}) {
                const glm::dvec2 p(place, -place);
                const Polygon2 triangle{p, p + glm::dvec2(size, 0.3 * size), p + glm::dvec2(0.2 * size, size)};
                EXPECT_LT(difference(average.over(triangle), {0.25, 0.5, 0.75, 1.0}), 1e-6) << size << " at " << place;
            }
    }
}

TEST(TexelAverage, OfALineOrAPointIsThatOfTheTexelsThere) {
    const TexelAverage average(2, 2, TextureWrap::Repeat, TextureWrap::Repeat,
                               [](int x, int y) { return glm::dvec4(x + 2 * y); });
    EXPECT_EQ(average.over(Polygon2{{0.75, 0.25}}).x, 1.0);
    EXPECT_EQ(average.over(Polygon2(4, glm::dvec2(0.25, 0.75))).x, 2.0);
    EXPECT_NEAR(average.over(Polygon2{{0.25, 0.25}, {0.75, 0.25}, {0.5, 0.25}}).x, 0.5, 1e-12); // rounding
    EXPECT_NEAR(average.over(Polygon2{{0.25, 0.25}, {0.25, 0.75}, {0.25, 0.5}}).x, 1.0, 1e-12);
    EXPECT_NEAR(average.over(Polygon2{{0, 0}, {1, 1}, {0.5, 0.5}, {0.2, 0.2}}).x, 1.5, 1e-12);
}

TEST(TexelAverage, OfManyImagesIsThatOfTheImageWithinTheStatedBound) {
    const TexelAverage average(256, 256, TextureWrap::Repeat, TextureWrap::Mirror,
                               [](int x, int y) { return glm::dvec4(((x / 32) + (y / 32)) % 2); });
    for (const double size : {16.0, 70.3, 300.7, 1e4, 1e8}) {
        const Polygon2 square{{0.1, 0.2}, {0.1 + size, 0.2}, {0.1 + size, 0.2 + size}, {0.1, 0.2 + size}};
        // Contrast 1; what the square has beyond whole images is half black and half white to within its border.
        EXPECT_NEAR(average.over(square).x, 0.5, 1.0 / 256.0 + 0.125 / size) << size;
    }
}

TEST(WrappedTexel, ContinuesTheImage) {
    std::vector<int> repeat, mirror, clamp;
    for (int cell = -4; cell < 7; ++cell) {
        repeat.push_back(wrappedTexel(cell, 3, TextureWrap::Repeat));
        mirror.push_back(wrappedTexel(cell, 3, TextureWrap::Mirror));
        clamp.push_back(wrappedTexel(cell, 3, TextureWrap::Clamp));
    }
    EXPECT_EQ(repeat, (std::vector{2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0}));
    EXPECT_EQ(mirror, (std::vector{2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0}));
    EXPECT_EQ(clamp, (std::vector{0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2}));
    for (const float coordinate : {1e30F, -1e30F, 1e-30F, -1e-30F, 1.0F, 0.99999994F})
        for (const TextureWrap wrap : kWraps) {
            const int texel = texelAt(coordinate, 7, wrap);
            EXPECT_TRUE(texel >= 0 && texel < 7) << coordinate;
        }
}

} // namespace
} // namespace lambert
