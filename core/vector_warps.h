#pragma once

#include <cmath>
#include <numbers>

namespace lambert {

/// Maps of warps.h in single precision, without calls and branches: loops over them vectorise in files that are compiled with
/// -fno-math-errno (else a square root may have to set errno).

/// sin and cos of |x| <= π/2 to float precision, in code that vectorises.
inline float sine(float x) {
    const float y = x * x;
    return x * (1.0F +
                y * (-1.0F / 6 + y * (1.0F / 120 + y * (-1.0F / 5040 + y * (1.0F / 362880 - y * (1.0F / 39916800))))));
}
inline float cosine(float x) {
    const float y = x * x;
    return 1.0F +
           y * (-0.5F + y * (1.0F / 24 +
                             y * (-1.0F / 720 + y * (1.0F / 40320 + y * (-1.0F / 3628800 + y * (1.0F / 479001600))))));
}

/// A disk's point for (u, v) of the unit square, as concentricDisk has it.
struct DiskPoint {
    float x, y;
    float squaredRadius;
    DiskPoint(float u, float v) {
        const float a = 2.0F * u - 1.0F;
        const float b = 2.0F * v - 1.0F;
        const bool wide = std::abs(a) > std::abs(b);
        const float radius = wide ? a : b;
        const float other = wide ? b : a;
        const float angle = std::numbers::pi_v<float> / 4.0F * other / (radius != 0.0F ? radius : 1.0F);
        const float along = radius * cosine(angle);
        const float across = radius * sine(angle);
        x = wide ? along : across;
        y = wide ? across : along;
        squaredRadius = radius * radius;
    }
};

/// A sphere's point for (u, v) of the unit square: uniformSphere in single precision.
struct SpherePoint {
    float x, y, z;
    SpherePoint(float u, float v) {
        z = 1.0F - 2.0F * u;
        const float squared = 1.0F - z * z;
        const float radius = std::sqrt(squared > 0.0F ? squared : 0.0F);
        const float half = std::numbers::pi_v<float> * (v - 0.5F); // of the angle, less π
        const float s = sine(half);
        const float c = cosine(half);
        x = radius * (s * s - c * c);
        y = radius * (-2.0F * s * c);
    }
};

} // namespace lambert
