#include "formfactors/global_lines.h"

#include "core/error.h"
#include "core/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

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
    LineCrossings crossings;
    SpanLog log;
    /// The k-th crossings of the packet's lines, for the lookup.
    struct Hits {
        alignas(64) std::uint32_t polygon[16], patch[16];
        alignas(64) float u[16], v[16];
    };
    std::vector<Hits> hits;
};

GlobalLines::GlobalLines(const PatchMesh& mesh, const LineCaster& caster, const GlobalLineOptions& options)
    : mesh_(mesh), caster_(caster), options_(options), lines_(caster.bounds(), options) {
    const Scene& scene = caster.scene();
    for (const Polygon& polygon : scene.polygons) occluder_.push_back(isOccluder(scene, polygon));
    if (std::find(occluder_.begin(), occluder_.end(), true) == occluder_.end()) occluder_.clear();
}

/// The k-th crossings of all lines together: neighbouring lines mostly cross the same polygon, for which the lookup is fastest.
void GlobalLines::findPatches(Scratch& scratch) const {
    for (std::size_t k = 0;; ++k) {
        std::array<int, LinePacket::kSize> lanes{}; // that have a k-th crossing
        std::size_t count = 0;
        for (int lane = 0; lane < LinePacket::kSize; ++lane) {
            lanes[count] = lane;
            count += scratch.crossings[lane].size() > k ? 1 : 0;
        }
        if (count == 0) return;
        if (scratch.hits.size() == k) scratch.hits.emplace_back();
        Scratch::Hits& hits = scratch.hits[k];
        // Where few are missing, others stand for them, so that the polygons may still be all the same.
        const Crossing& other = scratch.crossings[lanes[0]][k];
        std::fill_n(hits.polygon, 16, count >= 8 ? other.polygon : kNone);
        std::fill_n(hits.u, 16, other.u);
        std::fill_n(hits.v, 16, other.v);
        for (std::size_t i = 0; i < count; ++i) {
            const Crossing& crossing = scratch.crossings[lanes[i]][k];
            hits.polygon[lanes[i]] = crossing.polygon;
            hits.u[lanes[i]] = crossing.u;
            hits.v[lanes[i]] = crossing.v;
        }
        mesh_.lookup.patchesAt(hits.polygon, hits.u, hits.v, hits.patch);
    }
}

void GlobalLines::traceBlock(std::uint64_t block, Scratch& scratch) const {
    lines_.fill(block, scratch.block);
    SpanLog& log = scratch.log;
    for (const LinePacket& packet : scratch.block.packets) {
        caster_.cross(packet, scratch.crossings);
        findPatches(scratch);
        for (int line = 0; line < LinePacket::kSize; ++line) {
            std::uint32_t left = log.out(); // what the line left last
            const std::span<const Crossing> crossings = scratch.crossings[line];
            for (std::size_t k = 0; k < crossings.size(); ++k) {
                const Crossing& crossing = crossings[k];
                std::uint32_t front = scratch.hits[k].patch[line];
                std::uint32_t back = std::min(mesh_.lookup.backPatch(crossing.polygon, front), log.back());
                if (!occluder_.empty() && occluder_[crossing.polygon]) front = back = log.back();
                log.add(left, crossing.front ? front : back);
                left = crossing.front ? back : front;
            }
            log.add(left, log.out());
        }
    }
}

void GlobalLines::trace(GlobalLineCounts& counts, Progress& progress,
                        const std::function<void(const GlobalLineCounts&)>& afterBatch) const {
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
        if (afterBatch) afterBatch(counts);
    }
    progress.end();
}

FormFactorMatrix GlobalLines::matrix(MatrixStorage storage, Progress& progress) const {
    GlobalLineCounts counts(mesh_.size());
    trace(counts, progress);
    return counts.matrix(storage, progress);
}

} // namespace lambert
