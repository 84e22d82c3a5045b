#include "scene/texture.h"

#include "core/error.h"
#include "tests/core/temporary_folder.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

namespace lambert {
namespace {

constexpr float kHalfInSrgb = 0.21404114F; // of 0.5

/// Writes an image whose value in channel c of pixel (x, y) is `values` there; `tile` > 0 for a tiled one.
void writeImage(const std::filesystem::path& path, int width, int height, int channels, OIIO::TypeDesc type,
                const std::vector<float>& values, int tile = 0) {
    OIIO::ImageSpec spec(width, height, channels, type);
    spec["oiio:UnassociatedAlpha"] = 1;
    spec.tile_width = spec.tile_height = tile;
    const auto output = OIIO::ImageOutput::create(path.string());
    ASSERT_TRUE(output && output->open(path.string(), spec)) << path;
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data())) << output->geterror();
    output->close();
}

std::string bytesOf(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// A PNG file with other numbers of columns and rows in its header.
std::string resized(std::string png, std::uint32_t width, std::uint32_t height) {
    const auto put = [&](std::size_t place, std::uint32_t value) {
        for (std::size_t k = 0; k < 4; ++k) png[place + k] = static_cast<char>(value >> (24 - 8 * k) & 0xFF);
    };
    put(16, width);
    put(20, height);
    std::uint32_t crc = 0xFFFFFFFF;
    for (std::size_t k = 12; k < 29; ++k) { // the chunk's type and content
        crc ^= static_cast<std::uint8_t>(png[k]);
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc % 2 != 0 ? 0xEDB88320U : 0U);
    }
    put(29, ~crc);
    return png;
}

std::string reasonFor(const std::filesystem::path& path) {
    try {
        readTexture(path, TextureContent::Colour);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

void expectTexel(const Texture& texture, int x, int y, const glm::vec4& expected, float tolerance) {
    const glm::vec4 found = texture.texel(x, y);
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(found[c], expected[c], tolerance) << texture.name() << " channel " << c;
    EXPECT_EQ(texture.opacity(x, y), found.w);
}

TEST(ReadTexture, DecodesColoursOf8And16BitsAndLeavesFloatsAsTheyAre) {
    const TemporaryFolder folder;
    const std::vector<float> rgba{0.5F, 0, 1, 1, 0.5F, 0.5F, 0.5F, 0.25F};
    for (const auto& [name, type, tolerance] :
         {std::tuple("8.png", OIIO::TypeDesc::UINT8, 3e-3F), {"16.png", OIIO::TypeDesc::UINT16, 1e-4F}}) {
        writeImage(folder.path() / name, 2, 1, 4, type, rgba);
        const auto texture = readTexture(folder.path() / name, TextureContent::Colour);
        EXPECT_EQ(texture->width(), 2);
        expectTexel(*texture, 0, 0, {kHalfInSrgb, 0, 1, 1}, tolerance); // half a code
        expectTexel(*texture, 1, 0, {kHalfInSrgb, kHalfInSrgb, kHalfInSrgb, 0.25F}, tolerance);
    }
    for (const char* name : {"float.exr", "float.hdr", "float.tif"}) {
        writeImage(folder.path() / name, 1, 2, 3, OIIO::TypeDesc::FLOAT, {0.5F, 8, 0, 0.25F, 0.5F, 1});
        const auto texture = readTexture(folder.path() / name, TextureContent::Colour);
        expectTexel(*texture, 0, 0, {0.5F, 8, 0, 1}, 0.04F); // .hdr: a shared exponent
        expectTexel(*texture, 0, 1, {0.25F, 0.5F, 1, 1}, 0.005F);
    }
}

TEST(ReadTexture, ReadsGreyWithAndWithoutOpacity) {
    const TemporaryFolder folder;
    writeImage(folder.path() / "grey.png", 1, 1, 1, OIIO::TypeDesc::UINT8, {0.5F});
    expectTexel(*readTexture(folder.path() / "grey.png", TextureContent::Colour), 0, 0,
                {kHalfInSrgb, kHalfInSrgb, kHalfInSrgb, 1}, 3e-3F);
    const auto opacity = readTexture(folder.path() / "grey.png", TextureContent::GreyAlpha);
    EXPECT_NEAR(opacity->opacity(0, 0), 0.5F, 2.1e-3F) << "the grey value as it is";
    expectTexel(*readTexture(folder.path() / "grey.png", TextureContent::Linear), 0, 0, {0.5F, 0.5F, 0.5F, 1}, 2.1e-3F);
    writeImage(folder.path() / "both.png", 1, 1, 2, OIIO::TypeDesc::UINT8, {0.5F, 0.2F});
    EXPECT_NEAR(readTexture(folder.path() / "both.png", TextureContent::GreyAlpha)->opacity(0, 0), 0.2F, 2.1e-3F);
}

TEST(ReadTexture, ReadsJpegAndTilesAndMemory) {
    const TemporaryFolder folder;
    writeImage(folder.path() / "flat.jpg", 16, 16, 3, OIIO::TypeDesc::UINT8, std::vector<float>(768, 0.5F));
    const auto jpeg = readTexture(folder.path() / "flat.jpg", TextureContent::Colour);
    expectTexel(*jpeg, 7, 9, {kHalfInSrgb, kHalfInSrgb, kHalfInSrgb, 1}, 1e-2F); // JPEG is lossy

    std::vector<float> ramp;
    for (int k = 0; k < 100 * 70; ++k) ramp.insert(ramp.end(), {static_cast<float>(k), 0, 0});
    writeImage(folder.path() / "tiled.exr", 100, 70, 3, OIIO::TypeDesc::FLOAT, ramp, 32);
    const auto tiled = readTexture(folder.path() / "tiled.exr", TextureContent::Colour);
    for (const auto& [x, y] : {std::pair(0, 0), {99, 69}, {33, 31}, {50, 64}})
        EXPECT_EQ(tiled->texel(x, y).x, static_cast<float>(y * 100 + x));

    const std::string bytes = bytesOf(folder.path() / "flat.jpg");
    const auto memory = readTexture(std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()),
                                    "image 3", TextureContent::Colour);
    EXPECT_EQ(memory->texel(7, 9), jpeg->texel(7, 9));
    EXPECT_EQ(memory->name(), "image 3");
}

TEST(ReadTexture, NumbersThatAreNotFiniteOrNegativeAreZero) {
    const TemporaryFolder folder;
    writeImage(folder.path() / "odd.exr", 1, 1, 3, OIIO::TypeDesc::FLOAT, {std::nanf(""), -1.0F, INFINITY});
    EXPECT_EQ(readTexture(folder.path() / "odd.exr", TextureContent::Colour)->texel(0, 0), glm::vec4(0, 0, 0, 1));
}

TEST(ReadTexture, SaysInOneLineWhatIsWrongWithAFile) {
    const TemporaryFolder folder;
    writeImage(folder.path() / "good.png", 64, 64, 3, OIIO::TypeDesc::UINT8, std::vector<float>(64 * 64 * 3, 0.3F));
    writeImage(folder.path() / "good.exr", 64, 64, 3, OIIO::TypeDesc::FLOAT, std::vector<float>(64 * 64 * 3, 0.3F));
    const std::string png = bytesOf(folder.path() / "good.png");
    const std::string exr = bytesOf(folder.path() / "good.exr");
    const std::vector<std::filesystem::path> files{
        folder.path() / "missing.png",
        folder.path(),
        folder.write("empty.png", ""),
        folder.write("text.png", "not an image"),
        folder.write("text.xyz", "not an image"),
        folder.write("cut.png", png.substr(0, png.size() / 2)),
        folder.write("cut_header.png", png.substr(0, 20)),
        folder.write("cut.exr", exr.substr(0, exr.size() / 2)),
        folder.write("huge.png", resized(png, 0x7FFFFFFF, 0x7FFFFFFF)),
        folder.write("large.png", resized(png, 16384, 16384)),
        folder.write("tall.png", resized(png, 64, 65)),
        folder.write("zero.png", resized(png, 0, 64)),
    };
    for (const std::filesystem::path& file : files) {
        const std::string reason = reasonFor(file);
        RecordProperty(file.filename().string(), reason);
        EXPECT_NE(reason, "no error") << file;
        EXPECT_FALSE(reason.empty()) << file;
        EXPECT_LT(reason.size(), 120U) << file << ": " << reason;
        EXPECT_EQ(reason.find('\n'), std::string::npos) << reason;
        EXPECT_EQ(reason.find(folder.path().string()), std::string::npos) << "the caller names the file: " << reason;
    }
    EXPECT_THROW(readTexture(std::span<const std::uint8_t>(), "none", TextureContent::Colour), InputError);
}

} // namespace
} // namespace lambert
