#pragma once

#include <string>

namespace lambert {

/// The text on one line, control characters replaced: names come from files.
inline std::string oneLine(std::string text) {
    for (char& c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (code < 0x20 || code == 0x7F) c = ' ';
    }
    return text;
}

} // namespace lambert
