#include "core/data_uri.h"

#include <array>
#include <cstdint>

namespace lambert {

namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

} // namespace

std::string dataUri(std::string_view mediaType, std::string_view content) {
    std::string result = "data:" + std::string(mediaType) + ";base64,";
    result.reserve(result.size() + 4 * (content.size() / 3 + 1));
    for (std::size_t at = 0; at < content.size(); at += 3) {
        const std::size_t bytes = content.size() - at < 3 ? content.size() - at : 3;
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < bytes ? static_cast<unsigned char>(content[at + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k) result += k <= bytes ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
    }
    return result;
}

std::vector<unsigned char> decodedBase64(std::string_view text) {
    std::array<std::uint8_t, 256> values{};
    values.fill(64);
    for (std::size_t k = 0; k < kDigits.size(); ++k)
        values[static_cast<unsigned char>(kDigits[k])] = static_cast<std::uint8_t>(k);
    std::vector<unsigned char> result;
    result.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0; // those read; the oldest fall out at the top
    int pending = 0;        // how many of them are not in the result
    for (const char digit : text) {
        const std::uint32_t value = values[static_cast<unsigned char>(digit)];
        if (value == 64) break;
        bits = bits << 6 | value;
        pending += 6;
        if (pending < 8) continue;
        pending -= 8;
        result.push_back(static_cast<unsigned char>(bits >> pending));
    }
    return result;
}

} // namespace lambert
