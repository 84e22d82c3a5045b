#pragma once

#include "scene/scene.h"

#include <glm/vec2.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// Fine uniform grid over a polygon in a plane frame, which finds the patch at a point of the polygon's chart.
struct CellGrid {
    std::array<glm::vec2, 2> origin, axisU, axisV; //!< chart → cells, for u + v <= 1 and for the rest of a quad
    std::uint32_t columns, rows;
    std::uint32_t firstCell = 0;   //!< into the codes
    std::uint32_t firstCorner = 0; //!< into the corners
};

/// An edge between two patches, for the cells that no other crosses.
struct CellSplit {
    glm::vec2 normal;
    float offset;
    std::uint32_t inside, outside; //!< patches where normal · point >= offset, and where not
};

/// The codes of cells: below kSplit the only patch, relative to the polygon's first.
inline constexpr std::uint32_t kSplit = 0x80000000;  //!< from here: kSplit + index into the splits
inline constexpr std::uint32_t kSearch = 0xC0000000; //!< from here: kSearch + index into the candidates

/// All that finds the patches of one polygon.
struct PatchLocator {
    CellGrid grid{};
    std::vector<std::uint32_t> codes; //!< columns × rows, row by row
    std::vector<CellSplit> splits;
    std::vector<std::uint32_t> candidates; //!< per searched cell: how many, then the patches
    std::vector<glm::vec2> corners;        //!< 4 per patch, in cells; a triangle repeats its last corner
};

/// For a polygon whose patches have these `corners` (convex; a triangle ends in kNone).
PatchLocator locatePatches(const Scene& scene, const Polygon& polygon,
                           std::span<const std::array<std::uint32_t, 4>> corners, std::span<const glm::vec3> positions);

} // namespace lambert
