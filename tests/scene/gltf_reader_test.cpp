#include "gltf_test.h"

#include <glm/gtc/constants.hpp>

#include <cmath>

namespace lambert {
namespace {

using nlohmann::json;

using GltfReader = GltfTest;

TEST_F(GltfReader, ReadsGlbDataUriAndExternalBufferAlike) {
    Square square;
    std::vector<Scene> scenes = {read(square).scene};
    for (const std::string& uri : {"data:application/octet-stream;base64," + base64(square.binary),
                                   "data:application/gltf-buffer;base64," + base64(square.binary),
                                   "data:;base64," + base64(square.binary + "more"), std::string("a%20b+c.bin")}) {
        square["/buffers/0/uri"] = uri;
        folder.write("a b+c.bin", square.binary + "more than the buffer needs");
        scenes.push_back(readScene(folder.write("scene.gltf", square.document.dump(2))).scene);
    }
    for (const Scene& scene : scenes) {
        ASSERT_EQ(scene.polygons.size(), 2U);
        EXPECT_EQ(scene.polygons[0].vertices, (std::array<std::uint32_t, 4>{0, 1, 2, kNone}));
        EXPECT_EQ(scene.polygons[1].vertices, (std::array<std::uint32_t, 4>{0, 2, 3, kNone}));
        EXPECT_EQ(scene.positions.size(), 4U);
        EXPECT_EQ(scene.nodes, std::vector<std::string>{"square"});
        EXPECT_EQ(scene.materials[0].name, "white");
        EXPECT_EQ(scene.materials[0].reflectance, Rgb(0.5F, 0.25F, 0.125F));
        EXPECT_FALSE(scene.materials[0].twoSided);
        EXPECT_EQ(totalArea(scene), 1.0);
    }
}

TEST_F(GltfReader, ReadsIndicesOfAllSizesAndNone) {
    for (const int type : {5121, 5125}) {
        Square square;
        square.binary.resize(48);
        square.binary +=
            type == 5121 ? bytesOf<std::uint8_t>({0, 1, 2, 0, 2, 3}) : bytesOf<std::uint32_t>({0, 1, 2, 0, 2, 3});
        square["/accessors/1/componentType"] = type;
        square["/bufferViews/1/byteLength"] = square.binary.size() - 48;
        square["/buffers/0/byteLength"] = square.binary.size();
        EXPECT_EQ(totalArea(read(square).scene), 1.0);
    }
    Square square;
    square["/meshes/0/primitives/0"].erase("indices");
    square["/accessors/0/count"] = 3;
    EXPECT_EQ(totalArea(read(square).scene), 0.5);
}

TEST_F(GltfReader, ReadsInterleavedPositions) {
    Square square;
    square.binary = bytesOf<float>({9, 0, 0, 0, 9, 1, 0, 0, 9, 1, 1, 0, 9, 0, 1, 0}) + square.binary.substr(48);
    square["/bufferViews/0"] = {{"buffer", 0}, {"byteLength", 64}, {"byteStride", 16}};
    square["/accessors/0/byteOffset"] = 4;
    square["/bufferViews/1/byteOffset"] = 64;
    square["/buffers/0/byteLength"] = 76;
    EXPECT_EQ(totalArea(read(square).scene), 1.0);
}

TEST_F(GltfReader, StripsAndFansKeepTheFront) {
    for (const int mode : {5, 6}) {
        Square square;
        const std::vector<std::uint16_t> order =
            mode == 5 ? std::vector<std::uint16_t>{0, 1, 3, 2} : std::vector<std::uint16_t>{0, 1, 2, 3};
        square.binary = square.binary.substr(0, 48) + bytesOf(order);
        square["/accessors/1/count"] = 4;
        square["/bufferViews/1/byteLength"] = 8;
        square["/buffers/0/byteLength"] = 56;
        square["/meshes/0/primitives/0/mode"] = mode;
        const Scene scene = read(square).scene;
        ASSERT_EQ(scene.polygons.size(), 2U);
        for (const Polygon& polygon : scene.polygons) EXPECT_EQ(areaVector(scene, polygon), glm::vec3(0, 0, 0.5F));
    }
}

TEST_F(GltfReader, ComposesTransformsAlongTheHierarchyAndFlipsMirroredFaces) {
    Square square;
    const double half = std::sqrt(0.5);
    square["/scenes/0/nodes"] = {3, 1};
    square["/nodes"] = {{{"name", "a"}, {"mesh", 0}, {"scale", {-2, 1, 1}}},
                        {{"children", {0}}, {"translation", {0, 0, 5}}, {"rotation", {0, 0, half, half}}},
                        {{"mesh", 0}},
                        {{"children", {2}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1}}}};
    square["/meshes/0/name"] = "mesh";
    const Scene scene = read(square).scene;
    ASSERT_EQ(scene.polygons.size(), 4U);
    EXPECT_EQ(scene.nodes, (std::vector<std::string>{"mesh", "a"}));
    EXPECT_EQ(corner(scene, scene.polygons[0], 0), glm::vec3(7, 8, 9));
    for (const Polygon& polygon : scene.polygons) EXPECT_GT(areaVector(scene, polygon).z, 0.0F);
    // Local (1, 0, 0) is scaled to (-2, 0, 0), turned by 90 degrees to (0, -2, 0) and moved up by 5.
    const glm::vec3 moved = corner(scene, scene.polygons[2], 2);
    EXPECT_NEAR(glm::distance(moved, glm::vec3(0, -2, 5)), 0.0F, 1e-6F);
    EXPECT_NEAR(totalArea(scene), 3.0, 1e-6);
}

TEST_F(GltfReader, ReadsAHierarchyThatIsAHundredThousandNodesDeep) {
    Square square;
    json nodes = json::array();
    constexpr int kDepth = 100000;
    for (int k = 0; k + 1 < kDepth; ++k) nodes.push_back({{"children", {k + 1}}});
    nodes.push_back({{"mesh", 0}});
    square["/nodes"] = nodes;
    EXPECT_EQ(read(square).scene.nodes[0], "node_99999");
}

TEST_F(GltfReader, TakesTheFirstSceneOrAllRootsWhereNoneIsChosen) {
    Square square;
    square.document.erase("scene");
    square["/scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
    square["/nodes/1"] = {{"name", "other"}, {"mesh", 0}};
    EXPECT_EQ(read(square).scene.nodes, std::vector<std::string>{"square"});
    square.document.erase("scenes");
    square["/nodes/2"] = {{"children", {0}}};
    EXPECT_EQ(read(square).scene.nodes, (std::vector<std::string>{"other", "square"}));
}

TEST_F(GltfReader, ReadsMaterials) {
    Square square;
    square["/materials/0"] = {
        {"doubleSided", true},
        {"emissiveFactor", {1, 0.5, 0}},
        {"pbrMetallicRoughness", {{"metallicFactor", 0.5}}},
        {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 5000000000}}}}}};
    square["/materials/1"] = json::object();
    square["/extensionsRequired"] = {"KHR_materials_emissive_strength"};
    const ReadResult result = read(square);
    const Material& material = result.scene.materials[0];
    EXPECT_EQ(material.name, "material_0");
    EXPECT_EQ(material.reflectance, Rgb(0.5F));
    EXPECT_EQ(material.emittedRadiance, Rgb(5e9F, 2.5e9F, 0));
    EXPECT_TRUE(material.twoSided);
    EXPECT_EQ(result.scene.materials[1].reflectance, Rgb(0.0F));
    EXPECT_TRUE(hasWarning(result, "material \"material_1\": is fully metallic"));
    EXPECT_EQ(result.report.warnings.size(), 1U);

    square["/meshes/0/primitives/0"].erase("material");
    const Scene scene = read(square).scene;
    EXPECT_EQ(scene.materials[scene.polygons[0].material].name, "default");
    EXPECT_EQ(scene.materials[scene.polygons[0].material].reflectance, Rgb(0.5F));
}

TEST_F(GltfReader, ReadsPerspectiveCamerasThroughTheirNodes) {
    Square square;
    const double half = std::sqrt(0.5);
    square["/cameras"] = {
        {{"type", "perspective"}, {"name", "front"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}},
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 1}, {"znear", 0}}}}};
    square["/nodes/0/camera"] = 1;
    square["/nodes/1"] = {{"camera", 0}, {"translation", {1, 2, 3}}, {"rotation", {0, half, 0, half}}};
    square["/scenes/0/nodes"] = {0, 1};
    const ReadResult result = read(square);
    ASSERT_EQ(result.scene.cameras.size(), 1U);
    const Camera& camera = result.scene.cameras[0];
    EXPECT_EQ(camera.name, "front");
    EXPECT_EQ(camera.eye, glm::vec3(1, 2, 3));
    EXPECT_NEAR(glm::distance(camera.direction, glm::vec3(-1, 0, 0)), 0.0F, 1e-6F);
    EXPECT_NEAR(glm::distance(camera.up, glm::vec3(0, 1, 0)), 0.0F, 1e-6F);
    EXPECT_EQ(camera.verticalFov, 0.5F);
    EXPECT_TRUE(hasWarning(result, "orthographic camera \"square\""));
}

TEST_F(GltfReader, LooksAtNothingThatTheSceneDoesNotUse) {
    Square square;
    square["/images"] = {{{"uri", "none.png"}}, {{"bufferView", 99}}};
    square["/textures"] = {{{"source", 0}}, {{"source", 99}}};
    square["/animations"] = {1, 2};
    square["/extensions/X_new"] = 5;
    square["/extensionsUsed"] = {"X_new"};
    square["/extras"] = {{"a", 1}};
    const ReadResult result = read(square);
    EXPECT_EQ(result.scene.polygons.size(), 2U);
    EXPECT_TRUE(result.report.warnings.empty());
}

TEST_F(GltfReader, IgnoresPointsAndLinesWithAWarning) {
    Square square;
    square["/meshes/0/primitives/1"] = {{"attributes", {{"POSITION", 0}}}, {"mode", 0}};
    square["/meshes/0/primitives/2"] = {{"attributes", {{"POSITION", 0}}}, {"mode", 3}};
    EXPECT_TRUE(hasWarning(read(square), "2 primitives of points or lines"));
}

TEST_F(GltfReader, AddsOnlyVerticesThatAreUsed) {
    Square square;
    square.binary = square.binary.substr(0, 48) + bytesOf<std::uint16_t>({1, 2, 3, 1, 2, 3});
    EXPECT_EQ(read(square).scene.positions.size(), 3U);
}

TEST_F(GltfReader, DropsTrianglesThatATransformMakesInfinite) {
    Square square;
    square["/nodes/1"] = {{"mesh", 0}, {"scale", {1e300, 1e300, 1}}};
    square["/scenes/0/nodes"] = {0, 1};
    const ReadResult result = read(square);
    EXPECT_EQ(result.scene.polygons.size(), 2U);
    EXPECT_EQ(result.report.nonFinitePolygons, 2U);
}

TEST_F(GltfReader, RefusesAUnit) {
    EXPECT_THROW(readScene(folder.write("scene.glb", "x"), {.metresPerUnit = 0.01}), UsageError);
}

TEST_F(GltfReader, RejectsAccessorsThatReachPastTheirMemory) {
    expectErrorAt("/accessors/0/count", "5",
                  "/accessors/0/count: found 5, allowed at most 4 (bufferView 0 has 48 bytes)");
    expectErrorAt("/accessors/0/count", "18446744073709551615", "/accessors/0/count: found 18446744073709551615");
    expectErrorAt("/accessors/0/byteOffset", "18446744073709551612", "/accessors/0/count: found 4, allowed at most 0");
    expectErrorAt("/accessors/0/byteOffset", "4", "/accessors/0/count: found 4, allowed at most 3");
    expectErrorAt("/bufferViews/0/byteStride", "16", "/accessors/0/count: found 4, allowed at most 3");
    expectErrorAt("/bufferViews/0/byteStride", "8", "/bufferViews/0/byteStride: found 8, allowed at least 12");
    expectErrorAt("/bufferViews/0/byteLength", "61", "/bufferViews/0/byteLength: found 61, allowed at most 60");
    expectErrorAt("/bufferViews/0/byteLength", "18446744073709551615", "/bufferViews/0/byteLength: found");
    expectErrorAt("/bufferViews/1/byteOffset", "18446744073709551615", "/bufferViews/1/byteOffset: found");
    expectErrorAt("/bufferViews/1/byteOffset", "52", "/bufferViews/1/byteLength: found 12, allowed at most 8");
    expectErrorAt("/buffers/0/byteLength", "61", "/buffers/0/byteLength: found 61, allowed 1 to 60");
    expectErrorAt("/buffers/0/byteLength", "0", "/buffers/0/byteLength: found 0");
}

TEST_F(GltfReader, RejectsIndicesOutOfRangeWithTheirPath) {
    expectErrorAt("/accessors/0/count", "3", "/accessors/1: found index 3 as element 5, allowed indices below 3");
    expectErrorAt("/accessors/1/bufferView", "2", "/accessors/1/bufferView: found 2, allowed 0 to 1");
    expectErrorAt("/accessors/0/bufferView", "2", "/accessors/0/bufferView: found 2, allowed 0 to 1");
    expectErrorAt("/bufferViews/0/buffer", "1", "/bufferViews/0/buffer: found 1, allowed 0 to 0");
    expectErrorAt("/scene", "1", "/scene: found 1, allowed 0 to 0");
    expectErrorAt("/scenes/0/nodes/0", "4294967296", "/scenes/0/nodes/0: found 4294967296");
    expectErrorAt("/scenes/0/nodes/0", "1", "/scenes/0/nodes/0: found 1, allowed a node below 1");
    expectErrorAt("/scenes/0/nodes/0", "-1", "/scenes/0/nodes/0: found -1");
    expectErrorAt("/nodes/0/mesh", "1", "/nodes/0/mesh: found 1");
    expectErrorAt("/nodes/0/camera", "0", "/nodes/0/camera: found 0");
    expectErrorAt("/nodes/0/children", "[5]", "/nodes/0/children/0: found 5");
    expectErrorAt("/meshes/0/primitives/0/material", "1", "/meshes/0/primitives/0/material: found 1");
    expectErrorAt("/meshes/0/primitives/0/attributes/POSITION", "2", "/attributes/POSITION: found 2, allowed 0 to 1");
    expectErrorAt("/meshes/0/primitives/0/mode", "7", "/meshes/0/primitives/0/mode: found 7, allowed 0 to 6");
}

TEST_F(GltfReader, RejectsCyclesAndSecondParents) {
    expectErrorAt("/nodes/0/children", "[0]", "/nodes/0/children/0: found node 0 again");
    expectErrorAt("/nodes", R"([{"children": [1]}, {"children": [0], "mesh": 0}])",
                  "/nodes/1/children/0: found node 0");
    expectErrorAt("/nodes", R"([{"children": [1, 2]}, {"children": [2]}, {"mesh": 0}])", "found node 2 again");
    expectErrorAt("/scenes/0/nodes", "[0, 0]", "/scenes/0/nodes/1: found node 0 again");
}

TEST_F(GltfReader, RejectsMembersOfAWrongTypeWithTheirPath) {
    expectErrorAt("/accessors/0/componentType", "5125", "/accessors/0: found UNSIGNED_INT VEC3, allowed FLOAT VEC3");
    expectErrorAt("/accessors/0/type", "\"VEC2\"", "/accessors/0: found FLOAT VEC2");
    expectErrorAt("/accessors/1/componentType", "5122", "/accessors/1: found SHORT SCALAR");
    expectErrorAt("/accessors/1/componentType", "5126", "/accessors/1: found FLOAT SCALAR");
    expectErrorAt("/accessors/0/count", "4.5", "/accessors/0/count: found 4.5, allowed an integer");
    expectErrorAt("/accessors/1/count", "4", "/meshes/0/primitives/0: found triangles with 4 corners");
    expectErrorAt("/meshes/0/primitives/0/indices", "\"1\"", "/meshes/0/primitives/0/indices: found \"1\"");
    expectErrorAt("/meshes/0/primitives/0/attributes", "{}", "/attributes/POSITION: found nothing");
    expectErrorAt("/meshes/0/primitives/0", "{}", "/meshes/0/primitives/0/attributes: found nothing");
    expectErrorAt("/meshes/0", "[]", "/meshes/0: found [], allowed an object");
    expectErrorAt("/nodes", "{}", "/nodes: found an object, allowed an array");
    expectErrorAt("/nodes/0/matrix", "[1, 2, 3]", "/nodes/0/matrix: found [1,2,3], allowed 16 numbers");
    expectErrorAt("/nodes/0/rotation", "[0, 0, 0, 0]", "/nodes/0/rotation: found 0 0 0 0");
    expectErrorAt("/nodes/0/scale", "[1, null, 1]", "/nodes/0/scale: found [1,null,1], allowed 3 numbers");
    expectErrorAt("/asset/version", "\"1.0\"", "/asset/version: found \"1.0\", allowed 2.x");
    expectErrorAt("/asset", "{\"version\": 1.0}", "/asset/version: found \"1.0\", allowed 2.x");
    expectErrorAt("/asset", "{}", "/asset/version: found nothing");
    // Lists of glTF 1.0 are objects, which would be errors too.
    expectInputError(folder.write("scene.gltf", R"({"asset": {"version": "1.0"}, "meshes": {}, "nodes": {}})"),
                     "/asset/version: found \"1.0\", allowed 2.x: this is another version of glTF");
    expectErrorAt("/materials/0/emissiveFactor", "[1, 1]", "/materials/0/emissiveFactor: found [1,1]");
    expectErrorAt("/materials/0/emissiveFactor", "[1, -1, 1]", "/materials/0/emissiveFactor/1: found -1");
    expectErrorAt("/materials/0/pbrMetallicRoughness/metallicFactor", "2", "/metallicFactor: found 2, allowed 0 to 1");
    expectErrorAt("/materials/0/pbrMetallicRoughness/baseColorFactor/2", "-0.5", "baseColorFactor/2: found -0.5");
    expectErrorAt("/materials/0/extensions", R"({"KHR_materials_emissive_strength": {"emissiveStrength": 1e60}})",
                  "emissiveStrength: found 1e+60");
    expectErrorAt("/materials/0/extensions", R"({"KHR_materials_emissive_strength": {"emissiveStrength": "1"}})",
                  "/emissiveStrength: found \"1\", allowed a number");
    Square camera;
    camera["/cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 4}, {"znear", 0.1}}}}};
    camera["/nodes/0/camera"] = 0;
    expectError(camera, "/cameras/0/perspective/yfov: found 4");
}

TEST_F(GltfReader, RejectsValuesThatTheFormatDoesNotHaveEvenWhereNothingUsesThem) {
    expectErrorAt("/accessors/2", R"({"componentType": 5126, "count": 1, "type": "VEC5"})",
                  "/accessors/2/type: found \"VEC5\", allowed SCALAR, VEC2 to VEC4 or MAT2 to MAT4");
    for (const std::string type : {"5119", "5131", "\"5126\""})
        expectErrorAt("/accessors/2", R"({"count": 1, "type": "VEC3", "componentType": )" + type + "}",
                      "/accessors/2/componentType: found " + type + ", allowed an integer of 5120 to 5130");
    for (const std::string stride : {"14", "256", "4294967296"})
        expectErrorAt("/bufferViews/2", R"({"buffer": 0, "byteLength": 1, "byteStride": )" + stride + "}",
                      "/bufferViews/2/byteStride: found " + stride + ", allowed a multiple of 4 from 0 to 252");
    expectErrorAt("/cameras/0", R"({"type": "fisheye"})",
                  "/cameras/0/type: found \"fisheye\", allowed \"perspective\" or \"orthographic\"");
    expectErrorAt("/cameras/0", R"({"type": "perspective"})",
                  "/cameras/0/perspective: found nothing, allowed an object: the type is \"perspective\"");
    expectErrorAt("/cameras/0", R"({"type": "orthographic", "perspective": {"yfov": 1, "znear": 1}})",
                  "/cameras/0/orthographic: found nothing, allowed an object");
    expectErrorAt("/cameras/0", R"({"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "zfar": 2}})",
                  "/cameras/0/orthographic/znear: found nothing, allowed a number");
    expectErrorAt("/extensions/KHR_lights_punctual/lights/0", R"({"type": "spot"})",
                  "/extensions/KHR_lights_punctual/lights/0/spot: found nothing, allowed an object");

    Square square; // of doubles, which an extension has
    square["/accessors/2"] = {{"componentType", 5130}, {"count", 1}, {"type", "MAT4"}};
    EXPECT_EQ(totalArea(read(square).scene), 1.0);
    square["/meshes/0/primitives/0/attributes/POSITION"] = 2;
    expectError(square, "/accessors/2: found 5130 MAT4, allowed FLOAT VEC3");
}

TEST_F(GltfReader, RefusesRequiredExtensionsThatItDoesNotKnowByName) {
    for (const char* name : {"X_new", "MSFT_lod", "KHR_materials_diffuse_transmission"})
        expectErrorAt("/extensionsRequired", json{name}.dump(),
                      std::string("/extensionsRequired/0: found \"") + name + "\"");
}

TEST_F(GltfReader, RejectsBuffersThatCannotBeRead) {
    Square square;
    const auto expectUriError = [&](const json& uri, const std::string& part) {
        square["/buffers/0/uri"] = uri;
        expectInputError(folder.write("scene.gltf", square.document.dump()), part);
    };
    expectUriError("none.bin", "/buffers/0/uri: found \"none.bin\", allowed the name of a file that exists");
    expectUriError("", "/buffers/0/uri: found \"\"");
    expectUriError(".", "/buffers/0/uri: found \".\"");
    expectUriError(7, "/buffers/0/uri: found 7, allowed a string");
    expectUriError("data:text/plain,abc", "/buffers/0/uri: found \"data:text/plain,abc\"");
    expectUriError("data:application/octet-stream;base64,AAAA", "/buffers/0/byteLength: found 60, allowed 1 to 3");
    expectUriError("data:application/octet-stream;base64," + std::string(80, '!'), "scene.gltf: ");
    folder.write("short.bin", "short");
    expectUriError("short.bin", "/buffers/0/byteLength: found 60, allowed 1 to 5");
    square["/buffers/0"].erase("uri");
    expectInputError(folder.write("scene.gltf", square.document.dump()), "/buffers/0/uri: found nothing");
}

TEST_F(GltfReader, RejectsBrokenContainersAndText) {
    const Square square;
    const std::string whole = glb(square.document, square.binary);
    expectInputError(folder.write("scene.glb", "glTF"), "found 4 bytes, a .glb has at least 20");
    expectInputError(folder.write("scene.glb", whole.substr(0, whole.size() - 1)), "is the file cut?");
    std::string broken = whole;
    broken[4] = 1;
    expectInputError(folder.write("scene.glb", broken), "found glTF binary version 1");
    broken = whole;
    broken[15] = 0x7F;
    expectInputError(folder.write("scene.glb", broken), "the chunk at byte 12 has length");
    broken = whole;
    broken[16] = 'X';
    expectInputError(folder.write("scene.glb", broken), "its first chunk is not JSON");
    broken = whole;
    broken[whole.size() - 60 - 8] = 64; // the length of the binary chunk
    expectInputError(folder.write("scene.glb", broken), "has length 64, allowed at most 60");

    expectInputError(folder.write("scene.gltf", "{\n\"asset\": }"), "not JSON: parse error at line 2");
    expectInputError(folder.write("scene.gltf", "[]"), "found JSON that is not an object");
    expectInputError(folder.write("scene.gltf", R"({"asset": {"version": "2.0"}, "scene": 1e999})"), "not JSON");
    expectInputError(folder.write("scene.gltf", "{\"a\": \"\xff\"}"), "not JSON");
    expectInputError(folder.write("scene.gltf", "{}"), "/asset: found nothing");
    expectInputError(folder.write("scene.gltf", R"({"asset": {"version": "2.0"}})"), "found no polygons");
    expectInputError(folder.write("scene.gltf", ""), "the file is empty");
    expectInputError(folder.write("scene.gltf", "{\"extras\": " + std::string(1000000, '[')), "nested deeper than 64");
    expectInputError(folder.path() / "none.glb", "none.glb: no such file");
}

} // namespace
} // namespace lambert
