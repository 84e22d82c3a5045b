#pragma once

#include "baking/final_gather.h"
#include "baking/vertex_places.h"
#include "core/progress.h"

#include <vector>

namespace lambert {

/// Light that was gathered at a vertex.
struct VertexLight {
    RgbSum irradiance{0.0};    //!< E per m²
    RgbSum standardError{0.0}; //!< of rays and patches
    double relative = 0.0;     //!< error of the rays alone, as FinalGatherOptions::error has it
    std::uint32_t rays = 0;    //!< 0: there is no place from which more is seen than backs
};

/// Gathers at all vertices of `mesh`. Direct light is found at each as well as asked for. What surfaces reflect is found by few rays,
/// and smoothed over neighbours (VertexSmoothing); only where that is not good enough, as in corners, more rays are taken. The same
/// bits whatever the number of threads. Throws Cancelled.
std::vector<VertexLight> gatherAtVertices(const FinalGather& gather, const VertexPlaces& places, const BakedMesh& mesh,
                                          Progress& progress);

} // namespace lambert
