#include "discrepancy.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lambert {

double starDiscrepancy(std::span<const glm::dvec2> points) {
    if (points.empty()) return 1.0;
    std::vector<glm::dvec2> byX(points.begin(), points.end());
    std::sort(byX.begin(), byX.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
    const auto n = static_cast<double>(byX.size());
    double worst = 0.0;
    // The supremum is taken at boxes whose sides pass through points (or 1), the boundary counted in or out. Column by
    // column: `inside` holds the y of all points left of the box's right side, ascending.
    std::vector<double> inside;
    for (std::size_t i = 0; i <= byX.size();) {
        const double x = i < byX.size() ? byX[i].x : 1.0;
        for (std::size_t k = 0; k <= inside.size(); ++k) { // open boxes: too few points
            const double y = k < inside.size() ? inside[k] : 1.0;
            worst = std::max(worst, x * y - static_cast<double>(k) / n);
        }
        if (i == byX.size()) break;
        for (; i < byX.size() && byX[i].x == x; ++i)
            inside.insert(std::upper_bound(inside.begin(), inside.end(), byX[i].y), byX[i].y);
        for (std::size_t k = 0; k < inside.size(); ++k) // closed boxes: too many
            worst = std::max(worst, static_cast<double>(k + 1) / n - x * inside[k]);
    }
    return worst;
}

double l2StarDiscrepancy(std::span<const double> coordinates, std::size_t dimensions) {
    const std::size_t count = coordinates.size() / dimensions;
    const auto n = static_cast<double>(count);
    double single = 0.0;
    double pairs = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const double* a = coordinates.data() + i * dimensions;
        double product = 1.0;
        for (std::size_t d = 0; d < dimensions; ++d) product *= 1.0 - a[d] * a[d];
        single += product;
        for (std::size_t j = 0; j < count; ++j) {
            const double* b = coordinates.data() + j * dimensions;
            product = 1.0;
            for (std::size_t d = 0; d < dimensions; ++d) product *= 1.0 - std::max(a[d], b[d]);
            pairs += product;
        }
    }
    const auto dims = static_cast<double>(dimensions);
    const double squared = std::pow(3.0, -dims) - std::pow(2.0, 1.0 - dims) / n * single + pairs / (n * n);
    return std::sqrt(std::max(0.0, squared));
}

} // namespace lambert
