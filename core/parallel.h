#pragma once

#include <cstddef>
#include <functional>

namespace lambert {

/// Number of threads that parallel loops use; at first the number of processors.
int threadCount();

/// Sets the number of threads for all following loops; `count` >= 1, or 0 for the number of processors.
void setThreadCount(int count);

/// Runs `body(begin, end, worker)` over [0, count) in chunks of about `grain` items, on threadCount()
/// threads. `worker` is in [0, threadCount()) and unique among the bodies running at one time, so it can
/// index per-thread scratch memory. Which worker gets which chunk is unspecified: results must not depend
/// on it. An exception of a body ends the loop and is rethrown here.
void parallelFor(std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t begin, std::size_t end, int worker)>& body);

} // namespace lambert
