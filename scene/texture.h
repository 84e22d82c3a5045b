#pragma once

#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lambert {

/// What the colours of an 8-bit image mean; its opacity is linear in any case.
enum class TexelEncoding : std::uint8_t { Srgb, Linear };

/// An image on a surface: texels are constant squares, row 0 is at the top. Immutable.
class Texture {
public:
    /// `rgba`: 4 bytes per texel, row by row.
    Texture(std::string name, int width, int height, std::vector<std::uint8_t> rgba,
            TexelEncoding encoding = TexelEncoding::Srgb);
    /// `rgba`: linear and finite, one per texel, row by row; for images of more than 8 bits.
    Texture(std::string name, int width, int height, std::vector<glm::vec4> rgba);

    const std::string& name() const { return name_; } //!< for messages: the file's name
    int width() const { return width_; }
    int height() const { return height_; }
    /// Linear colour and opacity. 0 <= x < width, 0 <= y < height.
    glm::vec4 texel(int x, int y) const;
    /// The opacity alone.
    float opacity(int x, int y) const;

private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }

    std::string name_;
    int width_, height_;
    TexelEncoding encoding_ = TexelEncoding::Srgb; //!< of bytes_
    std::vector<std::uint8_t> bytes_;
    std::vector<glm::vec4> floats_; //!< one of the two is empty
};

/// How the numbers of an image become a texture.
enum class TextureContent {
    Colour,    //!< 8-bit images are sRGB; opacity is the alpha channel, 1 without one
    GreyAlpha, //!< for opacity maps: opacity is the alpha channel, or without one the (undecoded) grey value
    Linear     //!< numbers taken as they are, such as metalness
};

/// A plain square of 16,384 texels.
inline constexpr std::uint64_t kMostTexels = std::uint64_t{1} << 28;

/// Reads an image file. Throws InputError with one reason if it is missing, broken, of zero size, or has more
/// than `mostTexels`, a power of 2.
std::shared_ptr<const Texture> readTexture(const std::filesystem::path& path, TextureContent content,
                                           std::uint64_t mostTexels = kMostTexels);
/// The same from a file's bytes in memory (PNG or JPEG, as inside glTF); `name` stands in messages. Throws SystemError if
/// there is no memory for them.
std::shared_ptr<const Texture> readTexture(std::span<const std::uint8_t> bytes, const std::string& name,
                                           TextureContent content);

} // namespace lambert
