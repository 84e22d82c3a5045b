#pragma once

#include <cstddef>

namespace lambert {

/// What came of dividing a scene into patches.
struct MeshReport {
    double patchLength = 0.0;               //!< the length used, metres; infinite where nothing was refined
    std::size_t undividedPolygons = 0;      //!< could not be divided cleanly, kept whole (T-vertices remain)
    double undividedArea = 0.0;             //!< of these, m²
    std::size_t degeneratePatches = 0;      //!< dropped: no area in single precision
    std::size_t contactPolygons = 0;        //!< divided along contact lines
    std::size_t ignoredContactPolygons = 0; //!< their contact lines cross each other
    std::size_t nearContactPolygons = 0;    //!< divided along the outlines of what hovers over them
    std::size_t nearContactPatches = 0;     //!< more than without these outlines, those of backs included
    std::size_t nearContactBudget = 0;      //!< most that may be more
};

} // namespace lambert
