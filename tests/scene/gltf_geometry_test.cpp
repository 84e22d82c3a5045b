#include "gltf_test.h"

#include <array>
#include <cmath>

namespace lambert {
namespace {

using nlohmann::json;
using GltfGeometry = GltfTest;

constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123, kUnsignedInt = 5125,
              kFloat = 5126;
const std::string kPositions = "/meshes/0/primitives/0/attributes/POSITION";

TEST_F(GltfGeometry, ReadsQuantisedPositionsNormalisedOrNot) {
    const auto areaOf = [&](const std::string& bytes, int type, bool normalised) {
        Square square;
        square[kPositions] = square.addAccessor(bytes, type, "VEC3", 4, normalised);
        square["/extensionsRequired"] = {"KHR_mesh_quantization"};
        return totalArea(read(square).scene);
    };
    EXPECT_EQ(areaOf(bytesOf<std::int8_t>({-2, 0, 0, 1, 0, 0, 1, 2, 0, -2, 2, 0}), kByte, false), 6.0);
    EXPECT_EQ(areaOf(bytesOf<std::uint8_t>({0, 0, 0, 200, 0, 0, 200, 3, 0, 0, 3, 0}), kUnsignedByte, false), 600.0);
    EXPECT_EQ(areaOf(bytesOf<std::int16_t>({-300, 0, 0, 1, 0, 0, 1, 2, 0, -300, 2, 0}), kShort, false), 602.0);
    EXPECT_EQ(areaOf(bytesOf<std::uint8_t>({0, 0, 0, 255, 0, 0, 255, 255, 0, 0, 255, 0}), kUnsignedByte, true), 1.0);
    // Both -128 and -127 stand for -1.
    EXPECT_EQ(areaOf(bytesOf<std::int8_t>({-128, -127, 0, 127, -127, 0, 127, 127, 0, -127, 127, 0}), kByte, true), 4.0);
    EXPECT_EQ(
        areaOf(bytesOf<std::int16_t>({-32767, 0, 0, 32767, 0, 0, 32767, 32767, 0, -32768, 32767, 0}), kShort, true),
        2.0);
    EXPECT_EQ(
        areaOf(bytesOf<std::uint16_t>({0, 0, 0, 65535, 0, 0, 65535, 65535, 0, 0, 65535, 0}), kUnsignedShort, true),
        1.0);
}

TEST_F(GltfGeometry, SparseElementsReplaceThoseOfTheBase) {
    Square square;
    const int indices = square.addView(bytesOf<std::uint8_t>({1, 2}));
    const int values = square.addView(bytesOf<float>({3, 0, 0, 3, 1, 0}));
    square["/accessors/0/sparse"] = {{"count", 2},
                                     {"indices", {{"bufferView", indices}, {"componentType", kUnsignedByte}}},
                                     {"values", {{"bufferView", values}}}};
    EXPECT_EQ(totalArea(read(square).scene), 3.0);
}

TEST_F(GltfGeometry, SparseElementsWithoutABaseReplaceZeros) {
    Square square;
    const int indices = square.addView(bytesOf<std::uint16_t>({9, 1, 2}));
    const int values = square.addView(bytesOf<float>({9, 9, 9, 2, 0, 0, 2, 1, 0}));
    square["/accessors/0"] = {
        {"componentType", kFloat},
        {"type", "VEC3"},
        {"count", 4},
        {"sparse",
         {{"count", 2},
          {"indices", {{"bufferView", indices}, {"byteOffset", 2}, {"componentType", kUnsignedShort}}},
          {"values", {{"bufferView", values}, {"byteOffset", 12}}}}}};
    // Vertices 0 and 3 are the origin: one triangle is left.
    const ReadResult result = read(square);
    EXPECT_EQ(totalArea(result.scene), 1.0);
    EXPECT_EQ(result.report.degeneratePolygons, 1U);
}

TEST_F(GltfGeometry, SparseIndicesNeedNoBase) {
    Square square;
    const int indices = square.addView(bytesOf<std::uint32_t>({1, 2}));
    const int values = square.addView(bytesOf<std::uint16_t>({1, 2}));
    square["/accessors/1"] = {{"componentType", kUnsignedShort},
                              {"type", "SCALAR"},
                              {"count", 3},
                              {"sparse",
                               {{"count", 2},
                                {"indices", {{"bufferView", indices}, {"componentType", kUnsignedInt}}},
                                {"values", {{"bufferView", values}}}}}};
    EXPECT_EQ(totalArea(read(square).scene), 0.5);
}

TEST_F(GltfGeometry, RejectsBrokenSparseAccessors) {
    Square square;
    const int indices = square.addView(bytesOf<std::uint8_t>({1, 2}));
    const int values = square.addView(bytesOf<float>({3, 0, 0, 3, 1, 0}));
    const json whole = {{"count", 2},
                        {"indices", {{"bufferView", indices}, {"componentType", kUnsignedByte}}},
                        {"values", {{"bufferView", values}}}};
    const auto expectSparseError = [&](const std::string& pointer, const json& value, const std::string& part) {
        square["/accessors/0/sparse"] = whole;
        square["/accessors/0/sparse" + pointer] = value;
        expectError(square, part);
    };
    expectSparseError("/count", 3, "/accessors/0/sparse/count: found 3, allowed at most 2 indices");
    expectSparseError("/values/byteOffset", 4, "/accessors/0/sparse/count: found 2, allowed at most 1 values");
    expectSparseError("/count", 4294967296, "/accessors/0/sparse/count: found 4294967296");
    expectSparseError("/indices/componentType", kFloat, "/sparse/indices/componentType: found 5126");
    expectSparseError("/indices/bufferView", 99, "/accessors/0/sparse/indices/bufferView: found 99");
    expectSparseError("/indices", json::object(), "/accessors/0/sparse/indices/bufferView: found nothing");
    square.binary[60] = 2; // 2, 2: not ascending
    expectSparseError("/count", 2, "/accessors/0/sparse/indices: found index 2 as element 1, allowed ascending");
    square.binary[60] = 1;
    square.binary[61] = 4;
    expectSparseError("/count", 2, "/accessors/0/sparse/indices: found index 4 as element 1");
}

TEST_F(GltfGeometry, AnAccessorWithoutMemoryIsNoLargerThanTheBuffers) {
    Square square;
    square["/accessors/0"].erase("bufferView");
    square["/accessors/0/count"] = 4000000000;
    expectError(square, "/accessors/0/count: found 4000000000, allowed at most 60 without a buffer view");
    square["/accessors/0/count"] = 4;
    expectError(square, "found no usable polygon among 2");
}

TEST_F(GltfGeometry, VertexColoursAreTints) {
    const auto tintOf = [&](const std::string& bytes, int type, const char* shape, bool normalised) {
        Square square;
        square["/meshes/0/primitives/0/attributes/COLOR_0"] = square.addAccessor(bytes, type, shape, 4, normalised);
        const Scene scene = read(square).scene;
        EXPECT_NE(scene.polygons[0].surface, kNone);
        return scene.surfaces[scene.polygons[0].surface].tint[1];
    };
    EXPECT_EQ(tintOf(bytesOf<float>({1, 1, 1, .5F, .25F, 0, 1, 1, 1, 1, 1, 1}), kFloat, "VEC3", false),
              Rgb(0.5F, 0.25F, 0.0F));
    EXPECT_EQ(tintOf(bytesOf<std::uint8_t>({0, 0, 0, 255, 255, 51, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}), kUnsignedByte,
                     "VEC4", true),
              Rgb(1.0F, 0.2F, 0.0F));
    EXPECT_EQ(
        tintOf(bytesOf<std::uint16_t>({0, 0, 0, 65535, 13107, 0, 0, 0, 0, 0, 0, 0}), kUnsignedShort, "VEC3", true),
        Rgb(1.0F, 0.2F, 0.0F));
}

TEST_F(GltfGeometry, WhiteVertexColoursCostNothing) {
    Square square;
    square["/meshes/0/primitives/0/attributes/COLOR_0"] =
        square.addAccessor(bytesOf<float>(std::vector<float>(12, 1.0F)), kFloat, "VEC3", 4);
    EXPECT_TRUE(read(square).scene.surfaces.empty());
}

TEST_F(GltfGeometry, RejectsVertexColoursThatDoNotFit) {
    Square square;
    auto& colours = square["/meshes/0/primitives/0/attributes/COLOR_0"];
    colours = square.addAccessor(bytesOf<float>(std::vector<float>(9, 1.0F)), kFloat, "VEC3", 3);
    expectError(square, "/attributes/COLOR_0: found 3 elements, allowed 4, as in POSITION");
    colours = 1;
    expectError(square, "/accessors/1: found UNSIGNED_SHORT SCALAR, allowed FLOAT or normalised");
}

TEST_F(GltfGeometry, InstancesAreCopiesOfOneNode) {
    Square square;
    const float half = std::sqrt(0.5F);
    const int translations = square.addAccessor(bytesOf<float>({0, 0, 0, 0, 0, 5}), kFloat, "VEC3", 2);
    const int rotations = square.addAccessor(
        bytesOf<std::int16_t>({0, 0, 0, 32767, 0, 0, static_cast<std::int16_t>(half * 32767), 23170}), kShort, "VEC4",
        2, true);
    const int scales = square.addAccessor(bytesOf<float>({1, 1, 1, -2, 3, 1}), kFloat, "VEC3", 2);
    square["/nodes/0/translation"] = {10, 0, 0};
    square["/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes"] = {
        {"TRANSLATION", translations}, {"ROTATION", rotations}, {"SCALE", scales}};
    square["/extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    const Scene scene = read(square).scene;
    ASSERT_EQ(scene.polygons.size(), 4U);
    EXPECT_EQ(scene.nodes.size(), 1U);
    EXPECT_NEAR(totalArea(scene), 1.0 + 6.0, 1e-3); // rotations of 16 bits
    for (const Polygon& polygon : scene.polygons) EXPECT_GT(areaVector(scene, polygon).z, 0.0F);
    // Local (1, 0, 0) is scaled to (-2, 0, 0), turned by 90 degrees to (0, -2, 0), and moved by (10, 0, 5).
    EXPECT_NEAR(glm::distance(corner(scene, scene.polygons[2], 2), glm::vec3(10, -2, 5)), 0.0F, 1e-3F);
}

TEST_F(GltfGeometry, RejectsInstancesThatDoNotFit) {
    const std::string attributes = "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes";
    Square square;
    const int two = square.addAccessor(bytesOf<float>({0, 0, 0, 0, 0, 5}), kFloat, "VEC3", 2);
    square[attributes] = {{"TRANSLATION", two}, {"SCALE", 0}};
    expectError(square, attributes + "/SCALE: found 4 elements, allowed 2");
    square[attributes] = {{"ROTATION", two}};
    expectError(square, "found FLOAT VEC3, allowed FLOAT or normalised BYTE or SHORT VEC4");
    square[attributes] = {{"TRANSLATION", 99}};
    expectError(square, attributes + "/TRANSLATION: found 99");
    square["/nodes/0/extensions/EXT_mesh_gpu_instancing"] = json::object();
    expectError(square, attributes + ": found nothing, allowed an object");
}

TEST_F(GltfGeometry, ABillionInstancesAreRefusedBeforeTheFirst) {
    Square square;
    square[("/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes")] = {{"TRANSLATION", 2}};
    square["/accessors/2"] = {{"componentType", kFloat}, {"type", "VEC3"}, {"count", 1000000000}};
    expectError(square, "/accessors/2/count: found 1000000000, allowed at most 60");
    // With memory for them, but too many triangles.
    square["/accessors/2"] = {{"componentType", kFloat}, {"type", "VEC3"}, {"count", 9000}};
    square["/meshes/0/primitives/0/indices"] =
        square.addAccessor(bytesOf<std::uint16_t>(std::vector<std::uint16_t>(27000)), kUnsignedShort, "SCALAR", 27000);
    expectError(square, "/nodes/0: found 9000 copies of a mesh of 9000 triangles after 0 others, allowed at most 1");
}

TEST_F(GltfGeometry, AMeshInManyNodesCountsInEach) {
    Square square;
    square["/nodes"] = {{{"mesh", 0}}, {{"mesh", 0}}, {{"mesh", 0}}};
    square["/scenes/0/nodes"] = {0, 1, 2};
    EXPECT_EQ(read(square, {.mostPolygons = 6}).scene.polygons.size(), 6U);
    try {
        read(square, {.mostPolygons = 5});
        ADD_FAILURE() << "no error";
    } catch (const InputError& error) {
        const std::string part = "/nodes/2: found 1 copies of a mesh of 2 triangles after 4 others, allowed at most 5";
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
}

TEST_F(GltfGeometry, NamesTheScenesThatItDoesNotRead) {
    Square square;
    square["/scene"] = 1;
    square["/scenes"] = {{{"name", "first"}, {"nodes", {0}}}, {{"nodes", {1}}}, {{"nodes", {0}}}};
    square["/nodes/1"] = {{"name", "other"}, {"mesh", 0}};
    const ReadResult result = read(square);
    EXPECT_EQ(result.scene.nodes, std::vector<std::string>{"other"});
    EXPECT_TRUE(hasWarning(result, "scene 1 of 3 is read, the others are not: \"first\", 2"));
}

TEST_F(GltfGeometry, SharesTheVerticesOfACopyButNotBetweenCopies) {
    Square square;
    square["/meshes/0/primitives/1"] = square["/meshes/0/primitives/0"];
    square["/nodes/1"] = {{"mesh", 0}};
    square["/scenes/0/nodes"] = {0, 1};
    EXPECT_EQ(read(square).scene.positions.size(), 8U);
}

TEST_F(GltfGeometry, ReadsNoBufferOutsideTheFolderUnlessAllowed) {
    Square square;
    folder.write("square.bin", square.binary);
    square["/buffers/0/uri"] = "../square.bin";
    const auto scene = folder.write("inside/scene.gltf", square.document.dump());
    expectInputError(scene, "/buffers/0/uri: \"../square.bin\" lies outside the scene's folder");
    EXPECT_EQ(totalArea(readScene(scene, {.allowOutsideFiles = true}).scene), 1.0);
}

TEST_F(GltfGeometry, AZeroByteDoesNotCutAName) {
    Square square;
    folder.write("square.bin", square.binary);
    for (const std::string& uri : {std::string("square.bin%00.txt"), std::string("square.bin\0.txt", 15)}) {
        square["/buffers/0/uri"] = uri;
        expectInputError(folder.write("scene.gltf", square.document.dump()), "allowed the name of a file that exists");
    }
}

} // namespace
} // namespace lambert
