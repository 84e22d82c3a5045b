#include "picture/tone_mapping.h"

#include <algorithm>
#include <cmath>

namespace lambert {

Rgb toneMap(const Rgb& radiance, float ev) {
    constexpr double kShoulder = 0.8;
    const glm::dvec3 exposed = glm::dvec3(radiance) * std::exp2(static_cast<double>(ev));
    const double largest = std::max({exposed.x, exposed.y, exposed.z});
    if (largest <= kShoulder) return Rgb(exposed);
    const double t = (largest - kShoulder) / (1.0 - kShoulder);
    const double shown = kShoulder + (1.0 - kShoulder) * t / (1.0 + t);
    return Rgb(exposed * (shown / largest));
}

} // namespace lambert
