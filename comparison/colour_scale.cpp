#include "comparison/colour_scale.h"

#include "scene/texture.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lambert {

Rgb viridis(float t) {
    // Every ninth of the map.
    constexpr std::array<std::uint32_t, 10> kColours{0x440154, 0x482878, 0x3E4A89, 0x31688E, 0x26828E,
                                                     0x1F9E89, 0x35B779, 0x6DCD59, 0xB4DE2C, 0xFDE725};
    const auto colour = [&](std::size_t k) {
        return Rgb((kColours[k] >> 16) & 0xFFU, (kColours[k] >> 8) & 0xFFU, kColours[k] & 0xFFU) / 255.0F;
    };
    const float place = std::clamp(t, 0.0F, 1.0F) * static_cast<float>(kColours.size() - 1);
    const std::size_t k = std::min(static_cast<std::size_t>(place), kColours.size() - 2);
    const float part = place - static_cast<float>(k);
    return (1.0F - part) * colour(k) + part * colour(k + 1);
}

Rgb linearDisplay(const Rgb& srgb) {
    return {srgbDecoded(static_cast<double>(srgb.x)), srgbDecoded(static_cast<double>(srgb.y)),
            srgbDecoded(static_cast<double>(srgb.z))};
}

ColourScale::ColourScale(std::span<const float> values, int mostDecades) : lowest_(-1), highest_(0) {
    float smallest = INFINITY;
    float largest = 0.0F;
    for (const float value : values) {
        if (!(value > 0.0F) || !std::isfinite(value)) continue;
        smallest = std::min(smallest, value);
        largest = std::max(largest, value);
    }
    if (!(largest > 0.0F)) return;
    highest_ = static_cast<int>(std::ceil(std::log10(largest)));
    lowest_ = std::clamp(static_cast<int>(std::floor(std::log10(smallest))), highest_ - mostDecades, highest_ - 1);
}

float ColourScale::position(float value) const {
    if (!(value > 0.0F) || !std::isfinite(value)) return 0.0F;
    return std::clamp((std::log10(value) - static_cast<float>(lowest_)) / static_cast<float>(highest_ - lowest_), 0.0F,
                      1.0F);
}

} // namespace lambert
