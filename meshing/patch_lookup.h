#pragma once

#include "meshing/patch_locator.h"
#include "scene/scene.h"

#include <glm/vec2.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// Turns what a ray hit, a source polygon and a point in its chart (see polygonPoint), into a patch. Rays are traced
/// against the source polygons; this is why the ray caster need not know the patches.
class PatchLookup {
public:
    /// The front patch of `polygon` at chart coordinates (u, v). Every point belongs to exactly one patch.
    std::uint32_t patchAt(std::uint32_t polygon, float u, float v) const {
        const Entry& entry = entries_[polygon];
        if (entry.locator != kNone) return locate(entry, u, v);
        const GridPoint p = gridPoint(u, v, entry.skew);
        return entry.first + gridIndex(p.t, entry.rows) * entry.columns + gridIndex(p.s, entry.columns);
    }

    /// The same for 16 hits at once, which is faster. `patch` is left as it is where `polygon` is kNone.
    void patchesAt(const std::uint32_t (&polygon)[16], const float (&u)[16], const float (&v)[16],
                   std::uint32_t (&patch)[16]) const;
    /// Whether all hits are on one polygon, for which that is fastest.
    static bool onOnePolygon(const std::uint32_t (&polygon)[16]);
    /// The same for any number of hits, none of them missing; all of one length.
    void patchesAt(std::span<const std::uint32_t> polygon, std::span<const float> u, std::span<const float> v,
                   std::span<std::uint32_t> patch) const;

    /// Whether any polygon has patches on its second side.
    bool hasBacks() const { return hasBacks_; }
    /// The patch on the other side of a front patch of `polygon`, or kNone if the polygon is one-sided.
    std::uint32_t backPatch(std::uint32_t polygon, std::uint32_t frontPatch) const {
        const Entry& entry = entries_[polygon];
        return entry.firstBack == kNone ? kNone : entry.firstBack + (frontPatch - entry.first);
    }

    // Building: polygons are added in order.

    /// A polygon whose patches are a columns × rows grid, row by row from `first`, bilinear if it is a quad (which must be
    /// convex and planar); both at most 65535. A triangle has one patch.
    void addGrid(const Scene& scene, const Polygon& polygon, std::uint32_t first, std::uint32_t columns,
                 std::uint32_t rows);
    /// Any other polygon, whose patches the locator knows; the first has the index `first`.
    void addLocated(const PatchLocator& locator, std::uint32_t first);
    /// Says where the patches of the polygon's second side begin.
    void setBack(std::uint32_t polygon, std::uint32_t firstBack) {
        entries_[polygon].firstBack = firstBack;
        hasBacks_ = true;
    }

private:
    struct Entry {
        std::uint32_t first = 0;
        std::uint32_t firstBack = kNone;
        std::uint32_t locator = kNone; ///< into grids_; kNone: a grid
        std::uint16_t columns = 1, rows = 1;
        glm::vec2 skew{0.0F}; ///< see gridPoint
    };

    struct GridPoint {
        float s, t;
    };

    /// Bilinear coordinates of a chart point of a quad. In the frame of two edges, v0 = (0, 0), v1 = (1, 0), v3 = (0, 1),
    /// the last corner is v2 = (1, 1) + skew and the quad is (s, t) + s t skew, while the chart is (u, v), and beyond the
    /// diagonal (u, v) + (u + v − 1) skew. Of the two solutions the one that goes on to (u, v) as the skew goes to 0.
    static GridPoint gridPoint(float u, float v, glm::vec2 skew) {
        if (skew.x == 0.0F && skew.y == 0.0F) return {u, v};
        const float beyond = u + v > 1.0F ? u + v - 1.0F : 0.0F;
        const float x = u + beyond * skew.x;
        const float y = v + beyond * skew.y;
        const float k = x * skew.y - y * skew.x;
        return {2.0F * x / (1.0F - k + root((1.0F - k) * (1.0F - k) + 4.0F * skew.y * x)),
                2.0F * y / (1.0F + k + root((1.0F + k) * (1.0F + k) + 4.0F * skew.x * y))};
    }
    static float root(float value) { return std::sqrt(value > 0.0F ? value : 0.0F); }
    static std::uint32_t gridIndex(float coordinate, std::uint32_t count) {
        const int index = static_cast<int>(coordinate * static_cast<float>(count));
        return static_cast<std::uint32_t>(std::clamp(index, 0, static_cast<int>(count) - 1));
    }
    static void gridPatches(const Entry& entry, const float (&u)[16], const float (&v)[16], std::uint32_t (&patch)[16]);

    std::uint32_t locate(const Entry& entry, float u, float v) const;
    static std::uint32_t cellAt(const CellGrid& grid, glm::vec2 point) {
        const auto column = std::min(static_cast<std::uint32_t>(std::max(point.x, 0.0F)), grid.columns - 1);
        const auto row = std::min(static_cast<std::uint32_t>(std::max(point.y, 0.0F)), grid.rows - 1);
        return grid.firstCell + row * grid.columns + column;
    }
    static glm::vec2 cellPoint(const CellGrid& grid, float u, float v) {
        const std::size_t half = u + v <= 1.0F ? 0 : 1;
        return grid.origin[half] + u * grid.axisU[half] + v * grid.axisV[half];
    }
    std::uint32_t decode(const CellGrid& grid, std::uint32_t code, glm::vec2 point) const {
        if (code < kSplit) return code;
        if (code >= kSearch) return search(grid, code - kSearch, point);
        const CellSplit& split = splits_[code - kSplit];
        return split.normal.x * point.x + split.normal.y * point.y >= split.offset ? split.inside : split.outside;
    }
    std::uint32_t search(const CellGrid& grid, std::uint32_t firstCandidate, glm::vec2 point) const;
    void locate16(const Entry& entry, const float (&u)[16], const float (&v)[16], std::uint32_t (&patch)[16]) const;
    static bool decode16(const std::uint32_t* cells, const CellSplit* splits, const float (&x)[16],
                         const float (&y)[16], const std::uint32_t (&cell)[16], std::uint32_t (&code)[16],
                         std::uint32_t (&patch)[16]);
    /// A locator's or a grid's half, for hits on different polygons.
    struct Chart {
        glm::vec2 origin{0.0F}, axisU{0.0F}, axisV{0.0F}; ///< chart → cells, or → patches of a grid
        std::int32_t lastColumn = 0, lastRow = 0;
        std::uint32_t firstCell = kNone; ///< into cells_; kNone: a grid; a skewed one has the first cell
        std::uint32_t first = 0;         ///< patch
    };
    std::uint32_t addCharts(const Chart& near, const Chart& far);
    static constexpr std::size_t kSome = 64;
    /// For hits on any polygons, at most kSome.
    void findSome(const std::uint32_t* polygon, const float* u, const float* v, std::size_t count,
                  std::uint32_t* patch) const;
    static void cells16(const CellGrid& grid, const float (&u)[16], const float (&v)[16], float (&x)[16],
                        float (&y)[16], std::uint32_t (&cell)[16]);

    std::vector<Entry> entries_;
    std::vector<std::uint32_t> places_; ///< by polygon: its patch if it has but one, or kCharts + index into charts_
    static constexpr std::uint32_t kCharts = 0x80000000;
    std::vector<Chart> charts_{Chart{}}; ///< in pairs but for the first, which stands for polygons that have none
    bool hasBacks_ = false;
    std::vector<CellGrid> grids_;
    std::vector<std::uint32_t> cells_{kSearch};  ///< codes; below kSplit: the patch, relative to the first
    std::vector<CellSplit> splits_{CellSplit{}}; ///< the first for cells that have none
    std::vector<std::uint32_t> candidates_;      ///< per searched cell: how many, then the patches
    std::vector<glm::vec2> gridCorners_;         ///< 4 per patch, in cells; a triangle repeats its last corner
};

} // namespace lambert
