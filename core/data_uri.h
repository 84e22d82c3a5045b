#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lambert {

/// A file as part of another: data:MEDIATYPE;base64,… (RFC 2397)
std::string dataUri(std::string_view mediaType, std::string_view content);

/// The bytes that base64 stands for, up to the first character that is none of its digits.
std::vector<unsigned char> decodedBase64(std::string_view text);

} // namespace lambert
