#pragma once

#include <string_view>

namespace lambert {

inline constexpr std::string_view kExrStart = "\x76\x2f\x31\x01";

/// Throws InputError unless the header of this flat EXR file holds together: each attribute has the size that its type
/// asks for and lies inside the file, and the picture is at most 65,536 pixels wide and high. OpenEXR takes memory for what a
/// header announces before it looks if that is there.
void checkExrHeader(std::string_view content);

} // namespace lambert
