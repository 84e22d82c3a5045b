#include "reader_checks.h"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include <cmath>

namespace lambert {
namespace {

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

class ObjReader : public ReaderTest {
protected:
    ObjReader() : ReaderTest("scene.obj") {}
};

TEST_F(ObjReader, ReadsTrianglesAndQuadsInTheFilesOrder) {
    const ReadResult result = read("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl b\nf 1 2 3 4\ng second\nusemtl a\n"
                                   "f 1 2 3\nusemtl b\nf 4 3 1\no third\nf 4 3 2\n");
    const Scene& scene = result.scene;
    ASSERT_EQ(scene.polygons.size(), 4U);
    EXPECT_EQ(scene.polygons[0].vertices, (std::array<std::uint32_t, 4>{0, 1, 2, 3}));
    EXPECT_EQ(scene.polygons[1].vertices, (std::array<std::uint32_t, 4>{0, 1, 2, kNone}));
    EXPECT_EQ(scene.polygons[2].vertices, (std::array<std::uint32_t, 4>{3, 2, 0, kNone}));
    EXPECT_EQ(scene.polygons[3].vertices, (std::array<std::uint32_t, 4>{3, 2, 1, kNone}));
    std::string materials, nodes;
    for (const Polygon& polygon : scene.polygons) {
        materials += scene.materials[polygon.material].name + " ";
        nodes += scene.nodes[polygon.node] + " ";
    }
    EXPECT_EQ(materials, "b a b b ");
    EXPECT_EQ(nodes, "default second second third ");
}

TEST_F(ObjReader, ReadsTheSameFromAllLineEndingsTabsAndContinuations) {
    const std::string plain = "# c \\\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const std::vector<std::string> variants = {
        plain,
        "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n",
        "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r",
        "\tv\t0\t0\t0\n  v  1 0\t0  \nv 0 1 0\n\tf\t1  2\t3 ",
        "v 0 0 \\\n0\nv 1 \\\r\n 0 0\nv 0 1 0\nf 1 \\\n2 \\\n3",
        "\xEF\xBB\xBFv 0 0 0\nv 1 0 0 # comment\nv 0 1 0\nf 1 2 3 # comment",
        "f 1 2 3\n" + kTriangle,
        kTriangle + "f -3 -2 -1\n",
        "v +0 .0 0.\nv 1e0 0 0\nv 0 1.0E+0 0 1\nvt 0\nvn 0 0 1\nf 1/1/1 2//1 3/1"};
    for (const std::string& obj : variants) {
        SCOPED_TRACE(obj);
        expectUnitTriangle(read(obj).scene);
    }
}

TEST_F(ObjReader, NegativeIndicesCountFromTheLineTheyStandIn) {
    const Scene scene = read(kTriangle + "f -3 -2 -1\nv 5 5 0\nf -4 -3 -1\n").scene;
    EXPECT_EQ(scene.polygons[0].vertices[0], 0U);
    EXPECT_EQ(scene.polygons[1].vertices, (std::array<std::uint32_t, 4>{0, 1, 3, kNone}));
}

TEST_F(ObjReader, AppliesMetresPerUnitInDoublePrecision) {
    const Scene scene = read("v 0 0 0\nv 1000 0 0\nv 0 1000 0\nf 1 2 3", {.metresPerUnit = 0.001}).scene;
    EXPECT_EQ(corner(scene, scene.polygons[0], 1).x, 1.0F);
    EXPECT_THROW(read(kTriangle + "f 1 2 3", {.metresPerUnit = 0.0}), UsageError);
    EXPECT_THROW(read(kTriangle + "f 1 2 3", {.metresPerUnit = NAN}), UsageError);
    EXPECT_THROW(read(kTriangle + "f 1 2 3", {.metresPerUnit = 1e300}), InputError);
}

TEST_F(ObjReader, SplitsConcaveAndLargePolygons) {
    const ReadResult concave = read("v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nf 1 2 3 4");
    EXPECT_EQ(concave.scene.polygons.size(), 2U);
    EXPECT_NEAR(totalArea(concave.scene), 4.0, 1e-6);
    const ReadResult pentagon = read("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.5 2 0\nv 0 1 0\nf 1 2 3 4 5");
    EXPECT_EQ(pentagon.scene.polygons.size(), 3U);
    EXPECT_NEAR(totalArea(pentagon.scene), 1.5, 1e-6);
}

TEST_F(ObjReader, ReadsPolygonsOfMoreThan255Vertices) {
    for (const int sides : {255, 256, 257, 512, 1000}) {
        std::string obj, face = "f";
        for (int k = 0; k < sides; ++k) {
            const double angle = glm::two_pi<double>() * k / sides;
            obj += fmt::format("v {} {} 0\n", std::cos(angle), std::sin(angle));
            face += fmt::format(" {}", k + 1);
        }
        const ReadResult result = read(obj + face + "\nv 9 0 0\nv 9 1 0\nv 8 0 0\nf -3 -2 -1\n");
        EXPECT_EQ(result.scene.polygons.size(), static_cast<std::size_t>(sides - 2 + 1));
        // The regular polygon and a triangle of 1/2; single precision.
        EXPECT_NEAR(totalArea(result.scene), 0.5 * sides * std::sin(glm::two_pi<double>() / sides) + 0.5, 1e-4);
    }
}

TEST_F(ObjReader, DropsPolygonsWithVerticesThatAreNotNumbers) {
    for (const std::string spelling : {"nan", "-nan", "NaN", "inf", "-inf", "-nan(ind)", "1.#QNAN", "-1.#IND", "1e999",
                                       "1e99999999999", "infinity"}) {
        SCOPED_TRACE(spelling);
        const ReadResult result =
            read(kTriangle + "v 0 " + spelling + " 1\nvn nan nan nan\nf 1//1 2//1 3//1\nf 1 2 4\n");
        EXPECT_EQ(result.scene.polygons.size(), 1U);
        EXPECT_EQ(result.report.nonFinitePolygons, 1U);
    }
}

TEST_F(ObjReader, ReadsMaterials) {
    folder.write("m/my materials.mtl", "newmtl red wall\r\n  Kd 0.5 0.25 0.125 # red\r\n\tKe 1 2 3\r\nnewmtl  grey\r\n"
                                       "Kd 0.5\r\nnewmtl spectrum\nKd spectral a.rfl\nnewmtl light\nKe 4\n");
    const ReadResult result =
        read("mtllib m/my materials.mtl\n" + kTriangle + "usemtl red wall\nf 1 2 3\nusemtl grey\nf 1 2 3\n");
    const auto& materials = result.scene.materials;
    ASSERT_EQ(materials.size(), 4U);
    EXPECT_EQ(materials[0].name, "red wall");
    EXPECT_EQ(materials[0].reflectance, Rgb(0.5F, 0.25F, 0.125F));
    EXPECT_EQ(materials[0].emittedRadiance, Rgb(1, 2, 3));
    EXPECT_EQ(materials[1].name, "grey");
    EXPECT_EQ(materials[1].reflectance, Rgb(0.5F));
    EXPECT_EQ(materials[2].reflectance, Rgb(0.5F));
    EXPECT_EQ(materials[3].reflectance, Rgb(0.0F));
    EXPECT_EQ(materials[3].emittedRadiance, Rgb(4.0F));
    EXPECT_EQ(result.scene.polygons[0].material, 0U);
    EXPECT_EQ(result.scene.polygons[1].material, 1U);
    EXPECT_EQ(result.report.warnings.size(), 1U);
    EXPECT_TRUE(hasWarning(result, "material \"spectrum\": Kd spectral"));
}

TEST_F(ObjReader, ReadsSeveralLibrariesAndKeepsTheFirstOfTwoEqualNames) {
    folder.write("a.mtl", "newmtl a\nKd 0.1\n");
    folder.write("b.mtl", "newmtl a\nKd 0.2\nnewmtl b\nKd 0.3\n");
    const ReadResult result = read("mtllib a.mtl b.mtl\nmtllib b.mtl\n" + kTriangle + "usemtl b\nf 1 2 3\n");
    ASSERT_EQ(result.scene.materials.size(), 2U);
    EXPECT_EQ(result.scene.materials[0].reflectance, Rgb(0.1F));
    EXPECT_EQ(result.scene.materials[1].reflectance, Rgb(0.3F));
    EXPECT_TRUE(hasWarning(result, "defined again"));
}

TEST_F(ObjReader, WarnsOfUnknownMaterialsAndMissingLibraries) {
    const ReadResult result =
        read("mtllib none.mtl\n" + kTriangle + "f 1 2 3\nusemtl x\nf 1 2 3\nusemtl y\nf 1 2 3\nusemtl x\nf 1 2 3\n");
    ASSERT_EQ(result.scene.materials.size(), 3U);
    EXPECT_EQ(result.scene.materials[0].name, "default");
    EXPECT_EQ(result.scene.materials[1].name, "x");
    EXPECT_EQ(result.scene.materials[1].reflectance, Rgb(0.5F));
    EXPECT_EQ(result.scene.polygons[3].material, 1U);
    ASSERT_EQ(result.report.warnings.size(), 3U);
    EXPECT_TRUE(hasWarning(result, "none.mtl: no such file"));
    EXPECT_TRUE(hasWarning(result, "material \"y\" is not defined"));
}

TEST_F(ObjReader, IgnoresUnknownStatementsPointsAndLines) {
    const ReadResult result =
        read(kTriangle + "s off\nvp 1\ncurv x\np 1\nl 1 2\nl 0 junk\nvw x y z\nt x 9/9/9\nf 1 2 3\nend");
    EXPECT_EQ(result.scene.polygons.size(), 1U);
    ASSERT_EQ(result.report.warnings.size(), 1U);
    EXPECT_TRUE(hasWarning(result, "3 points or lines"));
}

TEST_F(ObjReader, IgnoresCurvesAndSurfacesWithACount) {
    const ReadResult result = read(kTriangle + "vp 0.1\ncstype bezier\ndeg 3\ncurv 0 1 1 2 3\nparm u 0 1\nend\n"
                                               "surf 0 1 0 1 1 2 3\np 1\nf 1 2 3");
    ASSERT_EQ(result.report.warnings.size(), 1U);
    EXPECT_TRUE(hasWarning(result, "1 points or lines and 2 curves or surfaces were ignored"));
}

TEST_F(ObjReader, LeavesOutHolesAtBridges) {
    const ReadResult result = read("v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 0\nv 1 3 0\nv 3 3 0\nv 3 1 0\n"
                                   "f 1 2 3 4 1 5 6 7 8 5\n");
    EXPECT_NEAR(totalArea(result.scene), 12.0, 1e-6);
    EXPECT_TRUE(result.report.warnings.empty());
}

TEST_F(ObjReader, ReadsFilesOfManyPiecesWithAnyLineEnding) {
    // Pieces are of a megabyte, so that each of them ends in another byte of a line.
    for (const std::string end : {"\n", "\r\n", "\r", " \\\n\n"}) {
        std::string obj;
        constexpr int kTriangles = 40000;
        for (int k = 0; k < kTriangles; ++k)
            obj += fmt::format("v {0} 0 0{1}v {0} 2 0{1}v {0} 0 1{1}f -3 -2 -1{1}", k, end);
        const ReadResult result = read(obj);
        ASSERT_EQ(result.scene.polygons.size(), static_cast<std::size_t>(kTriangles));
        EXPECT_EQ(totalArea(result.scene), double{kTriangles}); // each is of area 1
    }
}

TEST_F(ObjReader, RefusesUtf16ByItsName) {
    expectError(std::string("\xFF\xFEv\0 \0", 6), "found UTF-16 text, expected UTF-8 or Latin-1");
    expectError(std::string("\xFE\xFF\0v", 4), "found UTF-16");
}

TEST_F(ObjReader, RefusesOverlongStatementsAndPolygons) {
    std::string face = "f";
    for (int k = 0; k < 70000; ++k) face += " 1";
    expectError(kTriangle + face, "scene.obj:4: found \"f 1 1");
    expectError(kTriangle + face, "expected at most 65536 vertices after f");
    expectError(kTriangle + std::string((std::size_t{1} << 26) + (1 << 21), 'x'), "scene.obj:4: found a statement of");
    std::string continued;
    for (int k = 0; k < 70; ++k) continued += std::string(1 << 20, 'x') + "\\\n";
    expectError(kTriangle + continued, "found a statement of more than 67108864 bytes");
}

TEST_F(ObjReader, ReportsItsProgressInBytesAndCanBeCancelled) {
    struct Counted : Progress {
        std::uint64_t done = 0, total = 0;
        bool ended = false;
        void onBegin(std::string_view, std::uint64_t bytes) override { total = bytes; }
        void onAdvance(std::uint64_t soFar, std::uint64_t) override { done = soFar; }
        void onEnd() override { ended = true; }
    } progress;
    const std::string obj = kTriangle + "f 1 2 3\n" + std::string(3000000, '#');
    read(obj, {.progress = &progress});
    EXPECT_EQ(progress.total, obj.size());
    EXPECT_EQ(progress.done, obj.size());
    EXPECT_TRUE(progress.ended);
    progress.cancel();
    EXPECT_THROW(read(obj, {.progress = &progress}), Cancelled);
}

TEST_F(ObjReader, RejectsIndexPastTheLastVertex) {
    expectError(kTriangle + "f 1 2 3\nf 1 2 4\n",
                "scene.obj:5: found \"4\", expected a vertex that exists: the file has 3");
    expectError("f 1 2 5\nf 1 2 4\nf 1 2 9\n" + kTriangle + "v 0 0 1\n", "scene.obj:1: found \"5\"");
    expectError("f 1 2 4\nf 1 2 5\n" + kTriangle + "v 0 0 1\n", "scene.obj:2: found \"5\"");
}

TEST_F(ObjReader, RejectsMalformedFilesWithLineAndText) {
    expectError("v 0 0\n", "scene.obj:1: found \"v 0 0\", expected 3 numbers after v");
    expectError("v\n", "scene.obj:1: found \"v\"");
    expectError("\n# c\nv 0 x 0\n", "scene.obj:3: found \"x\"");
    expectError("v 0 0 1,5\n", "scene.obj:1: found \"1,5\"");
    expectError("v 0 0 1.5f\n", "found \"1.5f\"");
    expectError("v 0 0 --1\n", "found \"--1\"");
    expectError("v 0 0 +-1\n", "found \"+-1\"");
    expectError("v 0 0 0x10\n", "found \"0x10\"");
    expectError("v 0 0 e5\n", "found \"e5\"");
    expectError("vn 0 1\n", "scene.obj:1: found \"vn 0 1\"");
    expectError("vt a\n", "expected 1 number after vt");
    expectError(kTriangle + "f 1 2\n", "scene.obj:4: found \"f 1 2\", expected at least 3");
    expectError(kTriangle + "f\n", "scene.obj:4: found \"f\"");
    expectError(kTriangle + "f 0 1 2\n", "found \"0\"");
    expectError(kTriangle + "f 1 2 -4\n", "found \"-4\", expected a vertex that exists: 3 vertices lie before");
    expectError("f -1 -2 -3\n" + kTriangle, "scene.obj:1: found \"-1\"");
    expectError(kTriangle + "f 1 2 c\n", "found \"c\"");
    expectError(kTriangle + "f 1 2 3.0\n", "found \"3.0\"");
    expectError(kTriangle + "f 1 2 /3\n", "found \"/3\"");
    expectError(kTriangle + "f 1/x 2 3\n", "found \"1/x\"");
    expectError(kTriangle + "f 1/0 2 3\n", "found \"1/0\"");
    expectError(kTriangle + "f 1/1/1/1 2 3\n", "found \"1/1/1/1\"");
    expectError(kTriangle + "f 1 2 99999999999999999999\n", "found \"99999999999999999999\"");
    expectError(kTriangle + "f 1 2 9223372036854775807\n", "found \"9223372036854775807\"");
    expectError(kTriangle + "f 1 2 -9223372036854775808\n", "scene.obj:4");
    expectError("v 0 0 \\\n\\\nx\n", "scene.obj:1: found \"x\"");
    expectError(kTriangle + "\r\n\r\nf 1 2 \x01\x1b[31m\n", "scene.obj:6: found \"??[31m\"");
    expectError("v " + std::string(100000, 'x'), "xxx...\"");
    expectError(kTriangle, "found no polygons");
    expectError(kTriangle + "f 1 1 2\n", "1 without area");
    expectError("v 0 0 0 1 0 x\n", "scene.obj:1: found \"x\"");
    expectError("", "the file is empty");
    expectError(std::string("\0\xff\xfe\0binary", 10), "found no polygons");
}

TEST_F(ObjReader, RejectsMalformedMaterialsWithTheirOwnFileAndLine) {
    const auto expectMtlError = [&](const std::string& mtl, const std::string& part) {
        folder.write("scene.mtl", mtl);
        expectError("mtllib scene.mtl\n" + kTriangle + "f 1 2 3\n", part);
    };
    expectMtlError("newmtl a\nKd 0.5 0.5\n", "scene.mtl:2: found \"Kd 0.5 0.5\", expected 1 or 3 numbers after Kd");
    expectMtlError("newmtl a\nKd\n", "scene.mtl:2: found \"Kd\"");
    expectMtlError("newmtl a\n\nKe 1 x 3\n", "scene.mtl:3: found \"x\", expected a finite number after Ke");
    expectMtlError("newmtl a\nKd nan nan nan\n", "scene.mtl:2: found \"nan\"");
    expectMtlError("newmtl a\nKe 1e39\n", "scene.mtl:2: found \"1e39\"");
    expectMtlError("Kd 1 1 1\n", "scene.mtl:1: found \"Kd 1 1 1\", expected newmtl NAME before it");
}

TEST_F(ObjReader, RejectsWhatIsNotAReadableFile) {
    expectInputError(folder.path() / "none.obj", "none.obj: no such file");
    std::filesystem::create_directory(folder.path() / "folder.obj");
    expectInputError(folder.path() / "folder.obj", "folder.obj: found a folder");
    expectInputError(folder.write("scene.fbx", "x"), "allowed are .gltf, .glb, .obj, .ply, .stl and .mgf");
    expectInputError(folder.write("scene", "x"), "found the extension \"\"");
}

TEST_F(ObjReader, KnowsTheExtensionInCapitals) {
    EXPECT_EQ(readScene(folder.write("SCENE.OBJ", kTriangle + "f 1 2 3")).scene.polygons.size(), 1U);
}

} // namespace
} // namespace lambert
