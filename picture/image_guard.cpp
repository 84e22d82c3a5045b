#include "picture/image_guard.h"

#include "core/error.h"
#include "picture/exr_header.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace lambert {

namespace {

/// TGA has nothing at its start that tells it: a plausible header must do.
bool looksLikeTga(std::string_view content) {
    if (content.size() < 18) return false;
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(content[k]); };
    constexpr std::array<unsigned char, 6> kTypes{1, 2, 3, 9, 10, 11};
    constexpr std::array<unsigned char, 5> kDepths{8, 15, 16, 24, 32};
    return byte(1) <= 1 && std::find(kTypes.begin(), kTypes.end(), byte(2)) != kTypes.end() &&
           std::find(kDepths.begin(), kDepths.end(), byte(16)) != kDepths.end();
}

bool isKnownFormat(std::string_view content) {
    using namespace std::string_view_literals;
    constexpr std::array kStarts = {
        "\x89PNG\r\n\x1a\n"sv, "\xFF\xD8\xFF"sv, "BM"sv,    "GIF87a"sv,  "GIF89a"sv, "II*\0"sv, "MM\0*"sv,
        "#?RADIANCE"sv,        "#?RGBE"sv,       kExrStart, "\x01\xDA"sv};
    if (std::any_of(kStarts.begin(), kStarts.end(), [&](auto start) { return content.starts_with(start); }))
        return true;
    if (content.starts_with("RIFF") && content.substr(0, 12).ends_with("WEBP")) return true;
    if (content.size() > 2 && content[0] == 'P' && content[1] >= '1' && content[1] <= '6') return true;
    return looksLikeTga(content);
}

} // namespace

void refuseHostileImage(std::span<const std::uint8_t> content) {
    const std::string_view text(reinterpret_cast<const char*>(content.data()), content.size());
    if (!isKnownFormat(text))
        throw InputError(
            "not a picture that is read: expected PNG, JPEG, BMP, GIF, TGA, TIFF, WebP, HDR, EXR, PNM or SGI");
    if (text.starts_with(kExrStart)) checkExrHeader(text);
}

} // namespace lambert
