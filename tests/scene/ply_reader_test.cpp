#include "ply_test.h"

#include <fmt/format.h>

#include <cstdint>
#include <type_traits>

namespace lambert {
namespace {

using PlyReader = PlyTest;

TEST_F(PlyReader, ReadsTextWithAnyLineEndAndLayout) {
    expectQuad(kQuad);
    std::string windows, old;
    for (const char c : kQuad) {
        windows += c == '\n' ? "\r\n" : std::string(1, c);
        old += c == '\n' ? '\r' : c;
    }
    expectQuad(windows);
    expectQuad(old);
    expectQuad(plyText(kVertices + kFaces, "0 0 0 1 0 0\n1\t1 0\n\n 0 1e0 0 4 0 1 2 3"));
    expectQuad(plyText("comment c\nobj_info x y\n\n" + kVertices + "comment\n" + kFaces, kCorners + "4 0 1 2 3 rest"));
    expectQuad(plyText("comment " + std::string(100000, 'x') + "\n" + kVertices + kFaces, kCorners + "4 0 1 2 3"));
}

TEST_F(PlyReader, GivesPolygonsWithoutColoursTheDefaultMaterial) {
    const ReadResult result = read(kQuad);
    ASSERT_EQ(result.scene.materials.size(), 1U);
    EXPECT_EQ(result.scene.materials[0].name, "default");
    EXPECT_EQ(result.scene.materials[0].reflectance, Rgb(0.5F));
    EXPECT_EQ(result.scene.polygons[0].surface, kNone);
    EXPECT_EQ(result.scene.nodes, std::vector<std::string>{"default"});
    EXPECT_TRUE(result.report.warnings.empty());
}

TEST_F(PlyReader, ReadsBothByteOrders) {
    for (const bool bigEndian : {false, true}) {
        Bytes body(bigEndian);
        body.put<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}).put<std::uint8_t>({4}).put<std::int32_t>({0, 1, 2, 3});
        const std::string header = fmt::format("ply\nformat binary_{}_endian 1.0\n{}{}end_header\n",
                                               bigEndian ? "big" : "little", kVertices, kFaces);
        expectQuad(header + body.text);
        expectQuad(header + body.text + "what follows is not read");
    }
}

TEST_F(PlyReader, ReadsEveryType) {
    const auto expectTypes = [&](const std::string& coordinate, const std::string& length, const std::string& index,
                                 const auto& putCoordinates, const auto& putLength, const auto& putIndices) {
        for (const bool bigEndian : {false, true}) {
            Bytes body(bigEndian);
            putCoordinates(body);
            putLength(body);
            putIndices(body);
            expectQuad(fmt::format("ply\nformat binary_{}_endian 1.0\nelement vertex 4\nproperty {} x\nproperty {} y\n"
                                   "property {} z\nelement face 1\nproperty list {} {} vertex_index\nend_header\n",
                                   bigEndian ? "big" : "little", coordinate, coordinate, coordinate, length, index) +
                       body.text);
        }
    };
    const auto numbers = []<typename T>(T) {
        return [](Bytes& body) {
            body.put<T>({T(0), T(0), T(0), T(1), T(0), T(0), T(1), T(1), T(0), T(0), T(1), T(0)});
        };
    };
    const auto length = []<typename T>(T) { return [](Bytes& body) { body.put<T>({T(4)}); }; };
    const auto indices = []<typename T>(T) { return [](Bytes& body) { body.put<T>({T(0), T(1), T(2), T(3)}); }; };
    const auto expectType = [&](const std::string& name, const std::string& other, auto t) {
        for (const std::string& type : {name, other}) {
            expectTypes(type, "uchar", "int", numbers(t), length(std::uint8_t{}), indices(std::int32_t{}));
            expectTypes("float", "uchar", type, numbers(float{}), length(std::uint8_t{}), indices(t));
            if (std::is_integral_v<decltype(t)>)
                expectTypes("double", type, "uint", numbers(double{}), length(t), indices(std::uint32_t{}));
        }
    };
    expectType("char", "int8", std::int8_t{});
    expectType("uchar", "uint8", std::uint8_t{});
    expectType("short", "int16", std::int16_t{});
    expectType("ushort", "uint16", std::uint16_t{});
    expectType("int", "int32", std::int32_t{});
    expectType("uint", "uint32", std::uint32_t{});
    expectType("float", "float32", float{});
    expectType("double", "float64", double{});
}

TEST_F(PlyReader, PassesOverUnknownElementsAndProperties) {
    const std::string header =
        "element camera 1\nproperty float focus\nproperty list uchar float lens\n"
        "element nothing 1000000000000\n"
        "element vertex 4\nproperty list uchar short bones\nproperty double x\nproperty uchar w\n"
        "property float y\nproperty float z\nproperty float confidence\n"
        "element face 1\nproperty list ushort float weights\nproperty int flags\n"
        "property list uchar int vertex_indices\nproperty float quality\n"
        "element edge 1\nproperty int vertex1\n";
    expectQuad(plyText(header, "0.5 2 1 2\n0 0 7 0 0 1\n1 9 1 7 0 0 1\n2 9 9 1 7 1 0 1\n0 0 7 1 0 1\n"
                               "3 .1 .2 .3 -1 4 0 1 2 3 1.5\n0\n"));
    Bytes body;
    body.put<float>({0.5F}).put<std::uint8_t>({2}).put<float>({1, 2});
    for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        body.put<std::uint8_t>({1}).put<std::int16_t>({9}).put<double>({double(x)}).put<std::uint8_t>({7});
        body.put<float>({float(y), 0, 1});
    }
    body.put<std::uint16_t>({2}).put<float>({1, 2}).put<std::int32_t>({-1});
    body.put<std::uint8_t>({4}).put<std::int32_t>({0, 1, 2, 3}).put<float>({1.5F});
    expectQuad("ply\nformat binary_little_endian 1.0\n" + header + "end_header\n" + body.text);
}

TEST_F(PlyReader, ReadsFacesThatComeBeforeTheVertices) {
    expectQuad(plyText(kFaces + "element edge 1\nproperty int a\n" + kVertices, "4 0 1 2 3\n8\n" + kCorners));
    Bytes body;
    body.put<std::uint8_t>({4}).put<std::int32_t>({0, 1, 2, 3}).put<std::int32_t>({8});
    body.put<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    expectQuad("ply\nformat binary_little_endian 1.0\n" + kFaces + "element edge 1\nproperty int a\n" + kVertices +
               "end_header\n" + body.text);
}

TEST_F(PlyReader, ReadsBinaryDataThatBeginsWithALineFeed) {
    // The first byte of the first number is 0x0A.
    Bytes body;
    body.put<std::int16_t>({10, 0, 0, 11, 0, 0, 11, 1, 0, 10, 1, 0}).put<std::uint8_t>({4, 0, 1, 2, 3});
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        std::string ply;
        for (const std::string line :
             {"ply", "format binary_little_endian 1.0", "element vertex 4", "property short x", "property short y",
              "property short z", "element face 1", "property list uchar uchar vertex_indices", "end_header"})
            ply += line + end;
        const Scene scene = read(ply + body.text).scene;
        EXPECT_EQ(corner(scene, scene.polygons.at(0), 0), glm::vec3(10, 0, 0));
    }
}

TEST_F(PlyReader, AppliesMetresPerUnitInDoublePrecision) {
    const std::string ply =
        plyText("element vertex 3\nproperty double x\nproperty double y\nproperty double z\n" + kFaces,
                "0 0 0\n1000 0 0\n0 1000 0\n3 0 1 2\n");
    const Scene scene = read(ply, {.metresPerUnit = 0.001}).scene;
    EXPECT_EQ(corner(scene, scene.polygons[0], 1).x, 1.0F);
    EXPECT_THROW(read(ply, {.metresPerUnit = -1.0}), UsageError);
}

TEST_F(PlyReader, SplitsLargePolygonsAndCountsThoseWithoutArea) {
    const std::string header = "element vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
                               "element face 6\nproperty list uchar int vertex_indices\n";
    const ReadResult result = read(plyText(header, "0 0 0\n1 0 0\n1 1 0\n.5 2 0\n0 1 0\nnan 0 0\n"
                                                   "5 0 1 2 3 4\n0\n1 0\n2 0 1\n3 0 0 1\n3 0 1 5\n"));
    EXPECT_EQ(result.scene.polygons.size(), 3U);
    EXPECT_NEAR(totalArea(result.scene), 1.5, 1e-6);
    EXPECT_EQ(result.report.inputPolygons, 6U);
    EXPECT_EQ(result.report.splitPolygons, 1U);
    EXPECT_EQ(result.report.degeneratePolygons, 4U);
    EXPECT_EQ(result.report.nonFinitePolygons, 1U);
}

TEST_F(PlyReader, KeepsFacesThatShareAnEdgeWithManyOthers) {
    const std::string header = "element vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
                               "element face 4\nproperty list uchar int vertex_indices\n";
    const std::string body = "0 0 0\n1 0 0\n0 1 0\n0 -1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n3 0 1 4\n3 0 1 2\n";
    EXPECT_EQ(read(plyText(header, body)).scene.polygons.size(), 4U);
}

TEST_F(PlyReader, ReportsVerticesAndFacesAsProgress) {
    struct Recorder : Progress {
        std::string stages;
        void onBegin(std::string_view stage, std::uint64_t total) override {
            stages += fmt::format("{} {}; ", stage, total);
        }
    } progress;
    read(kQuad, {.progress = &progress});
    EXPECT_EQ(progress.stages, "read vertex 4; read face 1; ");
    progress.cancel();
    EXPECT_THROW(read(kQuad, {.progress = &progress}), Cancelled);
}

} // namespace
} // namespace lambert
