#pragma once

#include "scene/rays/ray_caster.h"

#include <vector>

namespace lambert {

/// A quick look at which light is lost on black backs. Exact to about 1 % (absolute).
struct BackFaceSample {
    double fraction = 0.0;          //!< of the rays that end on a black back
    std::vector<double> byMaterial; //!< #materials, the part of the fraction that ends on each
    std::uint32_t mostMet() const;  //!< the material with the largest part; kNone if no back was met
};

/// Rays from points spread evenly over all sides that are not black (of a prepared scene), in the directions in which a diffuse
/// surface shines. Points that see hardly anything but backs lie inside something and do not count. Occluders are no backs.
BackFaceSample sampleBackFaces(const RayCaster& rays);

/// The same from the sides that emit, as much light from each as it emits; all 0 if none emits.
BackFaceSample sampleBackFacesFromLights(const RayCaster& rays);

} // namespace lambert
