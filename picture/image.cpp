#include "picture/image.h"

#include "core/error.h"
#include "core/text.h"
#include "core/whole_file.h"
#include "picture/image_module.h"
#include "picture/srgb.h"
#include "picture/tone_mapping.h"

#include <fmt/format.h>

#include <string>
#include <vector>

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
    const std::string extension = lowerCase(path.extension().string());
    if (extension == ".exr") return ImageFormat::Exr;
    if (extension == ".png") return ImageFormat::Png;
    throw UsageError(
        fmt::format("{}: a picture's name must end in .png (tone-mapped) or .exr (linear radiance)", path.string()));
}

std::string encodeImage(const Image& image, ImageFormat format, float ev) {
    const ImageModule& module = imageModule();
    std::vector<unsigned char> content;
    std::string error;
    const bool done =
        format == ImageFormat::Exr
            ? module.exr(image.width, image.height, reinterpret_cast<const float*>(image.pixels.data()), content, error)
            : module.png(image.width, image.height, srgbBytes(image, ev).data(), content, error);
    if (!done) throw SystemError(fmt::format("picture: {}", error));
    return {content.begin(), content.end()};
}

void writeImage(const Image& image, const std::filesystem::path& path, float ev) {
    writeWholeFile(path, encodeImage(image, imageFormatOf(path), ev));
}

} // namespace lambert
