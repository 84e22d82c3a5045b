#include "reader_checks.h"

#include <cmath>
#include <cstring>
#include <initializer_list>

namespace lambert {
namespace {

std::string facet(const std::string& a, const std::string& b, const std::string& c) {
    return "  facet normal 0 0 1\n    outer loop\n      vertex " + a + "\n      vertex " + b + "\n      vertex " + c +
           "\n    endloop\n  endfacet\n";
}

const std::string kFacet = facet("0 0 0", "1 0 0", "0 1 0");

/// A binary file: `count` as its header says it, and facets of 9 coordinates.
std::string binary(std::uint32_t count, std::initializer_list<std::array<float, 9>> facets,
                   const std::string& header = "") {
    std::string result = header;
    result.resize(80, '\0');
    const auto put = [&](const auto& value) { result.append(reinterpret_cast<const char*>(&value), sizeof value); };
    put(count);
    for (const std::array<float, 9>& coordinates : facets) {
        put(std::array<float, 3>{0, 0, 1});
        put(coordinates);
        put(std::uint16_t{0x1234}); // some programs keep a colour here
    }
    return result;
}

constexpr std::array<float, 9> kTriangle{0, 0, 0, 1, 0, 0, 0, 1, 0};

class StlReader : public ReaderTest {
protected:
    StlReader() : ReaderTest("scene.stl") {}

    /// Expects the one triangle of kFacet, and returns what was read.
    ReadResult expectTriangle(const std::string& stl) {
        SCOPED_TRACE(stl.substr(0, 300));
        ReadResult result = read(stl);
        const Scene& scene = result.scene;
        expectUnitTriangle(scene);
        EXPECT_EQ(scene.materials.size(), 1U);
        EXPECT_EQ(scene.materials[0].name, "default");
        EXPECT_EQ(scene.materials[0].reflectance, Rgb(0.5F));
        return result;
    }
};

TEST_F(StlReader, NamesInLatin1BecomeUtf8) {
    const ReadResult result = read("solid t\xFCr\n" + kFacet + "endsolid t\xFCr\n");
    EXPECT_EQ(result.scene.nodes, std::vector<std::string>{"t\xC3\xBCr"});
}

TEST_F(StlReader, ReadsTextInAnyCaseAndWithAnyLineEnd) {
    const std::string plain = "solid part\n" + kFacet + "endsolid part\n";
    std::string windows, capitals;
    for (const char c : plain) {
        windows += c == '\n' ? "\r\n" : std::string(1, c);
        capitals += static_cast<char>(std::toupper(c));
    }
    for (const std::string& stl : {plain, windows, capitals, "\n \t" + plain}) {
        const ReadResult result = expectTriangle(stl);
        EXPECT_EQ(result.scene.nodes.size(), 1U);
        EXPECT_TRUE(result.report.warnings.empty());
    }
}

TEST_F(StlReader, MakesNodesOfSolids) {
    const Scene scene = read("solid table top\n" + kFacet + kFacet + "endsolid table top\nsolid\n" + kFacet +
                             "endsolid\nsolid leg\n" + kFacet + "endsolid leg\n")
                            .scene;
    std::string nodes;
    for (const Polygon& polygon : scene.polygons) nodes += scene.nodes[polygon.node] + "; ";
    EXPECT_EQ(nodes, "table top; table top; default; leg; ");
    EXPECT_EQ(scene.materials.size(), 1U);
}

TEST_F(StlReader, TakesASolidsNameAsItStands) {
    EXPECT_EQ(read("solid  C:\\parts\\ # 1 \\\n" + kFacet + "endsolid\n").scene.nodes.at(0), "C:\\parts\\ # 1 \\");
}

TEST_F(StlReader, ReadsBinaryAlsoIfItBeginsWithSolid) {
    for (const std::string header : {"", "solid part", "solid", "COLOR=abcd"}) {
        const ReadResult result = expectTriangle(binary(1, {kTriangle}, header));
        EXPECT_EQ(result.scene.nodes, std::vector<std::string>{"default"});
        EXPECT_TRUE(result.report.warnings.empty());
    }
    const std::string full = "solid " + std::string(74, 'x');
    expectTriangle(binary(1, {kTriangle}, full));
    EXPECT_TRUE(hasWarning(expectTriangle(binary(1, {kTriangle}, full) + "\1"), "1 bytes after the last facet"));
}

TEST_F(StlReader, IgnoresBytesAfterTheLastFacetWithAWarning) {
    EXPECT_TRUE(
        hasWarning(expectTriangle(binary(1, {kTriangle}) + "abc"), "3 bytes after the last facet were ignored"));
    EXPECT_TRUE(hasWarning(expectTriangle(binary(1, {kTriangle, kTriangle})), "50 bytes after the last facet"));
}

TEST_F(StlReader, CountsFacetsWithoutAreaOrWithCoordinatesThatAreNotNumbers) {
    const ReadResult text =
        read("solid\n" + kFacet + facet("0 0 0", "1 1 1", "2 2 2") + facet("0 0 0", "nan 0 0", "0 1 0") +
             facet("0 0 0", "1 0 0", "1e999 0 0") + "endsolid\n");
    const ReadResult bytes = read(binary(
        4,
        {kTriangle, {0, 0, 0, 1, 1, 1, 2, 2, 2}, {0, 0, 0, NAN, 0, 0, 0, 1, 0}, {0, 0, 0, 1, 0, 0, INFINITY, 0, 0}}));
    for (const ReadResult* result : {&text, &bytes}) {
        EXPECT_EQ(result->scene.polygons.size(), 1U);
        EXPECT_EQ(result->report.inputPolygons, 4U);
        EXPECT_EQ(result->report.degeneratePolygons, 1U);
        EXPECT_EQ(result->report.nonFinitePolygons, 2U);
    }
}

TEST_F(StlReader, ReadsFacetsOfMoreThanThreeVertices) {
    const ReadResult result = read("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2 0 0\nvertex 2 2 0\n"
                                   "vertex 0 2 0\nendloop\nendfacet\nendsolid\n");
    ASSERT_EQ(result.scene.polygons.size(), 1U);
    EXPECT_TRUE(result.scene.polygons[0].isQuad());
    EXPECT_EQ(totalArea(result.scene), 4.0);
}

TEST_F(StlReader, AppliesMetresPerUnitAndTwoSided) {
    const ReadOptions options{.metresPerUnit = 0.001, .twoSided = true};
    const std::string text = "solid\n" + facet("0 0 0", "1000 0 0", "0 1000 0") + "endsolid\n";
    for (const std::string& stl : {text, binary(1, {{0, 0, 0, 1000, 0, 0, 0, 1000, 0}})}) {
        const Scene scene = read(stl, options).scene;
        EXPECT_EQ(corner(scene, scene.polygons.at(0), 1).x, 1.0F);
        EXPECT_TRUE(scene.materials[0].twoSided);
    }
    EXPECT_THROW(read(text, {.metresPerUnit = 0.0}), UsageError);
}

TEST_F(StlReader, RejectsFilesWithoutFacets) {
    expectError("solid x\nendsolid x\n", "found no polygons");
    expectError(binary(0, {}), "found no polygons");
    expectError("", "the file is empty");
}

TEST_F(StlReader, RejectsCountsThatDoNotFitIntoTheFile) {
    expectError(binary(2, {kTriangle}), "byte 80: found 2 as the number of facets, expected at most 1");
    expectError(binary(0xFFFFFFFF, {kTriangle}), "found 4294967295 as the number of facets, expected at most 1");
    const std::string whole = binary(1, {kTriangle});
    for (std::size_t size = 84; size < whole.size(); ++size) expectError(whole.substr(0, size), "expected at most 0");
    for (const std::size_t size : {1U, 5U, 79U, 83U}) expectError(whole.substr(0, size), "or at least the 84 bytes");
}

TEST_F(StlReader, RejectsMalformedTextWithItsLine) {
    const std::string solid = "solid x\n";
    expectError(solid + "vertex 0 0 0\n", "scene.stl:2: found \"vertex 0 0 0\", expected facet before it");
    expectError(solid + kFacet + "endfacet\n", "scene.stl:9: found \"endfacet\", expected facet before it");
    expectError(solid + "facet\nfacet\n", "scene.stl:3: found \"facet\", expected endfacet before it");
    expectError(solid + "facet\nendsolid\n", "scene.stl:3: found \"endsolid\", expected endfacet before it");
    expectError(solid + "facet\nvertex 0 0\n", "scene.stl:3: found \"vertex 0 0\", expected 3 numbers after vertex");
    expectError(solid + "facet\nvertex 0 0 x\n", "scene.stl:3: found \"vertex 0 0 x\"");
    expectError(solid + kFacet + "facet\nvertex 0 0 0\n",
                "scene.stl:10: found \"the end of the file\", expected endfacet");
    expectError(solid + "<html>\n", "scene.stl:2: found \"<html>\", expected solid, facet, outer loop");
    EXPECT_TRUE(hasWarning(read(solid + kFacet), "the file ends without endsolid"));
}

TEST_F(StlReader, KnowsTheExtensionInCapitals) {
    EXPECT_EQ(readScene(folder.write("PART.STL", binary(1, {kTriangle}))).scene.polygons.size(), 1U);
}

} // namespace
} // namespace lambert
