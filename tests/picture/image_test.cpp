#include "picture/image.h"

#include "core/error.h"
#include "core/input_file.h"
#include "picture/srgb.h"
#include "picture/tone_mapping.h"
#include "tests/core/temporary_folder.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>

namespace lambert {
namespace {

Image gradient(int width, int height) {
    Image image;
    image.width = width;
    image.height = height;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            image.pixels.emplace_back(1e-6F * static_cast<float>(x * x * x), 3.7F * static_cast<float>(y), 1e5F);
    return image;
}

Image uniform(int width, int height, const Rgb& value) {
    return {width, height, std::vector<Rgb>(static_cast<std::size_t>(width * height), value)};
}

template <typename Channel>
std::vector<Channel> readBack(const std::filesystem::path& path, OIIO::ImageSpec& spec) {
    const auto input = OIIO::ImageInput::open(path.string());
    EXPECT_TRUE(input != nullptr);
    spec = input->spec();
    std::vector<Channel> channels(static_cast<std::size_t>(spec.width * spec.height * spec.nchannels));
    EXPECT_TRUE(input->read_image(0, 0, 0, spec.nchannels, OIIO::BaseTypeFromC<Channel>::value, channels.data()));
    return channels;
}

TEST(WriteImage, KeepsFloatsExactlyInExr) {
    const TemporaryFolder folder;
    const Image image = gradient(37, 21);
    const std::filesystem::path path = folder.path() / "gradient.exr";
    writeImage(image, path, 3.0F);
    OIIO::ImageSpec spec;
    const std::vector<float> channels = readBack<float>(path, spec);
    ASSERT_EQ(spec.width, 37);
    ASSERT_EQ(spec.height, 21);
    ASSERT_EQ(spec.nchannels, 3);
    EXPECT_EQ(spec.format, OIIO::TypeDesc::FLOAT);
    for (std::size_t i = 0; i < channels.size(); ++i)
        EXPECT_EQ(channels[i], image.pixels[i / 3][static_cast<int>(i % 3)]);
}

TEST(WriteImage, ToneMapsPng) {
    const TemporaryFolder folder;
    const Rgb radiance(0.05F, 0.4F, 1.7F);
    const std::filesystem::path path = folder.path() / "uniform.png";
    writeImage(uniform(64, 64, radiance), path, -1.0F);
    OIIO::ImageSpec spec;
    const std::vector<unsigned char> bytes = readBack<unsigned char>(path, spec);
    const Rgb expected = toneMap(radiance, -1.0F);
    for (int c = 0; c < 3; ++c) {
        double sum = 0.0;
        const float encoded = 255.0F * srgbEncode(expected[c]);
        for (std::size_t i = static_cast<std::size_t>(c); i < bytes.size(); i += 3) {
            EXPECT_NEAR(static_cast<float>(bytes[i]), encoded, 1.0F); // the dither moves less than one step
            sum += bytes[i];
        }
        // The dither has 64 thresholds: their mean is exact to 1/64 of a step.
        EXPECT_NEAR(sum / (64.0 * 64.0), static_cast<double>(encoded), 1.0 / 64.0);
    }
}

TEST(WriteImage, TakesDisplayColoursAsTheyAre) {
    const TemporaryFolder folder;
    Image image = uniform(8, 8, Rgb(0.0F, 0.2140411F, 1.0F));
    image.content = PixelContent::Display;
    const std::filesystem::path path = folder.path() / "display.png";
    writeImage(image, path, 5.0F);
    OIIO::ImageSpec spec;
    const std::vector<unsigned char> bytes = readBack<unsigned char>(path, spec);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        EXPECT_EQ(bytes[i], 0);
        EXPECT_NEAR(bytes[i + 1], 127.5, 0.6);
        EXPECT_EQ(bytes[i + 2], 255);
    }
}

TEST(WriteImage, WritesTheSameBytesWithoutTimeOrMachine) {
    const TemporaryFolder folder;
    for (const char* name : {"same.exr", "same.png"}) {
        const std::filesystem::path path = folder.path() / name;
        writeImage(gradient(40, 30), path, 0.0F);
        const std::string first = readInputFile(path);
        writeImage(gradient(40, 30), path, 0.0F);
        EXPECT_EQ(first, readInputFile(path));
        const auto input = OIIO::ImageInput::open(path.string());
        for (const auto& attribute : input->spec().extra_attribs) {
            const std::string key = attribute.name().string();
            if (key.find("Date") != std::string::npos) {
                EXPECT_EQ(attribute.get_string(), "1970:01:01 00:00:00");
            }
            EXPECT_EQ(key.find("Host"), std::string::npos) << key;
            EXPECT_EQ(attribute.get_string().find(path.parent_path().string()), std::string::npos) << key;
        }
    }
}

TEST(WriteImage, RefusesOtherExtensions) {
    const TemporaryFolder folder;
    const Image image = uniform(2, 2, Rgb(0.5F));
    EXPECT_THROW(writeImage(image, folder.path() / "a.jpg", 0.0F), UsageError);
    EXPECT_THROW(writeImage(image, folder.path() / "a", 0.0F), UsageError);
    EXPECT_EQ(imageFormatOf("a.PNG"), ImageFormat::Png);
    EXPECT_EQ(imageFormatOf("x/a.Exr"), ImageFormat::Exr);
}

TEST(WriteImage, SaysWhichFileCannotBeWritten) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "no such folder" / "a.png";
    try {
        writeImage(uniform(2, 2, Rgb(0.5F)), path, 0.0F);
        FAIL() << "nothing was thrown";
    } catch (const SystemError& error) {
        EXPECT_NE(std::string(error.what()).find(path.parent_path().string()), std::string::npos);
    }
}

TEST(ToneMap, LeavesDarkAndMiddleAlone) {
    EXPECT_EQ(toneMap(Rgb(0.1F, 0.2F, 0.4F), 1.0F), Rgb(0.2F, 0.4F, 0.8F));
    EXPECT_EQ(toneMap(Rgb(0.0F), 100.0F), Rgb(0.0F));
}

TEST(ToneMap, RisesSmoothlyAndStaysBelowOne) {
    float previous = 0.79F;
    for (float x = 0.8F; x < 1e6F; x *= 1.01F) {
        const float shown = toneMap(Rgb(x), 0.0F).x;
        EXPECT_GE(shown, previous);
        EXPECT_LE(shown, 1.0F);
        previous = shown;
    }
    EXPECT_GT(previous, 0.9999F);
    EXPECT_NEAR(toneMap(Rgb(0.801F), 0.0F).x, 0.801F, 1e-5F); // slope 1 at the shoulder
}

TEST(ToneMap, KeepsTheHue) {
    const Rgb shown = toneMap(Rgb(8.0F, 4.0F, 1.0F), 2.0F);
    EXPECT_NEAR(shown.y / shown.x, 0.5F, 1e-6F);
    EXPECT_NEAR(shown.z / shown.x, 0.125F, 1e-6F);
}

} // namespace
} // namespace lambert
