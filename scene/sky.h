#pragma once

#include "scene/environment.h"

namespace lambert {

/// Daylight in photometric units (lm, cd, lx), grey: the standards have no colour. What lies below the horizon is black.
/// Elevations of the sun are in degrees above the horizon, 0 to 90; azimuths as in skyDirection.

/// The CIE standard clear sky, low illuminance turbidity (type 12 of CIE S 011, relative to the sun's place), scaled to
/// clearSkyIlluminance. The sun itself is not part of it.
Environment clearSky(double sunAzimuth, double sunElevation);

/// The CIE standard overcast sky, L = L_z (1 + 2 sin elevation) / 3, the same all around; its `illuminance` (lx) on open level
/// ground is 7π/9 L_z.
Environment overcastSky(double illuminance);

/// On open level ground, from the sky without the sun, lx.
double clearSkyIlluminance(double sunElevation);
double overcastSkyIlluminance(double sunElevation);

/// Of the sun in a clear sky, on a plane that faces it, lx.
double sunIlluminance(double sunElevation);

/// Luminance of the standard clear sky relative to the zenith's; `direction` and `toSun` have unit length. 0 below the horizon.
double clearSkyPattern(const glm::dvec3& direction, const glm::dvec3& toSun);

} // namespace lambert
