#include "core/error.h"
#include "core/parallel.h"
#include "formfactors/hemicube.h"
#include "meshing/build_patch_mesh.h"
#include "meshing/prepare.h"
#include "scene/example_scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace lambert {
namespace {

using Quad = std::array<glm::vec3, 4>;

/// A scene, its patches and the matrix by hemicubes.
struct Transport {
    Transport(const Scene& input, double patchLength, ViewOptions options) : scene(prepareScene(input)), rays(scene) {
        Progress progress;
        MeshOptions meshOptions;
        meshOptions.patchLength = patchLength;
        mesh = buildPatchMesh(scene, meshOptions, progress);
        matrix = computeMatrix(Hemicube(mesh, rays, options), MatrixStorage::Double, progress);
    }

    /// F between two materials, averaged over the area of the first.
    double factor(std::uint32_t from, std::uint32_t to) const {
        double flux = 0.0;
        double area = 0.0;
        for (std::size_t i = 0; i < mesh.size(); ++i) {
            if (mesh.material[i] != from) continue;
            area += static_cast<double>(mesh.area[i]);
            matrix.visit(i, [&](std::uint32_t j, double f) {
                if (mesh.material[j] == to) flux += static_cast<double>(mesh.area[i]) * f;
            });
        }
        return flux / area;
    }

    Scene scene;
    RayCaster rays;
    PatchMesh mesh;
    FormFactorMatrix matrix;
};

Scene greyBox(const glm::vec3& size) {
    const Material wall = greyMaterial("wall", 0.5F, 1.0F);
    return boxScene(size, {wall, wall, wall, wall, wall, wall});
}

/// Two a × b rectangles that face each other at distance c.
Scene parallelRectangles(float a, float b, float c) {
    const std::array<Quad, 2> quads{
        {{{{0, 0, 0}, {a, 0, 0}, {a, b, 0}, {0, b, 0}}}, {{{0, 0, c}, {0, b, c}, {a, b, c}, {a, 0, c}}}}};
    return quadScene(quads, std::array{greyMaterial("one", 0.5F, 1.0F), greyMaterial("two", 0.5F)});
}

/// A w × l rectangle on the floor and an h × l one that stands on its edge of length l.
Scene perpendicularRectangles(float w, float h, float l) {
    const std::array<Quad, 2> quads{
        {{{{0, 0, 0}, {w, 0, 0}, {w, l, 0}, {0, l, 0}}}, {{{0, 0, 0}, {0, l, 0}, {0, l, h}, {0, 0, h}}}}};
    return quadScene(quads, std::array{greyMaterial("one", 0.5F, 1.0F), greyMaterial("two", 0.5F)});
}

TEST(Hemicube, RowSumsToOneInClosedBox) {
    // 18 and 30 leave ragged tiles at the ends of rows and columns.
    for (const int resolution : {16, 18, 30, 64, 128}) {
        const Transport t(greyBox({2.0F, 1.5F, 1.0F}), 0.25, {.resolution = resolution});
        for (std::size_t i = 0; i < t.mesh.size(); ++i) {
            const FormFactorRow row = t.matrix.row(i);
            EXPECT_NEAR(row.sum(), 1.0, 1e-6); // the pixels' weights are floats
            EXPECT_EQ(row.back, 0.0);
            EXPECT_EQ(row.out, 0.0);
        }
    }
}

TEST(Hemicube, OpenSceneLosesToTheOutsideWhatTheOtherSquareDoesNotGet) {
    const Transport t(parallelRectangles(1, 1, 1), 0.125, {.resolution = 128});
    double out = 0.0;
    for (std::size_t i = 0; i < t.mesh.size(); ++i)
        if (t.mesh.material[i] == 0) out += static_cast<double>(t.mesh.area[i]) * t.matrix.out(i);
    EXPECT_NEAR(out + t.factor(0, 1), 1.0, 1e-6);
}

TEST(Hemicube, RaysOnABackFaceCountAsBackAndNotAsOut) {
    Scene scene = parallelRectangles(1, 1, 1);
    std::swap(scene.polygons[1].vertices[1], scene.polygons[1].vertices[3]); // the upper square turns its back
    const Transport t(scene, 0.25, {.resolution = 64});
    for (std::size_t i = 0; i < t.mesh.size(); ++i) {
        if (t.mesh.material[i] != 0) continue;
        EXPECT_EQ(t.matrix.entryCount(i), 0U);
        EXPECT_GT(t.matrix.back(i), 0.1);
    }
}

TEST(Hemicube, SecondSideOfATwoSidedPolygonReceivesWhatComesFromBehind) {
    Scene scene = parallelRectangles(1, 1, 1);
    std::swap(scene.polygons[1].vertices[1], scene.polygons[1].vertices[3]);
    scene.materials[1].twoSided = true;
    const Transport t(scene, 0.125, {.resolution = 256});
    // Upper square: C-11 with a = b = c = 1. 0.5 %: the mid-point rule and aliasing at this mesh.
    EXPECT_NEAR(t.factor(0, 1), 0.1998248957, 0.005 * 0.2);
    for (std::size_t i = 0; i < t.mesh.size(); ++i) EXPECT_EQ(t.matrix.back(i), 0.0);
}

struct Rectangles {
    float a, b, c;
    double expected;
};

// data/reference/analytic.json. 0.5 %: aliasing of far squares at R = 256, and the mid-point rule over 24 patches a side.
TEST(Hemicube, FactorsOfParallelRectanglesMatchHowellC11) {
    for (const auto& [a, b, c, expected] : {Rectangles{1, 1, 1, 0.1998248957}, Rectangles{1, 1, 0.5F, 0.4152532836},
                                            Rectangles{1, 1, 2, 0.0685895888}, Rectangles{2, 1, 1, 0.2858753849}}) {
        const Transport t(parallelRectangles(a, b, c), 1.0 / 24.0, {.resolution = 256});
        EXPECT_NEAR(t.factor(0, 1), expected, 0.005 * expected) << a << ' ' << b << ' ' << c;
    }
}

TEST(Hemicube, FactorsOfPerpendicularRectanglesMatchHowellC14) {
    for (const auto& [w, h, l, expected] : {Rectangles{1, 1, 1, 0.2000437761}, Rectangles{1, 2, 1, 0.2328526028},
                                            Rectangles{2, 1, 1, 0.1164263014}, Rectangles{1, 1, 2, 0.2406360062}}) {
        const Transport t(perpendicularRectangles(w, h, l), 1.0 / 24.0, {.resolution = 256});
        EXPECT_NEAR(t.factor(0, 1), expected, 0.005 * expected) << w << ' ' << h << ' ' << l;
    }
}

TEST(Hemicube, PointRowConvergesToThePointToPolygonFormula) {
    // From the origin to [-1/2, 1/2]² at z = 1: data/reference/analytic.json. Aliasing falls with R.
    const std::array<Quad, 1> quad{{{{{-.5F, -.5F, 1}, {-.5F, .5F, 1}, {.5F, .5F, 1}, {.5F, -.5F, 1}}}}};
    const Scene scene = prepareScene(quadScene(quad, std::array{greyMaterial("square", 0.5F)}));
    const RayCaster rays(scene);
    Progress progress;
    MeshOptions options;
    options.patches = 0;
    const PatchMesh mesh = buildPatchMesh(scene, options, progress);
    // METHODS' table of random turns: 0.24 % RMS at R = 64, 0.02 % at 256; four times that for 40 turns.
    for (const auto& [resolution, tolerance] : {std::pair(64, 0.0096), std::pair(256, 0.0008)}) {
        const Hemicube hemicube(mesh, rays, {.resolution = resolution});
        RowAccumulator accumulator(mesh.size());
        FormFactorRow row;
        for (int turn = 0; turn < 40; ++turn) {
            hemicube.addHemicube({0, 0, 0}, {0, 0, 1}, 0.1571F * static_cast<float>(turn), accumulator);
            accumulator.take(row);
            ASSERT_EQ(row.entries.size(), 1U);
            EXPECT_NEAR(row.entries[0].value, 0.2394564705, tolerance * 0.24) << resolution;
        }
    }
}

TEST(Hemicube, FactorsDoNotDependOnTheSceneScale) {
    const Transport small(perpendicularRectangles(1e-3F, 1e-3F, 1e-3F), 1e-4, {.resolution = 64});
    const Transport large(perpendicularRectangles(1e3F, 1e3F, 1e3F), 1e2, {.resolution = 64});
    EXPECT_NEAR(small.factor(0, 1), large.factor(0, 1), 1e-4); // single pixels may fall to the other side of an edge
}

TEST(Hemicube, FactorsDoNotDependOnTheNumberOfThreads) {
    const auto compute = [](int threads) {
        setThreadCount(threads);
        Transport t(greyBox({1.0F, 1.0F, 1.0F}), 0.2, {.resolution = 64});
        setThreadCount(0);
        return std::move(t.matrix);
    };
    const FormFactorMatrix one = compute(1);
    const FormFactorMatrix three = compute(3);
    ASSERT_EQ(one.size(), three.size());
    for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one.row(i), three.row(i));
}

TEST(Hemicube, ResolutionOutOfRangeIsAUsageError) {
    const Scene scene = prepareScene(greyBox(glm::vec3(1.0F)));
    const RayCaster rays(scene);
    const PatchMesh mesh;
    for (const int resolution : {-2, 0, 2, 17, 4098})
        EXPECT_THROW(Hemicube(mesh, rays, {.resolution = resolution}), UsageError) << resolution;
}

TEST(Hemicube, CancellingEndsTheMatrixWithCancelled) {
    const Scene scene = prepareScene(greyBox(glm::vec3(1.0F)));
    const RayCaster rays(scene);
    Progress progress;
    const PatchMesh mesh = buildPatchMesh(scene, {}, progress);
    progress.cancel();
    EXPECT_THROW(computeMatrix(Hemicube(mesh, rays, {}), MatrixStorage::Float, progress), Cancelled);
}

TEST(RowAccumulator, TakesRowsInOrderAndStartsAfresh) {
    RowAccumulator accumulator(130);
    accumulator.add(129, 0.25);
    accumulator.add(3, 0.125);
    accumulator.add(129, 0.25);
    accumulator.add(accumulator.back(), 0.25);
    accumulator.add(accumulator.out(), 0.125);
    FormFactorRow row;
    accumulator.take(row);
    ASSERT_EQ(row.entries.size(), 2U);
    EXPECT_EQ(row.entries[0].patch, 3U);
    EXPECT_EQ(row.entries[1].patch, 129U);
    EXPECT_EQ(row.entries[1].value, 0.5);
    EXPECT_EQ(row.back, 0.25);
    EXPECT_EQ(row.out, 0.125);
    EXPECT_EQ(row.sum(), 1.0);
    accumulator.take(row);
    EXPECT_TRUE(row.entries.empty());
    EXPECT_EQ(row.sum(), 0.0);
}

} // namespace
} // namespace lambert
