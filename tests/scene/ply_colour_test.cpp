#include "picture/srgb.h"
#include "ply_test.h"

#include <fmt/format.h>

#include <array>
#include <vector>

namespace lambert {
namespace {

class PlyColour : public PlyTest {
protected:
    /// The reflectance of a polygon at its corners.
    static std::vector<Rgb> reflectances(const Scene& scene, std::size_t index = 0) {
        const Polygon& polygon = scene.polygons.at(index);
        std::vector<Rgb> result;
        for (std::size_t k = 0; k < static_cast<std::size_t>(polygon.size()); ++k)
            result.push_back(scene.materials[polygon.material].reflectance *
                             scene.surfaces.at(polygon.surface).tint.at(k));
        return result;
    }
    static void expectNear(const Rgb& found, const Rgb& expected) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 2e-7); // rounding of a product of floats
    }
};

TEST_F(PlyColour, TakesBytesAsSrgbAndRealNumbersAsLinearReflectance) {
    const std::string names[] = {"red", "green", "blue"};
    const auto header = [&](const std::string& type, const std::string& prefix = "") {
        std::string result = kVertices;
        for (const std::string& name : names) result += "property " + type + " " + prefix + name + "\n";
        return result + "property uchar alpha\n" + kFaces;
    };
    const auto coloured = [&](const std::string& type, const std::string& prefix, const std::string& colour) {
        std::string body;
        for (const std::string corner : {"0 0 0", "1 0 0", "1 1 0", "0 1 0"}) body += corner + " " + colour + " 255\n";
        return read(plyText(header(type, prefix), body + "4 0 1 2 3\n"));
    };
    // 188 is the code of 0.5 and 99 that of 1/8, both by hand from the sRGB formula and rounded to a byte.
    const Rgb bytes(static_cast<float>(srgbDecoded(188 / 255.0)), static_cast<float>(srgbDecoded(99 / 255.0)), 0.0F);
    EXPECT_NEAR(bytes.x, 0.5, 0.004);
    EXPECT_NEAR(bytes.y, 0.125, 0.002);
    for (const std::string prefix : {"", "diffuse_"}) {
        SCOPED_TRACE(prefix);
        for (const Rgb& found : reflectances(coloured("uchar", prefix, "188 99 0").scene)) expectNear(found, bytes);
        for (const Rgb& found : reflectances(coloured("int", prefix, "188 99 0").scene)) expectNear(found, bytes);
        for (const Rgb& found : reflectances(coloured("ushort", prefix, "48316 25443 0").scene))
            expectNear(found, bytes);
        for (const std::string type : {"float", "double"}) {
            const ReadResult result = coloured(type, prefix, "0.123456 0.5 0.98");
            for (const Rgb& found : reflectances(result.scene)) expectNear(found, Rgb(0.123456F, 0.5F, 0.98F));
            EXPECT_TRUE(result.report.warnings.empty());
        }
    }
    const ReadResult white = coloured("uchar", "", "255 255 255");
    for (const Rgb& found : reflectances(white.scene)) EXPECT_EQ(found, Rgb(0.99F));
    EXPECT_TRUE(hasWarning(white, "4 colours were clamped to 0 ... 0.99"));
    for (const Rgb& found : reflectances(coloured("float", "", "nan -1 7").scene)) EXPECT_EQ(found, Rgb(0, 0, 0.99F));
}

TEST_F(PlyColour, KeepsEachVertexColourAtItsCorner) {
    const Scene scene = read(plyText(kVertices + "property float r\nproperty float g\nproperty float b\n" + kFaces,
                                     "0 0 0 .1 0 0\n1 0 0 .2 0 0\n1 1 0 .3 0 0\n0 1 0 .4 0 0\n4 2 3 0 1\n"))
                            .scene;
    const std::vector<Rgb> found = reflectances(scene);
    ASSERT_EQ(found.size(), 4U);
    for (std::size_t k = 0; k < 4; ++k) expectNear(found[k], Rgb(std::array{.3F, .4F, .1F, .2F}[k], 0, 0));
    EXPECT_EQ(scene.materials.size(), 1U);
    EXPECT_EQ(scene.materials[0].name, "default");
}

TEST_F(PlyColour, PrefersColoursOfFacesToThoseOfVertices) {
    const std::string colour = "property float red\nproperty float green\nproperty float blue\n";
    const std::string header =
        kVertices + colour + "element face 2\n" + colour + "property list uchar int vertex_indices\n";
    const Scene scene = read(plyText(header, "0 0 0 1 1 1\n1 0 0 1 1 1\n1 1 0 1 1 1\n0 1 0 1 1 1\n"
                                             ".5 .25 0 4 0 1 2 3\n0 .25 .5 3 0 1 2\n"))
                            .scene;
    for (const Rgb& found : reflectances(scene, 0)) expectNear(found, Rgb(.5F, .25F, 0));
    for (const Rgb& found : reflectances(scene, 1)) expectNear(found, Rgb(0, .25F, .5F));
}

TEST_F(PlyColour, DoesNotTakeBakedLightForEmission) {
    const std::string colour = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    const ReadResult result = read(plyText(kVertices + colour + "property float radiosity_r\n" + kFaces,
                                           "0 0 0 9 9 9 5\n1 0 0 9 9 9 5\n1 1 0 9 9 9 5\n0 1 0 9 9 9 5\n4 0 1 2 3\n"));
    EXPECT_EQ(result.scene.materials[0].emittedRadiance, Rgb(0));
    EXPECT_TRUE(hasWarning(result, "holds baked light"));
}

/// A picture of one red and one green texel.
const std::string kPicture = "P6\n2 1\n255\n" + std::string("\xFF\0\0\0\xFF\0", 6);

TEST_F(PlyColour, ReadsTexturesWithCoordinatesAtVertices) {
    folder.write("my picture.ppm", kPicture);
    for (const auto& [u, v] : {std::pair{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}) {
        SCOPED_TRACE(u);
        const ReadResult result = read(plyText(fmt::format("comment TextureFile my picture.ppm\n{}property float {}\n"
                                                           "property float {}\n{}",
                                                           kVertices, u, v, kFaces),
                                               "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 .75\n4 0 1 2 3\n"));
        const Scene& scene = result.scene;
        EXPECT_TRUE(result.report.warnings.empty());
        ASSERT_EQ(scene.materials.size(), 1U);
        EXPECT_EQ(scene.materials[0].name, "default");
        EXPECT_EQ(scene.materials[0].reflectance, Rgb(kMaxReflectance));
        ASSERT_TRUE(scene.materials[0].reflectanceTexture);
        EXPECT_EQ(scene.textures.at(0)->width(), 2);
        const SurfaceCorners& surface = scene.surfaces.at(scene.polygons[0].surface);
        EXPECT_EQ(surface.uv[0], glm::vec2(0, 1)); // below is 1: a texture's v grows downwards
        EXPECT_EQ(surface.uv[2], glm::vec2(1, 0));
        EXPECT_EQ(surface.uv[3], glm::vec2(0, .25F));
        EXPECT_EQ(surface.tint[0], Rgb(1));
    }
}

TEST_F(PlyColour, ReadsSeveralTexturesWithCoordinatesAtFaces) {
    folder.write("\xC3\xA4.ppm", kPicture);
    folder.write("b.ppm", kPicture);
    const std::string header = "comment TextureFile \xE4.ppm\ncomment TextureFile b.ppm\n" + kVertices +
                               "element face 4\nproperty list uchar int vertex_indices\n"
                               "property list uchar float texcoord\nproperty int texnumber\n";
    const Scene scene = read(plyText(header, kCorners + "3 0 1 2 6 0 0 1 0 1 1 1\n3 0 1 2 6 0 0 1 0 .5 .5 0\n"
                                                        "3 0 1 2 6 0 0 1 0 1 1 -1\n3 0 1 2 0 0\n"))
                            .scene;
    std::string names;
    for (const Polygon& polygon : scene.polygons) names += scene.materials[polygon.material].name + " ";
    EXPECT_EQ(names, "b.ppm \xC3\xA4.ppm default default ");
    EXPECT_EQ(scene.surfaces.at(scene.polygons[1].surface).uv[2], glm::vec2(.5F, .5F));
    EXPECT_EQ(scene.polygons[2].surface, kNone);
    const std::string wrong = "3 0 1 2 6 0 0 1 0 1 1 0\n3 0 1 2 0 0\n3 0 1 2 0 0\n";
    expectError(plyText(header, kCorners + "3 0 1 2 6 0 0 1 0 1 1 2\n" + wrong),
                "face 0: found the image 2, expected -1 to 1");
    expectError(plyText(header, kCorners + "3 0 1 2 4 0 0 1 0 0\n" + wrong),
                "face 0: found 4 texture coordinates, expected 6");
}

TEST_F(PlyColour, WarnsOfImagesThatCannotBeUsed) {
    const std::string coordinates = "property float s\nproperty float t\n";
    const std::string body = "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 .75\n4 0 1 2 3\n";
    const std::string missing = plyText("comment TextureFile none.png\n" + kVertices + coordinates + kFaces, body);
    const ReadResult result = read(missing);
    EXPECT_TRUE(hasWarning(result, "none.png"));
    EXPECT_EQ(result.scene.materials[0].reflectance, Rgb(0.5F));
    EXPECT_THROW(read(missing, {.strict = true}), InputError);
    folder.write("a.ppm", kPicture);
    EXPECT_TRUE(hasWarning(read(plyText("comment TextureFile a.ppm\n" + kVertices + kFaces, kCorners + "4 0 1 2 3\n")),
                           "images without texture coordinates were ignored"));
}

} // namespace
} // namespace lambert
