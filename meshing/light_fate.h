#pragma once

#include "scene/rays/ray_caster.h"

#include <cstdint>

namespace lambert {

/// What light meets first, on its way from where it comes: shares of the rays that stand for it. They add up to 1, or are all
/// 0 where there is none.
struct LightFate {
    double fronts = 0.0;    //!< sides that are not black and do not emit
    double emitters = 0.0;  //!< sides that emit
    double backs = 0.0;     //!< black backs
    double occluders = 0.0; //!< what only blocks light
    double nothing = 0.0;   //!< it leaves the scene

    std::uint32_t node = kNone;     //!< of the black backs, the one that is met most; kNone: none is met
    std::uint32_t material = kNone; //!< of that node's backs, the one that is met most

    /// Some of it arrives at a front that does not emit, be it too little for the shares to show.
    bool arrives = false;
    bool isLost() const { return !arrives && emitters + backs + occluders + nothing > 0.0; }
};

/// Of what the sides of a prepared scene emit, by 16,384 rays: as many from each as it emits, in the directions in which a
/// diffuse surface shines.
LightFate fateOfEmission(const RayCaster& rays);

/// Of a light without area, by 4,096 rays toward points spread evenly over all surfaces, those where it shines; or, if it shines
/// on none, as it shines. Of a directional one, by rays that cross the scene.
LightFate fateOfLight(const RayCaster& rays, const PunctualLight& light);

/// Of what comes from all around, the same from everywhere, by 16,384 rays, of which those count that meet the scene.
LightFate fateOfEnvironment(const RayCaster& rays);

/// Whether any of 65,536 lines between a point that emits and a point of a front that does not, spread as their light and
/// their area are, is free on the sides to which both shine. Finds emitters however small or far away they are.
bool emissionArrives(const RayCaster& rays);

} // namespace lambert
