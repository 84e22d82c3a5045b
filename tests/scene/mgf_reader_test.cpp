#include "reader_checks.h"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace lambert {
namespace {

constexpr float kPi = glm::pi<float>();

/// Three vertices a, b, c, and a triangle of area 1/2 that looks along z.
const std::string kVertices = "v a =\np 0 0 0\nn 0 0 1\nv b =\n\tp 1 0 0\nv c =\n\tp 0 1 0\n";
const std::string kTriangle = kVertices + "f a b c\n";

class MgfReader : public ReaderTest {
protected:
    MgfReader() : ReaderTest("scene.mgf") {}

    /// The first corner of each polygon.
    std::vector<glm::vec3> places(const std::string& mgf, const ReadOptions& options = {}) {
        const Scene scene = read(mgf, options).scene;
        std::vector<glm::vec3> result;
        for (const Polygon& polygon : scene.polygons) result.push_back(corner(scene, polygon, 0));
        return result;
    }
    Material material(const std::string& mgf) { return read("m x =\n" + mgf + kTriangle).scene.materials.at(0); }
};

void expectNear(const glm::vec3& found, const glm::vec3& expected, float tolerance = 1e-6F) { // a few float roundings
    EXPECT_LE(glm::distance(found, expected), tolerance * std::max(1.0F, glm::length(expected)))
        << fmt::format("({}, {}, {}) and ({}, {}, {})", found.x, found.y, found.z, expected.x, expected.y, expected.z);
}

glm::vec3 normalOf(const Scene& scene, std::size_t polygon) {
    return glm::normalize(areaVector(scene, scene.polygons.at(polygon)));
}

float luminance(const Rgb& rgb) { return glm::dot(rgb, Rgb(0.2126F, 0.7152F, 0.0722F)); }

/// Directed edges without a partner the other way, vertices closer than 1e-5 taken as one.
std::size_t openEdges(const Scene& scene) {
    const auto key = [](const glm::vec3& p) {
        return std::array{std::lround(p.x * 1e4F), std::lround(p.y * 1e4F), std::lround(p.z * 1e4F)};
    };
    std::map<std::pair<std::array<long, 3>, std::array<long, 3>>, int> edges;
    for (const Polygon& polygon : scene.polygons) {
        for (int k = 0; k < polygon.size(); ++k) {
            const auto a = key(corner(scene, polygon, k)), b = key(corner(scene, polygon, (k + 1) % polygon.size()));
            ++edges[{a, b}];
            --edges[{b, a}];
        }
    }
    return static_cast<std::size_t>(
        std::count_if(edges.begin(), edges.end(), [](const auto& edge) { return edge.second != 0; }));
}

/// By the divergence theorem; positive if the fronts look outwards.
double volume(const Scene& scene) {
    double sum = 0.0;
    for (const Polygon& polygon : scene.polygons)
        sum += double{glm::dot(corner(scene, polygon, 0), areaVector(scene, polygon))} / 3.0;
    return sum;
}

// ---- Syntax

TEST_F(MgfReader, ReadsTheSameFromAllLineEndingsAndContinuations) {
    const std::vector<std::string> variants = {
        kTriangle,
        "\xEF\xBB\xBF# comment \\\n f this is comment too\n" + kTriangle,
        "v a =\r\np 0 0 0\r\nv b =\r\np 1 0 0\r\nv c =\r\np 0 1 0\r\nf a b c\r\n",
        "v a =\rv b =\rp +1 0 0\rv c =\rp 0 1e0 .0\rf a b c",
        "v a =\nv b =\np 1 \\\n 0 \\\r\n0\nv c =\np 0 1 0\nf \\\na \\\n b c\\",
    };
    for (const std::string& mgf : variants) {
        SCOPED_TRACE(mgf);
        expectUnitTriangle(read(mgf).scene);
    }
}

TEST_F(MgfReader, UnknownEntitiesAreReportedOnceAndIgnored) {
    const ReadResult result = read("nurbs 1 2 3\n" + kTriangle + "nurbs\nies lamp.ies -t 0 0 1\n");
    EXPECT_EQ(result.scene.polygons.size(), 1U);
    ASSERT_EQ(result.report.warnings.size(), 2U);
    EXPECT_TRUE(hasWarning(result, "the entity \"nurbs\" is unknown and was ignored (scene.mgf:1)"));
    EXPECT_TRUE(hasWarning(result, "1 luminaires (ies) were ignored, the first in scene.mgf:11"));
    std::string many = kTriangle;
    for (int k = 0; k < 1000; ++k) many += fmt::format("x{}\n", k);
    const ReadResult merged = read(many);
    ASSERT_EQ(merged.report.warnings.size(), 2U); // one of ten alike, one with the number of all others
    EXPECT_TRUE(hasWarning(merged, "990 more")) << merged.report.warnings[1];
}

// ---- Contexts

TEST_F(MgfReader, VerticesAreTakenAsTheyAreWhenASurfaceNamesThem) {
    const Scene scene = read(kTriangle + "v d = b\nv a\np 0 0 5\nf a b c\nv c = d\nf c b a\nv\np 9 9 9\nf a d c").scene;
    ASSERT_EQ(scene.polygons.size(), 2U); // the last two have no area: c is where b and d are
    EXPECT_EQ(corner(scene, scene.polygons[0], 0).z, 0.0F);
    EXPECT_EQ(corner(scene, scene.polygons[1], 0).z, 5.0F);
}

TEST_F(MgfReader, MaterialsHaveTheDefaultsOfTheFormat) {
    const Scene scene =
        read(kTriangle + "m\nf a b c\nm x =\nrd .5\nf a b c\nm y = x\nsides 1\nf a b c\nm x\nf a b c").scene;
    ASSERT_EQ(scene.materials.size(), 3U);
    EXPECT_EQ(scene.materials[0].name, "unnamed");
    EXPECT_EQ(scene.materials[0].reflectance, Rgb(0.0F));
    EXPECT_TRUE(scene.materials[0].twoSided);
    EXPECT_EQ(scene.materials[1].name, "x");
    EXPECT_EQ(scene.materials[1].reflectance, Rgb(0.5F));
    EXPECT_TRUE(scene.materials[1].twoSided);
    EXPECT_EQ(scene.materials[2].name, "y");
    EXPECT_FALSE(scene.materials[2].twoSided);
    EXPECT_EQ(scene.polygons[1].material, 0U);
    EXPECT_EQ(scene.polygons[4].material, 1U);
}

TEST_F(MgfReader, AMaterialThatChangesBetweenItsUsesBecomesSeveral) {
    const Scene scene =
        read(kVertices + "m x =\nrd .5\nf a b c\nrd .2\nf a b c\nm x =\nrd .5\nf a b c\nm x\nf a b c").scene;
    ASSERT_EQ(scene.materials.size(), 2U);
    EXPECT_EQ(scene.materials[1].name, "x.2");
    std::string used;
    for (const Polygon& polygon : scene.polygons) used += std::to_string(polygon.material);
    EXPECT_EQ(used, "0100");
}

TEST_F(MgfReader, NamesInLatin1BecomeUtf8) {
    const Scene scene = read(kVertices + "m b\xFChne =\no t\xFCr\nf a b c\no\n").scene;
    EXPECT_EQ(scene.materials.at(0).name, "b\xC3\xBChne");
    EXPECT_EQ(scene.nodes, std::vector<std::string>{"t\xC3\xBCr"});
}

TEST_F(MgfReader, ObjectsNameNodesWithTheObjectsAroundThem) {
    const Scene scene = read(kTriangle + "o room\nf a b c\no chair\nf a b c\no\no lamp\no\nf a b c\no\nf a b c").scene;
    std::string nodes;
    for (const Polygon& polygon : scene.polygons) nodes += scene.nodes[polygon.node] + " ";
    EXPECT_EQ(nodes, "default room room.chair room default ");
    EXPECT_EQ(scene.nodes.size(), 3U);
}

// ---- Colours

TEST_F(MgfReader, ReflectanceAndEmittanceAreLuminances) {
    for (const char* colour : {"c\n", "c\ncxy .3333 .3333\n", "c\ncxy .44 .40\n", "c\ncct 2900\n", "c\ncct 6504\n",
                               "c\ncspec 400 700 28 29 31 30 29 32 34 33 34 42 51\n"}) {
        SCOPED_TRACE(colour);
        const Material found = material(fmt::format("{}rd .3\ned 5000\n", colour));
        EXPECT_NEAR(luminance(found.reflectance), 0.3F, 1e-6F); // float
        EXPECT_NEAR(kPi * luminance(found.emittedRadiance), 5000.0F, 0.01F);
        const Rgb r = found.reflectance / luminance(found.reflectance);
        expectNear(r, found.emittedRadiance / luminance(found.emittedRadiance)); // the same colour
    }
}

TEST_F(MgfReader, NeutralIsGrey) {
    EXPECT_EQ(material("rd .3\n").reflectance, Rgb(0.3F));
    expectNear(material("c\ncxy .333333333333 .333333333333\nrd .3\n").reflectance, Rgb(0.3F));
    const Rgb warm = material("c\ncct 2900\nrd .3\n").reflectance;
    EXPECT_GT(warm.x, warm.y);
    EXPECT_GT(warm.y, warm.z);
}

TEST_F(MgfReader, MixedColoursAddUpByLuminance) {
    // The primaries of Rec. 709 in the luminances of its white give back that white, which is D65.
    const std::string primaries = "c R =\ncxy .64 .33\nc G =\ncxy .3 .6\nc B =\ncxy .15 .06\n";
    const Rgb mixed = material(primaries + "c w =\ncmix 2.126 R 7.152 G .722 B\nc\nc w\nrd .5\n").reflectance;
    expectNear(mixed, material("c\ncxy .3127 .3290\nrd .5\n").reflectance, 3e-4F); // of the rounded weights
}

TEST_F(MgfReader, TellsWhatItChangesInMaterials) {
    const ReadResult result =
        read("m glass =\nrs .1 0\nts .8 0\nm laser =\nc\ncxy .7 .29\ned 100\nm matte =\nc\nrd .5\n" + kVertices +
             "m glass\nf a b c\nm laser\nf a b c\nm matte\nf a b c\n");
    EXPECT_TRUE(hasWarning(result, "count by their diffuse reflection rd only: \"glass\""));
    EXPECT_TRUE(hasWarning(result, "outside the gamut of Rec. 709 were clamped: of materials \"laser\""));
    EXPECT_EQ(result.report.warnings.size(), 2U);
}

// ---- Transforms

TEST_F(MgfReader, ArgumentsOfATransformApplyInTheirOrder) {
    const auto place = [&](const std::string& arguments) {
        return places("v p =\np 1 2 3\nv q =\np 1 0 0\nv r =\np 0 1 0\nxf " + arguments + "\nf p q r\nxf\n").at(0);
    };
    expectNear(place("-t 1 0 0 -s 2"), {4, 4, 6});
    expectNear(place("-s 2 -t 1 0 0"), {3, 4, 6});
    expectNear(place("-rx 90"), {1, -3, 2});
    expectNear(place("-ry 90"), {3, 2, -1});
    expectNear(place("-rz 90"), {-2, 1, 3});
    expectNear(place("-rz 90 -t 1 0 0 -rz -90"), {1, 1, 3});
    expectNear(place("-i 3 -t 1 0 0 -i 1 -s 2"), {8, 4, 6});
    expectNear(place("-i 0 -t 1 0 0"), {1, 2, 3});
}

TEST_F(MgfReader, InnerTransformsApplyBeforeOuterOnes) {
    const auto found = places(kVertices + "xf -t 5 0 0\nxf -rx 180\nf b c a\nxf\nf b c a\nxf\nf b c a\n");
    ASSERT_EQ(found.size(), 3U);
    expectNear(found[0], {6, 0, 0});
    expectNear(found[1], {6, 0, 0});
    expectNear(found[2], {1, 0, 0});
    // The example of the format's description: a ring at (5, -10, 0) that looks down.
    const Scene scene = read("xf -t 5 0 0\nv v1 =\np 0 10 0\nn 0 0 1\nxf -rx 180\nring v1 0 2\nxf\nxf\n").scene;
    expectNear(corner(scene, scene.polygons[0], 0), {5, -10, 0});
    expectNear(normalOf(scene, 0), {0, 0, -1});
}

TEST_F(MgfReader, MirrorsKeepFrontsOutside) {
    const std::string solids = "v c =\np 3 0 0\nn 0 1 0\nv d =\np 3 1 0\n"
                               "v e =\nv f =\np 1 0 0\nv g =\np 0 1 0\n";
    for (const char* mirror : {"-mx", "-my", "-mz", "-s -1", "-mx -my -mz", "-mx -mz", "-s 2"}) {
        for (const char* shape : {"sph c 1", "torus c .5 1", "prism e f g -2"}) {
            SCOPED_TRACE(fmt::format("{} {}", mirror, shape));
            const double inside = volume(read(solids + shape).scene);
            const double mirrored = volume(read(fmt::format("{}xf {}\n{}\nxf\n", solids, mirror, shape)).scene);
            EXPECT_GT(inside * mirrored, 0.0);
        }
    }
    EXPECT_NEAR(volume(read("v a =\nxf -mx\nsph a -1\nxf\n").scene), -4.0, 0.2); // and insides inside: 4π/3 less 3 %
}

TEST_F(MgfReader, ArraysRepeatTheirContentsInGrids) {
    const auto found =
        places(kVertices + "xf -t 10 0 0 -a 2 -t 1 0 0 -a 3 -t 0 1 0 -i 1 -t 0 0 7\nf a b c\nxf\nf a b c\n");
    ASSERT_EQ(found.size(), 7U);
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 3; ++j) expectNear(found[static_cast<std::size_t>(3 * i + j)], glm::vec3(10 + i, j, 7));
    expectNear(found[6], {0, 0, 0});
}

TEST_F(MgfReader, ArraysNestAndRepeatWhatTheirContentsChange) {
    const auto found =
        places(kVertices + "m x =\nrd .1\nxf -a 2 -t 10 0 0\nxf -a 2 -t 0 5 0\nf a b c\nxf\nv a\np 0 0 1\nxf\n");
    ASSERT_EQ(found.size(), 4U);
    expectNear(found[0], {0, 0, 0});
    expectNear(found[1], {0, 5, 0});
    expectNear(found[2], {10, 0, 1}); // the second time the vertex has moved
    expectNear(found[3], {10, 5, 1});
}

TEST_F(MgfReader, UnitsScaleLengthsButNotEmittance) {
    const Scene scene = read("m l =\ned 100\n" + kTriangle, {.metresPerUnit = 0.5}).scene;
    expectNear(corner(scene, scene.polygons[0], 1), {0.5F, 0, 0});
    EXPECT_NEAR(scene.materials[0].emittedRadiance.x, 100.0F / kPi, 1e-4F);
    EXPECT_THROW(read(kTriangle, {.metresPerUnit = 0.0}), UsageError);
}

// ---- Surfaces

TEST_F(MgfReader, FacesMayHaveHolesAndSeams) {
    const std::string corners = "v 1 =\nv 2 =\np 4 0 0\nv 3 =\np 4 4 0\nv 4 =\np 0 4 0\n"
                                "v 5 =\np 1 3 0\nv 6 =\np 3 3 0\nv 7 =\np 3 1 0\nv 8 =\np 1 1 0\n";
    for (const char* face : {"fh 1 2 3 4 - 5 6 7 8", "fh 1 2 3 4 - 8 7 6 5", "f 1 2 3 4 5 6 7 8 5 4",
                             "xf -mz\nfh 4 3 2 1 - 5 6 7 8\nxf", "xf -mx\nf 1 2 3 4 5 6 7 8 5 4\nxf"}) {
        SCOPED_TRACE(face);
        const ReadResult result = read(corners + face);
        EXPECT_NEAR(totalArea(result.scene), 12.0, 1e-5);
        for (std::size_t k = 0; k < result.scene.polygons.size(); ++k)
            EXPECT_GT(normalOf(result.scene, k).z, 0.999F) << k; // mirrored twice or not at all: it looks up
        EXPECT_TRUE(result.report.warnings.empty());
    }
    const ReadResult outside = read(corners + "v 9 =\np 9 9 0\nfh 1 2 3 4 - 5 9 7");
    EXPECT_NEAR(totalArea(outside.scene), 16.0, 1e-5);
    EXPECT_TRUE(hasWarning(outside, "the holes of a face cross each other or its border and were filled (scene.mgf:"));
}

TEST_F(MgfReader, PrismsExtendAwayFromTheirBaseAndAreClosed) {
    const std::string base = "v 0 =\nv 1 =\np 0 1 0\nv 2 =\np 1 1 0\nv 3 =\np 1 0 0\n"; // looks along -z
    const Scene cube = read(base + "prism 0 1 2 3 1").scene;
    EXPECT_EQ(cube.polygons.size(), 6U);
    EXPECT_EQ(boundsOf(cube).lower, glm::vec3(0.0F));
    EXPECT_EQ(boundsOf(cube).upper, glm::vec3(1.0F));
    EXPECT_EQ(openEdges(cube), 0U);
    EXPECT_NEAR(volume(cube), 1.0, 1e-6);
    const Scene room = read(base + "prism 0 1 2 3 -1").scene;
    EXPECT_EQ(boundsOf(room).lower, glm::vec3(0, 0, -1));
    EXPECT_EQ(openEdges(room), 0U);
    EXPECT_NEAR(volume(room), -1.0, 1e-6);
}

TEST_F(MgfReader, CylindersWithRingsAreClosed) {
    for (const char* axis : {"0 0 1", "0 1 0", "1 1 1", ".3 -.8 .2"}) {
        SCOPED_TRACE(axis);
        const Scene can = read(fmt::format("v lower =\nn {0}\nv upper =\np {0}\nn {0}\ncyl lower .4 upper\n"
                                           "ring upper 0 .4\nxf -s -1\nring lower 0 .4\nxf\n",
                                           axis))
                              .scene;
        EXPECT_EQ(openEdges(can), 0U); // the scale by -1 turns the lower lid outwards
        EXPECT_GT(volume(can), 0.0);
        // Without T-vertices and slivers: 24 sides, and 12 quads in each lid
        EXPECT_EQ(can.polygons.size(), 24U + 12U + 12U);
    }
}

TEST_F(MgfReader, CurveSegmentsDivideACircle) {
    EXPECT_EQ(read("v a =\nv b =\np 0 0 1\ncyl a 1 b").scene.polygons.size(), 24U);
    EXPECT_EQ(read("v a =\nv b =\np 0 0 1\ncyl a 1 b", {.curveSegments = 6}).scene.polygons.size(), 6U);
    EXPECT_EQ(read("v a =\nsph a 1", {.curveSegments = 8}).scene.polygons.size(), 8U * 4U);
    for (const int segments : {0, -2, 7, 1026}) EXPECT_THROW(read(kTriangle, {.curveSegments = segments}), UsageError);
}

TEST_F(MgfReader, FluxIsEmittanceTimesArea) {
    const Scene scene =
        read("m l =\nsides 1\nc\ncct 3000\ned 87712\nv a =\nsph a .0381\n", {.curveSegments = 200}).scene;
    double flux = 0.0;
    for (const Polygon& polygon : scene.polygons)
        flux += double{glm::length(areaVector(scene, polygon)) * kPi *
                       luminance(scene.materials[polygon.material].emittedRadiance)};
    EXPECT_NEAR(flux, 1600.0, 0.5); // the bulb of the format's description; 200 segments miss 2e-4 of the area
}

// ---- Includes

TEST_F(MgfReader, IncludesAreRelativeToTheIncludingFileAndMayBeTransformed) {
    folder.write("parts/chair.mgf", "i vertices/abc.mgf\ni ../materials.mgf\nm wood\nf a b c\n");
    folder.write("parts/vertices/abc.mgf", kVertices);
    folder.write("materials.mgf", "m wood =\nrd .4\n");
    const std::string scene = "i parts/chair.mgf -t 1 0 0 -a 2 -t 0 1 0\ni PARTS\\chair.mgf\n";
    const auto found = places(scene);
    ASSERT_EQ(found.size(), 3U);
    expectNear(found[0], {1, 0, 0});
    expectNear(found[1], {1, 1, 0});
    expectNear(found[2], {0, 0, 0});
    EXPECT_EQ(read(scene).scene.materials.size(), 1U);
}

TEST_F(MgfReader, WhatAnIncludedFileLeavesOpenEndsWithIt) {
    folder.write("open.mgf", "xf -t 1 0 0\no y\nf a b c\n");
    const ReadResult result = read(kVertices + "i open.mgf\nf a b c\n");
    EXPECT_TRUE(hasWarning(result, "the transform of open.mgf:1 has no end"));
    expectNear(corner(result.scene, result.scene.polygons[1], 0), {0, 0, 0});
    EXPECT_EQ(result.scene.nodes[result.scene.polygons[1].node], "default");
}

// ---- Our own scenes

TEST_F(MgfReader, OurScenesAreTheSameInMgfAndObj) {
    for (const char* name : {"cornell_box", "cube6", "table_room"}) {
        SCOPED_TRACE(name);
        const std::filesystem::path data = LAMBERT_DATA;
        const Scene mgf = readScene(data / (std::string(name) + ".mgf")).scene;
        const Scene obj = readScene(data / (std::string(name) + ".obj")).scene;
        ASSERT_EQ(mgf.polygons.size(), obj.polygons.size());
        for (std::size_t k = 0; k < mgf.polygons.size(); ++k) {
            for (int c = 0; c < mgf.polygons[k].size(); ++c)
                expectNear(corner(mgf, mgf.polygons[k], c), corner(obj, obj.polygons[k], c));
            const Material &a = mgf.materials[mgf.polygons[k].material], &b = obj.materials[obj.polygons[k].material];
            EXPECT_EQ(a.name, b.name);
            expectNear(a.reflectance, b.reflectance);
            expectNear(a.emittedRadiance, b.emittedRadiance);
        }
    }
}

TEST_F(MgfReader, TheClassicRoomIsReadWithoutComplaint) {
    const ReadResult result = readScene(std::filesystem::path(LAMBERT_DATA) / "classic_room.mgf");
    ASSERT_EQ(result.report.warnings.size(), 1U);
    EXPECT_TRUE(hasWarning(result, "\"steel\""));
    EXPECT_EQ(result.report.degeneratePolygons, 0U);
}

} // namespace
} // namespace lambert
