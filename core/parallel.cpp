#include "core/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <thread>
#include <vector>

#ifndef LAMBERT_STD_THREADS
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

namespace lambert {

namespace {

int processorCount() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

thread_local int configuredThreads = 0;

} // namespace

int threadCount() { return configuredThreads > 0 ? configuredThreads : processorCount(); }

ThreadCountScope::ThreadCountScope(int count) : before_(configuredThreads) { setThreadCount(count); }

#ifndef LAMBERT_STD_THREADS

void setThreadCount(int count) {
    configuredThreads = count;
    // More threads than processors are to be had only by raising oneTBB's own limit.
    static thread_local std::unique_ptr<tbb::global_control> limit;
    limit.reset();
    if (count > processorCount())
        limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                      static_cast<std::size_t>(count));
}

void parallelFor(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t, int)>& body) {
    if (count == 0) return;
    tbb::task_arena arena(threadCount());
    arena.execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, count, std::max<std::size_t>(1, grain)),
            [&](const tbb::blocked_range<std::size_t>& range) {
                body(range.begin(), range.end(), tbb::this_task_arena::current_thread_index());
            },
            tbb::simple_partitioner());
    });
}

#else

void setThreadCount(int count) { configuredThreads = count; }

void parallelFor(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t, int)>& body) {
    if (count == 0) return;
    grain = std::max<std::size_t>(1, grain);
    std::atomic<std::size_t> next{0};
    std::atomic<bool> failed{false};
    std::exception_ptr failure;
    const auto work = [&](int worker) {
        try {
            while (!failed) {
                const std::size_t begin = next.fetch_add(grain);
                if (begin >= count) return;
                body(begin, std::min(count, begin + grain), worker);
            }
        } catch (...) {
            if (!failed.exchange(true)) failure = std::current_exception();
        }
    };
    std::vector<std::thread> threads;
    for (int worker = 1; worker < threadCount(); ++worker) threads.emplace_back(work, worker);
    work(0);
    for (std::thread& thread : threads) thread.join();
    if (failure) std::rethrow_exception(failure);
}

#endif

} // namespace lambert
