#include "formfactors/global_line_counts.h"

#include "core/error.h"
#include "core/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <utility>

namespace lambert {

namespace {

constexpr std::size_t kBlocks = 256;                         ///< of rows, about
constexpr std::size_t kEntriesAtOnce = std::size_t{1} << 24; ///< 128 MB

/// Seven bits to a byte, lowest first; the last byte has its highest bit clear.
void writeNumber(std::vector<std::uint8_t>& bytes, std::uint64_t number) {
    for (; number >= 0x80; number >>= 7) bytes.push_back(static_cast<std::uint8_t>(number | 0x80));
    bytes.push_back(static_cast<std::uint8_t>(number));
}

std::uint32_t readNumber(const std::uint8_t*& byte) {
    std::uint32_t number = *byte & 0x7FU;
    for (int shift = 7; (*byte++ & 0x80U) != 0; shift += 7) number |= (*byte & 0x7FU) << shift;
    return number;
}

} // namespace

SpanLog::SpanLog(std::size_t patches)
    : patches_(static_cast<std::uint32_t>(patches)), columnBits_(static_cast<unsigned>(std::bit_width(patches + 1))) {
    if (patches > kMostPatches)
        throw UsageError(fmt::format("global lines: found {} patches, allowed are at most {}", patches, kMostPatches));
    const auto bits = static_cast<unsigned>(std::bit_width(patches / kBlocks));
    rowBits_ = std::min(bits, 32U - columnBits_);
    blocks_.resize((patches >> rowBits_) + 1);
}

std::uint64_t SpanLog::size() const {
    std::uint64_t size = 0;
    for (const std::vector<std::uint32_t>& block : blocks_) size += block.size();
    return size;
}

void SpanLog::clear() {
    for (std::vector<std::uint32_t>& block : blocks_) block.clear();
}

/// Counts by column, one per thread, zero between the rows.
class GlobalLineCounts::Counters {
public:
    explicit Counters(std::size_t columnCount)
        : count_(columnCount, 0), touched_(columnCount / 64 + 1, 0), touchedWords_(touched_.size() / 64 + 1, 0) {}

    void add(std::uint32_t column, std::uint32_t count) {
        count_[column] += count;
        touched_[column / 64] |= std::uint64_t{1} << (column % 64);
        touchedWords_[column / 4096] |= std::uint64_t{1} << (column / 64 % 64);
    }

    /// Takes the counts above 0 by column, and sets them to 0.
    template <typename Use>
    void drain(Use&& use) {
        drainBits(touchedWords_, 0, touchedWords_.size(), [&](std::size_t word) {
            drainBits(touched_, word, word + 1, [&](std::size_t column) {
                use(static_cast<std::uint32_t>(column), std::exchange(count_[column], 0));
            });
        });
    }

    std::vector<std::uint32_t> rowEnd, columns; ///< scratch of countBlock
    std::vector<std::uint8_t> bytes;            ///< scratch of countBlock

private:
    template <typename Use>
    static void drainBits(std::vector<std::uint64_t>& words, std::size_t first, std::size_t last, Use&& use) {
        for (std::size_t k = first; k < last; ++k)
            for (std::uint64_t word = std::exchange(words[k], 0); word != 0; word &= word - 1)
                use(64 * k + static_cast<std::size_t>(std::countr_zero(word)));
    }

    std::vector<std::uint32_t> count_;
    std::vector<std::uint64_t> touched_, touchedWords_; ///< a bit per column, a bit per word of these
};

GlobalLineCounts::GlobalLineCounts(std::size_t patches) : rows_(patches) {}

/// Calls use(j, N_ij) for j > i, ascending.
template <typename Use>
void GlobalLineCounts::visit(std::size_t row, Use&& use) const {
    auto column = static_cast<std::uint32_t>(row);
    const std::uint8_t* byte = rows_[row].data();
    const std::uint8_t* end = byte + rows_[row].size();
    while (byte != end) {
        column += readNumber(byte) + 1;
        use(column, readNumber(byte));
    }
}

void GlobalLineCounts::countBlock(std::span<SpanLog> logs, std::size_t block, Counters& counters) {
    const unsigned rowBits = logs[0].rowBits_;
    const unsigned columnBits = logs[0].columnBits_;
    const std::uint32_t columnMask = (1U << columnBits) - 1U;
    const std::size_t firstRow = block << rowBits;
    const std::size_t rowCount = std::min(std::size_t{1} << rowBits, rows_.size() - firstRow);

    counters.rowEnd.assign(rowCount + 1, 0);
    for (const SpanLog& log : logs)
        for (const std::uint32_t span : log.blocks_[block]) ++counters.rowEnd[(span >> columnBits) + 1];
    for (std::size_t k = 0; k < rowCount; ++k) counters.rowEnd[k + 1] += counters.rowEnd[k];
    counters.columns.resize(counters.rowEnd.back());
    for (const SpanLog& log : logs)
        for (const std::uint32_t span : log.blocks_[block])
            counters.columns[counters.rowEnd[span >> columnBits]++] = span & columnMask;

    std::size_t next = 0;
    for (std::size_t k = 0; k < rowCount; ++k) {
        if (next == counters.rowEnd[k]) continue;
        const std::size_t row = firstRow + k;
        visit(row, [&](std::uint32_t column, std::uint32_t count) { counters.add(column, count); });
        for (; next < counters.rowEnd[k]; ++next) counters.add(counters.columns[next], 1);
        counters.bytes.clear();
        auto before = static_cast<std::uint32_t>(row);
        counters.drain([&](std::uint32_t column, std::uint32_t count) {
            writeNumber(counters.bytes, column - before - 1);
            writeNumber(counters.bytes, count);
            before = column;
        });
        rows_[row] = std::vector<std::uint8_t>(counters.bytes.begin(), counters.bytes.end());
    }
}

void GlobalLineCounts::count(std::span<SpanLog> logs, std::uint64_t lines) {
    std::vector<Counters> counters(static_cast<std::size_t>(threadCount()), Counters(rows_.size() + 2));
    const std::size_t blocks = logs[0].blocks_.size();
    parallelFor(blocks, 1, [&](std::size_t begin, std::size_t end, int worker) {
        for (std::size_t block = begin; block < end; ++block)
            countBlock(logs, block, counters[static_cast<std::size_t>(worker)]);
    });
    for (SpanLog& log : logs) log.clear();
    lines_ += lines;
}

std::vector<std::uint32_t> GlobalLineCounts::crossings() const {
    std::vector<std::uint32_t> result(size() + 2, 0);
    for (std::size_t row = 0; row < size(); ++row) {
        std::uint32_t sum = 0;
        visit(row, [&](std::uint32_t column, std::uint32_t count) {
            sum += count;
            result[column] += count;
        });
        result[row] += sum;
    }
    result.resize(size());
    return result;
}

std::vector<double> GlobalLineCounts::repairWeights(std::span<const float> area) const {
    const std::vector<std::uint32_t> lines = crossings();
    std::vector<double> weight(size());
    for (std::size_t i = 0; i < size(); ++i) weight[i] = static_cast<double>(lines[i]) / static_cast<double>(area[i]);
    return weight;
}

FormFactorMatrix GlobalLineCounts::matrix(MatrixStorage storage, Progress& progress) const {
    struct Entry {
        std::uint32_t patch, count;
    };
    const std::vector<std::uint32_t> lines = crossings();
    std::vector<std::size_t> begin(size() + 3, 0); // of what the rows before it hold of a column
    for (std::size_t row = 0; row < size(); ++row)
        visit(row, [&](std::uint32_t column, std::uint32_t) { ++begin[column + 1]; });
    for (std::size_t row = 0; row < size(); ++row) begin[row + 1] += begin[row];

    FormFactorMatrix result(size(), storage);
    std::vector<Entry> mirrored;
    std::vector<std::size_t> end;
    progress.begin("matrix", size());
    for (std::size_t first = 0; first < size();) {
        std::size_t last = first + 1;
        while (last < size() && begin[last + 1] - begin[first] <= kEntriesAtOnce) ++last;
        mirrored.resize(begin[last] - begin[first]);
        end.assign(begin.begin() + static_cast<std::ptrdiff_t>(first),
                   begin.begin() + static_cast<std::ptrdiff_t>(last));
        for (std::size_t row = 0; row < last; ++row)
            visit(row, [&](std::uint32_t column, std::uint32_t count) {
                if (column >= first && column < last)
                    mirrored[end[column - first]++ - begin[first]] = {static_cast<std::uint32_t>(row), count};
            });
        parallelFor(last - first, 8, [&](std::size_t from, std::size_t to, int) {
            FormFactorRow row;
            for (std::size_t i = first + from; i < first + to; ++i) {
                const auto n = static_cast<double>(lines[i]);
                row = {};
                row.lines = lines[i];
                for (std::size_t k = begin[i]; k < begin[i + 1]; ++k) {
                    const Entry& entry = mirrored[k - begin[first]];
                    row.entries.push_back({entry.patch, entry.count / n});
                }
                visit(i, [&](std::uint32_t column, std::uint32_t count) {
                    if (column < size())
                        row.entries.push_back({column, count / n});
                    else
                        (column == size() ? row.back : row.out) = count / n;
                });
                result.setRow(i, row);
            }
            progress.advance(to - from);
        });
        first = last;
    }
    progress.end();
    return result;
}

} // namespace lambert
