#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lambert {

/// A row of a table of what can be chosen by its name. Such tables may have other rows, with these two members.
template <typename Value>
struct Named {
    Value value;
    std::string_view name;
};

/// The value of this name; nothing if the table has none.
template <typename Table>
auto valueNamed(const Table& table, std::string_view name) {
    const auto row = std::ranges::find_if(table, [&](const auto& r) { return r.name == name; });
    return row != std::end(table) ? std::optional(row->value) : std::nullopt;
}

/// The row of a value, which must be there.
template <typename Table, typename Value>
const auto& rowOf(const Table& table, Value value) {
    return *std::ranges::find_if(table, [&](const auto& r) { return r.value == value; });
}

template <typename Table>
std::vector<std::string> namesIn(const Table& table) {
    std::vector<std::string> names;
    for (const auto& row : table) names.emplace_back(row.name);
    return names;
}

} // namespace lambert
