#include "comparison/page/colour_scale.h"

#include "picture/srgb.h"
#include "scene/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace lambert {

Rgb viridis(float t) {
    // Every nineteenth of the map.
    constexpr std::array<std::uint32_t, 20> kColours{
        0x440154, 0x481567, 0x482677, 0x453781, 0x404788, 0x39568C, 0x33638D, 0x2D708E, 0x287D8E, 0x238A8D,
        0x1F968B, 0x20A387, 0x29AF7F, 0x3CBB75, 0x55C667, 0x73D055, 0x95D840, 0xB8DE29, 0xDCE319, 0xFDE725};
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

double roundStep(int n) {
    constexpr std::array kSteps{1.0, 2.0, 5.0};
    const int decade = n >= 0 ? n / 3 : -((2 - n) / 3);
    return kSteps[static_cast<std::size_t>(n - 3 * decade)] * std::pow(10.0, decade);
}

int stepBelow(double value) {
    int n = 3 * static_cast<int>(std::floor(std::log10(value))) - 1;
    while (roundStep(n + 1) <= value) ++n;
    return n;
}

ColourScale::ColourScale(std::span<const float> values, int mostDecades) : lowest_(-3), highest_(0) {
    std::vector<float> positive;
    for (const float value : values)
        if (value > 0.0F && std::isfinite(value)) positive.push_back(value);
    if (positive.empty()) return;
    const auto low = positive.begin() + static_cast<std::ptrdiff_t>(positive.size() / 20);
    std::nth_element(positive.begin(), low, positive.end());
    const double smallest = static_cast<double>(*low);
    highest_ = stepBelow(static_cast<double>(*std::max_element(positive.begin(), positive.end()))) + 1;
    lowest_ = std::clamp(stepBelow(smallest), highest_ - 3 * mostDecades, highest_ - 1);
}

std::vector<double> ColourScale::ticks() const {
    const bool isShort = highest_ - lowest_ <= 7;
    std::vector<double> result;
    for (int n = lowest_; n <= highest_; ++n) {
        const int toEnd = std::min(n - lowest_, highest_ - n);
        if (isShort || toEnd == 0 || (n % 3 == 0 && toEnd >= 2)) result.push_back(roundStep(n));
    }
    return result;
}

float ColourScale::position(double value) const {
    if (!(value > 0.0) || !std::isfinite(value)) return 0.0F;
    return static_cast<float>(std::clamp(std::log(value / lowest()) / std::log(highest() / lowest()), 0.0, 1.0));
}

} // namespace lambert
