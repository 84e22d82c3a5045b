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

} // namespace
} // namespace lambert
