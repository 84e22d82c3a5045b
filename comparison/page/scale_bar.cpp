#include "comparison/page/scale_bar.h"

#include "comparison/page/figure_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace lambert {

namespace {

constexpr int kGlyphWidth = 5, kGlyphHeight = 7, kGlyphScale = 2;

/// Five pixels by seven, a row after the other, the leftmost in the highest of five bits.
const std::array<unsigned char, kGlyphHeight>& glyph(char c) {
    static constexpr std::array<std::array<unsigned char, kGlyphHeight>, 15> kGlyphs{{
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
        {0x00, 0x00, 0x00, 0x00, 0x00, 0x0C, 0x0C}, // .
        {0x19, 0x19, 0x02, 0x04, 0x08, 0x13, 0x13}, // %
        {},                                         // blank
    }};
    const std::size_t place = std::string_view("0123456789e-.% ").find(c);
    return kGlyphs[std::min(place, kGlyphs.size() - 1)];
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

constexpr int kStops = 19; ///< between which the map is linear

} // namespace

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
        for (int y = top; y < top + kBar; ++y) image.at(x, y) = linearDisplay(viridis(t));
    }
    for (const double tick : scale.ticks()) {
        const int x = left + static_cast<int>(static_cast<float>(right - left) * scale.position(tick));
        for (int y = top + kBar; y < top + kBar + kTick; ++y) image.at(x, y) = Rgb(0.0F);
        const std::string label = percentLabel(tick);
        drawText(image, label, x - textWidth(label) / 2, top + kBar + kTick + kGap);
    }
    return image;
}

std::string scaleBarSvg(const ColourScale& scale, const std::string& name) {
    constexpr int kWidth = 720, kHeight = 50, kBar = 16, kMargin = 40;
    std::string svg = fmt::format(
        "<svg class=\"plot\" role=\"img\" aria-label=\"colours from {} to {}\" viewBox=\"0 0 {} {}\" "
        "style=\"max-width:{}px\" xmlns=\"http://www.w3.org/2000/svg\">\n<defs><linearGradient id=\"{}_scale\">",
        percentLabel(scale.lowest()), percentLabel(scale.highest()), kWidth, kHeight, kWidth, name);
    for (int k = 0; k <= kStops; ++k) {
        const float t = static_cast<float>(k) / kStops;
        const Rgb c = 255.0F * viridis(t) + 0.5F;
        svg += fmt::format("<stop offset=\"{:.4f}\" stop-color=\"#{:02x}{:02x}{:02x}\"/>", t, static_cast<int>(c.x),
                           static_cast<int>(c.y), static_cast<int>(c.z));
    }
    svg += fmt::format(
        "</linearGradient></defs>\n<rect x=\"{0}\" y=\"2\" width=\"{1}\" height=\"{2}\" fill=\"url(#{3}_scale)\"/>\n",
        kMargin, kWidth - 2 * kMargin, kBar, name);
    for (const double tick : scale.ticks()) {
        const int x = kMargin + static_cast<int>(static_cast<float>(kWidth - 2 * kMargin) * scale.position(tick));
        svg += fmt::format(
            "<path d=\"M{0} {1}v6\" stroke=\"currentColor\"/><text x=\"{0}\" y=\"{2}\" text-anchor=\"middle\" "
            "font-size=\"13\" fill=\"currentColor\">{3}</text>\n",
            x, 2 + kBar, kBar + 24, percentLabel(tick));
    }
    return svg + "</svg>";
}

} // namespace lambert
