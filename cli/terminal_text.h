#pragma once

#include <cstdio>
#include <string>

namespace lambert {

/// The text on one line, control characters replaced: names come from files.
inline std::string printable(std::string text) {
    for (char& c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (code < 0x20 || code == 0x7F) c = ' ';
    }
    return text;
}

/// Writes to stderr. Where that is closed or full the text is lost: what a run computes is worth more than its log.
inline void writeLog(const std::string& text) {
    if (std::fputs(text.c_str(), stderr) >= 0) std::fflush(stderr);
}

} // namespace lambert
