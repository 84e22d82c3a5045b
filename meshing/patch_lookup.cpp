#include "meshing/patch_lookup.h"

#include "core/vector_clones.h"
#include "meshing/plane_frame.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lambert {

namespace {

float cross(glm::vec2 a, glm::vec2 b) { return a.x * b.y - a.y * b.x; }

/// The smallest of the signed areas that the point spans with the edges of a patch: not negative inside.
float insideness(const glm::vec2* c, glm::vec2 point) {
    float smallest = std::min(
        {cross(c[1] - c[0], point - c[0]), cross(c[2] - c[1], point - c[1]), cross(c[0] - c[3], point - c[3])});
    if (c[3] != c[2]) smallest = std::min(smallest, cross(c[3] - c[2], point - c[2]));
    return smallest;
}

LAMBERT_VECTOR_CLONES
bool allEqual(const std::uint32_t (&values)[16]) {
    std::uint32_t difference = 0;
    for (int lane = 0; lane < 16; ++lane) difference |= values[lane] ^ values[0];
    return difference == 0;
}

} // namespace

LAMBERT_VECTOR_CLONES
void PatchLookup::gridPatches(const Entry& entry, const float (&u)[16], const float (&v)[16],
                              std::uint32_t (&patch)[16]) {
    const Entry grid = entry;
    if (grid.skew == glm::vec2(0.0F)) {
        for (int lane = 0; lane < 16; ++lane)
            patch[lane] = grid.first + gridIndex(v[lane], grid.rows) * grid.columns + gridIndex(u[lane], grid.columns);
        return;
    }
    for (int lane = 0; lane < 16; ++lane) {
        const GridPoint p = gridPoint(u[lane], v[lane], grid.skew);
        patch[lane] = grid.first + gridIndex(p.t, grid.rows) * grid.columns + gridIndex(p.s, grid.columns);
    }
}

void PatchLookup::addGrid(const Scene& scene, const Polygon& polygon, std::uint32_t first, std::uint32_t columns,
                          std::uint32_t rows) {
    Entry entry;
    entry.first = first;
    entry.columns = static_cast<std::uint16_t>(columns);
    entry.rows = static_cast<std::uint16_t>(rows);
    if (polygon.isQuad() && columns * rows > 1) {
        const PlaneFrame frame = planeFrame(scene, polygon);
        const glm::dvec2 origin = frame.project(corner(scene, polygon, 0));
        const glm::dvec2 a = frame.project(corner(scene, polygon, 1)) - origin;
        const glm::dvec2 b = frame.project(corner(scene, polygon, 3)) - origin;
        const glm::dvec2 beyond = frame.project(corner(scene, polygon, 2)) - origin - a - b;
        const glm::vec2 skew(glm::dvec2(beyond.x * b.y - beyond.y * b.x, a.x * beyond.y - a.y * beyond.x) /
                             (a.x * b.y - a.y * b.x));
        // Rounding alone must not cost a parallelogram its short way.
        if (std::max(std::abs(skew.x), std::abs(skew.y)) > 1e-5F) entry.skew = skew;
    }
    entries_.push_back(entry);
    Chart chart;
    chart.first = first;
    if (entry.skew != glm::vec2(0.0F)) {
        chart.firstCell = 0;
    } else {
        chart.axisU = {static_cast<float>(columns), 0.0F};
        chart.axisV = {0.0F, static_cast<float>(rows)};
        chart.lastColumn = static_cast<int>(columns) - 1;
        chart.lastRow = static_cast<int>(rows) - 1;
    }
    places_.push_back(columns * rows == 1 ? first : addCharts(chart, chart));
}

void PatchLookup::addLocated(const PatchLocator& locator, std::uint32_t first) {
    Entry entry;
    entry.first = first;
    entry.locator = static_cast<std::uint32_t>(grids_.size());
    entries_.push_back(entry);

    CellGrid grid = locator.grid;
    grid.firstCell = static_cast<std::uint32_t>(cells_.size());
    grid.firstCorner = static_cast<std::uint32_t>(gridCorners_.size());
    grids_.push_back(grid);
    std::array<Chart, 2> charts;
    for (std::size_t half = 0; half < 2; ++half)
        charts[half] = {grid.origin[half],
                        grid.axisU[half],
                        grid.axisV[half],
                        static_cast<int>(grid.columns) - 1,
                        static_cast<int>(grid.rows) - 1,
                        grid.firstCell,
                        first};
    places_.push_back(addCharts(charts[0], charts[1]));

    const auto splits = static_cast<std::uint32_t>(splits_.size());
    const auto candidates = static_cast<std::uint32_t>(candidates_.size());
    for (const std::uint32_t code : locator.codes)
        cells_.push_back(code + (code < kSplit ? 0 : code < kSearch ? splits : candidates));
    splits_.insert(splits_.end(), locator.splits.begin(), locator.splits.end());
    candidates_.insert(candidates_.end(), locator.candidates.begin(), locator.candidates.end());
    gridCorners_.insert(gridCorners_.end(), locator.corners.begin(), locator.corners.end());
}

std::uint32_t PatchLookup::search(const CellGrid& grid, std::uint32_t firstCandidate, glm::vec2 point) const {
    std::uint32_t best = 0;
    float bestInsideness = std::numeric_limits<float>::lowest();
    const std::uint32_t* candidate = candidates_.data() + firstCandidate;
    for (std::uint32_t remaining = *candidate; remaining > 0; --remaining) {
        const std::uint32_t patch = *++candidate;
        const float inside = insideness(gridCorners_.data() + grid.firstCorner + 4 * std::size_t{patch}, point);
        if (inside >= 0.0F) return patch;
        if (inside > bestInsideness) {
            bestInsideness = inside;
            best = patch;
        }
    }
    return best;
}

std::uint32_t PatchLookup::locate(const Entry& entry, float u, float v) const {
    const CellGrid& grid = grids_[entry.locator];
    const glm::vec2 point = cellPoint(grid, u, v);
    return entry.first + decode(grid, cells_[cellAt(grid, point)], point);
}

LAMBERT_VECTOR_CLONES
void PatchLookup::cells16(const CellGrid& grid, const float (&u)[16], const float (&v)[16], float (&x)[16],
                          float (&y)[16], std::uint32_t (&cell)[16]) {
    const CellGrid l = grid;
    const int lastColumn = static_cast<int>(l.columns) - 1;
    const int lastRow = static_cast<int>(l.rows) - 1;
    for (int lane = 0; lane < 16; ++lane) {
        const bool near = u[lane] + v[lane] <= 1.0F;
        const float nearX = l.origin[0].x + u[lane] * l.axisU[0].x + v[lane] * l.axisV[0].x;
        const float nearY = l.origin[0].y + u[lane] * l.axisU[0].y + v[lane] * l.axisV[0].y;
        const float farX = l.origin[1].x + u[lane] * l.axisU[1].x + v[lane] * l.axisV[1].x;
        const float farY = l.origin[1].y + u[lane] * l.axisU[1].y + v[lane] * l.axisV[1].y;
        x[lane] = near ? nearX : farX;
        y[lane] = near ? nearY : farY;
        const int column = std::clamp(static_cast<int>(x[lane]), 0, lastColumn);
        const int row = std::clamp(static_cast<int>(y[lane]), 0, lastRow);
        cell[lane] = l.firstCell + static_cast<std::uint32_t>(row * static_cast<int>(l.columns) + column);
    }
}

/// Patches, relative to the first, of the cells' codes: as decode, without branches, which these unpredictable cells would make
/// expensive. Returns whether some cell has to be searched.
LAMBERT_VECTOR_CLONES
bool PatchLookup::decode16(const std::uint32_t* cells, const CellSplit* splits, const float (&x)[16],
                           const float (&y)[16], const std::uint32_t (&cell)[16], std::uint32_t (&code)[16],
                           std::uint32_t (&patch)[16]) {
    std::uint32_t highest = 0;
    for (int lane = 0; lane < 16; ++lane) code[lane] = cells[cell[lane]];
    for (int lane = 0; lane < 16; ++lane) {
        const bool isSplit = code[lane] - kSplit < kSearch - kSplit;
        const CellSplit& split = splits[isSplit ? code[lane] - kSplit : 0];
        const float side = split.normal.x * x[lane] + split.normal.y * y[lane];
        const std::uint32_t chosen = side >= split.offset ? split.inside : split.outside;
        patch[lane] = isSplit ? chosen : code[lane];
        highest = std::max(highest, code[lane]);
    }
    return highest >= kSearch;
}

void PatchLookup::locate16(const Entry& entry, const float (&u)[16], const float (&v)[16],
                           std::uint32_t (&patch)[16]) const {
    alignas(64) float x[16], y[16];
    alignas(64) std::uint32_t cell[16], code[16];
    const CellGrid& grid = grids_[entry.locator];
    cells16(grid, u, v, x, y, cell);
    if (decode16(cells_.data(), splits_.data(), x, y, cell, code, patch))
        for (int lane = 0; lane < 16; ++lane)
            if (code[lane] >= kSearch) patch[lane] = search(grid, code[lane] - kSearch, {x[lane], y[lane]});
    for (std::uint32_t& p : patch) p += entry.first;
}

/// Charts of a polygon's halves: for points with u + v <= 1 and for the others.
std::uint32_t PatchLookup::addCharts(const Chart& near, const Chart& far) {
    charts_.push_back(near);
    charts_.push_back(far);
    return kCharts + static_cast<std::uint32_t>(charts_.size() - 2);
}

bool PatchLookup::onOnePolygon(const std::uint32_t (&polygon)[16]) { return polygon[0] != kNone && allEqual(polygon); }

void PatchLookup::patchesAt(const std::uint32_t (&polygon)[16], const float (&u)[16], const float (&v)[16],
                            std::uint32_t (&patch)[16]) const {
    if (onOnePolygon(polygon)) {
        const Entry& entry = entries_[polygon[0]];
        if (entry.locator != kNone)
            locate16(entry, u, v, patch);
        else
            gridPatches(entry, u, v, patch);
        return;
    }
    std::uint32_t hits[16], found[16];
    float hitU[16], hitV[16];
    std::size_t count = 0;
    for (int lane = 0; lane < 16; ++lane) {
        hits[count] = polygon[lane];
        hitU[count] = u[lane];
        hitV[count] = v[lane];
        count += polygon[lane] != kNone ? 1 : 0;
    }
    findSome(hits, hitU, hitV, count, found);
    const std::uint32_t* next = found;
    for (int lane = 0; lane < 16; ++lane) {
        patch[lane] = polygon[lane] != kNone ? *next : patch[lane];
        next += polygon[lane] != kNone ? 1 : 0;
    }
}

void PatchLookup::patchesAt(std::span<const std::uint32_t> polygon, std::span<const float> u, std::span<const float> v,
                            std::span<std::uint32_t> patch) const {
    for (std::size_t k = 0; k < polygon.size(); k += kSome)
        findSome(&polygon[k], &u[k], &v[k], std::min(kSome, polygon.size() - k), &patch[k]);
}

/// In steps, each for all hits, so that memory is asked for all cells and then for all edges at once; without branches, which
/// hits on different polygons would make unpredictable.
void PatchLookup::findSome(const std::uint32_t* polygon, const float* u, const float* v, std::size_t count,
                           std::uint32_t* patch) const {
    float x[kSome], y[kSome];
    std::uint32_t index[kSome], slow[kSome];
    const std::uint32_t* code[kSome];
    for (std::size_t k = 0; k < count; ++k) {
        const std::uint32_t place = places_[polygon[k]];
        const bool only = place < kCharts;
        const Chart& chart = charts_[only ? 0 : place - kCharts + (u[k] + v[k] <= 1.0F ? 0 : 1)];
        x[k] = chart.origin.x + u[k] * chart.axisU.x + v[k] * chart.axisV.x;
        y[k] = chart.origin.y + u[k] * chart.axisU.y + v[k] * chart.axisV.y;
        const int column = std::min(std::max(static_cast<int>(x[k]), 0), chart.lastColumn);
        const int row = std::min(std::max(static_cast<int>(y[k]), 0), chart.lastRow);
        index[k] = static_cast<std::uint32_t>(row * (chart.lastColumn + 1) + column);
        code[k] = chart.firstCell == kNone ? &index[k] : &cells_[chart.firstCell + index[k]];
        patch[k] = only ? place : chart.first;
    }
    std::size_t slowCount = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const std::uint32_t found = *code[k];
        const bool isSplit = found - kSplit < kSearch - kSplit;
        const CellSplit& split = splits_[isSplit ? found - kSplit : 0];
        const std::uint32_t beside[2] = {split.outside, split.inside};
        const std::uint32_t chosen = beside[split.normal.x * x[k] + split.normal.y * y[k] >= split.offset ? 1 : 0];
        patch[k] += isSplit ? chosen : found;
        slow[slowCount] = static_cast<std::uint32_t>(k);
        slowCount += found >= kSearch ? 1 : 0;
    }
    for (std::size_t k = 0; k < slowCount; ++k) patch[slow[k]] = patchAt(polygon[slow[k]], u[slow[k]], v[slow[k]]);
}

} // namespace lambert
