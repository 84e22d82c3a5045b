#include "formfactors/visibility_sampling.h"

#include "closed_form_case.h"
#include "core/parallel.h"
#include "exact_case.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lambert {
namespace {

/// The unit room with a box that hides parts of the walls from each other.
Scene roomWithBox() {
    Scene scene = closedBox(kCube6);
    const Scene box =
        boxScene(glm::vec3(kBoxHigh - kBoxLow),
                 {greyMaterial("box", 0.5F, 0.0F), greyMaterial("box", 0.5F, 0.0F), greyMaterial("box", 0.5F, 0.0F),
                  greyMaterial("box", 0.5F, 0.0F), greyMaterial("box", 0.5F, 0.0F), greyMaterial("box", 0.5F, 0.0F)});
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    for (const glm::vec3& p : box.positions) scene.positions.push_back(p + glm::vec3(kBoxLow));
    for (Polygon polygon : box.polygons) {
        // Its fronts face outward.
        std::swap(polygon.vertices[1], polygon.vertices[3]);
        for (std::uint32_t& v : polygon.vertices) v += first;
        scene.polygons.push_back(polygon);
    }
    return scene;
}

PatchMesh divided(const Scene& scene, std::size_t patches) {
    MeshOptions options;
    options.patches = patches;
    Progress progress;
    return buildPatchMesh(scene, options, progress);
}

// 1e-3: what the rules of quadrature promise; walls that touch are integrated exactly.
TEST(VisibilitySampling, IsExactWhereNothingIsHidden) {
    for (const glm::vec3& size : {kCube6, kRoom432, glm::vec3(50.0F, 30.0F, 0.3F)}) {
        const ExactCase exact(closedBox(size));
        const VisibilitySampling method(exact.mesh, exact.rays, {});
        for (std::uint32_t i = 0; i < 6; ++i) {
            const FormFactorRow row = rowOf(method, i);
            EXPECT_NEAR(row.sum(), 1.0, 1e-6);
            EXPECT_EQ(row.back, 0.0);
            EXPECT_EQ(row.out, 0.0);
            for (std::uint32_t j = 0; j < 6; ++j)
                EXPECT_NEAR(entry(row, j), exact.factor[i][j], 1e-3 * exact.factor[i][j]) << i << " " << j;
        }
    }
}

// Patches of all distances and sizes, each against the exact factor: the rules err by 1e-3 of a factor (see PatchBlocks),
// closure spreads the sum of what they err.
TEST(VisibilitySampling, IsExactForThePatchesOfAnEmptyRoom) {
    const Scene scene = prepareScene(closedBox(kRoom432));
    const RayCaster rays(scene);
    const PatchMesh mesh = divided(scene, 300);
    const VisibilitySampling method(mesh, rays, {});
    for (std::uint32_t i = 0; i < mesh.size(); i += 7) {
        const FormFactorRow row = rowOf(method, i);
        std::vector<glm::dvec3> from, to;
        for (int k = 0; k < mesh.cornerCount(i); ++k) from.emplace_back(mesh.position(i, k));
        for (const FormFactor& entry : row.entries) {
            to.clear();
            for (int k = 0; k < mesh.cornerCount(entry.patch); ++k) to.emplace_back(mesh.position(entry.patch, k));
            const double exact = polygonToPolygon(from, to);
            ASSERT_NEAR(entry.value, exact, 2e-3 * exact) << i << " " << entry.patch;
        }
    }
}

// z-test of the mean over seeds, per pair, with the seeds' own standard error, of about 90 pairs: to fail by chance once in 1000
// (Šidák) each must fail once in 90,000: 4.4 standard errors of a normal distribution, of Student's t with 47 degrees of freedom 4.9.
// Beside it 5e-4 of the factor: the rules of quadrature, and closure.
TEST(VisibilitySampling, IsUnbiasedForPartlyHiddenPairs) {
    constexpr int kSeeds = 48;
    const ClosedFormCase exact(roomWithBox(), 1e-4);
    const std::size_t n = exact.mesh.size();
    std::vector<std::vector<double>> sum(n, std::vector<double>(n, 0.0)), squares = sum;
    for (int seed = 0; seed < kSeeds; ++seed) {
        const VisibilitySampling method(exact.mesh, exact.rays,
                                        {.error = 0.05, .seed = static_cast<std::uint64_t>(seed)});
        for (std::uint32_t i = 0; i < n; ++i) {
            const FormFactorRow row = rowOf(method, i);
            EXPECT_NEAR(row.sum(), 1.0, 1e-6);
            for (const FormFactor& e : row.entries) {
                sum[i][e.patch] += e.value;
                squares[i][e.patch] += e.value * e.value;
            }
        }
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::vector<double> row = exact.row(i);
        for (std::uint32_t j = 0; j < n; ++j) {
            const double mean = sum[i][j] / kSeeds;
            const double variance = std::max(0.0, squares[i][j] / kSeeds - mean * mean) / (kSeeds - 1);
            EXPECT_LE(std::abs(mean - row[j]), 4.9 * std::sqrt(variance) + 5e-4 * row[j])
                << "pair " << i << " " << j << " mean " << mean << " exact " << row[j];
        }
    }
}

// The error that a row states against what it really is, as means over rows and seeds: within a factor of 1.5, since it is an
// estimate from two halves of few rays per pair; and what was asked for is kept.
TEST(VisibilitySampling, RowsKnowTheirError) {
    const Scene scene = prepareScene(roomWithBox());
    const RayCaster rays(scene);
    const PatchMesh mesh = divided(scene, 120);
    const ClosedForm closedForm(mesh, rays, {.error = 1e-3});
    std::vector<std::vector<double>> exact;
    std::vector<std::uint32_t> patches;
    for (std::uint32_t i = 0; i < mesh.size(); i += 5) {
        patches.push_back(i);
        exact.emplace_back(mesh.size(), 0.0);
        for (const FormFactor& e : rowOf(closedForm, i).entries) exact.back()[e.patch] = e.value;
    }
    for (const double asked : {0.05, 0.02, 0.01}) {
        double stated = 0.0, actual = 0.0;
        for (std::uint64_t seed = 0; seed < 4; ++seed) {
            const VisibilitySampling method(mesh, rays, {.error = asked, .seed = seed});
            for (std::size_t k = 0; k < patches.size(); ++k) {
                const FormFactorRow row = rowOf(method, patches[k]);
                stated += static_cast<double>(row.error);
                std::vector<double> dense(mesh.size(), 0.0);
                for (const FormFactor& e : row.entries) dense[e.patch] = e.value;
                for (std::size_t j = 0; j < mesh.size(); ++j) actual += std::abs(dense[j] - exact[k][j]);
            }
        }
        const double rows = 4.0 * static_cast<double>(patches.size());
        EXPECT_LT(actual / rows, 1.5 * stated / rows) << asked;
        EXPECT_GT(actual / rows, stated / rows / 3.0) << asked;
        EXPECT_LT(actual / rows, asked);
    }
}

TEST(VisibilitySampling, RowsFromPointsAreThoseOfClosedForms) {
    const ClosedFormCase exact(roomWithBox());
    const VisibilitySampling method(exact.mesh, exact.rays, {.error = 0.002});
    const auto rowAt = [&](const FormFactorMethod& m) {
        RowAccumulator accumulator(exact.mesh.size());
        m.pointRow({0.2F, 0.1F, 0.3F}, {0.0F, 1.0F, 0.0F}, 3, accumulator);
        FormFactorRow row;
        accumulator.take(row);
        return row;
    };
    const FormFactorRow sampled = rowAt(method), row = rowAt(exact.method);
    double error = 0.0;
    for (std::uint32_t j = 0; j < exact.mesh.size(); ++j) error += std::abs(entry(sampled, j) - entry(row, j));
    EXPECT_LT(error, 3.0 * 0.002); // three times what was asked for on average
}

TEST(VisibilitySampling, AScaleOfAPowerOfTwoChangesNoDigit) {
    const auto rows = [](float scale) {
        const ExactCase c(closedBox(scale * kRoom432));
        const VisibilitySampling method(c.mesh, c.rays, {});
        std::vector<FormFactorRow> result;
        for (std::uint32_t i = 0; i < 6; ++i) result.push_back(rowOf(method, i));
        return result;
    };
    const std::vector<FormFactorRow> metres = rows(1.0F);
    for (const int exponent : {-34, -20, 40}) EXPECT_EQ(rows(std::ldexp(1.0F, exponent)), metres) << exponent;
}

} // namespace
} // namespace lambert
