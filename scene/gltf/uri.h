#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lambert {

/// Whether a URI holds its data itself.
bool isDataUri(std::string_view uri);

/// The bytes of a data URI in base64, whatever its media type; none if it is not in base64 or empty.
std::optional<std::vector<unsigned char>> dataOfUri(const std::string& uri);

/// The path of a file from its URI: %20 becomes a space. The result contains no zero byte.
std::string pathOfUri(std::string_view uri);

} // namespace lambert
