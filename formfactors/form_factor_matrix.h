#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace lambert {

/// One entry of a row: the fraction F_ij of what leaves patch i that reaches patch j.
struct FormFactor {
    std::uint32_t patch; //!< j
    double value;        //!< F_ij, above 0
    bool operator==(const FormFactor&) const = default;
};

/// All that leaves one patch: Σ_j F_ij + back + out = 1.
struct FormFactorRow {
    std::vector<FormFactor> entries; //!< ascending by patch
    double back = 0.0;               //!< F_i,back: meets a black back face
    double out = 0.0;                //!< F_i,out: leaves the scene
    std::uint32_t lines = 0;         //!< every factor is a whole multiple of 1 / lines; 0: not of that kind
    float error = 0.0F;              //!< what the method knows of Σ_j |ΔF_ij|; 0: nothing

    /// Σ_j F_ij + back + out.
    double sum() const;
    bool operator==(const FormFactorRow&) const = default;
};

/// How a matrix keeps its factors.
enum class MatrixStorage {
    Double, ///< 12 bytes per factor
    Float,  ///< 8 bytes per factor, exact to 6e-8
    Compact ///< about 3 bytes per factor: exact for rows of lines, else to 1.7e-4 with row sums right to 1e-6
};

/// double, float or compact; nothing for any other name.
std::optional<MatrixStorage> storageByName(std::string_view name);
std::string_view nameOf(MatrixStorage storage);
/// Bytes that a factor takes, about.
double bytesPerFactor(MatrixStorage storage);

/// Sparse form factors, one row per patch.
class FormFactorMatrix {
public:
    explicit FormFactorMatrix(std::size_t patches = 0, MatrixStorage storage = MatrixStorage::Float);

    std::size_t size() const { return rows_.size(); } //!< #patches
    MatrixStorage storage() const { return storage_; }

    /// Packs a row away. Different rows may be set by different threads. Throws std::bad_alloc.
    void setRow(std::size_t patch, const FormFactorRow& row);
    /// The row as stored.
    FormFactorRow row(std::size_t patch) const;

    /// Appends the row as its bytes in memory, which no other storage or version understands.
    void appendBytes(std::size_t patch, std::vector<std::byte>& bytes) const;
    /// Sets a row from such bytes; false, and nothing done, if they are none.
    bool setBytes(std::size_t patch, std::span<const std::byte> bytes);

    double back(std::size_t patch) const { return rows_[patch].back; }
    double out(std::size_t patch) const { return rows_[patch].out; }
    float error(std::size_t patch) const { return rows_[patch].error; } //!< see FormFactorRow
    std::size_t entryCount(std::size_t patch) const { return rows_[patch].count; }
    /// Whether nothing is known of the patch: no line has met it. Such rows do not sum to 1.
    bool isEmpty(std::size_t patch) const {
        return rows_[patch].count == 0 && rows_[patch].back == 0.0 && rows_[patch].out == 0.0;
    }

    /// Calls `use(j, F_ij)` for every stored factor of a row, ascending by j.
    template <typename Use>
    void visit(std::size_t patch, Use&& use) const {
        const PackedRow& row = rows_[patch];
        byStorage([&]<typename Value>(Value) { visitPlain<Value>(row, use); }, [&] { visitCompact(row, use); });
    }

    std::size_t entryCount() const;
    std::size_t bytes() const;

private:
    struct PackedRow {
        /// Plain: #count values, then #count patches. Compact: #count codes of 16 bits, then the steps from patch to patch.
        std::unique_ptr<std::byte[]> data;
        std::uint32_t count = 0;
        std::uint32_t bytes = 0;
        float error = 0.0F;
        bool counts = false; ///< compact codes are numbers of lines, not logarithms
        double scale = 0.0;  ///< of compact codes
        double back = 0.0, out = 0.0;
    };

    /// A logarithmic code k stands for scale · 2^(−k / 2048); the last one for 0.
    static constexpr int kFractionBits = 11;
    static constexpr unsigned kFractionMask = (1U << kFractionBits) - 1U;
    static constexpr std::uint16_t kZeroCode = 0xFFFF;
    /// A step to the next patch in one byte: 0 for the very next; this one announces the patch's number in four bytes.
    static constexpr std::uint8_t kEscape = 0xFF;

    struct PowerTable {
        std::array<double, 1 << kFractionBits> fraction;       ///< 2^(−k / 2048)
        std::array<double, 1 << (16 - kFractionBits)> integer; ///< 2^−k
    };
    static const PowerTable& powerTable();

    /// Calls `plain` with a number of the type in which the matrix keeps its values, or `compact`.
    template <typename Plain, typename Compact>
    void byStorage(Plain&& plain, Compact&& compact) const {
        switch (storage_) {
        case MatrixStorage::Double:
            return plain(double{});
        case MatrixStorage::Float:
            return plain(float{});
        case MatrixStorage::Compact:
            return compact();
        }
    }

    template <typename Value>
    static void packPlain(const FormFactorRow& row, PackedRow& packed);
    static void packCompact(const FormFactorRow& row, PackedRow& packed);
    static void codeLogarithms(const FormFactorRow& row, PackedRow& packed, std::span<std::uint16_t> codes);

    template <typename Value, typename Use>
    static void visitPlain(const PackedRow& row, Use&& use) {
        const auto* values = reinterpret_cast<const Value*>(row.data.get());
        const auto* patches = reinterpret_cast<const std::uint32_t*>(values + row.count);
        for (std::uint32_t k = 0; k < row.count; ++k) use(patches[k], static_cast<double>(values[k]));
    }

    template <typename Use>
    static void visitCompact(const PackedRow& row, Use&& use) {
        const auto* codes = reinterpret_cast<const std::uint16_t*>(row.data.get());
        const auto* steps = reinterpret_cast<const std::uint8_t*>(codes + row.count);
        const PowerTable& table = powerTable();
        std::uint32_t patch = kBeforeFirst;
        for (std::uint32_t k = 0; k < row.count; ++k) {
            patch = nextPatch(patch, steps);
            const std::uint16_t code = codes[k];
            if (row.counts)
                use(patch, row.scale * code);
            else if (code != kZeroCode)
                use(patch, row.scale * table.fraction[code & kFractionMask] * table.integer[code >> kFractionBits]);
        }
    }

    static constexpr std::uint32_t kBeforeFirst = 0xFFFFFFFF; ///< one step later it is patch 0
    static std::uint32_t nextPatch(std::uint32_t patch, const std::uint8_t*& steps) {
        const std::uint8_t step = *steps++;
        if (step != kEscape) return patch + 1U + step;
        std::uint32_t result = 0;
        for (int k = 0; k < 4; ++k) result |= static_cast<std::uint32_t>(*steps++) << (8 * k);
        return result;
    }

    MatrixStorage storage_;
    std::vector<PackedRow> rows_;
};

} // namespace lambert
