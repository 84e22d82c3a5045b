#include "tests/scene/gltf_test.h"

#include <OpenImageIO/imageio.h>
#include <glm/gtc/constants.hpp>

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>

namespace lambert {
namespace {

using nlohmann::json;

using Texel = std::array<std::uint8_t, 4>;
constexpr int kUnsignedByte = 5121, kUnsignedShort = 5123, kFloat = 5126;

/// A square with texture coordinates, and images to lie on it.
class GltfMaterials : public GltfTest {
protected:
    GltfMaterials() {
        square["/meshes/0/primitives/0/attributes/TEXCOORD_0"] =
            square.addAccessor(bytesOf<float>({0, 1, 1, 1, 1, 0, 0, 0}), kFloat, "VEC2", 4);
        pbr()["baseColorFactor"] = {1, 1, 1, 1};
    }

    json& material() { return square["/materials/0"]; }
    json& pbr() { return square["/materials/0/pbrMetallicRoughness"]; }

    std::filesystem::path writeImage(const std::string& name, int width, const std::vector<Texel>& texels) {
        const auto path = folder.path() / name;
        const auto output = OIIO::ImageOutput::create(path.string());
        OIIO::ImageSpec spec(width, static_cast<int>(texels.size()) / width, 4, OIIO::TypeDesc::UINT8);
        spec["oiio:UnassociatedAlpha"] = 1;
        EXPECT_TRUE(output->open(path.string(), spec));
        EXPECT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, texels.data()));
        EXPECT_TRUE(output->close());
        return path;
    }

    std::string imageBytes(const std::string& name, int width, const std::vector<Texel>& texels) {
        std::ifstream stream(writeImage(name, width, texels), std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }

    /// Adds a texture of an image with these members and returns its textureInfo.
    json addTexture(const json& image, const json& members = json::object()) {
        square["/images"].push_back(image);
        json texture = members;
        if (!texture.contains("source")) texture["source"] = square["/images"].size() - 1;
        square["/textures"].push_back(texture);
        return {{"index", square["/textures"].size() - 1}};
    }
    json addImage(const std::string& name, int width, const std::vector<Texel>& texels) {
        writeImage(name, width, texels);
        return addTexture({{"uri", name}});
    }

    glm::vec4 reflectanceTexel(const Scene& scene, int x, int y) {
        const TextureUse& use = scene.materials[0].reflectanceTexture;
        EXPECT_TRUE(use);
        return use ? scene.textures[use.texture]->texel(x, y) : glm::vec4(-1.0F);
    }

    /// The texture coordinates of the corner at (1, 0, 0), which are (1, 1) in the file.
    static glm::vec2 uv(const Scene& scene) { return scene.surfaces.at(scene.polygons[0].surface).uv[1]; }

    Square square;
    const Texel kRed{255, 0, 0, 255}, kGreen{0, 255, 0, 255}, kWhite{255, 255, 255, 255};
};

TEST_F(GltfMaterials, BaseColourTexturesComeFromFilesDataUrisAndBufferViews) {
    const std::string png = imageBytes("a b.png", 2, {kRed, kGreen});
    const std::string jpeg = imageBytes("a.jpg", 8, std::vector<Texel>(64, kWhite));
    pbr()["baseColorFactor"] = {0.5, 0.25, 0.125, 1};
    for (const json& image : {json{{"uri", "a%20b.png"}}, json{{"uri", "data:image/png;base64," + base64(png)}},
                              json{{"bufferView", square.addView(png)}, {"mimeType", "image/png"}}}) {
        pbr()["baseColorTexture"] = addTexture(image);
        const ReadResult result = read(square);
        EXPECT_TRUE(result.report.warnings.empty()) << testing::PrintToString(result.report.warnings);
        EXPECT_EQ(result.scene.materials[0].reflectance, Rgb(0.5F, 0.25F, 0.125F));
        EXPECT_EQ(reflectanceTexel(result.scene, 0, 0), glm::vec4(1, 0, 0, 1));
        EXPECT_EQ(reflectanceTexel(result.scene, 1, 0), glm::vec4(0, 1, 0, 1));
        EXPECT_EQ(uv(result.scene), glm::vec2(1, 1));
    }
    pbr()["baseColorTexture"] = addTexture({{"bufferView", square.addView(jpeg)}, {"mimeType", "image/jpeg"}});
    EXPECT_EQ(reflectanceTexel(read(square).scene, 3, 3), glm::vec4(1.0F));
}

TEST_F(GltfMaterials, OneImageIsReadOnce) {
    const json first = addImage("a.png", 1, {kRed});
    pbr()["baseColorTexture"] = first;
    square["/textures"].push_back({{"source", 0}});
    material()["emissiveTexture"] = {{"index", 1}};
    material()["emissiveFactor"] = {1, 1, 1};
    EXPECT_EQ(read(square).scene.textures.size(), 1U);
}

TEST_F(GltfMaterials, EmissionHasATextureAndCoordinatesOfItsOwn) {
    square["/meshes/0/primitives/0/attributes/TEXCOORD_1"] =
        square.addAccessor(bytesOf<std::uint16_t>({0, 0, 32768, 65535, 0, 0, 0, 0}), kUnsignedShort, "VEC2", 4, true);
    json info = addImage("glow.png", 1, {kRed});
    info["texCoord"] = 1;
    material()["emissiveTexture"] = info;
    material()["emissiveFactor"] = {1, 0.5, 0};
    material()["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 10;
    const Scene scene = read(square).scene;
    EXPECT_EQ(scene.materials[0].emittedRadiance, Rgb(10, 5, 0));
    EXPECT_EQ(scene.textures[scene.materials[0].emissionTexture.texture]->texel(0, 0), glm::vec4(1, 0, 0, 1));
    EXPECT_FALSE(scene.materials[0].reflectanceTexture);
    const glm::vec2 found = scene.surfaces[scene.polygons[0].surface].emissionUv[1];
    EXPECT_NEAR(found.x, 32768.0F / 65535.0F, 1e-7F);
    EXPECT_EQ(found.y, 1.0F);
}

TEST_F(GltfMaterials, TextureCoordinatesMayBeQuantised) {
    square["/meshes/0/primitives/0/attributes/TEXCOORD_0"] =
        square.addAccessor(bytesOf<std::uint8_t>({0, 0, 255, 51, 0, 0, 0, 0}), kUnsignedByte, "VEC2", 4, true);
    pbr()["baseColorTexture"] = addImage("a.png", 1, {kRed});
    EXPECT_EQ(uv(read(square).scene), glm::vec2(1.0F, 0.2F));
}

TEST_F(GltfMaterials, SamplersTellTheWraps) {
    json info = addImage("a.png", 1, {kRed});
    square["/samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
    square["/textures/0/sampler"] = 0;
    pbr()["baseColorTexture"] = info;
    const TextureUse use = read(square).scene.materials[0].reflectanceTexture;
    EXPECT_EQ(use.wrapU, TextureWrap::Clamp);
    EXPECT_EQ(use.wrapV, TextureWrap::Mirror);
    square["/samplers/0/wrapS"] = 7;
    expectError(square, "/samplers/0/wrapS: found 7, allowed 10497, 33648 or 33071");
    square["/textures/0/sampler"] = 3;
    expectError(square, "/textures/0/sampler: found 3, allowed 0 to 0 (samplers)");
}

TEST_F(GltfMaterials, TextureTransformsAreInTheCoordinates) {
    json info = addImage("a.png", 1, {kRed});
    const auto uvWith = [&](const json& transform) {
        info["extensions"]["KHR_texture_transform"] = transform;
        pbr()["baseColorTexture"] = info;
        return uv(read(square).scene);
    };
    EXPECT_EQ(uvWith({{"offset", {0.5, 0.25}}, {"scale", {2, 3}}}), glm::vec2(2.5F, 3.25F));
    // The specification's example: the lower left quarter of the image, turned. (1, 1) is its upper right corner.
    const glm::vec2 turned = uvWith({{"offset", {0, 1}}, {"rotation", glm::half_pi<double>()}, {"scale", {0.5, 0.5}}});
    EXPECT_NEAR(glm::distance(turned, glm::vec2(0.5F, 0.5F)), 0.0F, 1e-6F);
    // Its own set of coordinates goes before that of the texture.
    square["/meshes/0/primitives/0/attributes/TEXCOORD_3"] =
        square.addAccessor(bytesOf<float>({0, 0, 7, 8, 0, 0, 0, 0}), kFloat, "VEC2", 4);
    EXPECT_EQ(uvWith({{"texCoord", 3}}), glm::vec2(7, 8));
    info["extensions"]["KHR_texture_transform"] = {{"scale", {1}}};
    pbr()["baseColorTexture"] = info;
    expectError(square, "/KHR_texture_transform/scale: found [1], allowed 2 numbers");
}

TEST_F(GltfMaterials, TexturesWithoutCoordinatesAreNamed) {
    pbr()["baseColorTexture"] = addImage("a.png", 1, {kRed});
    pbr()["baseColorTexture"]["texCoord"] = 1;
    const ReadResult result = read(square);
    EXPECT_TRUE(hasWarning(result, "1 primitives lack the texture coordinates of their material"));
    EXPECT_EQ(uv(result.scene), glm::vec2(0.0F));
}

TEST_F(GltfMaterials, MetalLosesItsDiffusePartTexelByTexel) {
    pbr()["baseColorTexture"] = addImage("colour.png", 2, {kWhite, kRed, kGreen, kWhite});
    pbr()["metallicRoughnessTexture"] = addImage("metal.png", 1, {{0, 9, 0, 255}, {0, 9, 255, 255}});
    pbr()["metallicFactor"] = 0.5;
    const Scene scene = read(square).scene;
    EXPECT_EQ(scene.materials[0].reflectance, Rgb(0.99F));
    EXPECT_EQ(scene.textures.size(), 1U); // neither the colours nor the metalness alone
    EXPECT_EQ(reflectanceTexel(scene, 0, 0), glm::vec4(1, 1, 1, 1));
    EXPECT_EQ(reflectanceTexel(scene, 1, 0), glm::vec4(1, 0, 0, 1));
    // Half is left; the nearest 8-bit sRGB code is 188, of 0.5029.
    EXPECT_NEAR(reflectanceTexel(scene, 0, 1).y, 0.5F, 0.003F);
    EXPECT_EQ(reflectanceTexel(scene, 0, 1).x, 0.0F);
    EXPECT_NEAR(reflectanceTexel(scene, 1, 1).x, 0.5F, 0.003F);
}

TEST_F(GltfMaterials, TheFinerOfColoursAndMetalnessGivesTheGrid) {
    pbr().erase("metallicFactor"); // its default is 1
    pbr()["baseColorTexture"] = addImage("colour.png", 1, {kRed});
    pbr()["metallicRoughnessTexture"] = addImage("metal.png", 2, {{0, 0, 0, 255}, {0, 0, 255, 255}});
    const Scene scene = read(square).scene;
    EXPECT_EQ(reflectanceTexel(scene, 0, 0), glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(reflectanceTexel(scene, 1, 0), glm::vec4(0, 0, 0, 1));
}

TEST_F(GltfMaterials, MetalnessAloneIsATextureToo) {
    pbr().erase("metallicFactor");
    pbr()["baseColorFactor"] = {0.5, 0.5, 0.5, 1};
    pbr()["metallicRoughnessTexture"] = addImage("metal.png", 2, {{0, 0, 0, 255}, {0, 0, 255, 255}});
    const Scene scene = read(square).scene;
    EXPECT_EQ(scene.materials[0].reflectance, Rgb(0.5F));
    EXPECT_EQ(reflectanceTexel(scene, 0, 0), glm::vec4(1.0F));
    EXPECT_EQ(reflectanceTexel(scene, 1, 0), glm::vec4(0, 0, 0, 1));
}

TEST_F(GltfMaterials, UniformMetalnessIsAFactor) {
    pbr()["metallicFactor"] = 0.5;
    pbr()["baseColorTexture"] = addImage("colour.png", 1, {kRed});
    pbr()["metallicRoughnessTexture"] = addImage("metal.png", 2, {{0, 0, 51, 255}, {9, 9, 51, 255}});
    const Scene scene = read(square).scene;
    EXPECT_NEAR(scene.materials[0].reflectance.x, 0.9F, 1e-6F);
    EXPECT_EQ(reflectanceTexel(scene, 0, 0), glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(scene.textures.size(), 1U);
}

TEST_F(GltfMaterials, MetalnessThatLiesOtherwiseCountsByItsMean) {
    pbr()["metallicFactor"] = 1;
    pbr()["baseColorTexture"] = addImage("colour.png", 1, {kRed});
    json metal = addImage("metal.png", 2, {{0, 0, 0, 255}, {0, 0, 255, 255}});
    metal["extensions"]["KHR_texture_transform"]["scale"] = {2, 2};
    pbr()["metallicRoughnessTexture"] = metal;
    const ReadResult result = read(square);
    EXPECT_EQ(result.scene.materials[0].reflectance, Rgb(0.5F));
    EXPECT_TRUE(hasWarning(result, "material \"white\": metallicRoughnessTexture lies otherwise"));
}

TEST_F(GltfMaterials, AMaskCutsHolesWhereTheTextureIsTransparent) {
    pbr()["baseColorTexture"] = addImage("leaf.png", 2, {kGreen, {0, 255, 0, 100}});
    pbr()["baseColorFactor"] = {1, 1, 1, 0.5};
    material()["alphaMode"] = "MASK";
    material()["alphaCutoff"] = 0.25;
    const Scene scene = read(square).scene;
    EXPECT_TRUE(scene.materials[0].hasHoles());
    EXPECT_EQ(scene.materials[0].opacityCutoff, 0.5F);
    EXPECT_EQ(scene.materials[0].opacityTexture, scene.materials[0].reflectanceTexture);
    material()["alphaCutoff"] = 0.1; // all texels pass
    EXPECT_FALSE(read(square).scene.materials[0].hasHoles());
    EXPECT_TRUE(read(square).scene.materials[0].reflectanceTexture);
}

TEST_F(GltfMaterials, AMaskStaysWhereMetalTakesTheColour) {
    pbr()["baseColorTexture"] = addImage("leaf.png", 2, {kGreen, {0, 255, 0, 100}});
    pbr()["metallicFactor"] = 1;
    material()["alphaMode"] = "MASK";
    const Scene scene = read(square).scene;
    EXPECT_TRUE(scene.materials[0].hasHoles());
    EXPECT_FALSE(scene.materials[0].reflectanceTexture);
    EXPECT_EQ(uv(scene), glm::vec2(1, 1));
}

TEST_F(GltfMaterials, WhatAMaskMakesInvisibleIsLeftOut) {
    square["/materials/1"] = json::object();
    square["/meshes/0/primitives/1"] = {{"attributes", {{"POSITION", 0}}}, {"indices", 1}, {"material", 1}};
    material()["alphaMode"] = "MASK";
    pbr()["baseColorFactor"] = {1, 1, 1, 0.4};
    ReadResult result = read(square);
    EXPECT_EQ(result.scene.polygons.size(), 2U);
    EXPECT_TRUE(hasWarning(result, "2 triangles were left out: alphaMode MASK makes them invisible"));

    pbr()["baseColorFactor"] = {1, 1, 1, 1};
    pbr()["baseColorTexture"] = addImage("faint.png", 2, {{0, 255, 0, 100}, {0, 255, 0, 120}});
    EXPECT_EQ(read(square).scene.polygons.size(), 2U);
}

TEST_F(GltfMaterials, BlendIsOpaqueWithOneWarning) {
    material()["alphaMode"] = "BLEND";
    pbr()["baseColorFactor"] = {0.5, 0.5, 0.5, 0.5};
    square["/materials/1"] = material();
    const ReadResult result = read(square);
    EXPECT_EQ(result.report.warnings.size(), 1U);
    EXPECT_TRUE(hasWarning(result, "2 materials of alphaMode BLEND are taken to be opaque"));
    material()["alphaMode"] = "GLASS";
    expectError(square, "/materials/0/alphaMode: found \"GLASS\", allowed OPAQUE, MASK or BLEND");
}

TEST_F(GltfMaterials, ExtensionsThatChangeTheDiffusePartAreRead) {
    pbr()["baseColorFactor"] = {0.5, 0.5, 0.5, 1};
    pbr()["metallicFactor"] = 1;
    material()["extensions"] = {{"KHR_materials_unlit", json::object()}};
    ReadResult result = read(square);
    EXPECT_EQ(result.scene.materials[0].reflectance, Rgb(0.5F));
    EXPECT_TRUE(result.report.warnings.empty());

    pbr()["metallicFactor"] = 0;
    material()["extensions"] = {{"KHR_materials_transmission", {{"transmissionFactor", 0.75}}}};
    result = read(square);
    EXPECT_EQ(result.scene.materials[0].reflectance, Rgb(0.125F));
    EXPECT_TRUE(hasWarning(result, "material \"white\": transmits 0.75 of the light"));

    json diffuse = addImage("a.png", 1, {kRed});
    diffuse["extensions"]["KHR_texture_transform"]["offset"] = {1, 2};
    material()["extensions"] = {{"KHR_materials_pbrSpecularGlossiness",
                                 {{"diffuseFactor", {0.25, 0.5, 0.75, 1}}, {"diffuseTexture", diffuse}}}};
    result = read(square);
    EXPECT_EQ(result.scene.materials[0].reflectance, Rgb(0.25F, 0.5F, 0.75F));
    EXPECT_EQ(reflectanceTexel(result.scene, 0, 0), glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(uv(result.scene), glm::vec2(2, 3));
}

TEST_F(GltfMaterials, ExtensionsThatLeaveTheDiffusePartAreSilent) {
    pbr()["baseColorFactor"] = {0.5, 0.5, 0.5, 1};
    for (const char* name : {"KHR_materials_specular", "KHR_materials_ior", "KHR_materials_clearcoat"})
        material()["extensions"][name] = {{"factor", 0.5}};
    square["/extensionsRequired"] = {"KHR_materials_specular"};
    EXPECT_TRUE(read(square).report.warnings.empty());
}

TEST_F(GltfMaterials, OtherImageFormatsFallBack) {
    pbr()["baseColorTexture"] = addImage("a.png", 1, {kRed});
    square["/images"].push_back({{"uri", "a.ktx2"}});
    square["/textures/0/extensions"] = {{"KHR_texture_basisu", {{"source", 1}}}, {"EXT_texture_webp", {{"source", 1}}}};
    EXPECT_TRUE(read(square).report.warnings.empty());
    square["/textures/0"] = {{"extensions", {{"KHR_texture_basisu", {{"source", 1}}}}}};
    const ReadResult result = read(square);
    EXPECT_TRUE(hasWarning(result, "/textures/0: its image is in KTX 2, which Lambert does not read; the material's "
                                   "constant colour is used"));
    EXPECT_FALSE(result.scene.materials[0].reflectanceTexture);
    EXPECT_THROW(read(square, {.strict = true}), InputError);
}

TEST_F(GltfMaterials, WebpFilesAreRead) {
    writeImage("a.webp", 8, std::vector<Texel>(64, kWhite));
    pbr()["baseColorTexture"] = addTexture({{"uri", "a.webp"}});
    square["/textures/0"] = {{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}};
    const ReadResult result = read(square);
    EXPECT_TRUE(result.report.warnings.empty());
    EXPECT_NEAR(reflectanceTexel(result.scene, 3, 3).x, 1.0F, 0.05F); // compressed with loss
}

TEST_F(GltfMaterials, ImagesThatCannotBeUsedAreReplacedWithAWarning) {
    folder.write("broken.png", "no picture");
    const std::string replaced = "; the material's constant colour is used";
    const auto expectReplaced = [&](const json& image, const std::string& part) {
        pbr()["baseColorTexture"] = addTexture(image);
        const ReadResult result = read(square);
        EXPECT_TRUE(hasWarning(result, part)) << part << "\n" << testing::PrintToString(result.report.warnings);
        EXPECT_TRUE(hasWarning(result, replaced));
        EXPECT_FALSE(result.scene.materials[0].reflectanceTexture);
        EXPECT_THROW(read(square, {.strict = true}), InputError);
    };
    expectReplaced({{"uri", "none.png"}}, "image \"none.png\": no such file");
    expectReplaced({{"uri", "../none.png"}}, "image \"../none.png\": \"../none.png\" lies outside");
    expectReplaced({{"uri", "broken.png"}}, "image \"broken.png\": ");
    expectReplaced({{"uri", "data:image/png;base64,!!!!"}}, "image \"/images/3\": is neither PNG nor JPEG");
    expectReplaced({{"bufferView", 0}, {"name", "wood"}}, "image \"wood\": is neither PNG nor JPEG");
}

TEST_F(GltfMaterials, WithoutItsImageAMaterialHasNoMetal) {
    pbr().erase("metallicFactor");
    pbr()["metallicRoughnessTexture"] = addTexture({{"uri", "none.png"}});
    const ReadResult result = read(square);
    EXPECT_EQ(result.scene.materials[0].reflectance, Rgb(0.99F));
    EXPECT_TRUE(hasWarning(result, "image \"none.png\": no such file; the material is taken to have no metal"));
}

TEST_F(GltfMaterials, IndicesOutOfRangeAreRejectedWithTheirPath) {
    pbr()["baseColorTexture"] = addImage("a.png", 1, {kRed});
    pbr()["baseColorTexture"]["index"] = 5;
    expectError(square, "/materials/0/pbrMetallicRoughness/baseColorTexture/index: found 5, allowed 0 to 0 (textures)");
    pbr()["baseColorTexture"]["index"] = 0;
    square["/textures/0/source"] = 9;
    expectError(square, "/textures/0/source: found 9, allowed 0 to 0 (images)");
    square["/textures/0/source"] = 0;
    square["/images/0"] = {{"bufferView", 99}};
    expectError(square, "/images/0/bufferView: found 99");
    square["/images/0"] = 5;
    expectError(square, "/images/0: found 5, allowed an object");
}

} // namespace
} // namespace lambert
