#pragma once

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <string>

namespace lambert {

/// Like CLI::Range, but NaN is outside too, and so is the negative number that an unsigned option would wrap around.
inline CLI::Validator between(double lowest, double highest) {
    return {[=](const std::string& text) {
                double value = 0.0;
                if (!CLI::detail::lexical_cast(text, value) || !(value >= lowest && value <= highest))
                    return fmt::format("found {}, allowed are numbers from {:.9g} to {:.9g}", text, lowest, highest);
                return std::string();
            },
            "", ""};
}

/// An option for one number, or several, `between` these two; `type`: what --help calls it.
template <typename Value>
CLI::Option* addNumber(CLI::App& command, const char* name, Value& value, const std::string& text, const char* type,
                       double lowest, double highest) {
    return command.add_option(name, value, text)->type_name(type)->check(between(lowest, highest));
}

} // namespace lambert
