#include "rendering/image.h"

#include "baking/exposure.h"
#include "core/error.h"
#include "core/whole_file.h"
#include "rendering/tone_mapping.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <string>

namespace lambert {

namespace {

/// Threshold of an 8×8 Bayer matrix, in (0, 1): its bits are those of x ^ y and y, interleaved in reverse.
float bayerThreshold(int x, int y) {
    unsigned rank = 0;
    for (unsigned bit = 0; bit < 3; ++bit) {
        const unsigned xBit = static_cast<unsigned>(x) >> bit & 1U;
        const unsigned yBit = static_cast<unsigned>(y) >> bit & 1U;
        rank = rank << 2 | (xBit ^ yBit) << 1 | yBit;
    }
    return (static_cast<float>(rank) + 0.5F) / 64.0F;
}

std::vector<unsigned char> srgbBytes(const Image& image, float ev) {
    std::vector<unsigned char> bytes;
    bytes.reserve(image.pixels.size() * 3);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const Rgb& pixel = image.at(x, y);
            const Rgb shown = image.content == PixelContent::Display ? pixel : toneMap(pixel, ev);
            // Rounding up above a threshold that varies from pixel to pixel, instead of above 0.5, is the
            // dither.
            const float threshold = bayerThreshold(x, y);
            for (int c = 0; c < 3; ++c)
                bytes.push_back(static_cast<unsigned char>(255.0F * srgbEncode(shown[c]) + threshold));
        }
    }
    return bytes;
}

} // namespace

ImageFormat imageFormatOf(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".exr") return ImageFormat::Exr;
    if (extension == ".png") return ImageFormat::Png;
    throw UsageError(
        fmt::format("{}: a picture's name must end in .png (tone-mapped) or .exr (linear radiance)", path.string()));
}

std::string encodeImage(const Image& image, ImageFormat format, float ev) {
    const bool linear = format == ImageFormat::Exr;
    OIIO::ImageSpec spec(image.width, image.height, 3, linear ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", linear ? "Linear" : "sRGB");
    spec.attribute("Software", "Lambert");
    // OpenImageIO puts the present time into an EXR file that has none; equal pixels must give equal files.
    if (linear) spec.attribute("DateTime", "1970:01:01 00:00:00");
    const std::vector<unsigned char> bytes = linear ? std::vector<unsigned char>() : srgbBytes(image, ev);
    const void* pixels = linear ? static_cast<const void*>(image.pixels.data()) : bytes.data();
    // In memory, because not every writer of OpenImageIO notices that the disk is full.
    std::vector<unsigned char> content;
    OIIO::Filesystem::IOVecOutput memory(content);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(linear ? "a.exr" : "a.png", &memory);
    if (!output) throw SystemError(fmt::format("picture: {}", OIIO::geterror()));
    if (!output->open("", spec) || !output->write_image(spec.format, pixels) || !output->close())
        throw SystemError(fmt::format("picture: {}", output->geterror()));
    return {content.begin(), content.end()};
}

void writeImage(const Image& image, const std::filesystem::path& path, float ev) {
    writeWholeFile(path, encodeImage(image, imageFormatOf(path), ev));
}

} // namespace lambert
