#include "core/progress.h"

#include "core/error.h"
#include "core/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <string>
#include <vector>

namespace lambert {
namespace {

class RecordingProgress : public Progress {
public:
    std::vector<std::string> stages;
    std::vector<std::uint64_t> counts;
    std::uint64_t lastTotal = 0;
    int ends = 0;

protected:
    void onBegin(std::string_view stage, std::uint64_t total) override {
        stages.emplace_back(stage);
        counts.clear();
        lastTotal = total;
    }
    void onAdvance(std::uint64_t done, std::uint64_t total) override {
        const std::lock_guard lock(mutex_);
        counts.push_back(done);
        EXPECT_EQ(total, lastTotal);
    }
    void onEnd() override { ++ends; }

private:
    std::mutex mutex_;
};

TEST(Progress, CountsUnitsAndStartsEachStageAtZero) {
    RecordingProgress progress;
    progress.begin("first", 10);
    progress.advance();
    progress.advance(4);
    progress.end();
    EXPECT_EQ(progress.counts, (std::vector<std::uint64_t>{1, 5}));
    progress.begin("second", 0);
    progress.advance(2);
    progress.end();
    EXPECT_EQ(progress.counts, std::vector<std::uint64_t>{2});
    EXPECT_EQ(progress.stages, (std::vector<std::string>{"first", "second"}));
    EXPECT_EQ(progress.ends, 2);
}

TEST(Progress, LosesNoUnitOfAnyThread) {
    setThreadCount(4);
    RecordingProgress progress;
    progress.begin("rows", 1000);
    parallelFor(1000, 1, [&](std::size_t, std::size_t, int) { progress.advance(); });
    setThreadCount(0);
    ASSERT_EQ(progress.counts.size(), 1000U);
    std::sort(progress.counts.begin(), progress.counts.end());
    for (std::uint64_t i = 0; i < 1000; ++i) EXPECT_EQ(progress.counts[i], i + 1);
}

TEST(Progress, ThrowsCancelledAfterCancel) {
    RecordingProgress progress;
    progress.begin("stage", 10);
    progress.throwIfCancelled();
    EXPECT_FALSE(progress.cancelled());
    progress.cancel();
    EXPECT_TRUE(progress.cancelled());
    EXPECT_THROW(progress.advance(), Cancelled);
    EXPECT_THROW(progress.throwIfCancelled(), Cancelled);
    EXPECT_THROW(progress.begin("next", 10), Cancelled);
    EXPECT_TRUE(progress.counts.empty());
    EXPECT_EQ(progress.stages.size(), 1U);
    progress.end(); // a destructor may call it
}

TEST(Progress, CancelEndsAParallelLoop) {
    Progress progress;
    progress.begin("stage", 0);
    const auto loop = [&] {
        parallelFor(1000, 1, [&](std::size_t begin, std::size_t, int) {
            if (begin == 500) progress.cancel();
            progress.advance();
        });
    };
    EXPECT_THROW(loop(), Cancelled);
}

TEST(Error, KnowsWhatTheShellIsTold) {
    EXPECT_EQ(UsageError("u").exitCode(), ExitCode::Usage);
    EXPECT_EQ(InputError("i").exitCode(), ExitCode::Input);
    EXPECT_EQ(SystemError("s").exitCode(), ExitCode::System);
    EXPECT_EQ(static_cast<int>(Cancelled().exitCode()), 130);
    EXPECT_STREQ(InputError("scene.obj:3: no").what(), "scene.obj:3: no");
}

} // namespace
} // namespace lambert
