#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lambert {

/// Whether `name` is what `pattern` says, in which * stands for any characters, also none; all else is taken as it is.
bool matchesPattern(std::string_view name, std::string_view pattern);

/// Indices of the names that are meant: those equal to `pattern`, or if there are none, those that match it.
std::vector<std::uint32_t> matchingNames(std::span<const std::string> names, std::string_view pattern);

/// At most `count` different names, those first that need the fewest letters changed, added or left out to become `wanted`;
/// upper and lower case count as the same letter. For messages: only the first 64 bytes of a name are compared.
std::vector<std::string> closestNames(std::string_view wanted, std::span<const std::string> names, std::size_t count);

} // namespace lambert
