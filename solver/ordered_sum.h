#pragma once

#include "core/parallel.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lambert {

/// Patches that passes over all patches take at a time.
inline constexpr std::size_t kPatchBlock = 4096;

/// Σ term(i) for i < count, in parallel, with the same bits whatever the number of threads: by blocks, then over these.
template <typename Value, typename Term>
Value orderedSum(std::size_t count, const Value& zero, Term&& term) {
    std::vector<Value> blocks((count + kPatchBlock - 1) / kPatchBlock, zero);
    parallelFor(blocks.size(), 1, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t b = begin; b < end; ++b)
            for (std::size_t i = b * kPatchBlock; i < std::min((b + 1) * kPatchBlock, count); ++i) blocks[b] += term(i);
    });
    Value sum = zero;
    for (const Value& block : blocks) sum += block;
    return sum;
}

/// Calls body(i) for i < count, in parallel.
template <typename Body>
void forPatches(std::size_t count, Body&& body) {
    parallelFor(count, kPatchBlock, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t i = begin; i < end; ++i) body(i);
    });
}

} // namespace lambert
