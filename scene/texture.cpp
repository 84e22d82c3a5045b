#include "scene/texture.h"

#include "picture/image_input.h"
#include "picture/srgb.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

namespace lambert {

namespace {

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

[[maybe_unused]] std::size_t texelCount(int width, int height) {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

/// Makes the texels of an image.
class Texels {
public:
    Texels(ImageInput& input, TextureContent content) : input_(input), content_(content) {
        const ImageHeader& header = input.header();
        const int colours = header.alpha >= 0 ? header.channels - 1 : header.channels;
        if (colours >= 3) green_ = 1, blue_ = 2;
        alpha_ = header.alpha;
    }

    std::vector<std::uint8_t> bytes() {
        std::vector<std::uint8_t> rgba;
        forPixels<std::uint8_t>([&](const std::uint8_t* pixel) {
            const int grey = (pixel[0] + pixel[green_] + pixel[blue_] + 1) / 3;
            const int opacity = alpha_ >= 0 ? pixel[alpha_] : content_ == TextureContent::GreyAlpha ? grey : 255;
            rgba.insert(rgba.end(), {pixel[0], pixel[green_], pixel[blue_], static_cast<std::uint8_t>(opacity)});
        });
        rgba.shrink_to_fit();
        return rgba;
    }

    std::vector<glm::vec4> floats() {
        const bool decode =
            content_ == TextureContent::Colour && input_.header().samples != ImageHeader::Samples::Floats;
        std::vector<glm::vec4> rgba;
        forPixels<float>([&](const float* pixel) {
            glm::vec4 texel(pixel[0], pixel[green_], pixel[blue_], 1.0F);
            if (alpha_ >= 0)
                texel.w = pixel[alpha_];
            else if (content_ == TextureContent::GreyAlpha)
                texel.w = (texel.x + texel.y + texel.z) / 3.0F;
            for (int channel = 0; channel < 4; ++channel) {
                float& value = texel[channel];
                value = std::isfinite(value) ? std::max(value, 0.0F) : 0.0F;
                if (decode && channel < 3) value = static_cast<float>(srgbDecoded(static_cast<double>(value)));
            }
            rgba.push_back(texel);
        });
        rgba.shrink_to_fit();
        return rgba;
    }

private:
    template <typename Value, typename Use>
    void forPixels(const Use& use) {
        const auto channels = static_cast<std::size_t>(input_.header().channels);
        input_.forRows<Value>([&](std::size_t pixels, const std::vector<Value>& values) {
            for (std::size_t k = 0; k < pixels; ++k) use(values.data() + k * channels);
        });
    }

    ImageInput& input_;
    TextureContent content_;
    int green_ = 0, blue_ = 0, alpha_ = -1;
};

std::shared_ptr<const Texture> textureOf(ImageInput input, std::string name, TextureContent content) {
    const ImageHeader& header = input.header();
    Texels texels(input, content);
    if (header.samples != ImageHeader::Samples::Bytes)
        return std::make_shared<Texture>(std::move(name), header.width, header.height, texels.floats());
    return std::make_shared<Texture>(std::move(name), header.width, header.height, texels.bytes(),
                                     content == TextureContent::Colour ? TexelEncoding::Srgb : TexelEncoding::Linear);
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
    return textureOf(ImageInput(path, mostTexels), path.filename().string(), content);
}

std::shared_ptr<const Texture> readTexture(std::span<const std::uint8_t> bytes, const std::string& name,
                                           TextureContent content) {
    return textureOf(ImageInput(bytes, kMostTexels), name, content);
}

} // namespace lambert
