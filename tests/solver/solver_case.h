#pragma once

#include "solver/form_factor_rows.h"
#include "solver/problem.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>

namespace lambert {

/// Patches of area 1 that exist for their material only.
inline PatchMesh patchesWith(std::span<const float> reflectance, std::span<const float> emitted) {
    PatchMesh mesh;
    mesh.frontCount = reflectance.size();
    for (std::size_t i = 0; i < reflectance.size(); ++i) {
        mesh.corners.push_back({0, 0, 0, 0});
        mesh.area.push_back(1.0F);
        mesh.reflectance.emplace_back(reflectance[i]);
        mesh.emittedRadiosity.emplace_back(emitted[i]);
    }
    return mesh;
}

inline FormFactorMatrix dense(std::size_t count, const std::function<double(std::size_t, std::size_t)>& factor) {
    FormFactorMatrix matrix(count, MatrixStorage::Double);
    for (std::size_t i = 0; i < count; ++i) {
        FormFactorRow row;
        for (std::size_t j = 0; j < count; ++j)
            if (const double f = factor(i, j); f > 0.0) row.entries.push_back({static_cast<std::uint32_t>(j), f});
        matrix.setRow(i, row);
    }
    return matrix;
}

/// Two patches that see nothing but each other.
inline FormFactorMatrix plates() {
    return dense(2, [](std::size_t i, std::size_t j) { return i == j ? 0.0 : 1.0; });
}

/// A mesh keeps reflectances as floats, off by up to 3e-8 of themselves; what is solved from them is off by a little more.
inline constexpr double kFloatReflectance = 1e-7;

} // namespace lambert
