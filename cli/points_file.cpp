#include "cli/points_file.h"
#include "cli/terminal_text.h"

#include "core/error.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>

namespace lambert {

namespace {

/// The first six numbers of a line, separated by commas and blanks; fewer if something else comes.
std::vector<float> leadingNumbers(std::string_view line) {
    std::vector<float> numbers;
    const auto skip = [&line] { line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size())); };
    for (skip(); numbers.size() < 6; skip()) {
        float value = 0.0F;
        if (line.starts_with('+')) line.remove_prefix(1);
        const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
        if (error != std::errc()) break;
        numbers.push_back(value);
        line.remove_prefix(static_cast<std::size_t>(end - line.data()));
        skip();
        if (line.empty()) break;
        if (line.front() != ',') {
            numbers.clear(); // something hangs on the number
            break;
        }
        line.remove_prefix(1);
    }
    return numbers;
}

ProbePoint toPoint(const std::vector<float>& n, const std::string& place) {
    const ProbePoint point{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
    const float length = glm::length(point.normal);
    if (!std::isfinite(point.position.x + point.position.y + point.position.z) || !std::isfinite(length) ||
        length == 0.0F)
        throw InputError(fmt::format("{}: found a point that is not finite or a normal without length", place));
    return point;
}

} // namespace

std::vector<ProbePoint> readPoints(const std::filesystem::path& path) {
    std::ifstream file(path);
    if (!file || std::filesystem::is_directory(path))
        throw InputError(fmt::format("{}: cannot be read", path.string()));
    std::vector<ProbePoint> points;
    std::string line;
    bool headerAllowed = true;
    for (std::size_t number = 1; std::getline(file, line); ++number) {
        if (line.find_first_not_of(" \t\r") == std::string::npos || line.front() == '#') continue;
        const std::vector<float> numbers = leadingNumbers(line);
        const std::string place = fmt::format("{}:{}", path.string(), number);
        if (numbers.size() == 6)
            points.push_back(toPoint(numbers, place));
        else if (!headerAllowed || !numbers.empty())
            throw InputError(
                fmt::format("{}: found \"{}\", expected x,y,z,nx,ny,nz", place, oneLine(line.substr(0, 60))));
        headerAllowed = false;
    }
    if (points.empty()) throw InputError(fmt::format("{}: holds no points", path.string()));
    return points;
}

} // namespace lambert
