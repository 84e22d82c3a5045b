#include "meshing/patch_lookup.h"

#include "core/vector_clones.h"
#include "meshing/plane_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lambert {

namespace {

constexpr std::size_t kLanes = 16;

float cross(glm::vec2 a, glm::vec2 b) { return a.x * b.y - a.y * b.x; }

/// The smallest of the signed areas that the point spans with the edges of a patch: not negative inside.
float insideness(const glm::vec2* c, glm::vec2 point) {
    float smallest = std::min(
        {cross(c[1] - c[0], point - c[0]), cross(c[2] - c[1], point - c[1]), cross(c[0] - c[3], point - c[3])});
    if (c[3] != c[2]) smallest = std::min(smallest, cross(c[3] - c[2], point - c[2]));
    return smallest;
}

LAMBERT_VECTOR_CLONES
bool allEqual(const std::uint32_t* values) {
    std::uint32_t difference = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) difference |= values[lane] ^ values[0];
    return difference == 0;
}

/// Points in cells, and the cells that they fall into.
LAMBERT_VECTOR_CLONES
void findCells(const CellChart* charts, const float* u, const float* v, float* x, float* y, std::uint32_t* cell) {
    const CellChart near = charts[0], far = charts[1];
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const bool isNear = u[lane] + v[lane] <= 1.0F;
        const float nearX = near.origin.x + u[lane] * near.axisU.x + v[lane] * near.axisV.x;
        const float nearY = near.origin.y + u[lane] * near.axisU.y + v[lane] * near.axisV.y;
        const float farX = far.origin.x + u[lane] * far.axisU.x + v[lane] * far.axisV.x;
        const float farY = far.origin.y + u[lane] * far.axisU.y + v[lane] * far.axisV.y;
        x[lane] = isNear ? nearX : farX;
        y[lane] = isNear ? nearY : farY;
        const int column = std::clamp(static_cast<int>(x[lane]), 0, near.lastColumn);
        const int row = std::clamp(static_cast<int>(y[lane]), 0, near.lastRow);
        cell[lane] = static_cast<std::uint32_t>(row * (near.lastColumn + 1) + column);
    }
}

/// Patches, relative to the first, of the cells' codes, without branches, which these unpredictable cells would make expensive.
/// Returns whether some cell has to be searched.
LAMBERT_VECTOR_CLONES
bool decode(const std::uint32_t* codes, const CellSplit* splits, const float* x, const float* y,
            const std::uint32_t* cell, std::uint32_t* code, std::uint32_t* patch) {
    std::uint32_t highest = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) code[lane] = codes[cell[lane]];
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const bool isSplit = code[lane] - kSplit < kSearch - kSplit;
        const CellSplit& split = splits[isSplit ? code[lane] - kSplit : 0];
        const float side = split.normal.x * x[lane] + split.normal.y * y[lane];
        const std::uint32_t chosen = side >= split.offset ? split.inside : split.outside;
        patch[lane] = isSplit ? chosen : code[lane];
        highest = std::max(highest, code[lane]);
    }
    return highest >= kSearch;
}

std::uint32_t gridIndex(float coordinate, std::uint32_t count) {
    const int index = static_cast<int>(coordinate * static_cast<float>(count));
    return static_cast<std::uint32_t>(std::clamp(index, 0, static_cast<int>(count) - 1));
}

float root(float value) { return std::sqrt(value > 0.0F ? value : 0.0F); }

} // namespace

void PatchLookup::addGrid(const Scene& scene, const Polygon& polygon, std::uint32_t first, std::uint32_t columns,
                          std::uint32_t rows) {
    Entry& entry = entries_.emplace_back();
    entry.first = first;
    entry.columns = static_cast<std::uint16_t>(columns);
    entry.rows = static_cast<std::uint16_t>(rows);
    if (columns * rows == 1) {
        places_.push_back(first);
        return;
    }
    if (polygon.isQuad()) {
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
    CellChart chart;
    chart.first = first;
    if (entry.isSkewed()) {
        chart.firstCell = 0;
    } else {
        chart.axisU = {static_cast<float>(columns), 0.0F};
        chart.axisV = {0.0F, static_cast<float>(rows)};
        chart.lastColumn = static_cast<int>(columns) - 1;
        chart.lastRow = static_cast<int>(rows) - 1;
    }
    places_.push_back(kCharts + static_cast<std::uint32_t>(charts_.size()));
    charts_.insert(charts_.end(), 2, chart);
}

void PatchLookup::addLocated(const PatchLocator& locator, std::uint32_t first) {
    Entry& entry = entries_.emplace_back();
    entry.first = first;
    entry.firstCorner = static_cast<std::uint32_t>(corners_.size());
    places_.push_back(kCharts + static_cast<std::uint32_t>(charts_.size()));
    for (CellChart chart : locator.charts) {
        chart.firstCell = static_cast<std::uint32_t>(cells_.size());
        chart.first = first;
        charts_.push_back(chart);
    }
    const auto splits = static_cast<std::uint32_t>(splits_.size());
    const auto candidates = static_cast<std::uint32_t>(candidates_.size());
    for (const std::uint32_t code : locator.codes)
        cells_.push_back(code + (code < kSplit ? 0 : code < kSearch ? splits : candidates));
    splits_.insert(splits_.end(), locator.splits.begin(), locator.splits.end());
    candidates_.insert(candidates_.end(), locator.candidates.begin(), locator.candidates.end());
    corners_.insert(corners_.end(), locator.corners.begin(), locator.corners.end());
}

/// By bilinear coordinates of a chart point of a quad. In the frame of two edges, v0 = (0, 0), v1 = (1, 0), v3 = (0, 1),
/// the last corner is v2 = (1, 1) + skew and the quad is (s, t) + s t skew, while the chart is (u, v), and beyond the
/// diagonal (u, v) + (u + v − 1) skew. Of the two solutions the one that goes on to (u, v) as the skew goes to 0.
std::uint32_t PatchLookup::skewedPatch(const Entry& entry, float u, float v) {
    const glm::vec2 skew = entry.skew;
    const float beyond = u + v > 1.0F ? u + v - 1.0F : 0.0F;
    const float x = u + beyond * skew.x;
    const float y = v + beyond * skew.y;
    const float k = x * skew.y - y * skew.x;
    const float s = 2.0F * x / (1.0F - k + root((1.0F - k) * (1.0F - k) + 4.0F * skew.y * x));
    const float t = 2.0F * y / (1.0F + k + root((1.0F + k) * (1.0F + k) + 4.0F * skew.x * y));
    return entry.first + gridIndex(t, entry.rows) * entry.columns + gridIndex(s, entry.columns);
}

LAMBERT_VECTOR_CLONES
void PatchLookup::skewedPatches(const Entry& entry, const float* u, const float* v, std::uint32_t* patch) {
    const Entry grid = entry;
    for (std::size_t lane = 0; lane < kLanes; ++lane) patch[lane] = skewedPatch(grid, u[lane], v[lane]);
}

/// In a cell whose code names no patch.
std::uint32_t PatchLookup::search(std::uint32_t polygon, std::uint32_t code, float u, float v, glm::vec2 point) const {
    const Entry& entry = entries_[polygon];
    if (entry.isSkewed()) return skewedPatch(entry, u, v);
    std::uint32_t best = 0;
    float bestInsideness = std::numeric_limits<float>::lowest();
    const std::uint32_t* candidate = candidates_.data() + (code - kSearch);
    for (std::uint32_t remaining = *candidate; remaining > 0; --remaining) {
        const std::uint32_t patch = *++candidate;
        const float inside = insideness(corners_.data() + entry.firstCorner + 4 * std::size_t{patch}, point);
        if (inside >= 0.0F) return entry.first + patch;
        if (inside > bestInsideness) {
            bestInsideness = inside;
            best = patch;
        }
    }
    return entry.first + best;
}

/// For kLanes hits.
void PatchLookup::onePolygon(std::uint32_t polygon, const float* u, const float* v, std::uint32_t* patch) const {
    const std::uint32_t place = places_[polygon];
    if (place < kCharts) {
        std::fill_n(patch, kLanes, place);
        return;
    }
    if (entries_[polygon].isSkewed()) return skewedPatches(entries_[polygon], u, v, patch);
    const CellChart* const charts = &charts_[place - kCharts];
    alignas(64) float x[kLanes], y[kLanes];
    alignas(64) std::uint32_t cell[kLanes], code[kLanes];
    findCells(charts, u, v, x, y, cell);
    if (charts->firstCell == kNone) {
        for (std::size_t lane = 0; lane < kLanes; ++lane) patch[lane] = charts->first + cell[lane];
        return;
    }
    const bool isSearched = decode(&cells_[charts->firstCell], splits_.data(), x, y, cell, code, patch);
    for (std::size_t lane = 0; lane < kLanes; ++lane) patch[lane] += charts->first;
    for (std::size_t lane = 0; isSearched && lane < kLanes; ++lane)
        if (code[lane] >= kSearch) patch[lane] = search(polygon, code[lane], u[lane], v[lane], {x[lane], y[lane]});
}

void PatchLookup::patchesAt(std::span<const std::uint32_t> polygon, std::span<const float> u, std::span<const float> v,
                            std::span<std::uint32_t> patch) const {
    // The hits on different polygons together. One more is written and not kept.
    std::uint32_t hit[kSome + 1], found[kSome];
    float hitU[kSome + 1], hitV[kSome + 1];
    std::size_t at[kSome + 1];
    std::size_t count = 0;
    const auto findHits = [&] {
        if (count == 0) return;
        findSome(hit, hitU, hitV, count, found);
        for (std::size_t k = 0; k < count; ++k) patch[at[k]] = found[k];
        count = 0;
    };
    for (std::size_t first = 0; first < polygon.size(); first += kLanes) {
        const std::size_t last = std::min(first + kLanes, polygon.size());
        if (last - first == kLanes && polygon[first] != kNone && allEqual(&polygon[first])) {
            onePolygon(polygon[first], &u[first], &v[first], &patch[first]);
            continue;
        }
        if (count + kLanes > kSome) findHits();
        for (std::size_t k = first; k < last; ++k) {
            hit[count] = polygon[k];
            hitU[count] = u[k];
            hitV[count] = v[k];
            at[count] = k;
            count += polygon[k] != kNone ? 1 : 0;
        }
    }
    findHits();
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
        const CellChart& chart = charts_[only ? 0 : place - kCharts + (u[k] + v[k] <= 1.0F ? 0 : 1)];
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
    for (std::size_t i = 0; i < slowCount; ++i) {
        const std::uint32_t k = slow[i];
        patch[k] = search(polygon[k], *code[k], u[k], v[k], {x[k], y[k]});
    }
}

} // namespace lambert
