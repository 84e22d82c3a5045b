#include "formfactors/closed_form_method.h"

#include "core/error.h"
#include "core/sample_points.h"
#include "formfactors/closed_form.h"
#include "meshing/build_patch_mesh.h"
#include "meshing/prepare.h"
#include "scene/example_scenes.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace lambert {
namespace {

/// A scene whose polygons are the patches.
struct Case {
    explicit Case(const Scene& source, double error = 1e-4)
        : scene(prepareScene(source)), rays(scene), mesh(wholePolygons(scene)), method(mesh, rays, {.error = error}) {}

    static PatchMesh wholePolygons(const Scene& scene) {
        MeshOptions options;
        options.patches = 0;
        Progress progress;
        return buildPatchMesh(scene, options, progress);
    }

    /// F_ij + back + out of one row, dense: back at [size], out at [size + 1].
    std::vector<double> row(std::uint32_t patch) const {
        RowAccumulator accumulator(mesh.size());
        method.row(patch, accumulator);
        FormFactorRow row;
        accumulator.take(row);
        std::vector<double> dense(mesh.size() + 2, 0.0);
        for (const FormFactor& e : row.entries) dense[e.patch] = e.value;
        dense[mesh.size()] = row.back;
        dense[mesh.size() + 1] = row.out;
        return dense;
    }
    double sum(const std::vector<double>& row) const {
        double total = 0.0;
        for (std::size_t j = 0; j <= mesh.size(); ++j) total += row[j];
        return total;
    }
    std::vector<glm::dvec3> polygon(std::size_t i) const {
        std::vector<glm::dvec3> points;
        for (int k = 0; k < mesh.cornerCount(i); ++k) points.emplace_back(mesh.position(i, k));
        return points;
    }
    bool touch(std::size_t i, std::size_t j) const {
        for (int a = 0; a < mesh.cornerCount(i); ++a)
            for (int b = 0; b < mesh.cornerCount(j); ++b)
                if (mesh.position(i, a) == mesh.position(j, b)) return true;
        return false;
    }

    Scene scene;
    RayCaster rays;
    PatchMesh mesh;
    ClosedForm method;
};

using Map = GridScene::Map;

glm::dvec3 same(const glm::dvec3& p) { return p; }
glm::dvec3 sheared(const glm::dvec3& p) { return {p.x + 0.3 * p.z + 0.1 * p.y, p.y + 0.2 * p.z, p.z}; }
glm::dvec3 rotated(const glm::dvec3& p) {
    const double c = std::cos(0.7), s = std::sin(0.7);
    const glm::dvec3 q(c * p.x - s * p.y, s * p.x + c * p.y, p.z);
    return {q.x, c * q.y - s * q.z, s * q.y + c * q.z};
}
/// A strip of the wall z = 0 pushed in, so that the room is not convex.
glm::dvec3 dented(const glm::dvec3& p) {
    return std::abs(p.x - 0.5) < 0.26 ? glm::dvec3(p.x, p.y, 0.25 + 0.75 * p.z) : p;
}

constexpr glm::dvec3 kBoxLow{0.35, 0.3, 0.4}, kBoxHigh{0.65, 0.6, 0.7};

/// ∫∫ cos cos / π r² of what a test of segments lets pass, by Sobol points over both patches: shares nothing with the method.
double sampledFactor(const Case& c, std::size_t i, std::size_t j,
                     const std::function<bool(const glm::dvec3&, const glm::dvec3&)>& visible, std::uint32_t count) {
    const SamplePoints points(Sampler::Sobol, count, 4, 17);
    const auto pi = c.polygon(i), pj = c.polygon(j);
    const auto at = [](const std::vector<glm::dvec3>& q, double u, double v) {
        return q[0] + u * (q[1] - q[0]) + v * (q[3] - q[0]); // parallelograms
    };
    const glm::dvec3 normalI = glm::normalize(polygonAreaVector(pi)), normalJ = glm::normalize(polygonAreaVector(pj));
    double sum = 0.0;
    for (std::uint32_t k = 0; k < count; ++k) {
        const glm::dvec3 x = at(pi, points.at(k, 0), points.at(k, 1)), y = at(pj, points.at(k, 2), points.at(k, 3));
        const glm::dvec3 d = y - x;
        const double squared = glm::dot(d, d);
        const double cosines = -glm::dot(normalI, d) * glm::dot(normalJ, d);
        if (cosines > 0.0 && glm::dot(normalI, d) > 0.0 && visible(x, y)) sum += cosines / (squared * squared);
    }
    return sum / count * glm::length(polygonAreaVector(pj)) / std::numbers::pi;
}

/// Whether the segment passes by the floating box (before a map).
bool passesBox(const glm::dvec3& x, const glm::dvec3& y) {
    double enter = 0.0, leave = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (kBoxLow[axis] - x[axis]) / (y[axis] - x[axis]);
        const double b = (kBoxHigh[axis] - x[axis]) / (y[axis] - x[axis]);
        if (y[axis] == x[axis]) {
            if (x[axis] <= kBoxLow[axis] || x[axis] >= kBoxHigh[axis]) return true;
            continue;
        }
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return leave - enter <= 1e-9;
}

class ClosedFormOf : public testing::TestWithParam<Map> {};
INSTANTIATE_TEST_SUITE_P(Maps, ClosedFormOf, testing::Values(same, sheared, rotated));

// Pairs of the rows of 40 patches, against the contour integral between the polygons before they were rounded to single
// precision. 1e-5 is what the method promises for pairs that graze each other's plane. Rounding moves such a patch, whose
// height over the other's plane is 1/24, by 2e-7 up or down: another 1e-5, whatever the quadrature.
TEST_P(ClosedFormOf, FreeFactorsAreThoseOfTheContourIntegral) {
    const Case c(GridScene().box({0, 0, 0}, {1, 1, 1}, 12, true, GetParam()).scene());
    const Case plain(GridScene().box({0, 0, 0}, {1, 1, 1}, 12, true, same).scene());
    const auto unrounded = [&](std::size_t i) {
        auto polygon = plain.polygon(i);
        for (glm::dvec3& p : polygon) p = GetParam()(p);
        return polygon;
    };
    const double tolerance = c.polygon(0) == plain.polygon(0) ? 1e-5 : 2e-5;
    std::mt19937 random(1);
    int touching = 0;
    for (int k = 0; k < 40; ++k) {
        const auto i = static_cast<std::uint32_t>(random() % c.mesh.size());
        const auto row = c.row(i);
        for (std::size_t j = 0; j < c.mesh.size(); j += 1 + random() % 12) {
            const double exact = i == j ? 0.0 : polygonToPolygon(unrounded(i), unrounded(j));
            EXPECT_NEAR(row[j], exact, tolerance * exact + 1e-12) << i << " " << j;
        }
        for (std::size_t j = 0; j < c.mesh.size(); ++j) {
            if (i == j || !c.touch(i, j)) continue;
            const double exact = polygonToPolygon(unrounded(i), unrounded(j));
            EXPECT_NEAR(row[j], exact, tolerance * exact + 1e-12) << i << " " << j;
            touching += exact > 1e-6 ? 1 : 0;
        }
        EXPECT_NEAR(c.sum(row), 1.0, 1e-5);
    }
    EXPECT_GT(touching, 10);
}

// The error of Sobol points in four dimensions with a discontinuity falls about as N^(−5/8): 2^20 leave some 2e-4 of a factor
// that is halfway hidden; the test asks for 1e-3 of the factor, and of the free factor where little is left of it.
TEST_P(ClosedFormOf, PartlyHiddenFactorsAreThoseOfASampledIntegral) {
    const Case plain(
        GridScene().box({0, 0, 0}, {1, 1, 1}, 8, true, same).box(kBoxLow, kBoxHigh, 4, false, same).scene());
    const Map map = GetParam();
    const Case c(GridScene().box({0, 0, 0}, {1, 1, 1}, 8, true, map).box(kBoxLow, kBoxHigh, 4, false, map).scene());
    // Both maps are affine: what is visible between points stays so.
    std::mt19937 random(2);
    int checked = 0;
    while (checked < 24) {
        const auto i = static_cast<std::uint32_t>(random() % 384);
        const auto row = c.row(i);
        for (std::size_t j = 0; j < 384; ++j) {
            const double free = polygonToPolygon(c.polygon(i), c.polygon(j));
            if (!(row[j] > 0.02 * free && row[j] < 0.98 * free) || random() % 8 != 0) continue;
            const auto pi = plain.polygon(i), pj = plain.polygon(j);
            const auto mi = c.polygon(i), mj = c.polygon(j);
            const auto back = [](const glm::dvec3& p, const std::vector<glm::dvec3>& from,
                                 const std::vector<glm::dvec3>& to) {
                const glm::dvec3 u = from[1] - from[0], v = from[3] - from[0], d = p - from[0];
                const double uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v);
                const double det = uu * vv - uv * uv;
                const double a = (glm::dot(d, u) * vv - glm::dot(d, v) * uv) / det;
                const double b = (glm::dot(d, v) * uu - glm::dot(d, u) * uv) / det;
                return to[0] + a * (to[1] - to[0]) + b * (to[3] - to[0]);
            };
            const double sampled = sampledFactor(
                c, i, j, [&](const auto& x, const auto& y) { return passesBox(back(x, mi, pi), back(y, mj, pj)); },
                1U << 20);
            EXPECT_NEAR(row[j], sampled, 1e-3 * std::max(sampled, 0.2 * free)) << i << " " << j << " free " << free;
            ++checked;
        }
    }
}

// Errors of 1e-4 per partly hidden factor, of which a row has many: they cancel.
TEST_P(ClosedFormOf, RowsCloseAndFactorsAreReciprocalAroundABox) {
    const Case c(GridScene()
                     .box({0, 0, 0}, {1, 1, 1}, 6, true, GetParam())
                     .box(kBoxLow, kBoxHigh, 3, false, GetParam())
                     .scene());
    std::vector<std::vector<double>> rows;
    for (std::uint32_t i = 0; i < c.mesh.size(); ++i) {
        rows.push_back(c.row(i));
        EXPECT_NEAR(c.sum(rows[i]), 1.0, 1e-5) << i;
        EXPECT_LT(rows[i][c.mesh.size()], 1e-6) << "sees backs of a closed box";
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const double a = rows[i][j] * static_cast<double>(c.mesh.area[i]);
            const double b = rows[j][i] * static_cast<double>(c.mesh.area[j]);
            EXPECT_NEAR(a, b, 1e-4 * std::max(a, b) + 1e-12) << i << " " << j;
        }
    }
}

TEST(ClosedFormMethod, RowsCloseInARoomThatIsNotConvex) {
    const Case c(GridScene().box({0, 0, 0}, {1, 1, 1}, 8, true, dented).scene());
    for (std::uint32_t i = 0; i < c.mesh.size(); i += 7) EXPECT_NEAR(c.sum(c.row(i)), 1.0, 1e-5) << i;
}

Scene facingSquares(const std::array<glm::vec3, 4>& occluder) {
    const std::vector<std::array<glm::vec3, 4>> quads{
        {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, {{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}}, occluder};
    const std::vector<Material> materials(3, greyMaterial("m", 0.5F, 1.0F));
    return quadScene(quads, materials);
}

std::array<glm::vec3, 4> square(float x, float y, float z, float side) {
    const float h = 0.5F * side;
    return {{{x - h, y - h, z}, {x + h, y - h, z}, {x + h, y + h, z}, {x - h, y + h, z}}};
}

// data/reference/analytic.json has 0.09950629 for the centred square of half the side.
TEST(ClosedFormMethod, TheCentredOccluderOfTheReference) {
    for (const double error : {1e-4, 1e-6}) {
        const Case c(facingSquares(square(0.5F, 0.5F, 0.5F, 0.5F)), error);
        EXPECT_NEAR(c.row(0)[1] / 0.09950629, 1.0, error); // the reference has seven digits
        EXPECT_NEAR(c.row(1)[0] / 0.09950629, 1.0, error);
    }
}

// Sobol points as above; 2^22 of them leave 1e-4 where half is visible, and some 1e-5 of the free factor where little is.
TEST(ClosedFormMethod, AnyOccluder) {
    constexpr double kFree = 0.1998248957;
    for (const auto& [x, y, z, side] : std::vector<std::array<float, 4>>{{0.5F, 0.5F, 0.5F, 0.9F},
                                                                         {0.3F, 0.6F, 0.2F, 0.3F},
                                                                         {0.05F, 0.4F, 0.8F, 0.5F},
                                                                         {0.5F, 0.5F, 0.02F, 0.5F}}) {
        const Case c(facingSquares(square(x, y, z, side)));
        const double sampled = sampledFactor(
            c, 0, 1,
            [&, x = x, y = y, z = z, side = side](const glm::dvec3& a, const glm::dvec3& b) {
                const glm::dvec3 p = a + static_cast<double>(z) * (b - a);
                return std::abs(p.x - static_cast<double>(x)) > 0.5 * static_cast<double>(side) ||
                       std::abs(p.y - static_cast<double>(y)) > 0.5 * static_cast<double>(side);
            },
            1U << 22);
        EXPECT_NEAR(c.row(0)[1], sampled, 1e-4 * sampled + 1e-5 * kFree) << x << " " << y << " " << z << " " << side;
    }
}

// A box on an undivided floor: what of the floor is under the box sees the inside of its walls.
TEST(ClosedFormMethod, NoRowIsAboveOneUnderABox) {
    Scene scene = GridScene()
                      .box({0, 0, 0}, {2, 2, 2}, 1, true, same)
                      .box({0.4, 0.5, 0}, {1.1, 1.3, 0.8}, 1, false, same)
                      .scene();
    const Case c(scene);
    for (std::uint32_t i = 0; i < c.mesh.size(); ++i) {
        const auto row = c.row(i);
        EXPECT_LE(c.sum(row), 1.0 + 1e-5) << i;
        const bool underside = i >= 6 && c.mesh.normal[i].z < -0.5F && c.mesh.centroid[i].z < 0.1F;
        if (!underside) {
            EXPECT_LT(row[c.mesh.size() + 1], 1e-4) << i; // nothing leaves
        }
    }
}

TEST(ClosedFormMethod, WhatLeavesAnOpenSceneIsOut) {
    const Case c(facingSquares(square(0.5F, 0.5F, 0.5F, 0.5F)));
    const auto row = c.row(0);
    EXPECT_NEAR(row[1] + row[2] + row[3] + row[4], 1.0, 1e-12);
    // The occluder shows its back to the lower square.
    auto back = c.polygon(2);
    std::reverse(back.begin(), back.end());
    EXPECT_NEAR(row[3], polygonToPolygon(c.polygon(0), back), 1e-6);
    EXPECT_EQ(row[2], 0.0);
}

// The sheet's left half is a hole: what passes is what the right half alone would let pass. 64 rays across the sheet's
// 1.5 see the hole's edge in steps of 1 %, which cancel over the other 63 rows.
TEST(ClosedFormMethod, LightPassesThroughHoles) {
    Scene scene = facingSquares(square(0.5F, 0.5F, 0.5F, 0.5F));
    Material& leaf = scene.materials[scene.polygons[2].material];
    leaf.opacityTexture.texture = 0;
    leaf.opacityCutoff = 0.5F;
    scene.textures.push_back(
        std::make_shared<Texture>("half", 2, 1, std::vector<std::uint8_t>{255, 255, 255, 0, 255, 255, 255, 255}));
    SurfaceCorners surface;
    surface.uv = {glm::vec2(0, 1), glm::vec2(1, 1), glm::vec2(1, 0), glm::vec2(0, 0)};
    scene.polygons[2].surface = 0;
    scene.surfaces.push_back(surface);
    const Case holed(scene);

    std::array<glm::vec3, 4> half = square(0.5F, 0.5F, 0.5F, 0.5F);
    half[0].x = half[3].x = 0.5F;
    const Case solid(facingSquares(half));
    EXPECT_NEAR(holed.row(0)[1], solid.row(0)[1], 0.01 * solid.row(0)[1]);
    EXPECT_GT(holed.row(0)[1], 1.1 * Case(facingSquares(square(0.5F, 0.5F, 0.5F, 0.5F))).row(0)[1]);
}

TEST(ClosedFormMethod, RefusesErrorsOutOfRange) {
    const Scene scene = prepareScene(facingSquares(square(0.5F, 0.5F, 0.5F, 0.5F)));
    const RayCaster rays(scene);
    const PatchMesh mesh = Case::wholePolygons(scene);
    EXPECT_THROW(ClosedForm(mesh, rays, {.error = 0.0}), Error);
    EXPECT_THROW(ClosedForm(mesh, rays, {.error = 0.5}), Error);
}

} // namespace
} // namespace lambert
