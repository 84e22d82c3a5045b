// P. Clarberg, W. Jarosz, T. Akenine-Möller, H. W. Jensen, "Wavelet importance sampling", SIGGRAPH 2005.

#include "core/hierarchical_warp.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

namespace lambert {

namespace {

/// Which of two parts a number of [0, 1) falls into, in proportion to their weights, and its place in there.
int split(double first, double second, double& u) {
    const double share = first / (first + second);
    const bool isFirst = u < share;
    u = isFirst ? u / share : (u - share) / (1.0 - share);
    u = std::clamp(u, 0.0, std::nextafter(1.0, 0.0));
    return isFirst ? 0 : 1;
}

} // namespace

HierarchicalWarp::HierarchicalWarp(int width, int height, std::span<const float> importance) {
    if (width < 1 || height < 1 ||
        importance.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
        throw std::invalid_argument("hierarchical warp: an empty image, or one of another size");
    std::size_t size = std::bit_ceil(static_cast<std::size_t>(std::max(width, height)));
    // What lies beyond the image has no importance.
    Level texels(size * size, 0.0);
    for (std::size_t i = 0; i < importance.size(); ++i) {
        const auto value = static_cast<double>(importance[i]);
        if (!(value >= 0.0) || !std::isfinite(value))
            throw std::invalid_argument("hierarchical warp: importance below 0 or not finite");
        texels[i / static_cast<std::size_t>(width) * size + i % static_cast<std::size_t>(width)] = value;
    }
    levels_.push_back(std::move(texels));
    for (; size > 1; size /= 2) {
        const Level& fine = levels_.back();
        Level coarse(size * size / 4);
        for (std::size_t y = 0; y < size / 2; ++y)
            for (std::size_t x = 0; x < size / 2; ++x) {
                const double* corner = fine.data() + 2 * y * size + 2 * x;
                coarse[y * size / 2 + x] = (corner[0] + corner[1]) + (corner[size] + corner[size + 1]);
            }
        levels_.push_back(std::move(coarse));
    }
    if (!(total() > 0.0)) throw std::invalid_argument("hierarchical warp: no importance");
}

glm::dvec2 HierarchicalWarp::warp(const glm::dvec2& u) const {
    glm::dvec2 place = u;
    std::size_t x = 0;
    std::size_t y = 0;
    std::size_t size = 1;
    for (auto level = levels_.rbegin() + 1; level != levels_.rend(); ++level) {
        size *= 2;
        x *= 2;
        y *= 2;
        const double* corner = level->data() + y * size + x;
        const bool lower = split(corner[0] + corner[1], corner[size] + corner[size + 1], place.y) == 1;
        y += lower ? 1 : 0;
        const double* row = corner + (lower ? size : 0);
        x += split(row[0], row[1], place.x) == 1 ? 1 : 0;
    }
    return {static_cast<double>(x) + place.x, static_cast<double>(y) + place.y};
}

double HierarchicalWarp::probability(int x, int y) const {
    const auto size = std::size_t{1} << (levels_.size() - 1);
    return levels_.front()[static_cast<std::size_t>(y) * size + static_cast<std::size_t>(x)] / total();
}

} // namespace lambert
