/// Linked into every test program: a test whose checks fail ten times ends, because one that fails in a loop over rays would go on
/// to report millions.

#include <gtest/gtest.h>

namespace {

class FailureLimit : public testing::EmptyTestEventListener {
    void OnTestStart(const testing::TestInfo&) override { failures_ = 0; }
    void OnTestPartResult(const testing::TestPartResult& result) override {
        constexpr int kMost = 10;
        if (result.failed() && ++failures_ >= kMost) throw testing::AssertionException(result);
    }
    int failures_ = 0; // reports come one at a time
};

const bool registered = [] {
    testing::UnitTest::GetInstance()->listeners().Append(new FailureLimit);
    return true;
}();

} // namespace
