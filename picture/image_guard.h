#pragma once

#include <cstdint>
#include <span>

namespace lambert {

/// Throws InputError if a file with this content must not reach OpenImageIO: because it is none of PNG, JPEG, BMP, GIF, TGA,
/// TIFF, WebP, HDR, EXR, PNM and SGI (other readers, of films or medical pictures, have no business in a scene), or because
/// its header promises far more bytes than there are, for which a library would take the memory before it looks.
void refuseHostileImage(std::span<const std::uint8_t> content);

} // namespace lambert
