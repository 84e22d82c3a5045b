#include "baking/exposure.h"
#include "baking/write_baked.h"
#include "picture/srgb.h"
#include "tests/baking/sample_mesh.h"

#include <gtest/gtest.h>
#include <tiny_obj_loader.h>

#include <cmath>
#include <cstring>

namespace lambert {
namespace {

std::string written(const std::string& name, Quantity quantity) {
    const std::filesystem::path path = test::temporaryFile(name);
    BakeOutputOptions options;
    options.quantity = quantity;
    options.exposure = 1.0F;
    options.version = "1.2.3";
    writeBaked(test::sampleMesh(), path, *formatOf(path), options);
    return test::contentOf(path);
}

/// Reads numbers one after the other.
class Payload {
public:
    Payload(const std::string& bytes, std::size_t begin) : bytes_(bytes), position_(begin) {}
    template <typename Number>
    Number next() {
        Number number;
        std::memcpy(&number, bytes_.data() + position_, sizeof(Number));
        position_ += sizeof(Number);
        return number;
    }
    glm::vec3 nextVector() {
        const auto x = next<float>();
        const auto y = next<float>();
        return {x, y, next<float>()};
    }
    bool atEnd() const { return position_ == bytes_.size(); }

private:
    const std::string& bytes_;
    std::size_t position_;
};

void expectPly(const std::string& bytes, Quantity quantity) {
    const BakedMesh mesh = test::sampleMesh();
    const std::string end = "end_header\n";
    Payload payload(bytes, bytes.find(end) + end.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        EXPECT_EQ(payload.nextVector(), mesh.positions[v]);
        EXPECT_EQ(payload.nextVector(), mesh.normals[v]);
        const Rgb colour = displayColour(shownRadiance(mesh, v, quantity), 1.0F);
        for (int c = 0; c < 3; ++c)
            EXPECT_EQ(payload.next<std::uint8_t>(), std::lround(255.0F * srgbEncode(colour[c])));
        EXPECT_EQ(payload.nextVector(), mesh.radiosity[v]);
        if (quantity == Quantity::Irradiance) {
            EXPECT_EQ(payload.nextVector(), mesh.irradiance[v]);
        }
    }
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        const auto count = payload.next<std::uint8_t>();
        ASSERT_EQ(count, mesh.isQuad(face) ? 4 : 3);
        for (std::size_t k = 0; k < count; ++k) EXPECT_EQ(payload.next<std::uint32_t>(), mesh.faces[face][k]);
    }
    EXPECT_TRUE(payload.atEnd());
}

TEST(PlyWriter, HeaderNamesWhatFollows) {
    const std::string bytes = written("header.ply", Quantity::Radiosity);
    EXPECT_EQ(bytes.substr(0, bytes.find("end_header")), "ply\n"
                                                         "format binary_little_endian 1.0\n"
                                                         "comment Lambert 1.2.3\n"
                                                         "comment metres; red green blue = sRGB of "
                                                         "clamp(B/pi * 2^exposure_ev)\n"
                                                         "comment exposure_ev 1\n"
                                                         "comment radiosity_r g b: B per m2, linear, Rec. 709\n"
                                                         "element vertex 9\n"
                                                         "property float x\n"
                                                         "property float y\n"
                                                         "property float z\n"
                                                         "property float nx\n"
                                                         "property float ny\n"
                                                         "property float nz\n"
                                                         "property uchar red\n"
                                                         "property uchar green\n"
                                                         "property uchar blue\n"
                                                         "property float radiosity_r\n"
                                                         "property float radiosity_g\n"
                                                         "property float radiosity_b\n"
                                                         "element face 3\n"
                                                         "property list uchar uint vertex_indices\n");
}

TEST(PlyWriter, KeepsFloatsAndQuads) { expectPly(written("radiosity.ply", Quantity::Radiosity), Quantity::Radiosity); }

TEST(PlyWriter, AddsIrradianceWhenThatIsTheQuantity) {
    const std::string bytes = written("irradiance.ply", Quantity::Irradiance);
    EXPECT_NE(bytes.find("property float irradiance_b\nelement face"), std::string::npos);
    expectPly(bytes, Quantity::Irradiance);
}

TEST(ObjWriter, RoundTripsThroughAReader) {
    written("round_trip.obj", Quantity::Radiosity);
    const BakedMesh mesh = test::sampleMesh();
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warning;
    std::string error;
    const std::filesystem::path path = test::temporaryFile("round_trip.obj");
    ASSERT_TRUE(tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, path.c_str(),
                                 (path.parent_path().string() + "/").c_str(), false));
    EXPECT_EQ(warning + error, "");
    ASSERT_EQ(attributes.vertices.size(), 3 * mesh.positions.size());
    ASSERT_EQ(attributes.colors.size(), 3 * mesh.positions.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const Rgb colour = displayColour(shownRadiance(mesh, v, Quantity::Radiosity), 1.0F);
        for (int c = 0; c < 3; ++c) {
            const std::size_t i = 3 * v + static_cast<std::size_t>(c);
            EXPECT_FLOAT_EQ(attributes.vertices[i], mesh.positions[v][c]);
            EXPECT_FLOAT_EQ(attributes.normals[i], mesh.normals[v][c]);
            EXPECT_NEAR(attributes.colors[i], srgbEncode(colour[c]), 1e-5F); // five decimals are written
        }
    }
    ASSERT_EQ(materials.size(), 2U);
    EXPECT_EQ(materials[0].name, "wall");
    EXPECT_EQ(materials[1].name, "lamp");
    ASSERT_EQ(shapes.size(), 1U);
    const auto& corners = shapes[0].mesh.num_face_vertices; // of another type in each version
    EXPECT_EQ(std::vector<int>(corners.begin(), corners.end()), (std::vector<int>{4, 4, 3}));
    EXPECT_EQ(shapes[0].mesh.material_ids, (std::vector<int>{1, 0, 1}));
}

TEST(ObjWriter, KeepsNamesWithSpacesAndNamesTheNameless) {
    BakedMesh mesh = test::sampleMesh();
    mesh.materials[0].name = "";
    mesh.materials[2].name = "ceiling lamp";
    const std::filesystem::path path = test::temporaryFile("names.obj");
    writeBaked(mesh, path, BakedFormat::Obj, {});
    const std::string materials = test::contentOf(test::temporaryFile("names.mtl"));
    for (const char* name : {"material0", "ceiling lamp"}) {
        EXPECT_NE(test::contentOf(path).find(std::string("usemtl ") + name + "\n"), std::string::npos);
        EXPECT_NE(materials.find(std::string("newmtl ") + name + "\nKd 1 1 1\n"), std::string::npos);
    }
}

TEST(ObjWriter, WritesNoNegativeZeros) {
    EXPECT_EQ(written("zeros.obj", Quantity::Radiosity).find("-0"), std::string::npos);
}

} // namespace
} // namespace lambert
