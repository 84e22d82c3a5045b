#pragma once

#include "scene/scene.h"

#include <glm/vec2.hpp>

#include <array>
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
        const auto column = static_cast<std::uint32_t>(u * static_cast<float>(entry.columns));
        const auto row = static_cast<std::uint32_t>(v * static_cast<float>(entry.rows));
        return entry.first + (row < entry.rows ? row : entry.rows - 1U) * entry.columns +
               (column < entry.columns ? column : entry.columns - 1U);
    }

    /// The same for 16 hits at once, which is faster. `patch` is left as it is where `polygon` is kNone.
    void patchesAt(const std::uint32_t (&polygon)[16], const float (&u)[16], const float (&v)[16],
                   std::uint32_t (&patch)[16]) const;

    /// The patch on the other side of a front patch of `polygon`, or kNone if the polygon is one-sided.
    std::uint32_t backPatch(std::uint32_t polygon, std::uint32_t frontPatch) const {
        const Entry& entry = entries_[polygon];
        return entry.firstBack == kNone ? kNone : entry.firstBack + (frontPatch - entry.first);
    }

    // Building: polygons are added in order.

    /// A polygon whose patches are a columns × rows grid in an affine chart (a triangle with one patch, a parallelogram),
    /// row by row from `first`; both at most 65535.
    void addGrid(std::uint32_t first, std::uint32_t columns, std::uint32_t rows);
    /// Any other polygon: `corners` are those of its patches (convex; a triangle ends in kNone), the first of which has
    /// the index `first`.
    void addPatches(const Scene& scene, const Polygon& polygon, std::uint32_t first,
                    std::span<const std::array<std::uint32_t, 4>> corners, std::span<const glm::vec3> positions);
    /// Says where the patches of the polygon's second side begin.
    void setBack(std::uint32_t polygon, std::uint32_t firstBack) { entries_[polygon].firstBack = firstBack; }

private:
    struct Entry {
        std::uint32_t first = 0;
        std::uint32_t firstBack = kNone;
        std::uint32_t locator = kNone; ///< into locators_; kNone: a grid
        std::uint16_t columns = 1, rows = 1;
    };

    /// Fine uniform grid over the polygon in a plane frame. A cell that lies in one patch holds it; another holds where
    /// its candidates begin.
    struct Locator {
        std::array<glm::vec2, 2> origin, axisU, axisV; ///< chart → grid, for u + v <= 1 and for the rest of a quad
        std::uint32_t columns, rows;
        std::uint32_t firstCell;   ///< into cells_
        std::uint32_t firstCorner; ///< into gridCorners_, 4 per patch
    };

    glm::vec2 gridPoint(const Locator& locator, float u, float v) const {
        const std::size_t half = u + v <= 1.0F ? 0 : 1;
        return locator.origin[half] + u * locator.axisU[half] + v * locator.axisV[half];
    }
    std::uint32_t search(const Locator& locator, std::uint32_t firstCandidate, glm::vec2 point) const;
    std::uint32_t locate(const Entry& entry, float u, float v) const;

    std::vector<Entry> entries_;
    std::vector<Locator> locators_;
    std::vector<std::uint32_t> cells_;      ///< a patch relative to the polygon's first, or kAmbiguous + candidates
    std::vector<std::uint32_t> candidates_; ///< per ambiguous cell: how many, then the patches
    std::vector<glm::vec2> gridCorners_;    ///< 4 per patch, in cells; a triangle repeats its last corner
};

} // namespace lambert
