#include "meshing/patch_lookup.h"

#include "core/vector_clones.h"
#include "meshing/plane_frame.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lambert {

namespace {

constexpr double kCellsPerPatch = 16.0; ///< more than half of the cells then lie in one patch

float cross(glm::vec2 a, glm::vec2 b) { return a.x * b.y - a.y * b.x; }

/// The smallest of the signed areas that the point spans with the edges of a patch: not negative inside.
float insideness(const glm::vec2* c, glm::vec2 point) {
    float smallest = std::min(
        {cross(c[1] - c[0], point - c[0]), cross(c[2] - c[1], point - c[1]), cross(c[0] - c[3], point - c[3])});
    if (c[3] != c[2]) smallest = std::min(smallest, cross(c[3] - c[2], point - c[2]));
    return smallest;
}

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

struct PatchCell {
    std::uint32_t cell, patch;
};

/// All pairs of a cell and a patch that may reach into it, by cell, then patch.
std::vector<PatchCell> rasterise(std::span<const glm::vec2> corners, std::uint32_t columns, std::uint32_t rows) {
    const auto clampTo = [](float value, std::uint32_t count) {
        return static_cast<std::uint32_t>(std::clamp(value, 0.0F, static_cast<float>(count - 1)));
    };
    std::vector<PatchCell> pairs;
    for (std::size_t first = 0; first < corners.size(); first += 4) {
        const glm::vec2* c = corners.data() + first;
        const glm::vec2 lower = glm::min(glm::min(c[0], c[1]), glm::min(c[2], c[3])) - 1e-3F;
        const glm::vec2 upper = glm::max(glm::max(c[0], c[1]), glm::max(c[2], c[3])) + 1e-3F;
        for (std::uint32_t row = clampTo(lower.y, rows); row <= clampTo(upper.y, rows); ++row)
            for (std::uint32_t column = clampTo(lower.x, columns); column <= clampTo(upper.x, columns); ++column)
                if (mayTouch(c, {column, row}))
                    pairs.push_back({row * columns + column, static_cast<std::uint32_t>(first / 4)});
    }
    std::sort(pairs.begin(), pairs.end(), [](const PatchCell& a, const PatchCell& b) {
        return a.cell != b.cell ? a.cell < b.cell : a.patch < b.patch;
    });
    return pairs;
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

void PatchLookup::addPatches(const Scene& scene, const Polygon& polygon, std::uint32_t first,
                             std::span<const std::array<std::uint32_t, 4>> corners,
                             std::span<const glm::vec3> positions) {
    Entry entry;
    entry.first = first;
    entry.locator = static_cast<std::uint32_t>(locators_.size());
    entries_.push_back(entry);

    const PlaneFrame frame = planeFrame(scene, polygon);
    std::array<glm::dvec2, 4> p{};
    glm::dvec2 lower(std::numeric_limits<double>::max());
    glm::dvec2 upper(std::numeric_limits<double>::lowest());
    for (int k = 0; k < polygon.size(); ++k) {
        p[static_cast<std::size_t>(k)] = frame.project(corner(scene, polygon, k));
        lower = glm::min(lower, p[static_cast<std::size_t>(k)]);
        upper = glm::max(upper, p[static_cast<std::size_t>(k)]);
    }
    const glm::dvec2 size = glm::max(upper - lower, glm::dvec2(1e-30));
    const double cells = kCellsPerPatch * static_cast<double>(corners.size());
    const double cellSize = std::sqrt(size.x * size.y / cells);
    const auto cellCount = [&](double extent) {
        return static_cast<std::uint32_t>(std::clamp(std::ceil(extent / cellSize), 1.0, cells));
    };
    Locator locator{};
    locator.columns = cellCount(size.x);
    locator.rows = cellCount(size.y);
    const glm::dvec2 cellsPerMetre = glm::dvec2(locator.columns, locator.rows) / size;
    const auto toGrid = [&](glm::dvec2 point) { return glm::vec2((point - lower) * cellsPerMetre); };
    for (glm::dvec2& point : p) point = (point - lower) * cellsPerMetre;
    const glm::dvec2 alongV = polygon.isQuad() ? p[3] - p[0] : p[2] - p[0];
    locator.origin = {glm::vec2(p[0]), glm::vec2(p[1] + p[3] - p[2])};
    locator.axisU = {glm::vec2(p[1] - p[0]), glm::vec2(p[2] - p[3])};
    locator.axisV = {glm::vec2(alongV), glm::vec2(p[2] - p[1])};
    if (!polygon.isQuad()) { // rounding may put u + v above 1
        locator.origin[1] = locator.origin[0];
        locator.axisU[1] = locator.axisU[0];
        locator.axisV[1] = locator.axisV[0];
    }
    locator.firstCell = static_cast<std::uint32_t>(cells_.size());
    std::array<Chart, 2> charts;
    for (std::size_t half = 0; half < 2; ++half)
        charts[half] = {locator.origin[half],
                        locator.axisU[half],
                        locator.axisV[half],
                        static_cast<int>(locator.columns) - 1,
                        static_cast<int>(locator.rows) - 1,
                        locator.firstCell,
                        first};
    places_.push_back(addCharts(charts[0], charts[1]));
    locator.firstCorner = static_cast<std::uint32_t>(gridCorners_.size());
    for (const auto& patch : corners)
        for (std::size_t k = 0; k < 4; ++k)
            gridCorners_.push_back(toGrid(frame.project(positions[patch[k] == kNone ? patch[2] : patch[k]])));

    const std::vector<PatchCell> pairs =
        rasterise(std::span(gridCorners_).subspan(locator.firstCorner), locator.columns, locator.rows);
    std::vector<std::uint32_t> patches;
    KnownSplits known;
    auto pair = pairs.begin();
    for (std::uint32_t cell = 0; cell < locator.columns * locator.rows; ++cell) {
        auto end = pair;
        patches.clear();
        for (; end != pairs.end() && end->cell == cell; ++end) patches.push_back(end->patch);
        cells_.push_back(codeFor(locator, patches, known));
        pair = end;
    }
    locators_.push_back(locator);
}

/// The code of a cell into which the given patches may reach.
std::uint32_t PatchLookup::codeFor(const Locator& locator, std::span<const std::uint32_t> patches, KnownSplits& known) {
    if (patches.size() == 1) return patches[0];
    if (patches.size() == 2) {
        const auto [split, isNew] =
            known.try_emplace({patches[0], patches[1]}, kSplit + static_cast<std::uint32_t>(splits_.size()));
        if (!isNew) return split->second;
        const glm::vec2* one = gridCorners_.data() + locator.firstCorner + 4 * std::size_t{patches[0]};
        const glm::vec2* two = gridCorners_.data() + locator.firstCorner + 4 * std::size_t{patches[1]};
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t k = 0; k < 4; ++k) {
                const glm::vec2 a = one[i];
                const glm::vec2 b = one[(i + 1) % 4];
                if (a == b || a != two[(k + 1) % 4] || b != two[k]) continue;
                const glm::vec2 normal(a.y - b.y, b.x - a.x); // to the left, where `one` lies
                splits_.push_back({normal, normal.x * a.x + normal.y * a.y, patches[0], patches[1]});
                return split->second;
            }
        }
        known.erase(split);
    }
    // Also for a cell outside the polygon, which a rounded point may fall into: it has no candidates.
    const auto code = kSearch + static_cast<std::uint32_t>(candidates_.size());
    candidates_.push_back(static_cast<std::uint32_t>(patches.size()));
    candidates_.insert(candidates_.end(), patches.begin(), patches.end());
    return code;
}

std::uint32_t PatchLookup::search(const Locator& locator, std::uint32_t firstCandidate, glm::vec2 point) const {
    std::uint32_t best = 0;
    float bestInsideness = std::numeric_limits<float>::lowest();
    const std::uint32_t* candidate = candidates_.data() + firstCandidate;
    for (std::uint32_t remaining = *candidate; remaining > 0; --remaining) {
        const std::uint32_t patch = *++candidate;
        const float inside = insideness(gridCorners_.data() + locator.firstCorner + 4 * std::size_t{patch}, point);
        if (inside >= 0.0F) return patch;
        if (inside > bestInsideness) {
            bestInsideness = inside;
            best = patch;
        }
    }
    return best;
}

std::uint32_t PatchLookup::locate(const Entry& entry, float u, float v) const {
    const Locator& locator = locators_[entry.locator];
    const glm::vec2 point = cellPoint(locator, u, v);
    return entry.first + decode(locator, cells_[cellAt(locator, point)], point);
}

LAMBERT_VECTOR_CLONES
void PatchLookup::cells16(const Locator& locator, const float (&u)[16], const float (&v)[16], float (&x)[16],
                          float (&y)[16], std::uint32_t (&cell)[16]) {
    const Locator l = locator;
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
bool PatchLookup::decode16(const std::uint32_t* cells, const Split* splits, const float (&x)[16], const float (&y)[16],
                           const std::uint32_t (&cell)[16], std::uint32_t (&code)[16], std::uint32_t (&patch)[16]) {
    std::uint32_t highest = 0;
    for (int lane = 0; lane < 16; ++lane) code[lane] = cells[cell[lane]];
    for (int lane = 0; lane < 16; ++lane) {
        const bool isSplit = code[lane] - kSplit < kSearch - kSplit;
        const Split& split = splits[isSplit ? code[lane] - kSplit : 0];
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
    const Locator& locator = locators_[entry.locator];
    cells16(locator, u, v, x, y, cell);
    if (decode16(cells_.data(), splits_.data(), x, y, cell, code, patch))
        for (int lane = 0; lane < 16; ++lane)
            if (code[lane] >= kSearch) patch[lane] = search(locator, code[lane] - kSearch, {x[lane], y[lane]});
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
        const Split& split = splits_[isSplit ? found - kSplit : 0];
        const std::uint32_t beside[2] = {split.outside, split.inside};
        const std::uint32_t chosen = beside[split.normal.x * x[k] + split.normal.y * y[k] >= split.offset ? 1 : 0];
        patch[k] += isSplit ? chosen : found;
        slow[slowCount] = static_cast<std::uint32_t>(k);
        slowCount += found >= kSearch ? 1 : 0;
    }
    for (std::size_t k = 0; k < slowCount; ++k) patch[slow[k]] = patchAt(polygon[slow[k]], u[slow[k]], v[slow[k]]);
}

} // namespace lambert
