#include "reader_checks.h"
#include "tests/core/temporary_folder.h"

#include <fmt/format.h>

#include <filesystem>

namespace lambert {
namespace {

const std::string kImage = "P3 2 1 255 255 0 0 0 0 255\n"; // red, blue
const std::string kTexturedTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0.25 0.75\n";

class ObjMaterials : public testing::Test {
protected:
    ObjMaterials() { folder.write("image.ppm", kImage); }

    ReadResult readMtl(const std::string& mtl, const ReadOptions& options = {},
                       const std::string& faces = "usemtl m\nf 1/1 2/2 3/3\n") {
        folder.write("scene.mtl", mtl);
        return readScene(folder.write("scene.obj", "mtllib scene.mtl\n" + kTexturedTriangle + faces), options);
    }
    static const SurfaceCorners& surface(const ReadResult& result) {
        return result.scene.surfaces.at(result.scene.polygons.at(0).surface);
    }

    TemporaryFolder folder;
};

TEST_F(ObjMaterials, TextureCoordinatesAreStoredFromTheImagesUpperLeftCorner) {
    const ReadResult result = readMtl("newmtl m\nKd 0.5 0.25 0.125\nmap_Kd image.ppm\n");
    const Material& material = result.scene.materials[0];
    EXPECT_EQ(material.reflectance, Rgb(0.5F, 0.25F, 0.125F));
    ASSERT_TRUE(material.reflectanceTexture);
    EXPECT_EQ(material.reflectanceTexture.wrapU, TextureWrap::Repeat);
    EXPECT_EQ(result.scene.textures.at(material.reflectanceTexture.texture)->texel(0, 0), glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(surface(result).uv[0], glm::vec2(0, 1));
    EXPECT_EQ(surface(result).uv[1], glm::vec2(1, 1));
    EXPECT_EQ(surface(result).uv[2], glm::vec2(0.25F, 0.25F));
    EXPECT_TRUE(result.report.warnings.empty());
}

TEST_F(ObjMaterials, MapOptionsScaleMoveAndClampEachMapForItself) {
    folder.write("my image.ppm", kImage);
    const ReadResult result = readMtl("newmtl m\nKd 1\nmap_Kd -s 2 4 1 -clamp on -o 0.5 my image.ppm\n"
                                      "Ke 4\nmap_Ke -blendu off -mm 0 0.5 -bm 1 -texres 64 -o 0 0.25 0 image.ppm\n");
    const Material& material = result.scene.materials[0];
    EXPECT_EQ(material.reflectanceTexture.wrapU, TextureWrap::Clamp);
    EXPECT_EQ(material.reflectanceTexture.wrapV, TextureWrap::Clamp);
    EXPECT_EQ(material.emissionTexture.wrapU, TextureWrap::Repeat);
    EXPECT_EQ(material.emittedRadiance, Rgb(2.0F));
    EXPECT_EQ(surface(result).uv[2], glm::vec2(0.25F * 2 + 0.5F, 1 - 0.75F * 4));
    EXPECT_EQ(surface(result).emissionUv[2], glm::vec2(0.25F, 1 - (0.75F + 0.25F)));
    EXPECT_TRUE(result.report.warnings.empty());
}

TEST_F(ObjMaterials, AnImageWithoutColourOrWithABlackOneCountsAlone) {
    const ReadResult without = readMtl("newmtl m\nmap_Kd image.ppm\nmap_Ke image.ppm\n");
    EXPECT_EQ(without.scene.materials[0].reflectance, Rgb(0.99F)); // the largest
    EXPECT_EQ(without.scene.materials[0].emittedRadiance, Rgb(1.0F));
    EXPECT_TRUE(without.report.warnings.empty());

    const ReadResult black = readMtl("newmtl m\nKd 0 0 0\nKe 0 0 0\nmap_Kd image.ppm\nmap_Ke image.ppm\n");
    EXPECT_EQ(black.scene.materials[0].reflectance, Rgb(0.99F));
    EXPECT_EQ(black.scene.materials[0].emittedRadiance, Rgb(1.0F));
    EXPECT_EQ(black.report.warnings.size(), 2U);
    EXPECT_TRUE(hasWarning(black, "material \"m\": Kd is black beside map_Kd"));
    EXPECT_TRUE(hasWarning(black, "Ke is black beside map_Ke"));
}

TEST_F(ObjMaterials, OnlyMapDCutsHoles) {
    EXPECT_FALSE(readMtl("newmtl m\nmap_Kd image.ppm\n").scene.materials[0].hasHoles());
    const ReadResult result = readMtl("newmtl m\nKd 0.5\nmap_d -s 3 image.ppm\n");
    const Material& material = result.scene.materials[0];
    EXPECT_TRUE(material.hasHoles());
    EXPECT_EQ(material.opacityCutoff, 0.5F);
    EXPECT_FLOAT_EQ(result.scene.textures.at(material.opacityTexture.texture)->texel(0, 0).w, 1.0F / 3.0F);
    EXPECT_EQ(surface(result).uv[1], glm::vec2(3, 1));

    const ReadResult both = readMtl("newmtl m\nmap_Kd image.ppm\nmap_d -s 3 image.ppm\n");
    EXPECT_EQ(surface(both).uv[1], glm::vec2(1, 1));
    EXPECT_TRUE(hasWarning(both, "-s and -o of map_d differ"));
}

TEST_F(ObjMaterials, MissingImagesAreReplacedOrRefusedUnderStrict) {
    const std::string mtl =
        "newmtl m\nKd 0.25\nmap_Kd none.png\nnewmtl n\nmap_Kd none2.png\nnewmtl k\nmap_Kd\nKd 0.5\n";
    const ReadResult result = readMtl(mtl);
    EXPECT_EQ(result.scene.materials[0].reflectance, Rgb(0.25F));
    EXPECT_EQ(result.scene.materials[1].reflectance, Rgb(0.5F));
    EXPECT_EQ(result.scene.polygons[0].surface, kNone);
    EXPECT_EQ(result.report.warnings.size(), 2U);
    EXPECT_TRUE(hasWarning(result, "image \"none.png\": no such file; Kd alone is used"));
    EXPECT_TRUE(hasWarning(result, "the reflectance 0.5 is used"));
    EXPECT_THROW(readMtl(mtl, {.strict = true}), InputError);
    EXPECT_NO_THROW(readMtl("newmtl m\nKd 0.25\nmap_Kd image.ppm\n", {.strict = true}));
}

TEST_F(ObjMaterials, AMaterialWithoutNameIsIgnoredWithAWarning) {
    const ReadResult result = readMtl("newmtl\nKd 1 0 0\nnewmtl m\nKd 0.25\nnewmtl \n");
    ASSERT_EQ(result.scene.materials.size(), 1U);
    EXPECT_EQ(result.scene.materials[0].reflectance, Rgb(0.25F));
    ASSERT_EQ(result.report.warnings.size(), 2U);
    EXPECT_TRUE(hasWarning(result, "line 1: a newmtl without a name was ignored, with what follows"));
    EXPECT_TRUE(hasWarning(result, "line 5: a newmtl"));
}

TEST_F(ObjMaterials, FilesAreFoundByNamesInLatin1HoweverTheDiskWritesThem) {
    const std::string latin1 = "fu\xDF"
                               "boden.ppm",
                      utf8 = "fu\xC3\x9F"
                             "boden.ppm";
    for (const std::string& onDisk : {latin1, utf8}) {
        const auto image = folder.write(onDisk, kImage);
        const ReadResult result = readMtl("newmtl m\nmap_Kd " + latin1 + "\n");
        EXPECT_TRUE(result.scene.materials[0].isTextured());
        EXPECT_TRUE(result.report.warnings.empty());
        std::filesystem::remove(image);
    }
    EXPECT_TRUE(hasWarning(readMtl("newmtl m\nmap_Kd " + latin1 + "\n"), utf8));
}

TEST_F(ObjMaterials, FilesAreFoundWithBackslashesAndInAnotherCase) {
    folder.write("Maps/Wood Floor.ppm", kImage);
    folder.write("Maps/Scene.mtl", "newmtl m\nmap_Kd maps\\wood floor.PPM\n");
    const ReadResult result =
        readScene(folder.write("scene.obj", "usemtl m\nf 1/1 2/2 3/3\nmtllib maps\\scene.MTL\n" + kTexturedTriangle));
    EXPECT_TRUE(result.scene.materials[0].isTextured());
    EXPECT_TRUE(result.report.warnings.empty());
}

TEST_F(ObjMaterials, FilesOutsideTheScenesFolderAreReadOnlyIfAllowed) {
    folder.write("out.mtl", "newmtl m\nKd 0.25\n");
    const auto obj = folder.write("inner/scene.obj", "mtllib ../out.mtl\n" + kTexturedTriangle + "usemtl m\nf 1 2 3\n");
    const ReadResult refused = readScene(obj);
    EXPECT_EQ(refused.scene.materials[0].reflectance, Rgb(0.5F));
    EXPECT_TRUE(hasWarning(refused, "mtllib \"../out.mtl\" lies outside the scene's folder"));
    EXPECT_THROW(readScene(obj, {.strict = true}), InputError);
    EXPECT_EQ(readScene(obj, {.allowOutsideFiles = true}).scene.materials[0].reflectance, Rgb(0.25F));
}

TEST_F(ObjMaterials, FilesBesideASceneInTheCurrentFolderAreFound) {
    readMtl("newmtl m\nmap_Kd image.ppm\n");
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    const ReadResult result = readScene("scene.obj");
    std::filesystem::current_path(before);
    EXPECT_TRUE(result.scene.materials[0].isTextured());
}

TEST_F(ObjMaterials, NamesThatNoFileCanHaveAreMissing) {
    const std::string name(5000, 'x');
    const ReadResult result = readMtl("newmtl m\nKd 0.5\nmap_Kd " + name + "\n", {},
                                      "usemtl m\nf 1 2 3\nmtllib " + name + " a.mtl\nmtllib .\nmtllib /dev/zero\n");
    EXPECT_EQ(result.report.warnings.size(), 5U);
}

TEST_F(ObjMaterials, NamesBecomeUtf8) {
    folder.write("a.mtl", "newmtl B\xFC"
                          "cher\nKd 0.25\n");                           // Latin-1
    folder.write("b.mtl", "\xEF\xBB\xBFnewmtl T\xC3\xBCr\nKd 0.125\n"); // UTF-8
    const ReadResult result = readScene(folder.write("scene.obj", "mtllib a.mtl b.mtl\n" + kTexturedTriangle +
                                                                      "g s\xFC"
                                                                      "d\nusemtl B\xFC"
                                                                      "cher\nf 1 2 3\n" +
                                                                      "usemtl T\xFCr\nf 1 2 3\n"));
    EXPECT_EQ(result.scene.materials[0].name, "B\xC3\xBC"
                                              "cher");
    EXPECT_EQ(result.scene.polygons[1].material, 1U);
    EXPECT_EQ(result.scene.nodes[0], "s\xC3\xBC"
                                     "d");
    EXPECT_TRUE(result.report.warnings.empty());
}

TEST_F(ObjMaterials, MirrorsAndGlassShareOneWarning) {
    const ReadResult result =
        readMtl("newmtl m\nKd 0.5\nKs 0.2 0.2 0.2\nillum 2\nTr 0\nnewmtl mirror\nKd 0.1\nillum 5\n"
                "newmtl pane\nKd 0.1\nd 0.3\nTr 0.7\nnewmtl veil\nKd 0.1\nTr 0.5\n"
                "newmtl chrome\nKd 0.1\nKs 0.9 0.9 0.9\nnewmtl solid\nKd 0.1\nd 1\nTr 1\n");
    ASSERT_EQ(result.report.warnings.size(), 1U);
    EXPECT_TRUE(hasWarning(result, "materials \"mirror\", \"pane\", \"veil\" and \"chrome\": only the diffuse part"));
}

TEST_F(ObjMaterials, PolygonsWithoutTextureCoordinatesAreCounted) {
    const ReadResult result = readMtl("newmtl m\nmap_Kd image.ppm\nnewmtl plain\nKd 0.5\n", {},
                                      "usemtl m\nf 1/1 2/2 3/3\nf 1 2 3\nf 1/1 2 3\nf 1//1 2//1 3//1\n"
                                      "usemtl plain\nf 1/1 2/2 3/9\n");
    EXPECT_TRUE(hasWarning(result, "3 polygons of materials with an image have no texture coordinates"));
    EXPECT_EQ(result.scene.surfaces.size(), 4U);
    EXPECT_EQ(result.scene.polygons[4].surface, kNone);
}

TEST_F(ObjMaterials, TextureCoordinatesThatDoNotExistAreRefused) {
    folder.write("scene.mtl", "newmtl m\nmap_Kd image.ppm\n");
    const auto expectError = [&](const std::string& face, const std::string& part) {
        expectInputError(folder.write("scene.obj", "mtllib scene.mtl\nusemtl m\n" + kTexturedTriangle + face), part);
    };
    expectError("f 1/1 2/2 3/4\n",
                "scene.obj:9: found \"3/4\", expected a texture coordinate that exists: the file has 3");
    expectError("f 1/-4 2/2 3/3\n", "found \"1/-4\", expected a texture coordinate that exists: 3 texture coordinates");
    expectError("f 1/4000000000 2/2 3/3\n", "found \"1/4000000000\"");
}

TEST_F(ObjMaterials, MalformedMapOptionsAreRefused) {
    EXPECT_THROW(readMtl("newmtl m\nmap_Kd -s x image.ppm\n"), InputError);
    EXPECT_THROW(readMtl("newmtl m\nmap_Kd -o\n"), InputError);
    EXPECT_THROW(readMtl("newmtl m\nmap_Kd -mm nan 1 image.ppm\n"), InputError);
    EXPECT_NO_THROW(readMtl("newmtl m\nd x\nillum nan\nKs a b c\nTr\nillum 1e300\n"));
}

TEST_F(ObjMaterials, VertexColoursAreTheReflectanceWhereNoMaterialTellsIt) {
    folder.write("scene.mtl", "newmtl known\nKd 0.25\n");
    const ReadResult result = readScene(
        folder.write("scene.obj", "mtllib scene.mtl\nv 0 0 0 1 0 0\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0 0 0 1\nv 1 1 0\n"
                                  "f 1 2 3\nusemtl unknown\nf 2 4 3\nusemtl known\nf 1 2 3\n"));
    const Scene& scene = result.scene;
    const auto reflectance = [&](std::size_t polygon, std::size_t k) {
        const Polygon& p = scene.polygons[polygon];
        return scene.materials[p.material].reflectance * scene.surfaces[p.surface].tint[k];
    };
    EXPECT_EQ(reflectance(0, 0), Rgb(0.99F, 0, 0));
    EXPECT_NEAR(reflectance(0, 1).x, 0.99F * 0.21404F, 1e-5F); // sRGB 0.5 in linear light
    EXPECT_NEAR(reflectance(1, 1).x, 0.5F, 1e-6F);             // a vertex without colour
    EXPECT_EQ(scene.polygons[2].surface, kNone);
    EXPECT_EQ(result.report.warnings.size(), 1U);
    EXPECT_TRUE(
        hasWarning(result, "material \"unknown\" is not defined: its reflectance is that of the vertex colours"));
}

TEST_F(ObjMaterials, VertexColoursBeyondOneAreClampedAndCounted) {
    const ReadResult result =
        readScene(folder.write("scene.obj", "v 0 0 0 255 0 0\nv 1 0 0 nan -1 0 1\nv 0 1 0 1\nf 1 2 3\n"));
    EXPECT_EQ(surface(result).tint[0], Rgb(1, 0, 0));
    EXPECT_EQ(surface(result).tint[1], Rgb(0.0F));
    EXPECT_TRUE(hasWarning(result, "2 vertex colours are not within 0 to 1"));
}

} // namespace
} // namespace lambert
