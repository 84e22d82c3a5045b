#include "comparison/page/html.h"

#include <boost/locale/utf.hpp>

namespace lambert {

namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

std::string_view entity(char c) {
    switch (c) {
    case '&':
        return "&amp;";
    case '<':
        return "&lt;";
    case '>':
        return "&gt;";
    case '"':
        return "&quot;";
    case '\'':
        return "&#39;";
    default:
        return {};
    }
}

} // namespace

std::string htmlEscaped(std::string_view text) {
    using boost::locale::utf::code_point;
    std::string result;
    for (const char* next = text.begin(); next != text.end();) {
        const char* const first = next;
        const code_point code = boost::locale::utf::utf_traits<char>::decode(next, text.end());
        const bool valid = boost::locale::utf::is_valid_codepoint(code);
        if (!valid) next = first + 1;
        const bool control = (code < 0x20 && code != '\t' && code != '\n' && code != '\r') || code == 0x7F;
        if (!valid || control)
            result += kReplacement;
        else if (const std::string_view name = entity(*first); !name.empty())
            result += name;
        else
            result.append(first, next);
    }
    return result;
}

} // namespace lambert
