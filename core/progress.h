#pragma once

#include <atomic>
#include <cstdint>
#include <string_view>

namespace lambert {

/// Through this a long computation reports how far it is, and learns that it should stop. The base class
/// reports to nobody; a front end overrides the three hooks.
///
/// `advance` may be called from any thread; `begin` and `end` only from the one that runs the stage.
class Progress {
public:
    Progress() = default;
    virtual ~Progress() = default;
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Starts a stage of `total` equal units (0: unknown) and sets the count to 0.
    void begin(std::string_view stage, std::uint64_t total);
    /// Counts `units` as done. Throws Cancelled if the computation should stop.
    void advance(std::uint64_t units = 1);
    void end();

    /// Throws Cancelled if the computation should stop.
    void throwIfCancelled() const;
    /// Asks the computation to stop at its next `advance`; safe inside a signal handler.
    void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
    bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }

protected:
    virtual void onBegin(std::string_view /*stage*/, std::uint64_t /*total*/) {}
    virtual void onAdvance(std::uint64_t /*done*/, std::uint64_t /*total*/) {} ///< from any thread
    virtual void onEnd() {}

private:
    std::atomic<std::uint64_t> done_{0};
    std::uint64_t total_ = 0;
    std::atomic<bool> cancelled_{false};
    static_assert(std::atomic<bool>::is_always_lock_free);
};

} // namespace lambert
