#include "picture/image_input.h"

#include "core/error.h"
#include "core/input_file.h"
#include "core/text.h"
#include "picture/image_guard.h"
#include "picture/quiet_libraries.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <string_view>

namespace lambert {

namespace {

constexpr int kMostChannels = 64;
constexpr int kPixelsAtOnce = 1 << 20;

/// What deflate makes of one byte at most, and a little more.
constexpr std::uint64_t kMostPerPngByte = 1100;

/// The library's message about `file`, without that name and what follows from the first reason.
std::string shortReason(std::string message, const std::string& file) {
    if (message.find("could not find a format reader") != std::string::npos)
        return "is in no image format that is known";
    for (const std::string& name : {" \"" + file + "\"", file})
        for (std::size_t at = message.find(name); at != std::string::npos; at = message.find(name))
            message.erase(at, name.size());
    const std::string reason = oneLine(message, 100);
    return reason.empty() ? "cannot be read" : reason.substr(0, reason.find("; "));
}

void check(const ImageHeader& header, const std::string& file, std::uint64_t mostPixels) {
    if (header.width < 1 || header.height < 1 || header.channels < 1) throw InputError("has no pixels");
    if (static_cast<std::uint64_t>(header.width) * static_cast<std::uint64_t>(header.height) > mostPixels)
        throw InputError(fmt::format("found {} x {} pixels, allowed are 2^{} in all", header.width, header.height,
                                     std::bit_width(mostPixels) - 1));
    if (header.channels > kMostChannels)
        throw InputError(fmt::format("found {} channels, allowed are {}", header.channels, kMostChannels));
    if (!header.flat) throw InputError("found a deep or volume image, expected a flat one");
    if (header.format != "png") return;
    // Interlaced images are not read row by row.
    std::error_code error;
    const std::uint64_t size = std::filesystem::file_size(file, error);
    if (!error && header.pixelBytes / kMostPerPngByte > size)
        throw InputError(fmt::format("found {} bytes, too few for {} x {} pixels", size, header.width, header.height));
}

} // namespace

ImageInput::ImageInput(const std::filesystem::path& path, std::uint64_t mostPixels) : file_(path.string()) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) throw InputError("no such file");
    if (std::filesystem::file_size(path, error) == 0) throw InputError("the file is empty");
    const std::string content = readInputFile(path);
    refuseHostileImage({reinterpret_cast<const std::uint8_t*>(content.data()), content.size()});
    open("", mostPixels);
}

ImageInput::ImageInput(std::span<const std::uint8_t> content, std::uint64_t mostPixels) {
    const std::string_view bytes(reinterpret_cast<const char*>(content.data()), content.size());
    const bool jpeg = bytes.starts_with("\xFF\xD8");
    if (!jpeg && !bytes.starts_with("\x89PNG")) throw InputError("is neither PNG nor JPEG");
    refuseHostileImage(content);
    memory_ = std::make_unique<MemoryFile>(bytes);
    file_ = memory_->path().string();
    open(jpeg ? "jpeg" : "png", mostPixels);
}

const ImageHeader& ImageInput::header() const { return decoder_->header(); }

void ImageInput::open(const std::string& format, std::uint64_t mostPixels) {
    const ImageModule& module = imageModule();
    const QuietLibraries quiet;
    std::string error;
    decoder_ = module.decoder(file_, format, error);
    if (!decoder_) throw InputError(shortReason(error, file_));
    check(decoder_->header(), file_, mostPixels);
}

int ImageInput::rowsAtOnce() const {
    const ImageHeader& h = header();
    return h.tileHeight > 0 ? h.tileHeight : std::clamp(kPixelsAtOnce / h.width, 1, 64);
}

template <typename Value>
void ImageInput::readRows(int first, int rows, Value* values) {
    const QuietLibraries quiet;
    if (!decoder_->read(first, rows, values)) throw InputError(shortReason(decoder_->error(), file_));
}
template void ImageInput::readRows(int, int, std::uint8_t*);
template void ImageInput::readRows(int, int, float*);

} // namespace lambert
