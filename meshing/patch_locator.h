#pragma once

#include "scene/scene.h"

#include <glm/vec2.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// Takes half of a polygon's chart, u + v <= 1 or the rest, to a grid of cells.
struct CellChart {
    glm::vec2 origin{0.0F}, axisU{0.0F}, axisV{0.0F};
    std::int32_t lastColumn = 0, lastRow = 0;
    std::uint32_t firstCell = kNone; //!< into the codes; kNone: the cells are the patches
    std::uint32_t first = 0;         //!< patch
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

/// All that finds the patches of one polygon: a fine uniform grid over it in a plane frame.
struct PatchLocator {
    std::array<CellChart, 2> charts{};
    std::vector<std::uint32_t> codes; //!< columns × rows, row by row
    std::vector<CellSplit> splits;
    std::vector<std::uint32_t> candidates; //!< per searched cell: how many, then the patches
    std::vector<glm::vec2> corners;        //!< 4 per patch, in cells; a triangle repeats its last corner
};

/// For a polygon whose patches have these `corners` (convex; a triangle ends in kNone).
PatchLocator locatePatches(const Scene& scene, const Polygon& polygon,
                           std::span<const std::array<std::uint32_t, 4>> corners, std::span<const glm::vec3> positions);

} // namespace lambert
