#include "scene/texture.h"

#include "core/error.h"
#include "scene/image_guard.h"
#include "scene/input_file.h"
#include "scene/quiet_libraries.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

namespace lambert {

namespace {

/// A plain square of 16,384 texels.
constexpr std::uint64_t kMostTexels = std::uint64_t{1} << 28;

double srgbDecoded(double value) { return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4); }

const std::array<float, 256>& srgbTable() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> result{};
        for (std::size_t code = 0; code < 256; ++code)
            result[code] = static_cast<float>(srgbDecoded(static_cast<double>(code) / 255.0));
        return result;
    }();
    return table;
}

std::size_t texelCount(int width, int height) {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

/// Reads one image, some rows at a time: a header that promises more than the file holds costs no memory.
class Reading {
public:
    Reading(OIIO::ImageInput& input, std::string name, TextureContent content)
        : input_(input), spec_(input.spec()), name_(std::move(name)), content_(content) {}

    std::shared_ptr<const Texture> run() {
        if (spec_.width < 1 || spec_.height < 1 || spec_.nchannels < 1) throw InputError("has no pixels");
        if (static_cast<std::uint64_t>(spec_.width) * static_cast<std::uint64_t>(spec_.height) > kMostTexels)
            throw InputError(fmt::format("found {} x {} pixels, allowed are 2^28 in all", spec_.width, spec_.height));
        const bool bytes = spec_.format == OIIO::TypeDesc::UINT8 && content_ == TextureContent::Colour;
        return bytes ? readBytes() : readFloats();
    }

private:
    struct Channels {
        int red = 0, green = 0, blue = 0, alpha = -1;
    };

    Channels channels() const {
        Channels result;
        const int colours = spec_.alpha_channel >= 0 ? spec_.nchannels - 1 : spec_.nchannels;
        if (colours >= 3) result = {0, 1, 2, -1};
        // OpenImageIO's GIF reader says 4 for the last of 4.
        result.alpha = std::min(spec_.alpha_channel, spec_.nchannels - 1);
        return result;
    }

    /// Calls `use(first row, rows, pixels)` for some rows after the other.
    template <typename T, typename Use>
    void forRows(OIIO::TypeDesc type, Use&& use) {
        const int step = spec_.tile_height > 0 ? spec_.tile_height : 64;
        std::vector<T> buffer;
        for (int row = 0; row < spec_.height; row += step) {
            const int rows = std::min(step, spec_.height - row);
            buffer.resize(texelCount(spec_.width, rows) * static_cast<std::size_t>(spec_.nchannels));
            const int y = spec_.y + row;
            const bool read =
                spec_.tile_width > 0
                    ? input_.read_tiles(0, 0, spec_.x, spec_.x + spec_.width, y, y + rows, spec_.z, spec_.z + 1, 0,
                                        spec_.nchannels, type, buffer.data())
                    : input_.read_scanlines(0, 0, y, y + rows, spec_.z, 0, spec_.nchannels, type, buffer.data());
            if (!read) throw InputError(oneLine(input_.geterror()));
            use(rows, buffer);
        }
    }

    std::shared_ptr<const Texture> readBytes() {
        const Channels c = channels();
        std::vector<std::uint8_t> rgba;
        forRows<std::uint8_t>(OIIO::TypeDesc::UINT8, [&](int rows, const std::vector<std::uint8_t>& pixels) {
            for (std::size_t k = 0; k < texelCount(spec_.width, rows); ++k) {
                const std::uint8_t* pixel = pixels.data() + k * static_cast<std::size_t>(spec_.nchannels);
                rgba.insert(rgba.end(), {pixel[c.red], pixel[c.green], pixel[c.blue],
                                         c.alpha >= 0 ? pixel[c.alpha] : std::uint8_t{255}});
            }
        });
        return std::make_shared<Texture>(name_, spec_.width, spec_.height, std::move(rgba));
    }

    std::shared_ptr<const Texture> readFloats() {
        const Channels c = channels();
        const bool integers = !spec_.format.is_floating_point();
        const bool decode = content_ == TextureContent::Colour && integers;
        std::vector<glm::vec4> rgba;
        forRows<float>(OIIO::TypeDesc::FLOAT, [&](int rows, const std::vector<float>& pixels) {
            for (std::size_t k = 0; k < texelCount(spec_.width, rows); ++k) {
                const float* pixel = pixels.data() + k * static_cast<std::size_t>(spec_.nchannels);
                glm::vec4 texel(pixel[c.red], pixel[c.green], pixel[c.blue], 1.0F);
                if (c.alpha >= 0)
                    texel.w = pixel[c.alpha];
                else if (content_ == TextureContent::GreyAlpha)
                    texel.w = (texel.x + texel.y + texel.z) / 3.0F;
                for (int channel = 0; channel < 4; ++channel) {
                    float& value = texel[channel];
                    value = std::isfinite(value) ? std::max(value, 0.0F) : 0.0F;
                    if (decode && channel < 3) value = static_cast<float>(srgbDecoded(static_cast<double>(value)));
                }
                rgba.push_back(texel);
            }
        });
        return std::make_shared<Texture>(name_, spec_.width, spec_.height, std::move(rgba));
    }

    OIIO::ImageInput& input_;
    OIIO::ImageSpec spec_;
    std::string name_;
    TextureContent content_;
};

std::shared_ptr<const Texture> read(const std::string& file, const std::string& name, TextureContent content,
                                    OIIO::Filesystem::IOProxy* proxy) {
    const QuietLibraries quiet;
    // Transparent pixels keep their colour as it stands in the file.
    OIIO::ImageSpec config;
    config["oiio:UnassociatedAlpha"] = 1;
    const auto input = OIIO::ImageInput::open(file, &config, proxy);
    if (!input) throw InputError(oneLine(OIIO::geterror()));
    auto texture = Reading(*input, name, content).run();
    input->close();
    return texture;
}

} // namespace

Texture::Texture(std::string name, int width, int height, std::vector<std::uint8_t> rgba)
    : name_(std::move(name)), width_(width), height_(height), bytes_(std::move(rgba)) {
    assert(bytes_.size() == 4 * texelCount(width, height));
}

Texture::Texture(std::string name, int width, int height, std::vector<glm::vec4> rgba)
    : name_(std::move(name)), width_(width), height_(height), floats_(std::move(rgba)) {
    assert(floats_.size() == texelCount(width, height));
}

glm::vec4 Texture::texel(int x, int y) const {
    const std::size_t index =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    if (!floats_.empty()) return floats_[index];
    const std::uint8_t* rgba = bytes_.data() + 4 * index;
    const auto& linear = srgbTable();
    return {linear[rgba[0]], linear[rgba[1]], linear[rgba[2]], static_cast<float>(rgba[3]) / 255.0F};
}

std::shared_ptr<const Texture> readTexture(const std::filesystem::path& path, TextureContent content) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) throw InputError("no such file");
    const std::string bytes = readInputFile(path);
    refuseHostileImage({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    return read(path.string(), path.filename().string(), content, nullptr);
}

std::shared_ptr<const Texture> readTexture(std::span<const std::uint8_t> bytes, const std::string& name,
                                           TextureContent content) {
    refuseHostileImage(bytes);
    OIIO::Filesystem::IOMemReader memory(const_cast<std::uint8_t*>(bytes.data()), bytes.size());
    // The name only has to tell the format.
    const bool jpeg = bytes.size() > 2 && bytes[0] == 0xFF && bytes[1] == 0xD8;
    return read(jpeg ? "image.jpg" : "image.png", name, content, &memory);
}

} // namespace lambert
