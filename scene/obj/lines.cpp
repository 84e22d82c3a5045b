#include "scene/obj/lines.h"

#include "core/error.h"
#include "core/input_file.h"
#include "scene/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace lambert {

namespace {

constexpr std::size_t kPiece = std::size_t{1} << 20;
constexpr std::size_t kLongestStatement = std::size_t{1} << 26;

/// Where `c` first stands in [begin, end) of `text`, or `end`.
std::size_t find(const std::string& text, std::size_t begin, std::size_t end, char c) {
    const void* found = begin < end ? std::memchr(text.data() + begin, c, end - begin) : nullptr;
    return found ? static_cast<std::size_t>(static_cast<const char*>(found) - text.data()) : end;
}

} // namespace

ObjLines::ObjLines(const std::filesystem::path& path, std::function<void(std::uint64_t)> onBytes)
    : file_(path.string()), stream_(openInputFile(path)), onBytes_(std::move(onBytes)), buffer_(kPiece, '\0') {
    readPiece();
    removeByteOrderMark();
}

void ObjLines::removeByteOrderMark() {
    const std::string_view text(buffer_.data(), end_);
    if (text.starts_with("\xEF\xBB\xBF")) begin_ = 3;
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
        throw InputError(file_ + ": found UTF-16 text, expected UTF-8 or Latin-1");
}

/// Adds a piece of the file to the buffer; false at its end.
bool ObjLines::readPiece() {
    if (!stream_) return false;
    const std::size_t kept = end_ - begin_;
    std::memmove(buffer_.data(), buffer_.data() + begin_, kept);
    if (buffer_.size() - kept < kPiece) buffer_.resize(2 * buffer_.size());
    stream_.read(buffer_.data() + kept, static_cast<std::streamsize>(kPiece));
    if (stream_.bad()) throw InputError(file_ + ": cannot be read to its end");
    const auto count = static_cast<std::size_t>(stream_.gcount());
    newline_ = newline_ < end_ ? newline_ - begin_ : find(buffer_, kept, kept + count, '\n');
    carriageReturn_ = carriageReturn_ < end_ ? carriageReturn_ - begin_ : find(buffer_, kept, kept + count, '\r');
    begin_ = 0;
    end_ = kept + count;
    if (onBytes_) onBytes_(count);
    return count > 0;
}

/// Where the line at begin_ ends in the buffer; end_ if that is not in it.
std::size_t ObjLines::findLineEnd() {
    if (newline_ < begin_) newline_ = find(buffer_, begin_, end_, '\n');
    if (carriageReturn_ < begin_) carriageReturn_ = find(buffer_, begin_, end_, '\r');
    return std::min(newline_, carriageReturn_);
}

std::optional<std::string_view> ObjLines::physicalLine() {
    std::size_t lineEnd = findLineEnd();
    // A '\r' at the end of a piece may be half of "\r\n".
    while (lineEnd + 1 >= end_) {
        if (end_ - begin_ > kLongestStatement) failTooLong();
        if (!readPiece()) break;
        lineEnd = findLineEnd();
    }
    if (begin_ == end_) return std::nullopt;
    ++number_;
    const std::string_view line(buffer_.data() + begin_, lineEnd - begin_);
    begin_ = lineEnd;
    if (begin_ < end_ && buffer_[begin_] == '\r' && begin_ + 1 < end_ && buffer_[begin_ + 1] == '\n') ++begin_;
    if (begin_ < end_) ++begin_;
    return line;
}

std::optional<ObjLine> ObjLines::next() {
    while (const auto line = physicalLine()) {
        std::string_view text = trimmed(*line);
        if (text.empty() || text.front() == '#') continue;
        const std::size_t number = number_;
        if (text.back() == '\\') {
            text = joinContinued(text);
            if (text.empty()) continue;
        }
        std::string_view rest = text;
        const std::string_view keyword = nextWord(rest);
        return ObjLine{number, text, keyword, trimmed(rest)};
    }
    return std::nullopt;
}

/// The statement that begins with `text`, of which the backslash at its end is taken away.
std::string_view ObjLines::joinContinued(std::string_view text) {
    joined_.clear();
    while (!text.empty() && text.back() == '\\') {
        joined_.append(text.substr(0, text.size() - 1)).append(" ");
        if (joined_.size() > kLongestStatement) failTooLong();
        text = trimmed(physicalLine().value_or(""));
    }
    joined_.append(text);
    return trimmed(joined_);
}

void ObjLines::failTooLong() const {
    throw InputError(fmt::format("{}:{}: found a statement of more than {} bytes, expected a shorter one", file_,
                                 number_ + 1, kLongestStatement));
}

} // namespace lambert
