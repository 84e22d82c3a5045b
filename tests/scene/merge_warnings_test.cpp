#include "scene/merge_warnings.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

namespace lambert {
namespace {

using Lines = std::vector<std::string>;

TEST(MergeWarnings, FourAlikeLinesBecomeOne) {
    Lines warnings{"a.obj: 3 points or lines were ignored"};
    for (int k = 1; k <= 40; ++k)
        warnings.push_back(fmt::format("a.obj: material \"m{}\": reflectance {} 1 -1e3 clamped", k, 1.0 + 0.5 * k));
    warnings.emplace_back("a.obj: something else");
    EXPECT_EQ(
        mergeWarnings(warnings),
        (Lines{"a.obj: 3 points or lines were ignored",
               "a.obj: material \"m1\": reflectance 1.5 1 -1e3 clamped (and 39 more of this kind: \"m2\", \"m3\", "
               "\"m4\", ...)",
               "a.obj: something else"}));
}

TEST(MergeWarnings, ThreeAlikeLinesStay) {
    const Lines warnings{"image \"a\" is missing", "image \"b\" is missing", "image \"c\" is missing"};
    EXPECT_EQ(mergeWarnings(warnings), warnings);
}

TEST(MergeWarnings, LinesThatSayDifferentThingsStay) {
    const Lines warnings{"\"a\" one", "\"a\" two", "\"a\" three", "\"a\" four", "\"a five", "\"a six"};
    EXPECT_EQ(mergeWarnings(warnings), warnings);
    EXPECT_TRUE(mergeWarnings({}).empty());
}

TEST(MergeWarnings, LinesWithoutNamesAreCounted) {
    EXPECT_EQ(mergeWarnings({"line 1: odd", "line 2: odd", "line 17: odd", "line 20: odd"}),
              (Lines{"line 1: odd (and 3 more of this kind)"}));
    EXPECT_EQ(mergeWarnings({"x \"a\"", "x \"b\"", "x \"b\"", "x \"b\""}),
              (Lines{"x \"a\" (and 3 more of this kind: \"b\")"}));
}

} // namespace
} // namespace lambert
