#include "picture/image_guard.h"

#include "core/error.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace lambert {
namespace {

using namespace std::string_literals;

void check(std::string_view content) {
    refuseHostileImage({reinterpret_cast<const std::uint8_t*>(content.data()), content.size()});
}

std::string number(std::uint32_t value) {
    std::string bytes;
    for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xFF);
    return bytes;
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
    return name + '\0' + type + '\0' + number(static_cast<std::uint32_t>(value.size())) + value;
}

std::string window(std::uint32_t right, std::uint32_t lower) {
    return attribute("dataWindow", "box2i", number(0) + number(0) + number(right) + number(lower));
}

/// The header of an EXR of one channel, with more attributes.
std::string exr(const std::string& more, std::uint32_t version = 2) {
    return "\x76\x2f\x31\x01"s + number(version) +
           attribute("channels", "chlist", "G\0"s + std::string(16, '\1') + '\0') + more + '\0' + "pixels";
}

TEST(ImageGuard, LetsTheKnownFormatsThrough) {
    for (const std::string& start :
         {"\x89PNG\r\n\x1a\n"s, "\xFF\xD8\xFF\xE0"s, "BM"s, "GIF89a"s, "II*\0"s, "RIFF\0\0\0\0WEBP"s, "#?RADIANCE\n"s,
          "P6\n"s, "\0\0\2\0\0\0\0\0\0\0\0\0\4\0\4\0\x18\0"s})
        EXPECT_NO_THROW(check(start + "...")) << start;
    EXPECT_NO_THROW(check(exr(window(63, 31) + attribute("comment", "string", "a lamp"))));
}

TEST(ImageGuard, RefusesWhatIsNoPicture) {
    for (const std::string& content : {""s, "hello"s, "DICM"s, "8BPS\0\1"s,
                                       "\0\0\0\x18"
                                       "ftypmp42"s,
                                       "<svg/>"s})
        EXPECT_THROW(check(content), InputError) << content;
}

TEST(ImageGuard, RefusesAnExrThatAnnouncesMoreThanThereIs) {
    const std::string sound = exr(window(63, 31));
    for (std::size_t length = 0; length + 6 < sound.size(); ++length)
        EXPECT_THROW(check(sound.substr(0, length)), InputError) << length;
    EXPECT_THROW(check(exr("comment\0string\0"s + number(0xFFFFFFFF) + "text")), InputError);
    EXPECT_THROW(check(exr(attribute("names", "stringvector", number(1000) + "a"))), InputError);
    EXPECT_THROW(check(exr(attribute("preview", "preview", number(0xFFFF) + number(0xFFFF)))), InputError);
}

TEST(ImageGuard, RefusesAnExrAttributeOfTheWrongSizeForItsType) {
    EXPECT_THROW(check(exr(attribute("pixelAspectRatio", "float", "12345"))), InputError);
    EXPECT_THROW(check(exr(attribute("more", "chlist", "G\0"s + std::string(16, '\1')))), InputError);
}

TEST(ImageGuard, RefusesAnExrThatIsHugeInsideOutDeepOrOfManyParts) {
    for (const std::string& size : {window(65536, 0), window(0, 0x7FFFFFFF), window(0xFFFFFFFE, 0)})
        EXPECT_THROW(check(exr(size)), InputError);
    EXPECT_THROW(check(exr(window(63, 31), 0x802)), InputError);
    EXPECT_THROW(check(exr(window(63, 31), 0x1002)), InputError);
}

} // namespace
} // namespace lambert
