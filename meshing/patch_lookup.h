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

    /// Uniform grid over the polygon in a plane frame; each cell lists the patches that touch it.
    struct Locator {
        std::array<glm::vec2, 4> corners; ///< of the polygon, in the plane frame
        bool quad;
        glm::vec2 lower, cellsPerMetre;
        std::uint32_t columns, rows;
        std::uint32_t firstCell;   ///< into cells_
        std::uint32_t firstCorner; ///< into planeCorners_, 4 per patch
    };

    std::uint32_t locate(const Entry& entry, float u, float v) const;
    float insideness(const Locator& locator, std::uint32_t patch, glm::vec2 point) const;

    std::vector<Entry> entries_;
    std::vector<Locator> locators_;
    std::vector<std::uint32_t> cells_;      ///< where each cell's candidates begin; the next cell's entry ends them
    std::vector<std::uint32_t> candidates_; ///< patches, relative to the polygon's first
    std::vector<glm::vec2> planeCorners_;   ///< 4 per patch; a triangle repeats its last corner
};

} // namespace lambert
