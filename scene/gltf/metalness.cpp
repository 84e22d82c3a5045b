#include "scene/gltf/metalness.h"
#include "picture/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace lambert {

namespace {

/// The nearest 8-bit sRGB code of a linear value.
std::uint8_t srgbCode(float linear) {
    // Between which values codes change: searched rather than computed, it is done for every texel.
    static const std::array<float, 255> steps = [] {
        std::array<float, 255> result{};
        for (std::size_t code = 0; code < 255; ++code)
            result[code] = static_cast<float>(srgbDecoded((static_cast<double>(code) + 0.5) / 255.0));
        return result;
    }();
    return static_cast<std::uint8_t>(std::upper_bound(steps.begin(), steps.end(), linear) - steps.begin());
}

std::int64_t texelCount(const Texture& texture) { return std::int64_t{texture.width()} * texture.height(); }

/// The texel of a `texture` that lies at the centre of texel (x, y) of a grid of `width` by `height`.
glm::vec4 texelAt(const Texture& texture, int x, int y, int width, int height) {
    const auto scaled = [](int k, int from, int to) {
        return static_cast<int>((2 * std::int64_t{k} + 1) * to / (2 * std::int64_t{from}));
    };
    return texture.texel(scaled(x, width, texture.width()), scaled(y, height, texture.height()));
}

} // namespace

std::optional<float> uniformMetalness(const Texture& metal) {
    const float first = metal.texel(0, 0).z;
    for (int y = 0; y < metal.height(); ++y)
        for (int x = 0; x < metal.width(); ++x)
            if (metal.texel(x, y).z != first) return std::nullopt;
    return std::min(first, 1.0F);
}

float meanMetalness(const Texture& metal) {
    double sum = 0.0;
    for (int y = 0; y < metal.height(); ++y)
        for (int x = 0; x < metal.width(); ++x) sum += double{std::min(metal.texel(x, y).z, 1.0F)};
    return static_cast<float>(sum / static_cast<double>(texelCount(metal)));
}

std::shared_ptr<const Texture> withoutMetal(const Texture* colour, const Texture& metal, float factor) {
    const Texture& grid = colour != nullptr && texelCount(*colour) >= texelCount(metal) ? *colour : metal;
    const int width = grid.width(), height = grid.height();
    std::vector<std::uint8_t> rgba;
    rgba.reserve(4 * static_cast<std::size_t>(texelCount(grid)));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::vec4 base = colour != nullptr ? texelAt(*colour, x, y, width, height) : glm::vec4(1.0F);
            const float share = 1.0F - factor * std::min(texelAt(metal, x, y, width, height).z, 1.0F);
            for (int k = 0; k < 3; ++k) rgba.push_back(srgbCode(base[k] * share));
            rgba.push_back(static_cast<std::uint8_t>(std::lround(std::min(base.w, 1.0F) * 255.0F)));
        }
    const std::string name = colour != nullptr ? colour->name() + " without metal" : metal.name();
    return std::make_shared<Texture>(name, width, height, std::move(rgba));
}

} // namespace lambert
