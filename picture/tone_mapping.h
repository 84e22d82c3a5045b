#pragma once

#include "core/rgb.h"

namespace lambert {

/// What a picture shows of a radiance: a linear colour in [0, 1].
///
/// With m the largest channel of radiance · 2^ev, colours with m <= 0.8 are shown as they are; above, the
/// colour is scaled so that m becomes 0.8 + 0.2 t / (1 + t) with t = (m − 0.8) / 0.2. The curve is smooth at
/// 0.8 and reaches 1 at infinity: highlights keep their hue and their gradients, which a clamp would flatten.
Rgb toneMap(const Rgb& radiance, float ev);

} // namespace lambert
