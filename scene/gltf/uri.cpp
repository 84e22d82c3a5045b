#include "scene/gltf/uri.h"

#include "core/data_uri.h"

#include <charconv>

namespace lambert {

bool isDataUri(std::string_view uri) { return uri.starts_with("data:"); }

std::optional<std::vector<unsigned char>> dataOfUri(const std::string& uri) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos || !std::string_view(uri).substr(0, comma).ends_with(";base64")) return std::nullopt;
    std::vector<unsigned char> data = decodedBase64(std::string_view(uri).substr(comma + 1));
    if (data.empty()) return std::nullopt;
    return data;
}

std::string pathOfUri(std::string_view uri) {
    std::string result;
    for (std::size_t k = 0; k < uri.size(); ++k) {
        unsigned code = 0;
        const bool escape = uri[k] == '%' && k + 2 < uri.size();
        if (escape && std::from_chars(uri.data() + k + 1, uri.data() + k + 3, code, 16).ptr == uri.data() + k + 3 &&
            code != 0) {
            result += static_cast<char>(code);
            k += 2;
        } else if (uri[k] == '\0') {
            result += "%00"; // a zero byte would end the name for the system, but not for our checks of it
        } else {
            result += uri[k];
        }
    }
    return result;
}

} // namespace lambert
