#include "comparison/patch_picture.h"

#include "rendering/render.h"
#include "scene/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <string>

namespace lambert {

namespace {

constexpr Rgb kGround(0.22F); ///< linear; lighter than the scale's dark end, darker than its light one

Rgb displayLinear(const Rgb& srgb) {
    return {srgbDecoded(static_cast<double>(srgb.x)), srgbDecoded(static_cast<double>(srgb.y)),
            srgbDecoded(static_cast<double>(srgb.z))};
}

/// A mesh whose patches share no vertices, each of one radiosity: what is shown of it is flat.
BakedMesh flatMesh(const PatchMesh& mesh, std::span<const float> values, const ColourScale& scale) {
    BakedMesh flat;
    for (std::size_t patch = 0; patch < mesh.size(); ++patch) {
        const Rgb radiosity = std::numbers::pi_v<float> * displayLinear(scale.colour(values[patch]));
        std::array<std::uint32_t, 4> face{kNone, kNone, kNone, kNone};
        for (int k = 0; k < mesh.cornerCount(patch); ++k) {
            face[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(flat.positions.size());
            flat.positions.push_back(mesh.position(patch, k));
            flat.normals.push_back(mesh.normal[patch]);
            flat.radiosity.push_back(radiosity);
            flat.irradiance.push_back(radiosity);
        }
        flat.faces.push_back(face);
    }
    flat.faceMaterials.assign(mesh.size(), 0);
    return flat;
}

constexpr int kGlyphWidth = 5, kGlyphHeight = 7, kGlyphScale = 2;

/// Five pixels by seven, a row after the other, the leftmost in the highest of five bits.
const std::array<unsigned char, kGlyphHeight>& glyph(char c) {
    static constexpr std::array<std::array<unsigned char, kGlyphHeight>, 12> kGlyphs{{
        {0x0E, 0x11, 0x13, 0x15, 0x19, 0x11, 0x0E}, // 0
        {0x04, 0x0C, 0x04, 0x04, 0x04, 0x04, 0x0E}, // 1
        {0x0E, 0x11, 0x01, 0x02, 0x04, 0x08, 0x1F}, // 2
        {0x1F, 0x02, 0x04, 0x02, 0x01, 0x11, 0x0E}, // 3
        {0x02, 0x06, 0x0A, 0x12, 0x1F, 0x02, 0x02}, // 4
        {0x1F, 0x10, 0x1E, 0x01, 0x01, 0x11, 0x0E}, // 5
        {0x06, 0x08, 0x10, 0x1E, 0x11, 0x11, 0x0E}, // 6
        {0x1F, 0x01, 0x02, 0x04, 0x08, 0x08, 0x08}, // 7
        {0x0E, 0x11, 0x11, 0x0E, 0x11, 0x11, 0x0E}, // 8
        {0x0E, 0x11, 0x11, 0x0F, 0x01, 0x02, 0x0C}, // 9
        {0x00, 0x00, 0x0E, 0x11, 0x1F, 0x10, 0x0E}, // e
        {0x00, 0x00, 0x00, 0x1F, 0x00, 0x00, 0x00}, // -
    }};
    if (c >= '0' && c <= '9') return kGlyphs[static_cast<std::size_t>(c - '0')];
    return kGlyphs[c == 'e' ? 10 : 11];
}

int textWidth(const std::string& text) { return static_cast<int>(text.size()) * (kGlyphWidth + 1) * kGlyphScale; }

void drawText(Image& image, const std::string& text, int left, int top) {
    for (const char c : text) {
        for (int y = 0; y < kGlyphHeight * kGlyphScale; ++y)
            for (int x = 0; x < kGlyphWidth * kGlyphScale; ++x)
                if ((glyph(c)[static_cast<std::size_t>(y / kGlyphScale)] >> (kGlyphWidth - 1 - x / kGlyphScale) & 1) !=
                        0 &&
                    left + x >= 0 && left + x < image.width && top + y < image.height)
                    image.at(left + x, top + y) = Rgb(0.0F);
        left += (kGlyphWidth + 1) * kGlyphScale;
    }
}

} // namespace

Image patchPicture(const PatchMesh& mesh, const RayCaster& rays, std::span<const float> values,
                   const ColourScale& scale, const Camera& camera, const PictureSize& size, Progress& progress) {
    RenderOptions options;
    options.width = size.width;
    options.height = size.height;
    options.samplesPerAxis = size.samplesPerAxis;
    options.background = kGround;
    Image image = renderBaked(mesh, flatMesh(mesh, values, scale), rays, camera, options, progress);
    image.content = PixelContent::Display;
    return image;
}

Image withScaleBar(const Image& picture, const ColourScale& scale) {
    constexpr int kBar = 18, kGap = 8, kTick = 5;
    Image image = picture;
    image.height += kGap + kBar + kTick + kGap + kGlyphHeight * kGlyphScale + kGap;
    image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height), Rgb(1.0F));
    const int margin = std::min(40, image.width / 8);
    const int left = margin;
    const int right = image.width - 1 - margin;
    const int top = picture.height + kGap;
    for (int x = left; x <= right; ++x) {
        const float t = static_cast<float>(x - left) / static_cast<float>(std::max(1, right - left));
        for (int y = top; y < top + kBar; ++y) image.at(x, y) = displayLinear(viridis(t));
    }
    const int decades = scale.highest() - scale.lowest();
    for (int k = 0; k <= decades; ++k) {
        const int x = left + (right - left) * k / decades;
        for (int y = top + kBar; y < top + kBar + kTick; ++y) image.at(x, y) = Rgb(0.0F);
        const std::string label = fmt::format("1e{}", scale.lowest() + k);
        drawText(image, label, x - textWidth(label) / 2, top + kBar + kTick + kGap);
    }
    return image;
}

} // namespace lambert
