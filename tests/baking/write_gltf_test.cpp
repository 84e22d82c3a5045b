#include "baking/exposure.h"
#include "baking/write_baked.h"
#include "core/error.h"
#include "tests/baking/sample_mesh.h"

#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace lambert {
namespace {

tinygltf::Model readBack(const std::filesystem::path& path) {
    tinygltf::Model model;
    tinygltf::TinyGLTF reader;
    std::string error;
    std::string warning;
    const bool read = path.extension() == ".glb" ? reader.LoadBinaryFromFile(&model, &error, &warning, path.string())
                                                 : reader.LoadASCIIFromFile(&model, &error, &warning, path.string());
    EXPECT_TRUE(read) << error;
    EXPECT_EQ(warning, "");
    return model;
}

template <typename Element>
std::vector<Element> elements(const tinygltf::Model& model, int index) {
    const tinygltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(index)];
    const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
    EXPECT_EQ(view.byteOffset % 4, 0U);
    EXPECT_EQ(view.byteLength, accessor.count * sizeof(Element));
    std::vector<Element> result(accessor.count);
    std::memcpy(result.data(), model.buffers[0].data.data() + view.byteOffset, view.byteLength);
    return result;
}

tinygltf::Model written(const BakedMesh& mesh, const std::string& name, const BakeOutputOptions& options) {
    const std::filesystem::path path = test::temporaryFile(name);
    writeBaked(mesh, path, *formatOf(path), options);
    return readBack(path);
}

BakeOutputOptions optionsOf(Quantity quantity, float exposure) {
    BakeOutputOptions options;
    options.quantity = quantity;
    options.exposure = exposure;
    options.version = "1.2.3";
    return options;
}

class GltfWriter : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(BothContainers, GltfWriter, testing::Values("glb", "gltf"));

TEST_P(GltfWriter, KeepsEveryVertexOfEveryMaterialUsed) {
    const BakedMesh mesh = test::sampleMesh();
    const std::string name = std::string("vertices.") + GetParam();
    const tinygltf::Model model = written(mesh, name, optionsOf(Quantity::Radiosity, 0.5F));
    ASSERT_EQ(model.meshes.size(), 1U);
    ASSERT_EQ(model.meshes[0].primitives.size(), 2U);
    ASSERT_EQ(model.materials.size(), 2U);
    EXPECT_EQ(model.materials[0].name, "wall");
    EXPECT_EQ(model.materials[1].name, "lamp");

    const tinygltf::Primitive& lamp = model.meshes[0].primitives[1];
    EXPECT_EQ(lamp.attributes.count("_IRRADIANCE"), 0U);
    const auto positions = elements<glm::vec3>(model, lamp.attributes.at("POSITION"));
    const auto normals = elements<glm::vec3>(model, lamp.attributes.at("NORMAL"));
    const auto radiosity = elements<glm::vec3>(model, lamp.attributes.at("_RADIOSITY"));
    const auto colours = elements<glm::vec3>(model, lamp.attributes.at("COLOR_0"));
    const auto indices = elements<std::uint32_t>(model, lamp.indices);
    EXPECT_EQ(positions.size(), 5U);
    EXPECT_EQ(indices.size(), 9U);
    for (std::size_t v = 0; v < positions.size(); ++v) {
        EXPECT_EQ(normals[v], glm::vec3(0, 0, 1));
        EXPECT_EQ(radiosity[v], Rgb(31.4F));
        EXPECT_EQ(colours[v], Rgb(1.0F)); // 31.4/π · √2, clamped
        EXPECT_FALSE(std::signbit(positions[v].z));
    }
}

TEST_P(GltfWriter, ColoursAreTheExposedQuantity) {
    const BakedMesh mesh = test::sampleMesh();
    const std::string name = std::string("colours.") + GetParam();
    const tinygltf::Model model = written(mesh, name, optionsOf(Quantity::Irradiance, -1.5F));
    const tinygltf::Primitive& wall = model.meshes[0].primitives[0];
    const auto positions = elements<glm::vec3>(model, wall.attributes.at("POSITION"));
    const auto irradiance = elements<glm::vec3>(model, wall.attributes.at("_IRRADIANCE"));
    const auto colours = elements<glm::vec3>(model, wall.attributes.at("COLOR_0"));
    ASSERT_EQ(positions.size(), 4U);
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const std::size_t source =
            positions[v].y == 0.0F ? (positions[v].x == 0.0F ? 0 : 1) : (positions[v].x == 0.0F ? 3 : 2);
        EXPECT_EQ(irradiance[v], mesh.irradiance[source]);
        EXPECT_EQ(colours[v], displayColour(shownRadiance(mesh, source, Quantity::Irradiance), -1.5F));
    }
}

TEST(GltfWriterDetails, SplitsQuadsWhereLightChangesLess) {
    // The wall's radiosity is nearly the same at its corners 0 and 2.
    const tinygltf::Model model = written(test::sampleMesh(), "split.glb", optionsOf(Quantity::Radiosity, 0.0F));
    const tinygltf::Primitive& wall = model.meshes[0].primitives[0];
    const auto positions = elements<glm::vec3>(model, wall.attributes.at("POSITION"));
    const auto indices = elements<std::uint32_t>(model, wall.indices);
    int onDiagonal = 0;
    for (const std::uint32_t i : indices) onDiagonal += 2.0F * positions[i].x == positions[i].y ? 1 : 0;
    EXPECT_EQ(onDiagonal, 4); // both ends of the diagonal are in both triangles
}

TEST(GltfWriterDetails, KeepsOrientation) {
    const tinygltf::Model model = written(test::sampleMesh(), "orientation.glb", optionsOf(Quantity::Radiosity, 0.0F));
    float area = 0.0F;
    for (const tinygltf::Primitive& primitive : model.meshes[0].primitives) {
        const auto positions = elements<glm::vec3>(model, primitive.attributes.at("POSITION"));
        const auto indices = elements<std::uint32_t>(model, primitive.indices);
        for (std::size_t i = 0; i < indices.size(); i += 3) {
            const glm::vec3 e = positions[indices[i + 1]] - positions[indices[i]];
            const glm::vec3 f = positions[indices[i + 2]] - positions[indices[i]];
            const float twice = e.x * f.y - e.y * f.x;
            EXPECT_GT(twice, 0.0F);
            area += 0.5F * twice;
        }
    }
    EXPECT_FLOAT_EQ(area, 0.5F + 0.25F + 0.125F);
}

TEST(GltfWriterDetails, SaysHowToReadIt) {
    const tinygltf::Model model = written(test::sampleMesh(), "asset.gltf", optionsOf(Quantity::Irradiance, 2.5F));
    EXPECT_EQ(model.asset.version, "2.0");
    EXPECT_EQ(model.asset.generator, "Lambert 1.2.3");
    EXPECT_EQ(model.asset.extras.Get("exposure_ev").GetNumberAsDouble(), 2.5);
    EXPECT_EQ(model.asset.extras.Get("quantity").Get<std::string>(), "irradiance");
    EXPECT_EQ(model.extensionsUsed, std::vector<std::string>{"KHR_materials_unlit"});
    for (const tinygltf::Material& material : model.materials) {
        EXPECT_EQ(material.extensions.count("KHR_materials_unlit"), 1U);
        EXPECT_EQ(material.pbrMetallicRoughness.baseColorFactor, (std::vector<double>{1, 1, 1, 1}));
        EXPECT_FALSE(material.doubleSided);
    }
    const tinygltf::Primitive& wall = model.meshes[0].primitives[0];
    const tinygltf::Accessor& positions = model.accessors[static_cast<std::size_t>(wall.attributes.at("POSITION"))];
    EXPECT_EQ(positions.minValues, (std::vector<double>{0, 0, 0}));
    EXPECT_EQ(positions.maxValues, (std::vector<double>{0.5, 1, 0}));
}

TEST(GltfWriterDetails, TakesNamesThatAreNotUtf8ForLatin1) {
    BakedMesh mesh = test::sampleMesh();
    mesh.materials[0].name = "gr\xFCn";
    mesh.materials[2].name = "größe";
    const tinygltf::Model model = written(mesh, "names.glb", optionsOf(Quantity::Radiosity, 0.0F));
    EXPECT_EQ(model.materials[0].name, "grün");
    EXPECT_EQ(model.materials[1].name, "größe");
}

TEST(GltfWriterDetails, WritesAnEmptyMesh) {
    const tinygltf::Model model = written(BakedMesh{}, "empty.glb", optionsOf(Quantity::Radiosity, 0.0F));
    EXPECT_TRUE(model.meshes.empty());
}

TEST(BakedFiles, AreTheSameBytesEveryTime) {
    for (const char* name : {"a.glb", "a.gltf", "a.ply", "a.obj"}) {
        const std::filesystem::path path = test::temporaryFile(name);
        writeBaked(test::sampleMesh(), path, *formatOf(path), optionsOf(Quantity::Irradiance, 0.3F));
        const std::string first = test::contentOf(path);
        writeBaked(test::sampleMesh(), path, *formatOf(path), optionsOf(Quantity::Irradiance, 0.3F));
        EXPECT_FALSE(first.empty());
        EXPECT_EQ(first, test::contentOf(path)) << name;
    }
}

TEST(BakedFiles, AreNotWrittenWithValuesThatAreNotFinite) {
    for (const char* name : {"nan.glb", "nan.gltf", "nan.ply", "nan.obj"}) {
        const std::filesystem::path path = test::temporaryFile(name);
        std::filesystem::remove(path);
        BakedMesh mesh = test::sampleMesh();
        mesh.radiosity[2].y = std::numeric_limits<float>::quiet_NaN();
        EXPECT_THROW(writeBaked(mesh, path, *formatOf(path), {}), SystemError);
        mesh = test::sampleMesh();
        mesh.irradiance[8].x = std::numeric_limits<float>::infinity();
        EXPECT_THROW(writeBaked(mesh, path, *formatOf(path), {}), SystemError);
        EXPECT_FALSE(std::filesystem::exists(path));
    }
}

TEST(BakedFiles, AreKnownByTheirExtension) {
    EXPECT_EQ(formatOf("a/b.glb"), BakedFormat::Glb);
    EXPECT_EQ(formatOf("b.GLTF"), BakedFormat::Gltf);
    EXPECT_EQ(formatOf("b.x.ply"), BakedFormat::Ply);
    EXPECT_EQ(formatOf("b.Obj"), BakedFormat::Obj);
    EXPECT_EQ(formatOf("b.png"), std::nullopt);
    EXPECT_EQ(formatOf("glb"), std::nullopt);
}

} // namespace
} // namespace lambert
