#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace lambert {

/// What stands in the header of an image file.
struct ImageHeader {
    enum class Samples : std::uint8_t { Bytes, WiderIntegers, Floats };
    int width = 0, height = 0; //!< pixels
    int channels = 0;
    int alpha = -1; //!< the channel of opacity; -1: none
    Samples samples = Samples::Bytes;
    bool flat = true;             //!< not deep, not a volume
    int tileHeight = 0;           //!< rows; 0: not tiled
    std::uint64_t pixelBytes = 0; //!< of all pixels, unpacked
    std::string format;           //!< what the library calls it, such as "png"
};

/// The bounds between Lambert and the library of image files. They lie in a module of their own, because that library loads
/// some 260 others, which takes longer than most bakes. Nothing is thrown across.
class ImageDecoder {
public:
    virtual ~ImageDecoder() = default;
    virtual const ImageHeader& header() const = 0;
    /// Values of `rows` rows from row `first` on, channels · width · rows of them, in the file's own encoding: codes, or
    /// floats (integers become 0 to 1). Of a tiled image `first` is a multiple of the tile height. False if the file is
    /// broken there.
    virtual bool read(int first, int rows, std::uint8_t* values) = 0;
    virtual bool read(int first, int rows, float* values) = 0;
    virtual std::string error() const = 0; //!< why the last read failed
};

struct ImageModule {
    /// `format`: how the file is to be read; empty: as its content or name says. Null, and the reason in `error`, if it cannot.
    std::unique_ptr<ImageDecoder> (*decoder)(const std::string& file, const std::string& format, std::string& error);
    /// The content of an image file of 3 channels, `width` · `height` pixels row by row: .exr from floats, .png from bytes.
    /// False, and the reason in `error`, if there is no memory for it.
    bool (*exr)(int width, int height, const float* pixels, std::vector<unsigned char>& content, std::string& error);
    bool (*png)(int width, int height, const unsigned char* pixels, std::vector<unsigned char>& content,
                std::string& error);
};

/// The module, loaded by the first call. Throws SystemError if it is not where it was installed.
const ImageModule& imageModule();

} // namespace lambert
