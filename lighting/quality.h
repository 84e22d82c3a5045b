#pragma once

#include "lighting/solve_scene.h"

#include <string_view>

namespace lambert {

/// A preset: what is taken where nobody says otherwise.
struct Quality {
    std::string_view name;
    double refinement;       //!< see MeshOptions
    int largestResolution;   //!< see TransportOptions
    double mostRays;         //!< see TransportOptions
    double tolerance;        //!< of the solver
    std::uint32_t particles; //!< of instant radiosity
    std::uint32_t skyRays;   //!< see DirectLightOptions
    double gatherErrors;     //!< of the errors that normal aims at where light is gathered
};

/// preview, normal or high; a better one is never worse. Throws UsageError for other names.
const Quality& qualityOf(std::string_view name);

/// A solve by form factors in this quality.
SolveOptions solveOptions(const Quality& quality, std::uint64_t seed);

} // namespace lambert
