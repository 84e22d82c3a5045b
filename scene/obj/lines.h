#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace lambert {

/// A statement of an OBJ or MTL file.
struct ObjLine {
    std::size_t number;       //!< of its first line, from 1
    std::string_view text;    //!< without the spaces around it; valid until the next statement
    std::string_view keyword; //!< the first word
    std::string_view rest;    //!< what follows, without the spaces around it
};

/// Goes through the statements of a file, of which it holds a piece at a time: knows the three line endings, a
/// byte-order mark, comments, and lines continued by a backslash.
class ObjLines {
public:
    /// Calls `onBytes` with the size of every piece it has read. Throws InputError as openInputFile, and for UTF-16.
    explicit ObjLines(const std::filesystem::path& path, std::function<void(std::uint64_t)> onBytes = {});

    /// The next statement that is neither empty nor a comment. Throws InputError for one longer than 2^26 bytes.
    std::optional<ObjLine> next();

    const std::string& file() const { return file_; } //!< for messages

private:
    std::optional<std::string_view> physicalLine();
    std::string_view joinContinued(std::string_view text);
    std::size_t findLineEnd();
    bool readPiece();
    void removeByteOrderMark();
    [[noreturn]] void failTooLong() const;

    std::string file_;
    std::ifstream stream_;
    std::function<void(std::uint64_t)> onBytes_;
    std::string buffer_; //!< [begin_, end_) is read but not yet gone through
    std::size_t begin_ = 0;
    std::size_t end_ = 0;
    std::size_t newline_ = 0;        //!< the first '\n' at or after begin_, if not before it; end_ if there is none
    std::size_t carriageReturn_ = 0; //!< the same of '\r'
    std::size_t number_ = 0;
    std::string joined_;
};

} // namespace lambert
