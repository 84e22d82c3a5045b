#pragma once

#include <string>
#include <string_view>

namespace lambert {

/// Text for HTML or XML, in an element or a quoted attribute. What is not UTF-8 (names come from files) and what XML forbids
/// becomes U+FFFD.
std::string htmlEscaped(std::string_view text);

} // namespace lambert
