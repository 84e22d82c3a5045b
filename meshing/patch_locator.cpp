#include "meshing/patch_locator.h"

#include "core/box.h"
#include "meshing/plane_frame.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace lambert {

namespace {

constexpr double kCellsPerPatch = 16.0; ///< more than half of the cells then lie in one patch

float cross(glm::vec2 a, glm::vec2 b) { return a.x * b.y - a.y * b.x; }

/// Whether a patch may reach into the unit cell at `cell`, a margin for rounding included: no edge has the whole cell
/// on its outer side.
bool mayTouch(const glm::vec2* c, glm::vec2 cell) {
    constexpr float kMargin = 1e-3F;
    for (std::size_t k = 0; k < 4; ++k) {
        const glm::vec2 edge = c[(k + 1) % 4] - c[k];
        // The corner of the cell farthest to the left of the edge.
        const glm::vec2 farthest(edge.y > 0.0F ? cell.x - kMargin : cell.x + 1.0F + kMargin,
                                 edge.x > 0.0F ? cell.y + 1.0F + kMargin : cell.y - kMargin);
        if (cross(edge, farthest - c[k]) < 0.0F) return false;
    }
    return true;
}

/// Calls `visit(cell, patch)` for all cells into which a patch may reach, patch by patch.
template <class Visit>
void forReachedCells(std::span<const glm::vec2> corners, std::uint32_t columns, std::uint32_t rows, Visit&& visit) {
    const auto clampTo = [](float value, std::uint32_t count) {
        return static_cast<std::uint32_t>(std::clamp(value, 0.0F, static_cast<float>(count - 1)));
    };
    for (std::size_t first = 0; first < corners.size(); first += 4) {
        const glm::vec2* c = corners.data() + first;
        const glm::vec2 lower = glm::min(glm::min(c[0], c[1]), glm::min(c[2], c[3])) - 1e-3F;
        const glm::vec2 upper = glm::max(glm::max(c[0], c[1]), glm::max(c[2], c[3])) + 1e-3F;
        for (std::uint32_t row = clampTo(lower.y, rows); row <= clampTo(upper.y, rows); ++row)
            for (std::uint32_t column = clampTo(lower.x, columns); column <= clampTo(upper.x, columns); ++column)
                if (mayTouch(c, {column, row})) visit(row * columns + column, static_cast<std::uint32_t>(first / 4));
    }
}

/// The patches that may reach into each cell, in their order.
struct ReachedCells {
    std::vector<std::uint32_t> first; ///< #cells + 1, into `patches`
    std::vector<std::uint32_t> patches;

    ReachedCells(std::span<const glm::vec2> corners, std::uint32_t columns, std::uint32_t rows)
        : first(std::size_t{columns} * rows + 1, 0) {
        // Two passes: pairs of cell and patch, to be sorted, would take twice the memory.
        forReachedCells(corners, columns, rows, [&](std::uint32_t cell, std::uint32_t) { ++first[cell]; });
        std::uint32_t sum = 0;
        for (std::uint32_t& count : first) sum += std::exchange(count, sum);
        patches.resize(sum);
        forReachedCells(corners, columns, rows,
                        [&](std::uint32_t cell, std::uint32_t patch) { patches[first[cell]++] = patch; });
        first.insert(first.begin(), 0); // each cell's first has become its end
        first.pop_back();
    }
    std::span<const std::uint32_t> of(std::size_t cell) const {
        return std::span(patches).subspan(first[cell], first[cell + 1] - first[cell]);
    }
};

/// Gives each cell its code.
class CellCoder {
public:
    explicit CellCoder(PatchLocator& locator) : locator_(locator) {}

    /// Of a cell into which the given patches may reach.
    std::uint32_t codeFor(std::span<const std::uint32_t> patches) {
        if (patches.size() == 1) return patches[0];
        if (patches.size() == 2)
            if (const std::uint32_t code = splitBetween(patches[0], patches[1]); code != kNone) return code;
        // Also for a cell outside the polygon, which a rounded point may fall into: it has no candidates.
        const auto code = kSearch + static_cast<std::uint32_t>(locator_.candidates.size());
        locator_.candidates.push_back(static_cast<std::uint32_t>(patches.size()));
        locator_.candidates.insert(locator_.candidates.end(), patches.begin(), patches.end());
        return code;
    }

private:
    /// kNone if the patches have no edge in common.
    std::uint32_t splitBetween(std::uint32_t one, std::uint32_t two) {
        const auto [known, isNew] = codes_.try_emplace({one, two}, kNone);
        if (!isNew) return known->second;
        const glm::vec2* c = locator_.corners.data() + 4 * std::size_t{one};
        const glm::vec2* d = locator_.corners.data() + 4 * std::size_t{two};
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t k = 0; k < 4; ++k) {
                const glm::vec2 a = c[i];
                const glm::vec2 b = c[(i + 1) % 4];
                if (a == b || a != d[(k + 1) % 4] || b != d[k]) continue;
                const glm::vec2 normal(a.y - b.y, b.x - a.x); // to the left, where `one` lies
                known->second = kSplit + static_cast<std::uint32_t>(locator_.splits.size());
                locator_.splits.push_back({normal, normal.x * a.x + normal.y * a.y, one, two});
                return known->second;
            }
        }
        return kNone;
    }

    PatchLocator& locator_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> codes_; ///< by two patches, the smaller one first
};

} // namespace

PatchLocator locatePatches(const Scene& scene, const Polygon& polygon,
                           std::span<const std::array<std::uint32_t, 4>> corners,
                           std::span<const glm::vec3> positions) {
    const PlaneFrame frame = planeFrame(scene, polygon);
    std::array<glm::dvec2, 4> p{};
    Box<glm::dvec2> box;
    for (int k = 0; k < polygon.size(); ++k) {
        p[static_cast<std::size_t>(k)] = frame.project(corner(scene, polygon, k));
        box.add(p[static_cast<std::size_t>(k)]);
    }
    const glm::dvec2 lower = box.lower, size = glm::max(box.size(), glm::dvec2(1e-30));
    const double cells = kCellsPerPatch * static_cast<double>(corners.size());
    const double cellSize = std::sqrt(size.x * size.y / cells);
    const auto cellCount = [&](double extent) {
        return static_cast<std::uint32_t>(std::clamp(std::ceil(extent / cellSize), 1.0, cells));
    };
    const std::uint32_t columns = cellCount(size.x), rows = cellCount(size.y);
    const glm::dvec2 cellsPerMetre = glm::dvec2(columns, rows) / size;
    const auto toGrid = [&](glm::dvec2 point) { return glm::vec2((point - lower) * cellsPerMetre); };
    for (glm::dvec2& point : p) point = (point - lower) * cellsPerMetre;
    const glm::dvec2 alongV = polygon.isQuad() ? p[3] - p[0] : p[2] - p[0];
    const auto chart = [&](glm::dvec2 origin, glm::dvec2 axisU, glm::dvec2 axisV) {
        return CellChart{glm::vec2(origin), glm::vec2(axisU), glm::vec2(axisV), static_cast<std::int32_t>(columns - 1),
                         static_cast<std::int32_t>(rows - 1)};
    };
    PatchLocator locator;
    locator.charts.fill(chart(p[0], p[1] - p[0], alongV)); // of a triangle both: rounding may put u + v above 1
    if (polygon.isQuad()) locator.charts[1] = chart(p[1] + p[3] - p[2], p[2] - p[3], p[2] - p[1]);
    locator.corners.reserve(4 * corners.size());
    for (const auto& patch : corners)
        for (std::size_t k = 0; k < 4; ++k)
            locator.corners.push_back(toGrid(frame.project(positions[patch[k] == kNone ? patch[2] : patch[k]])));

    const ReachedCells reached(locator.corners, columns, rows);
    CellCoder coder(locator);
    const std::size_t cellsInAll = std::size_t{columns} * rows;
    locator.codes.reserve(cellsInAll);
    for (std::size_t cell = 0; cell < cellsInAll; ++cell) locator.codes.push_back(coder.codeFor(reached.of(cell)));
    return locator;
}

} // namespace lambert
