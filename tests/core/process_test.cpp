#include "core/process.h"

#include <gtest/gtest.h>

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

TEST(PeakMemory, BeginsAfreshAfterAReset) {
    { const std::vector<char> block(kBlock, 1); }
    if (!resetPeakMemory()) GTEST_SKIP() << "the system does not let a process reset its peak";
    EXPECT_LT(peakMemoryBytes(), kBlock);
    { const std::vector<char> block(kBlock, 1); }
    EXPECT_GE(peakMemoryBytes(), kBlock);
}

} // namespace
} // namespace lambert
