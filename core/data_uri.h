#pragma once

#include <string>
#include <string_view>

namespace lambert {

/// A file as part of another: data:MEDIATYPE;base64,… (RFC 2397)
std::string dataUri(std::string_view mediaType, std::string_view content);

} // namespace lambert
