#include "meshing/patch_lookup.h"

#include "meshing/plane_frame.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lambert {

namespace {

float cross(glm::vec2 a, glm::vec2 b) { return a.x * b.y - a.y * b.x; }

struct CellRange {
    std::uint32_t beginColumn, endColumn, beginRow, endRow;
};

} // namespace

void PatchLookup::addGrid(std::uint32_t first, std::uint32_t columns, std::uint32_t rows) {
    Entry entry;
    entry.first = first;
    entry.columns = static_cast<std::uint16_t>(columns);
    entry.rows = static_cast<std::uint16_t>(rows);
    entries_.push_back(entry);
}

void PatchLookup::addPatches(const Scene& scene, const Polygon& polygon, std::uint32_t first,
                             std::span<const std::array<std::uint32_t, 4>> corners,
                             std::span<const glm::vec3> positions) {
    Entry entry;
    entry.first = first;
    entry.locator = static_cast<std::uint32_t>(locators_.size());
    entries_.push_back(entry);

    const PlaneFrame frame = planeFrame(scene, polygon);
    Locator locator{};
    locator.quad = polygon.isQuad();
    glm::vec2 lower(std::numeric_limits<float>::max());
    glm::vec2 upper(std::numeric_limits<float>::lowest());
    for (int k = 0; k < polygon.size(); ++k) {
        const glm::vec2 p(frame.project(corner(scene, polygon, k)));
        locator.corners[static_cast<std::size_t>(k)] = p;
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
    }
    // About one cell per patch, as square as the polygon allows.
    const glm::vec2 size = glm::max(upper - lower, glm::vec2(1e-20F));
    const double cellSize =
        std::sqrt(static_cast<double>(size.x) * static_cast<double>(size.y) / static_cast<double>(corners.size()));
    const auto cellCount = [&](float extent) {
        const double count = std::ceil(static_cast<double>(extent) / cellSize);
        return static_cast<std::uint32_t>(std::clamp(count, 1.0, 4.0 * static_cast<double>(corners.size())));
    };
    locator.lower = lower;
    locator.columns = cellCount(size.x);
    locator.rows = cellCount(size.y);
    locator.cellsPerMetre = glm::vec2(locator.columns, locator.rows) / size;
    locator.firstCell = static_cast<std::uint32_t>(cells_.size());
    locator.firstCorner = static_cast<std::uint32_t>(planeCorners_.size());

    const auto clampCell = [](float value, std::uint32_t count) {
        return static_cast<std::uint32_t>(std::clamp(value, 0.0F, static_cast<float>(count - 1)));
    };
    std::vector<CellRange> ranges;
    std::vector<std::uint32_t> counts(std::size_t{locator.columns} * locator.rows + 1, 0);
    for (const auto& patch : corners) {
        glm::vec2 patchLower(std::numeric_limits<float>::max());
        glm::vec2 patchUpper(std::numeric_limits<float>::lowest());
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint32_t vertex = patch[k] == kNone ? patch[2] : patch[k];
            const glm::vec2 p(frame.project(positions[vertex]));
            planeCorners_.push_back(p);
            patchLower = glm::min(patchLower, p);
            patchUpper = glm::max(patchUpper, p);
        }
        const glm::vec2 from = (patchLower - lower) * locator.cellsPerMetre - 1e-3F;
        const glm::vec2 to = (patchUpper - lower) * locator.cellsPerMetre + 1e-3F;
        ranges.push_back({clampCell(from.x, locator.columns), clampCell(to.x, locator.columns) + 1,
                          clampCell(from.y, locator.rows), clampCell(to.y, locator.rows) + 1});
        for (std::uint32_t row = ranges.back().beginRow; row < ranges.back().endRow; ++row)
            for (std::uint32_t column = ranges.back().beginColumn; column < ranges.back().endColumn; ++column)
                ++counts[std::size_t{row} * locator.columns + column];
    }
    auto next = static_cast<std::uint32_t>(candidates_.size());
    for (std::uint32_t& count : counts) {
        cells_.push_back(next);
        next += count;
        count = cells_.back(); // from here on: where the cell's next candidate goes
    }
    candidates_.resize(next);
    for (std::uint32_t patch = 0; patch < ranges.size(); ++patch)
        for (std::uint32_t row = ranges[patch].beginRow; row < ranges[patch].endRow; ++row)
            for (std::uint32_t column = ranges[patch].beginColumn; column < ranges[patch].endColumn; ++column)
                candidates_[counts[std::size_t{row} * locator.columns + column]++] = patch;
    locators_.push_back(locator);
}

/// The smallest of the signed areas that the point spans with the patch's edges: not negative inside.
float PatchLookup::insideness(const Locator& locator, std::uint32_t patch, glm::vec2 point) const {
    const glm::vec2* c = planeCorners_.data() + locator.firstCorner + 4 * std::size_t{patch};
    float smallest = std::min({cross(c[1] - c[0], point - c[0]), cross(c[2] - c[1], point - c[1]),
                               cross(c[0] - c[3], point - c[3])});
    if (c[3] != c[2]) smallest = std::min(smallest, cross(c[3] - c[2], point - c[2]));
    return smallest;
}

std::uint32_t PatchLookup::locate(const Entry& entry, float u, float v) const {
    const Locator& locator = locators_[entry.locator];
    const auto& c = locator.corners;
    glm::vec2 point;
    if (!locator.quad)
        point = c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0]);
    else if (u + v <= 1.0F)
        point = c[0] + u * (c[1] - c[0]) + v * (c[3] - c[0]);
    else
        point = c[2] + (1.0F - u) * (c[3] - c[2]) + (1.0F - v) * (c[1] - c[2]);

    const glm::vec2 cell = (point - locator.lower) * locator.cellsPerMetre;
    const auto column = std::min(static_cast<std::uint32_t>(std::max(cell.x, 0.0F)), locator.columns - 1);
    const auto row = std::min(static_cast<std::uint32_t>(std::max(cell.y, 0.0F)), locator.rows - 1);
    const std::size_t index = locator.firstCell + std::size_t{row} * locator.columns + column;
    std::uint32_t best = 0;
    float bestInsideness = std::numeric_limits<float>::lowest();
    for (std::uint32_t i = cells_[index]; i < cells_[index + 1]; ++i) {
        const float inside = insideness(locator, candidates_[i], point);
        if (inside > bestInsideness) {
            bestInsideness = inside;
            best = candidates_[i];
            if (inside >= 0.0F) break;
        }
    }
    return entry.first + best;
}

} // namespace lambert
