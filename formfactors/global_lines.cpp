#include "formfactors/global_lines.h"

#include "core/error.h"
#include "core/parallel.h"

#include <fmt/format.h>

#include <algorithm>

namespace lambert {

namespace {

/// A batch is counted at its end, which rewrites all rows: batches grow with what is counted already, so that this stays a
/// small part of the work, but the log of their spans stays below 256 MB.
constexpr std::uint64_t kSmallestBatch = std::uint64_t{1} << 20; ///< lines
constexpr std::uint64_t kSpansPerBatch = std::uint64_t{1} << 26;

} // namespace

/// What a thread needs.
struct GlobalLines::Scratch {
    explicit Scratch(std::size_t patches) : log(patches) {}
    IsotropicLines::Block block;
    LineSpans::Scratch spans;
    SpanLog log;
};

GlobalLines::GlobalLines(const PatchMesh& mesh, const LineCaster& caster, const GlobalLineOptions& options)
    : mesh_(mesh), options_(options), lines_(caster.bounds(), options), spans_(mesh, caster) {}

void GlobalLines::traceBlock(std::uint64_t block, Scratch& scratch) const {
    lines_.fill(block, scratch.block);
    for (const LinePacket& packet : scratch.block.packets)
        spans_.visit(packet, scratch.spans, [&](std::uint32_t a, std::uint32_t b) { scratch.log.add(a, b); });
}

void GlobalLines::trace(GlobalLineCounts& counts, Progress& progress, const std::function<void()>& afterBatch) const {
    const std::uint64_t perBlock = lines_.linesPerBlock();
    std::uint64_t block = (counts.lines() + perBlock - 1) / perBlock;
    if (counts.size() != mesh_.size() || block > lines_.blockCount() || lines_.linesBefore(block) != counts.lines())
        throw UsageError(fmt::format("global lines: {} lines between {} patches are not part of {} lines between {}",
                                     counts.lines(), counts.size(), options_.lines, mesh_.size()));
    std::vector<Scratch> scratch;
    for (int worker = 0; worker < threadCount(); ++worker) scratch.emplace_back(mesh_.size());
    std::vector<SpanLog> logs;
    progress.begin("lines", options_.lines);
    progress.advance(counts.lines());
    std::uint64_t batch = std::max(kSmallestBatch, counts.lines() / 2);
    while (block < lines_.blockCount()) {
        const std::uint64_t blocks = std::min((batch + perBlock - 1) / perBlock, lines_.blockCount() - block);
        parallelFor(blocks, 1, [&](std::size_t begin, std::size_t end, int worker) {
            for (std::size_t k = begin; k < end; ++k) traceBlock(block + k, scratch[static_cast<std::size_t>(worker)]);
            progress.advance(lines_.linesBefore(block + end) - lines_.linesBefore(block + begin));
        });
        logs.clear();
        for (Scratch& s : scratch) logs.push_back(std::move(s.log));
        std::uint64_t spans = 0;
        for (const SpanLog& log : logs) spans += log.size();
        const std::uint64_t lines = lines_.linesBefore(block + blocks) - lines_.linesBefore(block);
        counts.count(logs, lines);
        for (std::size_t k = 0; k < logs.size(); ++k) scratch[k].log = std::move(logs[k]);
        block += blocks;
        batch = std::max(kSmallestBatch, std::min(counts.lines() / 2, lines * kSpansPerBatch / (spans + 1)));
        if (afterBatch) afterBatch();
    }
    progress.end();
}

} // namespace lambert
