#pragma once

#include <cstddef>
#include <functional>

namespace lambert {

/// Number of threads that loops started by the calling thread use; at first the number of processors.
int threadCount();

/// Sets it for all following loops that the calling thread starts; `count` >= 1, or 0 for the number of processors.
void setThreadCount(int count);

/// Sets it while it lives, and the old one afterwards.
class ThreadCountScope {
public:
    explicit ThreadCountScope(int count);
    ~ThreadCountScope() { setThreadCount(before_); }
    ThreadCountScope(const ThreadCountScope&) = delete;
    ThreadCountScope& operator=(const ThreadCountScope&) = delete;

private:
    int before_;
};

/// Runs `body(begin, end, worker)` over [0, count) in chunks of about `grain` items, on threadCount()
/// threads. `worker` is in [0, threadCount()) and unique among the bodies running at one time, so it can
/// index per-thread scratch memory. Which worker gets which chunk is unspecified: results must not depend
/// on it. An exception of a body ends the loop and is rethrown here.
void parallelFor(std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t begin, std::size_t end, int worker)>& body);

} // namespace lambert
