#include "core/data_uri.h"

#include <cstdint>

namespace lambert {

std::string dataUri(std::string_view mediaType, std::string_view content) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
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

} // namespace lambert
