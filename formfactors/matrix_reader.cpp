#include "core/error.h"
#include "formfactors/matrix_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <fstream>
#include <limits>
#include <string_view>

namespace lambert {

namespace fs = std::filesystem;

namespace {

/// No factor exceeds 1, but single ones of crude estimates do by a little.
constexpr double kLargestFactor = 1.01;

std::ifstream opened(const fs::path& path) {
    std::error_code error;
    if (!fs::exists(path, error)) throw InputError(path.string() + ": no such file");
    if (!fs::is_regular_file(path, error)) throw InputError(path.string() + ": found no regular file");
    std::ifstream stream(path, std::ios::binary);
    if (!stream) throw InputError(path.string() + ": cannot be read");
    return stream;
}

/// A text file as numbers, line by line.
class NumberLines {
public:
    explicit NumberLines(const fs::path& path) : name_(path.string()), stream_(opened(path)) {}

    /// The next line that is not empty and does not begin with `comment`; false at the end.
    bool next(char comment) {
        do {
            if (!std::getline(stream_, line_)) return false;
            ++number_;
            if (!line_.empty() && line_.back() == '\r') line_.pop_back();
        } while (line_.empty() || line_.front() == comment);
        rest_ = line_;
        return true;
    }
    void require(char comment, const char* expected) {
        if (!next(comment)) fail("the file's end", expected);
    }

    const std::string& line() const { return line_; }

    bool atEnd() {
        while (!rest_.empty() && isSeparator(rest_.front())) rest_.remove_prefix(1);
        return rest_.empty();
    }

    template <typename Number>
    Number number(Number lowest, Number highest, const char* expected) {
        if (atEnd()) fail("the line's end", expected);
        Number value{};
        const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
        const auto length = static_cast<std::size_t>(end - rest_.data());
        const bool whole = length == rest_.size() || isSeparator(rest_[length]);
        if (error != std::errc() || !whole || !(value >= lowest && value <= highest)) {
            const std::string_view word = rest_.substr(0, std::min<std::size_t>(rest_.find_first_of(" ,\t"), 30));
            fail(fmt::format("\"{}\"", word), expected);
        }
        rest_.remove_prefix(length);
        return value;
    }
    double factor() { return number(0.0, kLargestFactor, "a form factor, 0 to 1"); }

    [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
        throw InputError(fmt::format("{}:{}: found {}, expected {}", name_, number_, found, expected));
    }

private:
    static bool isSeparator(char c) { return c == ' ' || c == '\t' || c == ','; }

    std::string name_;
    std::ifstream stream_;
    std::string line_;
    std::string_view rest_;
    std::size_t number_ = 0;
};

/// Collects rows that come in order of i, and closes them.
class RowsInOrder {
public:
    RowsInOrder(std::size_t count, MatrixStorage storage) : matrix_(count, storage) {}

    void add(std::size_t j, double factor) {
        if (factor > 0.0) row_.entries.push_back({static_cast<std::uint32_t>(j), factor});
    }
    void finishRow() {
        std::sort(row_.entries.begin(), row_.entries.end(), [](auto& a, auto& b) { return a.patch < b.patch; });
        row_.back = row_.out = 0.0;
        row_.out = std::max(0.0, 1.0 - row_.sum());
        matrix_.setRow(next_++, row_);
        row_.entries.clear();
    }
    std::size_t finishedRows() const { return next_; }
    FormFactorMatrix take() { return std::move(matrix_); }

private:
    FormFactorMatrix matrix_;
    FormFactorRow row_;
    std::size_t next_ = 0;
};

FormFactorMatrix readMatrixMarket(const fs::path& path, MatrixStorage storage) {
    NumberLines lines(path);
    lines.require('\0', "a Matrix Market header");
    if (lines.line() != "%%MatrixMarket matrix coordinate real general")
        lines.fail(fmt::format("\"{}\"", lines.line().substr(0, 60)), "%%MatrixMarket matrix coordinate real general");
    lines.require('%', "rows, columns, entries");
    constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max() - 1;
    const auto rows = lines.number<std::uint64_t>(1, kMost, "the number of rows");
    const auto columns = lines.number<std::uint64_t>(1, kMost, "the number of columns");
    if (rows != columns) lines.fail(fmt::format("{} rows, {} columns", rows, columns), "a square matrix");
    const auto entries =
        lines.number<std::uint64_t>(0, rows * columns, "the number of entries, at most rows times columns");
    if (entries < rows / 1000) lines.fail(fmt::format("{} entries of {} rows", entries, rows), "a form-factor matrix");

    // In any order: sorted first, then packed.
    struct Entry {
        std::uint32_t row, column;
        double factor;
    };
    std::vector<Entry> found;
    for (std::uint64_t k = 0; k < entries; ++k) {
        lines.require('%', fmt::format("{} entries", entries).c_str());
        const auto i = lines.number<std::uint64_t>(1, rows, "a row's number, from 1");
        const auto j = lines.number<std::uint64_t>(1, columns, "a column's number, from 1");
        found.push_back({static_cast<std::uint32_t>(i - 1), static_cast<std::uint32_t>(j - 1), lines.factor()});
    }
    if (lines.next('%')) lines.fail("another entry", fmt::format("{} in all", entries));
    std::stable_sort(found.begin(), found.end(), [](const Entry& a, const Entry& b) { return a.row < b.row; });
    RowsInOrder result(rows, storage);
    auto entry = found.begin();
    for (std::uint32_t i = 0; i < rows; ++i) {
        for (; entry != found.end() && entry->row == i; ++entry) result.add(entry->column, entry->factor);
        result.finishRow();
    }
    return result.take();
}

FormFactorMatrix readCsv(const fs::path& path, MatrixStorage storage) {
    NumberLines lines(path);
    lines.require('#', "a row of factors");
    const auto count = static_cast<std::size_t>(std::count(lines.line().begin(), lines.line().end(), ',')) + 1;
    if (count > kMostDenseCsv) lines.fail(fmt::format("{} columns", count), fmt::format("at most {}", kMostDenseCsv));
    RowsInOrder result(count, storage);
    for (std::size_t i = 0; i < count; ++i) {
        if (i > 0) lines.require('#', fmt::format("{} rows, as there are columns", count).c_str());
        for (std::size_t j = 0; j < count; ++j) result.add(j, lines.factor());
        if (!lines.atEnd()) lines.fail("more columns", fmt::format("{}", count));
        result.finishRow();
    }
    if (lines.next('#')) lines.fail("another row", fmt::format("{} in all, as there are columns", count));
    return result.take();
}

PatchMatrix readView3D(const fs::path& path, MatrixStorage storage) {
    NumberLines lines(path);
    lines.require('\0', "View3D's header");
    std::size_t count = 0;
    {
        // Program, version, format, enclosure, emittances, number.
        std::string header = lines.line();
        const auto end = header.find_last_not_of(' ');
        const auto begin = end == std::string::npos ? end : header.find_last_of(' ', end);
        const char* const first = header.data() + (begin == std::string::npos ? 0 : begin + 1);
        const char* const last = header.data() + (end == std::string::npos ? 0 : end + 1);
        const auto [stop, error] = std::from_chars(first, last, count);
        constexpr std::size_t kMost = 1'000'000;
        if (error != std::errc() || stop != last || count < 1 || count > kMost || !header.starts_with("View3D"))
            lines.fail(fmt::format("\"{}\"", header.substr(0, 40)), "a header like \"View3D 3.2 0 1 0 N\"");
    }
    // The format holds single precision. Numbers may be broken into lines anywhere.
    const auto advance = [&] {
        while (lines.atEnd()) lines.require('\0', "more numbers");
    };
    PatchMatrix result;
    lines.require('\0', "areas");
    for (std::size_t i = 0; i < count; ++i) {
        advance();
        result.area.push_back(static_cast<double>(lines.number(0.0F, 1e30F, "an area")));
    }
    RowsInOrder rows(count, storage);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = 0; j < count; ++j) {
            advance();
            rows.add(j, static_cast<double>(
                            lines.number(0.0F, static_cast<float>(kLargestFactor), "a form factor, 0 to 1")));
        }
        rows.finishRow();
    }
    for (std::size_t i = 0; i < count; ++i) {
        advance();
        result.emissivity.push_back(lines.number(0.0, 1.0, "an emissivity, 0 to 1"));
    }
    result.matrix = rows.take();
    return result;
}

/// The part of a .npy file after its header. Throws unless it holds little-endian numbers of `type` in C order.
class NumPyArray {
public:
    NumPyArray(const fs::path& path, std::string_view type) : name_(path.string()), stream_(opened(path)) {
        char magic[10]{};
        stream_.read(magic, sizeof magic);
        if (!stream_ || std::memcmp(magic, "\x93NUMPY\x01", 7) != 0) fail("no NumPy file of version 1");
        const auto low = static_cast<unsigned char>(magic[8]);
        const auto high = static_cast<unsigned char>(magic[9]);
        std::string header(static_cast<std::size_t>(low + 256 * high), '\0');
        stream_.read(header.data(), static_cast<std::streamsize>(header.size()));
        if (!stream_) fail("a header that ends early");
        if (header.find(fmt::format("'{}'", type)) == std::string::npos)
            fail("other numbers than " + std::string(type));
        if (header.find("'fortran_order': False") == std::string::npos) fail("columns stored before rows");
        parseShape(header);
        const auto bytes = fs::file_size(path) - sizeof magic - header.size();
        if (bytes / 8 != elements() || bytes % 8 != 0) fail(fmt::format("{} bytes for {} numbers", bytes, elements()));
    }

    const std::vector<std::uint64_t>& shape() const { return shape_; }
    std::uint64_t elements() const {
        std::uint64_t product = 1;
        for (const std::uint64_t side : shape_) product *= side;
        return product;
    }

    template <typename Number>
    void read(std::vector<Number>& numbers, std::size_t count) {
        static_assert(std::endian::native == std::endian::little && sizeof(Number) == 8);
        numbers.resize(count);
        stream_.read(reinterpret_cast<char*>(numbers.data()), static_cast<std::streamsize>(8 * count));
        if (!stream_) fail("the file's end");
    }

    [[noreturn]] void fail(const std::string& found) const {
        throw InputError(fmt::format("{}: found {}, expected a form-factor matrix", name_, found));
    }

private:
    void parseShape(const std::string& header) {
        const std::size_t open = header.find("'shape': (");
        if (open == std::string::npos) fail("no shape");
        const char* at = header.data() + open + std::strlen("'shape': (");
        const char* const end = header.data() + header.size();
        constexpr std::uint64_t kMost = std::uint64_t{1} << 40;
        std::uint64_t side = 0;
        for (auto parsed = std::from_chars(at, end, side); parsed.ec == std::errc();
             parsed = std::from_chars(at, end, side)) {
            if (side > kMost || shape_.size() == 2) fail("another shape");
            shape_.push_back(side);
            at = parsed.ptr;
            while (at != end && (*at == ',' || *at == ' ')) ++at;
        }
        if (shape_.empty() || (shape_.size() == 2 && shape_[0] > (std::uint64_t{1} << 20))) fail("another shape");
    }

    std::string name_;
    std::ifstream stream_;
    std::vector<std::uint64_t> shape_;
};

double checkedFactor(const NumPyArray& array, double factor) {
    if (!(factor >= 0.0 && factor <= kLargestFactor)) array.fail(fmt::format("the factor {}", factor));
    return factor;
}

FormFactorMatrix readDenseNumPy(const fs::path& path, MatrixStorage storage) {
    NumPyArray array(path, "<f8");
    if (array.shape().size() != 2 || array.shape()[0] != array.shape()[1]) array.fail("no square matrix");
    const std::size_t count = array.shape()[0];
    RowsInOrder result(count, storage);
    std::vector<double> row;
    for (std::size_t i = 0; i < count; ++i) {
        array.read(row, count);
        for (std::size_t j = 0; j < count; ++j) result.add(j, checkedFactor(array, row[j]));
        result.finishRow();
    }
    return result.take();
}

FormFactorMatrix readSparseNumPy(const fs::path& stem, MatrixStorage storage) {
    NumPyArray data(fs::path(stem.string() + ".data.npy"), "<f8");
    NumPyArray indices(fs::path(stem.string() + ".indices.npy"), "<i8");
    NumPyArray ends(fs::path(stem.string() + ".indptr.npy"), "<i8");
    std::vector<std::int64_t> end;
    ends.read(end, ends.elements());
    const std::size_t count = end.size() - 1;
    if (end.empty() || end.front() != 0 || !std::is_sorted(end.begin(), end.end()) ||
        static_cast<std::uint64_t>(end.back()) != data.elements() || data.elements() != indices.elements())
        ends.fail("row ends that do not fit the entries");
    RowsInOrder result(count, storage);
    std::vector<double> factors;
    std::vector<std::int64_t> columns;
    for (std::size_t i = 0; i < count; ++i) {
        const auto entries = static_cast<std::size_t>(end[i + 1] - end[i]);
        data.read(factors, entries);
        indices.read(columns, entries);
        for (std::size_t k = 0; k < entries; ++k) {
            if (columns[k] < 0 || static_cast<std::uint64_t>(columns[k]) >= count)
                indices.fail(fmt::format("the column {}", columns[k]));
            result.add(static_cast<std::size_t>(columns[k]), checkedFactor(data, factors[k]));
        }
        result.finishRow();
    }
    return result.take();
}

void readAreas(const fs::path& path, PatchMatrix& patches) {
    NumberLines lines(path);
    patches.area.clear();
    for (std::size_t i = 0; i < patches.matrix.size(); ++i) {
        lines.require('#', "a line \"area,F_back,F_out\" for every patch");
        patches.area.push_back(lines.number(0.0, 1e30, "an area"));
        if (lines.atEnd()) continue;
        FormFactorRow row = patches.matrix.row(i);
        row.back = lines.number(0.0, 1.0 + 1e-6, "F_back, 0 to 1");
        row.out = lines.number(0.0, 1.0 + 1e-6, "F_out, 0 to 1");
        patches.matrix.setRow(i, row);
    }
    if (lines.next('#')) lines.fail("another line", fmt::format("{} in all", patches.matrix.size()));
}

} // namespace

PatchMatrix readMatrix(const fs::path& path, MatrixStorage storage) {
    std::error_code error;
    PatchMatrix result;
    switch (requireMatrixFormat(path)) {
    case MatrixFormat::MatrixMarket:
        result.matrix = readMatrixMarket(path, storage);
        break;
    case MatrixFormat::Csv:
        result.matrix = readCsv(path, storage);
        break;
    case MatrixFormat::View3D:
        result = readView3D(path, storage);
        break;
    case MatrixFormat::NumPy: {
        const fs::path stem = fs::path(path).replace_extension();
        const bool sparse = !fs::exists(path, error) && fs::exists(fs::path(stem.string() + ".indptr.npy"), error);
        result.matrix = sparse ? readSparseNumPy(stem, storage) : readDenseNumPy(path, storage);
        break;
    }
    }
    const fs::path areas(path.string() + ".areas.csv");
    if (fs::exists(areas, error)) readAreas(areas, result);
    return result;
}

} // namespace lambert
