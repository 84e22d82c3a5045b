#include "core/progress.h"

#include "core/error.h"

namespace lambert {

void Progress::begin(std::string_view stage, std::uint64_t total) {
    throwIfCancelled();
    done_ = 0;
    total_ = total;
    onBegin(stage, total);
}

void Progress::advance(std::uint64_t units) {
    throwIfCancelled();
    onAdvance(done_.fetch_add(units, std::memory_order_relaxed) + units, total_);
}

void Progress::end() { onEnd(); }

void Progress::throwIfCancelled() const {
    if (cancelled()) throw Cancelled();
}

} // namespace lambert
