#include "picture/image_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>

namespace lambert {

namespace {

ImageHeader headerOf(const OIIO::ImageInput& input) {
    const OIIO::ImageSpec& spec = input.spec();
    ImageHeader header;
    header.width = spec.width;
    header.height = spec.height;
    header.channels = spec.nchannels;
    // The GIF reader says 4 for the last of 4.
    header.alpha = std::min(spec.alpha_channel, spec.nchannels - 1);
    header.samples = spec.format == OIIO::TypeDesc::UINT8 ? ImageHeader::Samples::Bytes
                     : spec.format.is_floating_point()    ? ImageHeader::Samples::Floats
                                                          : ImageHeader::Samples::WiderIntegers;
    header.flat = !spec.deep && spec.depth <= 1;
    header.tileHeight = spec.tile_width > 0 ? std::max(spec.tile_height, 1) : 0;
    header.pixelBytes = spec.image_bytes(true);
    header.format = input.format_name();
    return header;
}

class OiioDecoder final : public ImageDecoder {
public:
    explicit OiioDecoder(std::unique_ptr<OIIO::ImageInput> input)
        : input_(std::move(input)), header_(headerOf(*input_)) {}
    ~OiioDecoder() override { input_->close(); }
    OiioDecoder(const OiioDecoder&) = delete;
    OiioDecoder& operator=(const OiioDecoder&) = delete;

    const ImageHeader& header() const override { return header_; }
    bool read(int first, int rows, std::uint8_t* values) override {
        return readAs(first, rows, OIIO::TypeDesc::UINT8, values);
    }
    bool read(int first, int rows, float* values) override {
        return readAs(first, rows, OIIO::TypeDesc::FLOAT, values);
    }
    std::string error() const override { return input_->geterror(); }

private:
    bool readAs(int first, int rows, OIIO::TypeDesc type, void* values) {
        const OIIO::ImageSpec& spec = input_->spec();
        const int y = spec.y + first;
        return header_.tileHeight > 0
                   ? input_->read_tiles(0, 0, spec.x, spec.x + spec.width, y, y + rows, spec.z, spec.z + 1, 0,
                                        spec.nchannels, type, values)
                   : input_->read_scanlines(0, 0, y, y + rows, spec.z, 0, spec.nchannels, type, values);
    }

    std::unique_ptr<OIIO::ImageInput> input_;
    ImageHeader header_;
};

std::unique_ptr<ImageDecoder> decoder(const std::string& file, const std::string& format, std::string& error) {
    // Transparent pixels keep their colour as it stands in the file.
    OIIO::ImageSpec config;
    config["oiio:UnassociatedAlpha"] = 1;
    std::unique_ptr<OIIO::ImageInput> input;
    if (format.empty()) {
        input = OIIO::ImageInput::open(file, &config);
        if (!input) error = OIIO::geterror();
    } else if (input = OIIO::ImageInput::create(format); input) {
        OIIO::ImageSpec spec;
        if (!input->open(file, spec, config)) {
            error = input->geterror();
            input.reset();
        }
    }
    return input ? std::make_unique<OiioDecoder>(std::move(input)) : nullptr;
}

bool encode(const char* name, const OIIO::ImageSpec& spec, const void* pixels, std::vector<unsigned char>& content,
            std::string& error) {
    // In memory, because not every writer of OpenImageIO notices that the disk is full.
    OIIO::Filesystem::IOVecOutput memory(content);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(name, &memory);
    if (!output) {
        error = OIIO::geterror();
        return false;
    }
    if (output->open("", spec) && output->write_image(spec.format, pixels) && output->close()) return true;
    error = output->geterror();
    return false;
}

OIIO::ImageSpec specOf(int width, int height, OIIO::TypeDesc type, const char* colourSpace) {
    OIIO::ImageSpec spec(width, height, 3, type);
    spec.attribute("oiio:ColorSpace", colourSpace);
    spec.attribute("Software", "Lambert");
    return spec;
}

bool exr(int width, int height, const float* pixels, std::vector<unsigned char>& content, std::string& error) {
    OIIO::ImageSpec spec = specOf(width, height, OIIO::TypeDesc::FLOAT, "Linear");
    // OpenImageIO puts the present time into an EXR file that has none; equal pixels must give equal files.
    spec.attribute("DateTime", "1970:01:01 00:00:00");
    return encode("a.exr", spec, pixels, content, error);
}

bool png(int width, int height, const unsigned char* pixels, std::vector<unsigned char>& content, std::string& error) {
    return encode("a.png", specOf(width, height, OIIO::TypeDesc::UINT8, "sRGB"), pixels, content, error);
}

} // namespace

} // namespace lambert

// The one name that the module shows.
extern "C" __attribute__((visibility("default"))) lambert::ImageModule lambertImageModule();
extern "C" lambert::ImageModule lambertImageModule() { return {lambert::decoder, lambert::exr, lambert::png}; }
