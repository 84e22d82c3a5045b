#include "gltf_test.h"

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#include <meshoptimizer.h>

#include <random>

namespace lambert {
namespace {

using nlohmann::json;
using GltfMeshopt = GltfTest;
using GltfDraco = GltfTest;

constexpr int kGrid = 12; //!< squares along an edge

/// A flat grid of unit squares.
struct Grid {
    std::vector<float> positions;
    std::vector<std::uint32_t> indices;

    Grid() {
        for (int y = 0; y <= kGrid; ++y)
            for (int x = 0; x <= kGrid; ++x)
                for (const int value : {x, y, 0}) positions.push_back(static_cast<float>(value));
        for (std::uint32_t y = 0; y < kGrid; ++y)
            for (std::uint32_t x = 0; x < kGrid; ++x) {
                const std::uint32_t a = y * (kGrid + 1) + x, b = a + kGrid + 1;
                for (const std::uint32_t index : {a, a + 1, b + 1, a, b + 1, b}) indices.push_back(index);
            }
    }
    std::size_t vertexCount() const { return positions.size() / 3; }
    double area() const { return kGrid * kGrid; }
};

// meshoptimizer

template <typename Encode>
std::string encoded(std::size_t bound, Encode&& encode) {
    std::string bytes(bound, '\0');
    bytes.resize(encode(reinterpret_cast<unsigned char*>(bytes.data()), bytes.size()));
    return bytes;
}

std::string encodedVertices(const void* vertices, std::size_t count, std::size_t size) {
    return encoded(meshopt_encodeVertexBufferBound(count, size), [&](unsigned char* bytes, std::size_t length) {
        return meshopt_encodeVertexBuffer(bytes, length, vertices, count, size);
    });
}

std::string encodedIndices(const std::vector<std::uint32_t>& indices, std::size_t vertices, bool asTriangles) {
    return asTriangles ? encoded(meshopt_encodeIndexBufferBound(indices.size(), vertices),
                                 [&](unsigned char* bytes, std::size_t length) {
                                     return meshopt_encodeIndexBuffer(bytes, length, indices.data(), indices.size());
                                 })
                       : encoded(meshopt_encodeIndexSequenceBound(indices.size(), vertices),
                                 [&](unsigned char* bytes, std::size_t length) {
                                     return meshopt_encodeIndexSequence(bytes, length, indices.data(), indices.size());
                                 });
}

/// Makes a view that is compressed into these bytes, beside an uncompressed buffer without data.
int addCompressed(Square& square, const std::string& bytes, std::size_t count, std::size_t stride,
                  const std::string& mode, const std::string& extension = "EXT_meshopt_compression") {
    const int view = square.addView(bytes);
    json& target = square["/bufferViews/" + std::to_string(view)];
    const json source = target;
    target = {{"buffer", 1}, {"byteLength", count * stride}};
    target["extensions"][extension] = {{"buffer", 0},
                                       {"byteOffset", source["byteOffset"]},
                                       {"byteLength", bytes.size()},
                                       {"byteStride", stride},
                                       {"count", count},
                                       {"mode", mode}};
    square["/buffers/1"] = {{"byteLength", 1000000}, {"extensions", {{extension, {{"fallback", true}}}}}};
    return view;
}

Square compressedGrid(const Grid& grid, bool asTriangles, const std::string& extension = "EXT_meshopt_compression") {
    Square square;
    square["/extensionsRequired"] = {extension};
    const int positions = addCompressed(square, encodedVertices(grid.positions.data(), grid.vertexCount(), 12),
                                        grid.vertexCount(), 12, "ATTRIBUTES", extension);
    const int indices =
        addCompressed(square, encodedIndices(grid.indices, grid.vertexCount(), asTriangles), grid.indices.size(),
                      asTriangles ? 2 : 4, asTriangles ? "TRIANGLES" : "INDICES", extension);
    square["/accessors/0/bufferView"] = positions;
    square["/accessors/0/count"] = grid.vertexCount();
    square["/accessors/1"] = {{"bufferView", indices},
                              {"componentType", asTriangles ? 5123 : 5125},
                              {"type", "SCALAR"},
                              {"count", grid.indices.size()}};
    return square;
}

TEST_F(GltfMeshopt, TrianglesAndIndexSequencesAreDecompressed) {
    const Grid grid;
    for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
        for (const bool asTriangles : {true, false}) {
            const ReadResult result = read(compressedGrid(grid, asTriangles, extension));
            EXPECT_EQ(result.scene.polygons.size(), grid.indices.size() / 3);
            EXPECT_EQ(totalArea(result.scene), grid.area());
            EXPECT_TRUE(result.report.warnings.empty());
        }
}

TEST_F(GltfMeshopt, FiltersAreUndone) {
    const Grid grid;
    Square square = compressedGrid(grid, true);
    std::vector<std::uint32_t> coded(grid.positions.size());
#if MESHOPTIMIZER_VERSION >= 200
    meshopt_encodeFilterExp(coded.data(), grid.vertexCount(), 12, 20, grid.positions.data(), meshopt_EncodeExpSeparate);
#else
    meshopt_encodeFilterExp(coded.data(), grid.vertexCount(), 12, 20, grid.positions.data());
#endif
    const int view = addCompressed(square, encodedVertices(coded.data(), grid.vertexCount(), 12), grid.vertexCount(),
                                   12, "ATTRIBUTES");
    square["/bufferViews/" + std::to_string(view) + "/extensions/EXT_meshopt_compression/filter"] = "EXPONENTIAL";
    square["/accessors/0/bufferView"] = view;
    EXPECT_NEAR(totalArea(read(square).scene), grid.area(), 1e-3); // 20 bits for each coordinate
}

TEST_F(GltfMeshopt, RotationsOfInstancesAreUnfiltered) {
    const std::vector<float> rotations = {0, 0, 0, 1, 0, 0, 1, 0};
    std::vector<std::int16_t> coded(8);
    meshopt_encodeFilterQuat(coded.data(), 2, 8, 16, rotations.data());
    Square square;
    const int view = addCompressed(square, encodedVertices(coded.data(), 2, 8), 2, 8, "ATTRIBUTES");
    square["/bufferViews/" + std::to_string(view) + "/extensions/EXT_meshopt_compression/filter"] = "QUATERNION";
    square["/accessors/2"] = {
        {"bufferView", view}, {"componentType", 5122}, {"type", "VEC4"}, {"count", 2}, {"normalized", true}};
    square["/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/ROTATION"] = 2;
    const Scene scene = read(square).scene;
    ASSERT_EQ(scene.polygons.size(), 4U);
    // Half a turn around Z brings (1, 1, 0) to (-1, -1, 0); 16 bits for a component.
    EXPECT_NEAR(glm::distance(corner(scene, scene.polygons[2], 2), glm::vec3(-1, -1, 0)), 0.0F, 1e-3F);
}

TEST_F(GltfMeshopt, WhatCannotBeIsRejectedWithItsPath) {
    const std::string view = "/bufferViews/2/extensions/EXT_meshopt_compression";
    const auto expectAt = [&](const std::string& member, const json& value, const std::string& part) {
        Square square = compressedGrid(Grid(), true);
        square[view + member] = value;
        expectError(square, part);
    };
    expectAt("/count", 4000000000, view + "/count: found 4000000000, allowed at most");
    expectAt("/byteLength", 40, view + ": found data that cannot be decompressed");
    expectAt("/byteLength", 4000000000, view + "/byteLength: found 4000000000, allowed at most");
    expectAt("/byteOffset", 1e300, view + "/byteOffset: found 1e+300, allowed an integer");
    expectAt("/byteOffset", 18446744073709551615ULL, view + "/byteOffset: found");
    expectAt("/byteStride", 0, view + "/byteStride: found 0, allowed a multiple of 4");
    expectAt("/byteStride", 260, view + "/byteStride: found 260");
    expectAt("/mode", "SPELLS", view + "/mode: found \"SPELLS\"");
    expectAt("/mode", "TRIANGLES", view + "/byteStride: found 12, allowed 2 or 4");
    expectAt("/filter", "COLOR", view + "/filter: found \"COLOR\"");
    expectAt("/filter", "QUATERNION", view + "/byteStride: found 12, allowed 8");
    expectAt("/buffer", 7, view + "/buffer: found 7");
    expectAt("/buffer", 1, view + "/byteOffset: found"); // the buffer without data
    expectAt("", json::object(), view + "/buffer: found nothing");
}

TEST_F(GltfMeshopt, AViewOfTheBufferWithoutDataIsRejected) {
    Square square = compressedGrid(Grid(), true);
    square["/bufferViews/2"].erase("extensions");
    expectError(square, "/bufferViews/2/byteLength: found 2028, allowed at most 0 (buffer 1 has 0 bytes)");
}

// Draco

/// The grid as Draco's encoder writes it; attribute ids: 0 positions, 1 texture coordinates.
std::string dracoGrid(const Grid& grid, int method) {
    draco::Mesh mesh;
    const auto count = static_cast<std::uint32_t>(grid.vertexCount());
    mesh.set_num_points(count);
    const auto add = [&](draco::GeometryAttribute::Type type, std::int8_t components) {
        draco::GeometryAttribute attribute;
        attribute.Init(type, nullptr, static_cast<std::uint8_t>(components), draco::DT_FLOAT32, false,
                       components * std::int64_t{4}, 0);
        const int id = mesh.AddAttribute(attribute, true, count);
        for (std::uint32_t k = 0; k < count; ++k)
            mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(k), grid.positions.data() + 3 * k);
        return id;
    };
    const int positions = add(draco::GeometryAttribute::POSITION, 3);
    add(draco::GeometryAttribute::TEX_COORD, 2);
    for (std::size_t k = 0; k < grid.indices.size(); k += 3)
        mesh.AddFace({draco::PointIndex(grid.indices[k]), draco::PointIndex(grid.indices[k + 1]),
                      draco::PointIndex(grid.indices[k + 2])});
    draco::ExpertEncoder encoder(mesh);
    encoder.SetEncodingMethod(method);
    encoder.SetAttributeQuantization(positions, 14);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeToBuffer(&buffer).ok());
    return {buffer.data(), buffer.size()};
}

Square dracoSquare(const Grid& grid, const std::string& bytes) {
    Square square;
    const int view = square.addView(bytes);
    square["/extensionsRequired"] = {"KHR_draco_mesh_compression"};
    square["/accessors"] = {{{"componentType", 5126}, {"count", grid.vertexCount()}, {"type", "VEC3"}},
                            {{"componentType", 5123}, {"count", grid.indices.size()}, {"type", "SCALAR"}},
                            {{"componentType", 5126}, {"count", grid.vertexCount()}, {"type", "VEC2"}}};
    square["/meshes/0/primitives/0"] = {
        {"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 2}}},
        {"indices", 1},
        {"material", 0},
        {"extensions",
         {{"KHR_draco_mesh_compression",
           {{"bufferView", view}, {"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}}}}}};
    return square;
}

TEST_F(GltfDraco, BothMethodsAreDecompressed) {
    const Grid grid;
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING})
        for (const int mode : {4, 5}) { // strips too are compressed as triangles
            Square square = dracoSquare(grid, dracoGrid(grid, method));
            square["/meshes/0/primitives/0/mode"] = mode;
            const ReadResult result = read(square);
            EXPECT_EQ(result.scene.polygons.size(), grid.indices.size() / 3);
            EXPECT_NEAR(totalArea(result.scene), grid.area(), 1e-2); // 14 bits for each coordinate
            for (const Polygon& polygon : result.scene.polygons) EXPECT_GT(areaVector(result.scene, polygon).z, 0.0F);
        }
}

TEST_F(GltfDraco, WhatCannotBeIsRejectedWithItsPath) {
    const Grid grid;
    const std::string place = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
    const std::string whole = dracoGrid(grid, draco::MESH_EDGEBREAKER_ENCODING);
    expectError(dracoSquare(grid, whole.substr(0, whole.size() / 2)),
                place + ": found data that cannot be decompressed");
    expectError(dracoSquare(grid, "no Draco at all"), place + ": found data that cannot be decompressed");
    std::string old = whole;
    old[6] = 1;
    expectError(dracoSquare(grid, old), "(Draco bitstream 2.1), allowed a mesh compressed by Draco, bitstream 2.2");
    Square square = dracoSquare(grid, whole);
    square[place + "/attributes/POSITION"] = 9;
    expectError(square, place + "/attributes/POSITION: found 9, allowed the id");
    square[place + "/bufferView"] = 9;
    expectError(square, place + "/bufferView: found 9");
    square[place] = json::object();
    expectError(square, place + "/bufferView: found nothing");
}

TEST_F(GltfDraco, CountsWithoutBytesBehindThemAreRejectedBeforeTheyAreBelieved) {
    const Grid grid;
    // Behind the header of 11 bytes: the traversal's kind, then the numbers of points and triangles, 7 bits a byte.
    for (const std::size_t number : {12, 14}) {
        std::string bytes = dracoGrid(grid, draco::MESH_EDGEBREAKER_ENCODING);
        ASSERT_LT(static_cast<unsigned char>(bytes[number + 1]), 0x80);
        bytes.replace(number, 2, "\xFF\xFF\xFF\xFF\x04");
        expectError(dracoSquare(grid, bytes), "found data that cannot be decompressed");
    }
}

/// Every error is an InputError of one line, whatever byte changes.
class GltfCompressed : public GltfTest {
protected:
    void damage(const Square& whole, std::size_t begin, std::size_t end) {
        std::mt19937 random(7);
        for (int round = 0; round < 400; ++round) {
            Square square = whole;
            for (int k = 0; k < 1 + round % 3; ++k)
                square.binary[begin + random() % (end - begin)] = static_cast<char>(random() % 256);
            SCOPED_TRACE("round " + std::to_string(round) + " of seed 7");
            try {
                read(square);
            } catch (const InputError& error) {
                EXPECT_NE(std::string(error.what()).find("scene.glb: "), std::string::npos) << error.what();
            }
        }
    }
};

TEST_F(GltfCompressed, DamagedMeshoptDataGiveAnErrorOrAMesh) {
    const Square square = compressedGrid(Grid(), true);
    damage(square, 60, square.binary.size());
}

TEST_F(GltfCompressed, DamagedDracoDataGiveAnErrorOrAMesh) {
    const Grid grid;
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        const Square square = dracoSquare(grid, dracoGrid(grid, method));
        damage(square, 60, square.binary.size());
    }
}

} // namespace
} // namespace lambert
