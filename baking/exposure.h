#pragma once

#include "baking/baked_mesh.h"

namespace lambert {

/// The EV at which the 99th percentile of what is shown becomes 0.9 on the display. The percentile is
/// weighted by area over the faces; a face counts with the largest channel of the mean over its corners.
/// Emitters are left out, unless everything emits. Where less than 1 % of the area is lit, the percentile is
/// that of the lit faces. Faces darker than 1e-7 of the brightest are not lit: that is the light of rays that slip between
/// polygons. 0 for a black scene.
float automaticExposure(const BakedMesh& mesh, Quantity quantity);

/// What a display shows of a radiance: radiance · 2^ev, clamped to [0, 1] per channel, still linear. `ev` is
/// any finite number.
Rgb displayColour(const Rgb& radiance, float ev);

} // namespace lambert
