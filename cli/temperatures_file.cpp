#include "cli/temperatures_file.h"
#include "cli/terminal_text.h"

#include "core/error.h"
#include "scene/words.h"

#include <boost/algorithm/string/trim.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>

namespace lambert {

namespace {

constexpr double kHottest = 1e6; ///< kelvin

/// The fields of a line of CSV (RFC 4180, one record a line).
std::vector<std::string> fieldsOf(const std::string& line) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (std::size_t k = 0; k < line.size(); ++k) {
        const char c = line[k];
        if (c == '"' && quoted && k + 1 < line.size() && line[k + 1] == '"')
            fields.back() += line[++k];
        else if (c == '"')
            quoted = !quoted;
        else if (c == ',' && !quoted)
            fields.emplace_back();
        else
            fields.back() += c;
    }
    for (std::string& field : fields) boost::trim(field);
    return fields;
}

std::optional<double> numberOf(const std::string& text, double largest) {
    const auto value = parseNumber(text);
    return value && *value >= 0.0 && *value <= largest ? value : std::nullopt;
}

} // namespace

Temperatures readTemperatures(const std::filesystem::path& path, const std::vector<std::string>& groups) {
    std::ifstream file(path);
    if (!file || std::filesystem::is_directory(path))
        throw InputError(fmt::format("{}: cannot be read", path.string()));
    Temperatures result;
    std::vector<bool> known(groups.size(), false);
    result.surfaces.resize(groups.size());
    bool environmentKnown = false;
    bool headerAllowed = true;
    std::string line;
    for (std::size_t number = 1; std::getline(file, line); ++number) {
        if (boost::trim_copy(line).empty() || line.front() == '#') continue;
        const auto fail = [&](const std::string& what) {
            throw InputError(fmt::format("{}:{}: {}", path.string(), number, what));
        };
        const std::vector<std::string> fields = fieldsOf(line);
        const bool adiabatic = fields.size() >= 2 && fields[1] == "adiabatic";
        const auto kelvin = fields.size() >= 2 ? numberOf(fields[1], kHottest) : std::nullopt;
        const bool mayBeHeader = std::exchange(headerAllowed, false);
        const auto found = std::find(groups.begin(), groups.end(), fields[0]);
        if (!kelvin && !adiabatic) {
            if (mayBeHeader && found == groups.end()) continue;
            fail(fmt::format("found \"{}\", expected group,kelvin,emissivity with a temperature from 0 to {:g} or "
                             "adiabatic",
                             printable(line.substr(0, 60)), kHottest));
        }
        if (found == groups.end() || (fields[0] == "environment" && fields.size() == 2)) {
            if (fields[0] != "environment")
                fail(fmt::format("no group \"{}\"; there are {}", printable(fields[0]), fmt::join(groups, ", ")));
            if (!kelvin) fail("the environment needs a temperature");
            if (std::exchange(environmentKnown, true)) fail("the environment stands twice");
            result.environment = *kelvin;
            continue;
        }
        const auto group = static_cast<std::size_t>(found - groups.begin());
        if (known[group]) fail(fmt::format("\"{}\" stands twice", printable(fields[0])));
        known[group] = true;
        if (adiabatic) {
            result.surfaces[group] = {std::nullopt, 1.0};
            continue;
        }
        const auto emissivity = fields.size() >= 3 ? numberOf(fields[2], 1.0) : std::nullopt;
        if (!emissivity)
            fail(fmt::format("found {}, expected an emissivity from 0 to 1 after the temperature",
                             fields.size() >= 3 ? "\"" + printable(fields[2]) + "\"" : "nothing"));
        result.surfaces[group] = {kelvin, *emissivity};
    }
    std::vector<std::string> missing;
    for (std::size_t g = 0; g < groups.size(); ++g)
        if (!known[g]) missing.push_back(groups[g]);
    if (!missing.empty())
        throw InputError(printable(fmt::format("{}: no temperature for {}", path.string(), fmt::join(missing, ", "))));
    return result;
}

} // namespace lambert
