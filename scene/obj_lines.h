#pragma once

#include <cstddef>
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

/// Goes through the statements: knows the three line endings, a byte-order mark, comments, and lines
/// continued by a backslash.
class ObjLines {
public:
    explicit ObjLines(std::string_view text);

    /// The next statement that is neither empty nor a comment.
    std::optional<ObjLine> next();

private:
    std::string_view physicalLine();

    std::string_view text_;
    std::size_t number_ = 0;
    std::string joined_;
};

/// Takes the next word off `text`; empty at the end or where a comment begins.
std::string_view nextWord(std::string_view& text);

/// A number as C++ writes it, `nan` and `inf` in the spellings of the usual exporters included; nothing if
/// the word is something else.
std::optional<double> parseNumber(std::string_view word);

[[noreturn]] void failAt(const std::string& file, std::size_t line, std::string_view found,
                         const std::string& expected);

} // namespace lambert
