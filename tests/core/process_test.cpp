#include "core/process.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cstddef>
#include <vector>

namespace lambert {
namespace {

constexpr std::size_t kBlock = std::size_t{64} << 20;

TEST(PeakMemory, HoldsWhatWasUsedAndFreed) {
    const std::uint64_t before = peakMemoryBytes();
    { const std::vector<char> block(kBlock, 1); }
    EXPECT_GE(peakMemoryBytes(), before);
    EXPECT_GE(peakMemoryBytes(), kBlock);
}

TEST(ResidentMemory, GrowsByWhatIsInUseAndIsNoMoreThanThePeak) {
    const std::uint64_t before = residentMemoryBytes();
    const std::vector<char> block(kBlock, 1);
    EXPECT_GE(residentMemoryBytes(), before + kBlock / 2);
    EXPECT_LE(residentMemoryBytes(), peakMemoryBytes());
}

TEST(PeakMemory, BeginsAfreshAfterAResetWhereTheSystemAllowsIt) {
    { const std::vector<char> block(kBlock, 1); }
    const bool systemAllows = ::access("/proc/self/clear_refs", W_OK) == 0;
    EXPECT_EQ(resetPeakMemory(), systemAllows);
    if (systemAllows)
        EXPECT_LT(peakMemoryBytes(), kBlock);
    else
        EXPECT_GE(peakMemoryBytes(), kBlock); // the old peak stays
    { const std::vector<char> block(kBlock, 1); }
    EXPECT_GE(peakMemoryBytes(), kBlock);
}

} // namespace
} // namespace lambert
