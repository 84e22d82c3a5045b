#include "core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

namespace lambert {
namespace {

/// Runs a test with each number of threads, and gives the default back afterwards.
class ParallelFor : public testing::TestWithParam<int> {
protected:
    void SetUp() override { setThreadCount(GetParam()); }
    void TearDown() override { setThreadCount(0); }
};

std::vector<int> visits(std::size_t count, std::size_t grain) {
    std::vector<std::atomic<int>> visited(count);
    parallelFor(count, grain, [&](std::size_t begin, std::size_t end, int) {
        EXPECT_LT(begin, end);
        EXPECT_LE(end, count);
        for (std::size_t i = begin; i < end; ++i) ++visited[i];
    });
    return {visited.begin(), visited.end()};
}

TEST_P(ParallelFor, CoversEachIndexOnce) {
    for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{63}, std::size_t{10007}})
        for (const std::size_t grain : {std::size_t{0}, std::size_t{1}, std::size_t{7}, std::size_t{20000}})
            EXPECT_EQ(visits(count, grain), std::vector<int>(count, 1)) << count << " by " << grain;
}

TEST_P(ParallelFor, DoesNothingForNothing) {
    parallelFor(0, 1, [](std::size_t, std::size_t, int) { FAIL() << "called"; });
}

TEST_P(ParallelFor, ChunksAreNotLongerThanTheGrain) {
    parallelFor(1000, 16, [](std::size_t begin, std::size_t end, int) { EXPECT_LE(end - begin, 16U); });
}

TEST_P(ParallelFor, NoTwoBodiesHaveTheSameWorkerAtOneTime) {
    std::vector<std::atomic<int>> busy(static_cast<std::size_t>(GetParam()));
    parallelFor(500, 1, [&](std::size_t, std::size_t, int worker) {
        ASSERT_GE(worker, 0);
        ASSERT_LT(worker, GetParam());
        EXPECT_EQ(busy[static_cast<std::size_t>(worker)]++, 0);
        std::this_thread::yield(); // gives others the chance to come in between
        --busy[static_cast<std::size_t>(worker)];
    });
}

TEST_P(ParallelFor, PassesOnWhatABodyThrows) {
    std::atomic<int> bodies{0};
    const auto failing = [&](std::size_t begin, std::size_t, int) {
        ++bodies;
        if (begin == 37) throw std::domain_error("thirty-seven");
    };
    try {
        parallelFor(100, 1, failing);
        FAIL() << "nothing was thrown";
    } catch (const std::domain_error& error) {
        EXPECT_STREQ(error.what(), "thirty-seven");
    }
    EXPECT_LE(bodies, 100);
    EXPECT_EQ(visits(100, 1), std::vector<int>(100, 1)) << "the next loop must not suffer";
}

TEST_P(ParallelFor, MayBeNested) {
    constexpr std::size_t kOuter = 20, kInner = 300;
    std::vector<std::atomic<int>> visited(kOuter * kInner);
    std::vector<std::atomic<int>> busy(static_cast<std::size_t>(GetParam()));
    parallelFor(kOuter, 1, [&](std::size_t outerBegin, std::size_t outerEnd, int outerWorker) {
        // A thread that waits for its inner loop must not start another outer body meanwhile.
        EXPECT_EQ(busy[static_cast<std::size_t>(outerWorker)]++, 0);
        for (std::size_t outer = outerBegin; outer < outerEnd; ++outer)
            parallelFor(kInner, 10, [&](std::size_t begin, std::size_t end, int worker) {
                EXPECT_LT(worker, GetParam());
                for (std::size_t i = begin; i < end; ++i) ++visited[outer * kInner + i];
            });
        --busy[static_cast<std::size_t>(outerWorker)];
    });
    for (const std::atomic<int>& count : visited) ASSERT_EQ(count, 1);
}

INSTANTIATE_TEST_SUITE_P(WithThreads, ParallelFor, testing::Values(1, 2, 8), testing::PrintToStringParamName());

TEST(ThreadCount, IsWhatWasSetAndAtLeastOneByDefault) {
    setThreadCount(3);
    EXPECT_EQ(threadCount(), 3);
    setThreadCount(0);
    EXPECT_GE(threadCount(), 1);
}

} // namespace
} // namespace lambert
