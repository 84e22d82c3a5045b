#include "closed_form_case.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace lambert {
namespace {

using Map = GridScene::Map;

struct Element {
    glm::vec3 point, normal;
};

/// Dense, as ClosedFormCase::row.
std::vector<double> pointRow(const ClosedFormCase& c, const Element& element) {
    RowAccumulator accumulator(c.mesh.size());
    c.method.pointRow(element.point, element.normal, 0, accumulator);
    FormFactorRow row;
    accumulator.take(row);
    std::vector<double> dense(c.mesh.size() + 2, 0.0);
    for (const FormFactor& e : row.entries) dense[e.patch] = e.value;
    dense[c.mesh.size()] = row.back;
    dense[c.mesh.size() + 1] = row.out;
    return dense;
}

bool inBox(const glm::dvec3& p) {
    return glm::all(glm::greaterThan(p, kBoxLow)) && glm::all(glm::lessThan(p, kBoxHigh));
}

/// In the unit cube before a map, outside the floating box, with any normal.
std::vector<Element> elements(int count, const Map& map) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0.02, 0.98);
    std::vector<Element> result;
    while (result.size() < static_cast<std::size_t>(count)) {
        const glm::dvec3 p(unit(random), unit(random), unit(random));
        const glm::dvec3 n(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5);
        if (!inBox(p)) result.push_back({glm::vec3(map(p)), glm::vec3(glm::normalize(n))});
    }
    return result;
}

class ClosedFormPointOf : public testing::TestWithParam<Map> {};
INSTANTIATE_TEST_SUITE_P(Maps, ClosedFormPointOf, testing::Values(same, sheared, turned));

TEST_P(ClosedFormPointOf, FreeFactorsAreThoseOfTheFormula) {
    const ClosedFormCase c(GridScene().box({0, 0, 0}, {1, 1, 1}, 5, true, GetParam()).scene());
    for (const Element& element : elements(20, GetParam())) {
        const auto row = pointRow(c, element);
        for (std::size_t j = 0; j < c.mesh.size(); ++j) {
            const double exact =
                pointToPolygon(glm::dvec3(element.point), glm::normalize(glm::dvec3(element.normal)), c.polygon(j));
            EXPECT_NEAR(row[j], exact,
                        1e-6 * exact + 1e-9); // patches are taken as lying in one plane, which is rounded
        }
    }
}

// What is hidden of a wall is covered by what hides it: only where both are exact does the sum come to 1. Their corners are
// rounded to single precision.
TEST_P(ClosedFormPointOf, RowsCloseAroundABox) {
    const Map map = GetParam();
    const ClosedFormCase c(
        GridScene().box({0, 0, 0}, {1, 1, 1}, 8, true, map).box(kBoxLow, kBoxHigh, 4, false, map).scene());
    for (const Element& element : elements(60, map)) {
        const auto row = pointRow(c, element);
        EXPECT_NEAR(c.sum(row), 1.0, 1e-6);
        EXPECT_LT(row[c.mesh.size()], 1e-6); // no back is seen
    }
}

// 2^18 Sobol points in two dimensions with a discontinuity leave some N^(−3/4) = 1e-4.
TEST(ClosedFormPoint, PartlyHiddenFactorsAreThoseOfASampledIntegral) {
    const ClosedFormCase c(
        GridScene().box({0, 0, 0}, {1, 1, 1}, 4, true, same).box(kBoxLow, kBoxHigh, 1, false, same).scene());
    const SamplePoints points(Sampler::Sobol, 1U << 18, 2, 3);
    int checked = 0;
    for (const Element& element : elements(8, same)) {
        const auto row = pointRow(c, element);
        const glm::dvec3 x(element.point), normal = glm::normalize(glm::dvec3(element.normal));
        for (std::size_t j = 0; j < 96; ++j) {
            const auto polygon = c.polygon(j);
            const double free = pointToPolygon(x, normal, polygon);
            if (!(free > 1e-4 && row[j] > 0.01 * free && row[j] < 0.99 * free)) continue; // slivers meet few samples
            const glm::dvec3 area = polygonAreaVector(polygon);
            double sum = 0.0;
            for (std::uint32_t k = 0; k < points.count(); ++k) {
                const glm::dvec3 y = polygon[0] + points.at(k, 0) * (polygon[1] - polygon[0]) +
                                     points.at(k, 1) * (polygon[3] - polygon[0]);
                const glm::dvec3 d = y - x;
                const double squared = glm::dot(d, d), up = glm::dot(normal, d);
                if (up > 0.0 && passesBox(x, y)) sum -= up * glm::dot(area, d) / (squared * squared);
            }
            EXPECT_NEAR(row[j], sum / points.count() / std::numbers::pi, 1e-3 * free) << j;
            ++checked;
        }
    }
    EXPECT_GT(checked, 10);
}

// Where the point lies in the plane of a polygon it sees nothing of it, and what stands on that hides its walls' feet only.
TEST(ClosedFormPoint, OnAFloorWithABoxOnIt) {
    const ClosedFormCase c(GridScene()
                               .box({0, 0, 0}, {2, 2, 2}, 1, true, same)
                               .box({0.4, 0.5, 0}, {1.1, 1.3, 0.8}, 1, false, same)
                               .scene());
    for (const glm::vec3& point : {glm::vec3(0.2F, 0.2F, 0), glm::vec3(1.2F, 0.9F, 0), glm::vec3(1.101F, 0.9F, 0)}) {
        const auto row = pointRow(c, {point, {0, 0, 1}});
        EXPECT_NEAR(c.sum(row), 1.0, 1e-6);
        EXPECT_LT(row[c.mesh.size()], 1e-6);
    }
}

// Half of a sheet between the point and a square is a hole. 64 × 64 rays see its edge in steps of 1 %.
TEST(ClosedFormPoint, LightPassesThroughHoles) {
    Scene scene = GridScene().box({0, 0, 0}, {1, 1, 1}, 1, true, same).scene();
    scene.materials.push_back(scene.materials[0]);
    addQuad(scene, {{{0.2F, 0.2F, 0.5F}, {0.8F, 0.2F, 0.5F}, {0.8F, 0.8F, 0.5F}, {0.2F, 0.8F, 0.5F}}},
            static_cast<std::uint32_t>(scene.materials.size() - 1));
    Scene right = scene;
    right.positions[right.polygons.back().vertices[0]].x = 0.5F;
    right.positions[right.polygons.back().vertices[3]].x = 0.5F;
    openLeftHalf(scene, scene.polygons.back());
    const ClosedFormCase holed(scene), solid(right);
    const Element element{{0.4F, 0.45F, 0.1F}, {0, 0, 1}};
    const auto found = pointRow(holed, element), expected = pointRow(solid, element);
    for (std::uint32_t j = 0; j < 6; ++j) EXPECT_NEAR(found[j], expected[j], 0.01) << j;
}

} // namespace
} // namespace lambert
