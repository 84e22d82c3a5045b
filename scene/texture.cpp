#include "scene/texture.h"

#include "core/error.h"
#include "scene/image_guard.h"
#include "scene/input_file.h"
#include "scene/quiet_libraries.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <utility>

#include <sys/mman.h>
#include <unistd.h>

namespace lambert {

double srgbDecoded(double value) { return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4); }

namespace {

constexpr int kMostChannels = 64;
constexpr int kPixelsAtOnce = 1 << 20;

/// What deflate makes of one byte at most, and a little more.
constexpr std::uint64_t kMostPerPngByte = 1100;

/// OpenImageIO's message about `file`, without that name and what follows from the first reason.
std::string shortReason(std::string message, const std::string& file) {
    if (message.find("could not find a format reader") != std::string::npos)
        return "is in no image format that is known";
    for (const std::string& name : {" \"" + file + "\"", file})
        for (std::size_t at = message.find(name); at != std::string::npos; at = message.find(name))
            message.erase(at, name.size());
    const std::string reason = oneLine(message, 100);
    return reason.empty() ? "cannot be read" : reason.substr(0, reason.find("; "));
}

/// Bytes as a file that has a name but lies in memory: Debian's OpenImageIO reads JPEG only by name.
class MemoryFile {
public:
    explicit MemoryFile(std::span<const std::uint8_t> bytes) : descriptor_(memfd_create("image", MFD_CLOEXEC)) {
        while (descriptor_ >= 0 && !bytes.empty()) {
            const ssize_t written = write(descriptor_, bytes.data(), bytes.size());
            if (written <= 0) break;
            bytes = bytes.subspan(static_cast<std::size_t>(written));
        }
        if (descriptor_ >= 0 && bytes.empty()) return;
        close();
        throw SystemError("not enough memory for an image inside a scene");
    }
    ~MemoryFile() { close(); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    std::string path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

private:
    void close() const {
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    int descriptor_;
};

float unitValue(std::uint8_t code) { return static_cast<float>(code) / 255.0F; }

/// The linear value of each code.
const std::array<float, 256>& linearTable(TexelEncoding encoding) {
    using Table = std::array<float, 256>;
    static const auto tables = [] {
        std::pair<Table, Table> result{};
        for (std::size_t code = 0; code < 256; ++code) {
            result.first[code] = static_cast<float>(srgbDecoded(static_cast<double>(code) / 255.0));
            result.second[code] = unitValue(static_cast<std::uint8_t>(code));
        }
        return result;
    }();
    return encoding == TexelEncoding::Srgb ? tables.first : tables.second;
}

std::size_t texelCount(int width, int height) {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

/// Reads one image, some rows at a time: a header that promises more than the file holds costs no memory.
class Reading {
public:
    /// `file` is what OpenImageIO calls the image.
    Reading(OIIO::ImageInput& input, const std::string& file, std::string name, TextureContent content,
            std::uint64_t mostTexels)
        : input_(input),
          spec_(input.spec()),
          file_(file),
          name_(std::move(name)),
          content_(content),
          mostTexels_(mostTexels) {}

    std::shared_ptr<const Texture> run() {
        if (spec_.width < 1 || spec_.height < 1 || spec_.nchannels < 1) throw InputError("has no pixels");
        if (static_cast<std::uint64_t>(spec_.width) * static_cast<std::uint64_t>(spec_.height) > mostTexels_)
            throw InputError(fmt::format("found {} x {} pixels, allowed are 2^{} in all", spec_.width, spec_.height,
                                         std::bit_width(mostTexels_) - 1));
        if (spec_.nchannels > kMostChannels)
            throw InputError(fmt::format("found {} channels, allowed are {}", spec_.nchannels, kMostChannels));
        if (spec_.deep || spec_.depth > 1) throw InputError("found a deep or volume image, expected a flat one");
        refuseEmptyPromise();
        return spec_.format == OIIO::TypeDesc::UINT8 ? readBytes() : readFloats();
    }

private:
    /// Interlaced images are not read row by row.
    void refuseEmptyPromise() const {
        if (std::string_view(input_.format_name()) != "png") return;
        std::error_code error;
        const std::uint64_t size = std::filesystem::file_size(file_, error);
        if (!error && spec_.image_bytes(true) / kMostPerPngByte > size)
            throw InputError(
                fmt::format("found {} bytes, too few for {} x {} pixels", size, spec_.width, spec_.height));
    }

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

    /// Calls `use(pixels, values)` for some rows after the other.
    template <typename T, typename Use>
    void forRows(OIIO::TypeDesc type, Use&& use) {
        const bool tiled = spec_.tile_width > 0;
        const int step = tiled ? std::max(spec_.tile_height, 1) : std::clamp(kPixelsAtOnce / spec_.width, 1, 64);
        std::vector<T> buffer;
        for (int row = 0; row < spec_.height; row += step) {
            const int rows = std::min(step, spec_.height - row);
            const std::size_t pixels = texelCount(spec_.width, rows);
            buffer.resize(pixels * static_cast<std::size_t>(spec_.nchannels));
            const int y = spec_.y + row;
            const bool read =
                tiled ? input_.read_tiles(0, 0, spec_.x, spec_.x + spec_.width, y, y + rows, spec_.z, spec_.z + 1, 0,
                                          spec_.nchannels, type, buffer.data())
                      : input_.read_scanlines(0, 0, y, y + rows, spec_.z, 0, spec_.nchannels, type, buffer.data());
            if (!read) throw InputError(shortReason(input_.geterror(), file_));
            use(pixels, buffer);
        }
    }

    std::shared_ptr<const Texture> readBytes() {
        const Channels c = channels();
        const bool greyIsOpacity = content_ == TextureContent::GreyAlpha && c.alpha < 0;
        std::vector<std::uint8_t> rgba;
        forRows<std::uint8_t>(OIIO::TypeDesc::UINT8, [&](std::size_t pixels, const std::vector<std::uint8_t>& values) {
            for (std::size_t k = 0; k < pixels; ++k) {
                const std::uint8_t* pixel = values.data() + k * static_cast<std::size_t>(spec_.nchannels);
                const int grey = (pixel[c.red] + pixel[c.green] + pixel[c.blue] + 1) / 3;
                const int opacity = c.alpha >= 0 ? pixel[c.alpha] : greyIsOpacity ? grey : 255;
                rgba.insert(rgba.end(),
                            {pixel[c.red], pixel[c.green], pixel[c.blue], static_cast<std::uint8_t>(opacity)});
            }
        });
        rgba.shrink_to_fit();
        const bool colour = content_ == TextureContent::Colour;
        return std::make_shared<Texture>(name_, spec_.width, spec_.height, std::move(rgba),
                                         colour ? TexelEncoding::Srgb : TexelEncoding::Linear);
    }

    std::shared_ptr<const Texture> readFloats() {
        const Channels c = channels();
        const bool decode = content_ == TextureContent::Colour && !spec_.format.is_floating_point();
        std::vector<glm::vec4> rgba;
        forRows<float>(OIIO::TypeDesc::FLOAT, [&](std::size_t pixels, const std::vector<float>& values) {
            for (std::size_t k = 0; k < pixels; ++k) {
                const float* pixel = values.data() + k * static_cast<std::size_t>(spec_.nchannels);
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
        rgba.shrink_to_fit();
        return std::make_shared<Texture>(name_, spec_.width, spec_.height, std::move(rgba));
    }

    OIIO::ImageInput& input_;
    OIIO::ImageSpec spec_;
    const std::string& file_;
    std::string name_;
    TextureContent content_;
    std::uint64_t mostTexels_;
};

/// Opens `file` by its name, or as `format` if that is given.
std::shared_ptr<const Texture> read(const std::string& file, const char* format, const std::string& name,
                                    TextureContent content, std::uint64_t mostTexels) {
    const QuietLibraries quiet;
    // Transparent pixels keep their colour as it stands in the file.
    OIIO::ImageSpec config;
    config["oiio:UnassociatedAlpha"] = 1;
    std::unique_ptr<OIIO::ImageInput> input;
    std::string error;
    if (format == nullptr) {
        input = OIIO::ImageInput::open(file, &config);
        if (!input) error = OIIO::geterror();
    } else if (input = OIIO::ImageInput::create(format); input) {
        OIIO::ImageSpec spec;
        if (!input->open(file, spec, config)) error = std::exchange(input, nullptr)->geterror();
    }
    if (!input) throw InputError(shortReason(error, file));
    auto texture = Reading(*input, file, name, content, mostTexels).run();
    input->close();
    return texture;
}

} // namespace

Texture::Texture(std::string name, int width, int height, std::vector<std::uint8_t> rgba, TexelEncoding encoding)
    : name_(std::move(name)), width_(width), height_(height), encoding_(encoding), bytes_(std::move(rgba)) {
    assert(bytes_.size() == 4 * texelCount(width, height));
}

Texture::Texture(std::string name, int width, int height, std::vector<glm::vec4> rgba)
    : name_(std::move(name)), width_(width), height_(height), floats_(std::move(rgba)) {
    assert(floats_.size() == texelCount(width, height));
}

glm::vec4 Texture::texel(int x, int y) const {
    if (!floats_.empty()) return floats_[index(x, y)];
    const std::uint8_t* rgba = bytes_.data() + 4 * index(x, y);
    const auto& linear = linearTable(encoding_);
    return {linear[rgba[0]], linear[rgba[1]], linear[rgba[2]], unitValue(rgba[3])};
}

float Texture::opacity(int x, int y) const {
    return floats_.empty() ? unitValue(bytes_[4 * index(x, y) + 3]) : floats_[index(x, y)].w;
}

std::shared_ptr<const Texture> readTexture(const std::filesystem::path& path, TextureContent content,
                                           std::uint64_t mostTexels) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) throw InputError("no such file");
    if (std::filesystem::file_size(path, error) == 0) throw InputError("the file is empty");
    const std::string bytes = readInputFile(path);
    refuseHostileImage({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    return read(path.string(), nullptr, path.filename().string(), content, mostTexels);
}

std::shared_ptr<const Texture> readTexture(std::span<const std::uint8_t> bytes, const std::string& name,
                                           TextureContent content) {
    const std::string_view start(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const bool jpeg = start.starts_with("\xFF\xD8");
    if (!jpeg && !start.starts_with("\x89PNG")) throw InputError("is neither PNG nor JPEG");
    refuseHostileImage(bytes);
    const MemoryFile file(bytes);
    return read(file.path(), jpeg ? "jpeg" : "png", name, content, kMostTexels);
}

} // namespace lambert
