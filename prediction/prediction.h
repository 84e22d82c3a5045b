#pragma once

#include "lighting/solve_scene.h"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace lambert {

/// What a bake will take on this machine, as it is now loaded.
struct BakePrediction {
    std::size_t patches = 0;
    std::optional<TransportPlan> plan; //!< of form factors, as bakeScene makes it
    std::uint64_t rays = 0;            //!< of all form factors, or of what finds the light without them
    double secondsPerRay = 0.0;        //!< with all threads
    SolveSeconds seconds;              //!< `mesh` is measured
    double bakeSeconds = 0.0;          //!< of reconstruction
    std::uint64_t peakMemory = 0;      //!< bytes, of the whole process
    std::uint64_t matrixBytes = 0;     //!< the part of it for the form factors
    std::uint64_t lightBytes = 0;      //!< that for virtual point lights and where their light is gathered
};

/// Predicts bakeScene: meshes the scene, computes some form-factor rows, or finds the light with few rays, and extrapolates. Takes what
/// meshing takes and a fraction of a second; with a solver by lines also its passes over all patches. Throws what bakeScene
/// throws before it computes form factors.
BakePrediction predictBake(const Scene& scene, const SolveOptions& options, Progress& progress);

} // namespace lambert
