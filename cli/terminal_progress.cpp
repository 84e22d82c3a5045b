#include "cli/terminal_progress.h"
#include "cli/terminal_text.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <csignal>

namespace lambert {

namespace {

std::atomic<Progress*> cancelledBySignals{nullptr};
static_assert(std::atomic<Progress*>::is_always_lock_free);

extern "C" void onSignal(int signal) {
    if (Progress* progress = cancelledBySignals.load()) progress->cancel();
    std::signal(signal, SIG_DFL);
}

constexpr std::chrono::milliseconds kUpdateInterval{100};
constexpr std::size_t kLongestTitle = 32;

/// A line that wraps could not be cleared.
std::size_t terminalColumns() {
    winsize size{};
    return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col : 80;
}

} // namespace

TerminalProgress::TerminalProgress(bool quiet) : visible_(!quiet && ::isatty(STDERR_FILENO) == 1) {
    cancelledBySignals = this;
    std::signal(SIGINT, onSignal);
    std::signal(SIGTERM, onSignal);
}

TerminalProgress::~TerminalProgress() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    cancelledBySignals = nullptr;
    clearLine();
}

void TerminalProgress::setTitle(const std::string& title) {
    const std::lock_guard lock(mutex_);
    title_ = title.size() > kLongestTitle ? title.substr(0, kLongestTitle - 3) + "..." : title;
    if (!title_.empty()) title_ += ": ";
}

void TerminalProgress::onBegin(std::string_view stage, std::uint64_t /*total*/) {
    const std::lock_guard lock(mutex_);
    stage_ = stage;
    start_ = Clock::now();
    nextUpdate_ = (start_ + kUpdateInterval).time_since_epoch().count();
}

void TerminalProgress::onAdvance(std::uint64_t done, std::uint64_t total) {
    if (!visible_) return;
    const Clock::time_point now = Clock::now();
    auto due = nextUpdate_.load();
    if (now.time_since_epoch().count() < due ||
        !nextUpdate_.compare_exchange_strong(due, (now + kUpdateInterval).time_since_epoch().count()))
        return;
    const std::lock_guard lock(mutex_);
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const double rate = static_cast<double>(done) / seconds;
    std::string line = fmt::format("{}{:<14} ", title_, stage_);
    if (total > 0) {
        const int width = title_.empty() ? 24 : 8;
        const double part = static_cast<double>(done) / static_cast<double>(total);
        const int filled = static_cast<int>(part * width);
        line += fmt::format("[{:#<{}}{:<{}}] {}/{}  {:.3g}/s  {:.0f} s left", "", filled, "", width - filled, done,
                            total, rate, static_cast<double>(total - done) / rate);
    } else {
        line += fmt::format("{}  {:.3g}/s", done, rate);
    }
    writeLog("\r" + line.substr(0, terminalColumns() - 1) + "\033[K");
    lineShown_ = true;
}

void TerminalProgress::onEnd() { clearLine(); }

void TerminalProgress::clearLine() {
    const std::lock_guard lock(mutex_);
    if (lineShown_) writeLog("\r\033[K");
    lineShown_ = false;
}

} // namespace lambert
