#include "formfactors/form_factor_matrix.h"

#include "core/named.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace lambert {

namespace {

struct StorageFacts : Named<MatrixStorage> {
    double bytes; //!< per factor
};
constexpr std::array<StorageFacts, 3> kStorages{{
    {{MatrixStorage::Double, "double"}, 12.0},
    {{MatrixStorage::Float, "float"}, 8.0},
    {{MatrixStorage::Compact, "compact"}, 3.01} // some steps need five bytes
}};

double entrySum(const FormFactorRow& row) {
    double sum = 0.0;
    for (const FormFactor& entry : row.entries) sum += entry.value;
    return sum;
}

} // namespace

double FormFactorRow::sum() const { return entrySum(*this) + back + out; }

std::optional<MatrixStorage> storageByName(std::string_view name) { return valueNamed(kStorages, name); }
std::string_view nameOf(MatrixStorage storage) { return rowOf(kStorages, storage).name; }
double bytesPerFactor(MatrixStorage storage) { return rowOf(kStorages, storage).bytes; }

FormFactorMatrix::FormFactorMatrix(std::size_t patches, MatrixStorage storage) : storage_(storage), rows_(patches) {}

const FormFactorMatrix::PowerTable& FormFactorMatrix::powerTable() {
    static const PowerTable table = [] {
        PowerTable result{};
        for (std::size_t k = 0; k < result.fraction.size(); ++k)
            result.fraction[k] = std::exp2(-static_cast<double>(k) / static_cast<double>(result.fraction.size()));
        for (std::size_t k = 0; k < result.integer.size(); ++k) result.integer[k] = std::exp2(-static_cast<double>(k));
        return result;
    }();
    return table;
}

template <typename Value>
void FormFactorMatrix::packPlain(const FormFactorRow& row, PackedRow& packed) {
    packed.bytes = static_cast<std::uint32_t>(row.entries.size() * (sizeof(Value) + sizeof(std::uint32_t)));
    packed.data = std::make_unique_for_overwrite<std::byte[]>(packed.bytes);
    auto* values = reinterpret_cast<Value*>(packed.data.get());
    auto* patches = reinterpret_cast<std::uint32_t*>(values + row.entries.size());
    for (const FormFactor& entry : row.entries) {
        *values++ = static_cast<Value>(entry.value);
        *patches++ = entry.patch;
    }
}

void FormFactorMatrix::codeLogarithms(const FormFactorRow& row, PackedRow& packed, std::span<std::uint16_t> codes) {
    double largest = 0.0;
    for (const FormFactor& entry : row.entries) largest = std::max(largest, entry.value);
    constexpr double kSteps = 1 << kFractionBits;
    for (std::size_t k = 0; k < codes.size(); ++k) {
        const double value = row.entries[k].value;
        const double code = value > 0.0 ? std::round(-kSteps * std::log2(value / largest)) : kZeroCode;
        codes[k] = static_cast<std::uint16_t>(std::clamp(code, 0.0, static_cast<double>(kZeroCode)));
    }
    double coded = 0.0;
    packed.scale = 1.0;
    visitCompact(packed, [&](std::uint32_t, double value) { coded += value; });
    if (coded > 0.0) packed.scale = entrySum(row) / coded;
}

void FormFactorMatrix::packCompact(const FormFactorRow& row, PackedRow& packed) {
    const std::size_t count = row.entries.size();
    std::vector<std::uint8_t> steps;
    steps.reserve(count + count / 64);
    std::uint32_t before = kBeforeFirst;
    for (const FormFactor& entry : row.entries) {
        const std::uint32_t step = entry.patch - (before + 1U);
        before = entry.patch;
        if (step < kEscape) {
            steps.push_back(static_cast<std::uint8_t>(step));
            continue;
        }
        steps.push_back(kEscape);
        for (int k = 0; k < 4; ++k) steps.push_back(static_cast<std::uint8_t>(entry.patch >> (8 * k)));
    }
    packed.bytes = static_cast<std::uint32_t>(count * sizeof(std::uint16_t) + steps.size());
    packed.data = std::make_unique_for_overwrite<std::byte[]>(packed.bytes);
    const std::span codes(reinterpret_cast<std::uint16_t*>(packed.data.get()), count);
    std::copy(steps.begin(), steps.end(), reinterpret_cast<std::uint8_t*>(codes.data() + count));

    const auto lines = static_cast<double>(row.lines);
    packed.counts = row.lines > 0 && std::all_of(row.entries.begin(), row.entries.end(),
                                                 [&](const FormFactor& e) { return e.value * lines < 65535.5; });
    if (!packed.counts) {
        codeLogarithms(row, packed, codes);
        return;
    }
    packed.scale = 1.0 / lines;
    for (std::size_t k = 0; k < count; ++k)
        codes[k] = static_cast<std::uint16_t>(std::lround(row.entries[k].value * lines));
}

void FormFactorMatrix::setRow(std::size_t patch, const FormFactorRow& row) {
    PackedRow packed;
    packed.count = static_cast<std::uint32_t>(row.entries.size());
    packed.back = row.back;
    packed.out = row.out;
    packed.error = row.error;
    byStorage([&]<typename Value>(Value) { packPlain<Value>(row, packed); }, [&] { packCompact(row, packed); });
    rows_[patch] = std::move(packed);
}

namespace {

/// What is fixed of a packed row's bytes.
struct RowHeader {
    double scale, back, out;
    std::uint32_t count, counts;
    float error;
    std::uint32_t unused;
};

} // namespace

void FormFactorMatrix::appendBytes(std::size_t patch, std::vector<std::byte>& bytes) const {
    const PackedRow& row = rows_[patch];
    const RowHeader header{row.scale, row.back, row.out, row.count, row.counts ? 1U : 0U, row.error, 0};
    const auto headerBytes = std::as_bytes(std::span(&header, 1));
    bytes.insert(bytes.end(), headerBytes.begin(), headerBytes.end());
    if (row.bytes > 0) bytes.insert(bytes.end(), row.data.get(), row.data.get() + row.bytes);
}

bool FormFactorMatrix::setBytes(std::size_t patch, std::span<const std::byte> bytes) {
    RowHeader header{};
    if (bytes.size() < sizeof header) return false;
    std::memcpy(&header, bytes.data(), sizeof header);
    bytes = bytes.subspan(sizeof header);
    const std::size_t perFactor = storage_ == MatrixStorage::Double ? 12 : storage_ == MatrixStorage::Float ? 8 : 3;
    const std::size_t least = header.count * perFactor;
    if (bytes.size() < least || (storage_ != MatrixStorage::Compact && bytes.size() != least)) return false;
    PackedRow row;
    row.scale = header.scale;
    row.back = header.back;
    row.out = header.out;
    row.count = header.count;
    row.counts = header.counts != 0;
    row.error = header.error;
    row.bytes = static_cast<std::uint32_t>(bytes.size());
    row.data = std::make_unique_for_overwrite<std::byte[]>(row.bytes);
    std::copy(bytes.begin(), bytes.end(), row.data.get());
    rows_[patch] = std::move(row);
    return true;
}

FormFactorRow FormFactorMatrix::row(std::size_t patch) const {
    const PackedRow& packed = rows_[patch];
    FormFactorRow result;
    result.back = packed.back;
    result.out = packed.out;
    result.error = packed.error;
    if (packed.counts) result.lines = static_cast<std::uint32_t>(std::lround(1.0 / packed.scale));
    result.entries.reserve(packed.count);
    visit(patch, [&](std::uint32_t j, double value) { result.entries.push_back({j, value}); });
    return result;
}

std::size_t FormFactorMatrix::entryCount() const {
    std::size_t count = 0;
    for (const PackedRow& row : rows_) count += row.count;
    return count;
}

std::size_t FormFactorMatrix::bytes() const {
    std::size_t bytes = rows_.size() * sizeof(PackedRow);
    for (const PackedRow& row : rows_) bytes += row.bytes;
    return bytes;
}

} // namespace lambert
