#include "core/text.h"

#include <boost/locale/utf.hpp>

#include <iterator>

namespace lambert {

namespace {

/// Cuts after `length` bytes, but not inside a UTF-8 sequence.
std::string_view shortened(std::string_view text, std::size_t length) {
    if (text.size() <= length) return text;
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80) --length;
    return text.substr(0, length);
}

bool isControl(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

} // namespace

std::string asUtf8(std::string_view text) {
    using Utf8 = boost::locale::utf::utf_traits<char>;
    bool valid = true;
    for (auto next = text.begin(); valid && next != text.end();)
        valid = boost::locale::utf::is_valid_codepoint(Utf8::decode(next, text.end()));
    if (valid) return std::string(text);
    std::string result;
    for (const char byte : text) Utf8::encode(static_cast<unsigned char>(byte), std::back_inserter(result));
    return result;
}

std::string lowerCase(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return result;
}

std::string inQuotes(std::string_view text) {
    std::string result = "\"";
    const std::string_view start = shortened(text, 60);
    for (const char c : start) result += isControl(c) ? (c == '\t' ? ' ' : '?') : c;
    if (start.size() < text.size()) result += "...";
    return result + '"';
}

std::string oneLine(std::string_view text, std::size_t maxLength) {
    while (!text.empty() && isControl(text.back())) text.remove_suffix(1);
    std::string result;
    const std::string_view start = shortened(text, maxLength);
    for (const char c : start) {
        if (c == '\n') {
            result += "; ";
        } else if (c != '\r') {
            result += isControl(c) ? '?' : c;
        }
    }
    if (start.size() < text.size()) result += "...";
    return result;
}

} // namespace lambert
