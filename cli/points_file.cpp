#include "cli/points_file.h"
#include "cli/arguments.h"
#include "cli/terminal_text.h"

#include "core/error.h"
#include "scene/words.h"

#include <boost/algorithm/string/trim.hpp>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <fstream>
#include <string>

namespace lambert {

namespace {

/// The numbers that a line begins with, separated by commas; at most six.
std::vector<double> leadingNumbers(const std::string& line) {
    std::vector<double> numbers;
    for (const std::string& field : separated(line)) {
        const auto number = parseNumber(boost::trim_copy(field));
        if (!number || numbers.size() == 6) break;
        numbers.push_back(*number);
    }
    return numbers;
}

SensorPoint toPoint(const std::vector<double>& n, const std::string& place) {
    const SensorPoint point{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
    const float length = glm::length(point.normal);
    const glm::vec3 single(point.place);
    if (!std::isfinite(single.x + single.y + single.z) || !std::isfinite(length) || length == 0.0F)
        throw InputError(fmt::format("{}: found a point that is not finite or a normal without length", place));
    return point;
}

} // namespace

std::vector<SensorPoint> readPoints(const std::filesystem::path& path) {
    std::ifstream file(path);
    if (!file || std::filesystem::is_directory(path))
        throw InputError(fmt::format("{}: cannot be read", path.string()));
    std::vector<SensorPoint> points;
    std::string line;
    bool headerAllowed = true;
    for (std::size_t number = 1; std::getline(file, line); ++number) {
        if (boost::trim_copy(line).empty() || line.front() == '#') continue;
        const std::vector<double> numbers = leadingNumbers(line);
        const std::string place = fmt::format("{}:{}", path.string(), number);
        if (numbers.size() == 6)
            points.push_back(toPoint(numbers, place));
        else if (!headerAllowed || !numbers.empty())
            throw InputError(
                fmt::format("{}: found \"{}\", expected x,y,z,nx,ny,nz", place, printable(line.substr(0, 60))));
        headerAllowed = false;
    }
    if (points.empty()) throw InputError(fmt::format("{}: holds no points", path.string()));
    return points;
}

std::vector<ProbePoint> pointsInScene(const std::vector<SensorPoint>& points, const Scene& scene) {
    std::vector<ProbePoint> result;
    for (const SensorPoint& point : points) result.push_back({placeInScene(scene, point.place), point.normal});
    return result;
}

} // namespace lambert
