#include "core/data_uri.h"

#include <gtest/gtest.h>

namespace lambert {
namespace {

TEST(DataUri, Base64OfRfc4648) {
    EXPECT_EQ(dataUri("text/plain", ""), "data:text/plain;base64,");
    EXPECT_EQ(dataUri("text/plain", "f"), "data:text/plain;base64,Zg==");
    EXPECT_EQ(dataUri("text/plain", "fo"), "data:text/plain;base64,Zm8=");
    EXPECT_EQ(dataUri("text/plain", "foo"), "data:text/plain;base64,Zm9v");
    EXPECT_EQ(dataUri("text/plain", "foobar"), "data:text/plain;base64,Zm9vYmFy");
    EXPECT_EQ(dataUri("a/b", "\xFF\xFE\xFB"), "data:a/b;base64,//77");
}

TEST(DataUri, Base64IsDecodedUpToTheFirstOtherCharacter) {
    const auto decoded = [](std::string_view text) {
        const auto bytes = decodedBase64(text);
        return std::string(bytes.begin(), bytes.end());
    };
    for (const std::string content : {"", "f", "fo", "foo", "foob", "fooba", "foobar", "\xFF\xFE\xFB"}) {
        const std::string text = dataUri("", content).substr(std::string_view("data:;base64,").size());
        EXPECT_EQ(decoded(text), content);
        EXPECT_EQ(decoded(text.substr(0, text.find('='))), content) << "unpadded";
    }
    EXPECT_EQ(decoded("Zm9v\nYmFy"), "foo");
    EXPECT_EQ(decoded("Z"), "");
}

} // namespace
} // namespace lambert
