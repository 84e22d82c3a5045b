#pragma once

#include "meshing/patch_locator.h"
#include "scene/scene.h"

#include <glm/vec2.hpp>

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
        std::uint32_t patch;
        findSome(&polygon, &u, &v, 1, &patch);
        return patch;
    }
    /// The same for many hits at once, all spans of one length: fastest where 16 hits, from a multiple of 16 on, are on one polygon.
    /// `patch` is left as it is where `polygon` is kNone.
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
        std::uint32_t firstCorner = 0;       ///< into corners_
        std::uint16_t columns = 1, rows = 1; ///< of a grid
        glm::vec2 skew{0.0F};                ///< see skewedPatch

        bool isSkewed() const { return skew.x != 0.0F || skew.y != 0.0F; }
    };

    static std::uint32_t skewedPatch(const Entry& entry, float u, float v);
    static void skewedPatches(const Entry& entry, const float* u, const float* v, std::uint32_t* patch);
    void onePolygon(std::uint32_t polygon, const float* u, const float* v, std::uint32_t* patch) const;
    static constexpr std::size_t kSome = 64;
    /// For hits on any polygons, at most kSome.
    void findSome(const std::uint32_t* polygon, const float* u, const float* v, std::size_t count,
                  std::uint32_t* patch) const;
    std::uint32_t search(std::uint32_t polygon, std::uint32_t code, float u, float v, glm::vec2 point) const;

    std::vector<Entry> entries_;
    std::vector<std::uint32_t> places_; ///< by polygon: its patch if it has but one, or kCharts + index into charts_
    static constexpr std::uint32_t kCharts = 0x80000000;
    std::vector<CellChart> charts_{
        CellChart{}}; ///< in pairs but for the first, which stands for polygons that have none
    bool hasBacks_ = false;
    std::vector<std::uint32_t> cells_{kSearch};  ///< codes; the first of skewed grids
    std::vector<CellSplit> splits_{CellSplit{}}; ///< the first for cells that have none
    std::vector<std::uint32_t> candidates_;      ///< per searched cell: how many, then the patches
    std::vector<glm::vec2> corners_;             ///< 4 per patch, in cells; a triangle repeats its last corner
};

} // namespace lambert
