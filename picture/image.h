#pragma once

#include "core/rgb.h"

#include <filesystem>
#include <string>
#include <vector>

namespace lambert {

/// What the pixels of an image are: linear radiance (W or lm per m² and sr, unbounded), or linear display
/// colours in [0, 1] (tone-mapped already).
enum class PixelContent { Radiance, Display };

struct Image {
    int width = 0;
    int height = 0;
    std::vector<Rgb> pixels; //!< width · height, row by row from the top
    PixelContent content = PixelContent::Radiance;

    Rgb& at(int x, int y) { return pixels[index(x, y)]; }
    const Rgb& at(int x, int y) const { return pixels[index(x, y)]; }

private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

/// The files that pictures are written to.
enum class ImageFormat { Exr, Png };

/// The format that a file name's extension stands for (upper or lower case). Throws UsageError, naming what
/// is allowed, if it is neither .exr nor .png.
ImageFormat imageFormatOf(const std::filesystem::path& path);

/// The content of an image file, the same bytes for the same pixels.
///
/// - .exr: the pixels as linear floats, `ev` unused.
/// - .png: 8-bit sRGB, with an ordered dither of ±0.5/255 against banding. Radiance is tone-mapped at `ev`
/// (see toneMap); display colours are taken as they are.
///
/// Throws SystemError for want of memory.
std::string encodeImage(const Image& image, ImageFormat format, float ev);

/// Writes the image in the format of the name's extension, whole or not at all. Throws UsageError for any other extension,
/// SystemError if the file cannot be written.
void writeImage(const Image& image, const std::filesystem::path& path, float ev);

} // namespace lambert
