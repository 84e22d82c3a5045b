#include "meshing/weld.h"

#include <boost/functional/hash.hpp>
#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <unordered_map>

namespace lambert {

namespace {

using Cell = std::array<std::int64_t, 3>;

} // namespace

std::vector<std::uint32_t> weldPositions(std::span<const glm::vec3> positions, float tolerance) {
    // With cells of four tolerances a ball of one tolerance touches at most two cells along each axis.
    const double cellsPerMetre = 0.25 / static_cast<double>(tolerance);
    std::unordered_multimap<Cell, std::uint32_t, boost::hash<Cell>> representatives;
    representatives.reserve(positions.size());
    std::vector<std::uint32_t> result(positions.size());

    const auto find = [&](const glm::vec3& p, const glm::dvec3& scaled) -> std::int64_t {
        Cell from, to;
        for (int axis = 0; axis < 3; ++axis) {
            from[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(std::floor(scaled[axis] - 0.25));
            to[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(std::floor(scaled[axis] + 0.25));
        }
        std::int64_t best = -1;
        for (std::int64_t x = from[0]; x <= to[0]; ++x)
            for (std::int64_t y = from[1]; y <= to[1]; ++y)
                for (std::int64_t z = from[2]; z <= to[2]; ++z) {
                    const auto [begin, end] = representatives.equal_range({x, y, z});
                    for (auto it = begin; it != end; ++it)
                        if (glm::distance(positions[it->second], p) <= tolerance && (best < 0 || it->second < best))
                            best = it->second;
                }
        return best;
    };

    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        const glm::vec3 p = positions[i];
        result[i] = i;
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
        const glm::dvec3 scaled = glm::dvec3(p) * cellsPerMetre;
        if (const std::int64_t existing = find(p, scaled); existing >= 0) {
            result[i] = static_cast<std::uint32_t>(existing);
            continue;
        }
        representatives.emplace(Cell{static_cast<std::int64_t>(std::floor(scaled.x)),
                                     static_cast<std::int64_t>(std::floor(scaled.y)),
                                     static_cast<std::int64_t>(std::floor(scaled.z))},
                                i);
    }
    return result;
}

} // namespace lambert
