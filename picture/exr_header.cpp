// The OpenEXR File Layout, openexr.com: magic number, version, then attributes (name, type, size, value) until an empty name.

#include "picture/exr_header.h"

#include "core/error.h"
#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>

namespace lambert {

namespace {

constexpr std::int64_t kLongestSide = 65536;
constexpr std::int32_t kDeepOrParts = 0x1800; // flags in the version

/// Takes bytes from the front; what does not fit is an InputError.
class Cursor {
public:
    explicit Cursor(std::string_view bytes) : rest_(bytes) {}

    std::string_view take(std::size_t size) {
        if (size > rest_.size())
            throw InputError(fmt::format("its EXR header announces {} bytes where there are {}", size, rest_.size()));
        const std::string_view result = rest_.substr(0, size);
        rest_.remove_prefix(size);
        return result;
    }
    std::string_view text() {
        const std::size_t end = rest_.find('\0');
        const std::string_view result = take(end == std::string_view::npos ? rest_.size() + 1 : end);
        take(1);
        return result;
    }
    std::int32_t number() {
        std::uint32_t value = 0;
        const std::string_view bytes = take(4);
        for (std::size_t k = 4; k-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[k]);
        return static_cast<std::int32_t>(value);
    }
    /// A number that says how many bytes follow.
    std::string_view sized() { return take(static_cast<std::uint32_t>(number())); }
    bool empty() const { return rest_.empty(); }

private:
    std::string_view rest_;
};

/// The bytes of a value of this type; none for types whose values may have any size.
std::optional<std::size_t> sizeOf(std::string_view type) {
    using Entry = std::pair<std::string_view, std::size_t>;
    constexpr std::array<Entry, 24> kSizes{{{"box2i", 16},      {"box2f", 16},   {"chromaticities", 32},
                                            {"compression", 1}, {"double", 8},   {"envmap", 1},
                                            {"float", 4},       {"int", 4},      {"keycode", 28},
                                            {"lineOrder", 1},   {"m33f", 36},    {"m33d", 72},
                                            {"m44f", 64},       {"m44d", 128},   {"rational", 8},
                                            {"tiledesc", 9},    {"timecode", 8}, {"v2i", 8},
                                            {"v2f", 8},         {"v2d", 16},     {"v3i", 12},
                                            {"v3f", 12},        {"v3d", 24},     {"deepImageState", 1}}};
    const auto* found = std::find_if(kSizes.begin(), kSizes.end(), [&](const Entry& e) { return e.first == type; });
    return found == kSizes.end() ? std::nullopt : std::optional(found->second);
}

/// Whether a value is as long as its own counts say.
bool holdsTogether(std::string_view type, std::string_view value) {
    if (const auto size = sizeOf(type)) return value.size() == *size;
    Cursor cursor(value);
    if (type == "chlist") {
        while (!cursor.text().empty()) cursor.take(16);
    } else if (type == "stringvector") {
        while (!cursor.empty()) cursor.sized();
    } else if (type == "preview") {
        const std::uint64_t width = static_cast<std::uint32_t>(cursor.number());
        const std::uint64_t height = static_cast<std::uint32_t>(cursor.number());
        return width <= value.size() && height <= value.size() && 4 * width * height + 8 == value.size();
    } else {
        return true;
    }
    return cursor.empty();
}

void checkWindow(std::string_view name, std::string_view value) {
    Cursor cursor(value);
    std::array<std::int64_t, 4> window{};
    for (std::int64_t& coordinate : window) coordinate = cursor.number();
    const std::int64_t width = window[2] - window[0] + 1;
    const std::int64_t height = window[3] - window[1] + 1;
    if (width < 1 || height < 1 || width > kLongestSide || height > kLongestSide)
        throw InputError(
            fmt::format("its {} has {} x {} pixels, allowed are 1 to {} each", name, width, height, kLongestSide));
}

} // namespace

void checkExrHeader(std::string_view content) {
    Cursor cursor(content);
    cursor.take(kExrStart.size());
    if ((cursor.number() & kDeepOrParts) != 0) throw InputError("found a deep or multi-part EXR, expected a flat one");
    for (std::string_view name = cursor.text(); !name.empty(); name = cursor.text()) {
        const std::string_view type = cursor.text();
        const std::string_view value = cursor.sized();
        if (!holdsTogether(type, value))
            throw InputError(fmt::format("its EXR attribute {} has {} bytes, which no {} has", inQuotes(name),
                                         value.size(), inQuotes(type)));
        if (name == "dataWindow" || name == "displayWindow") {
            if (type != "box2i") throw InputError(fmt::format("its {} is no box2i", name));
            checkWindow(name, value);
        }
    }
}

} // namespace lambert
