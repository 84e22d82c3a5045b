#pragma once

#include "formfactors/form_factor_matrix.h"
#include "formfactors/form_factor_method.h"
#include "meshing/build_patch_mesh.h"
#include "meshing/prepare.h"
#include "polygon_factor.h"
#include "scene/example_scenes.h"
#include "scene/rays/ray_caster.h"

#include <cmath>
#include <vector>

namespace lambert {

inline FormFactorRow rowOf(const FormFactorMethod& method, std::uint32_t patch) {
    RowAccumulator accumulator(method.patchCount());
    method.row(patch, accumulator);
    FormFactorRow row;
    accumulator.take(row);
    return row;
}

/// A scene whose polygons are the patches, with the exact factors of all pairs, fully visible.
struct ExactCase {
    explicit ExactCase(const Scene& source)
        : scene(prepareScene(source)), rays(scene), mesh(wholePolygons(scene)), factor(mesh.size()) {
        std::vector<std::vector<glm::dvec3>> polygons;
        for (std::size_t i = 0; i < mesh.size(); ++i) {
            polygons.emplace_back();
            for (int k = 0; k < mesh.cornerCount(i); ++k) polygons.back().emplace_back(mesh.position(i, k));
        }
        for (std::size_t i = 0; i < mesh.size(); ++i)
            for (std::size_t j = 0; j < mesh.size(); ++j)
                factor[i].push_back(i == j ? 0.0 : polygonToPolygon(polygons[i], polygons[j]));
    }

    static PatchMesh wholePolygons(const Scene& scene) {
        MeshOptions options;
        options.patches = 0;
        Progress progress;
        return buildPatchMesh(scene, options, progress);
    }

    Scene scene;
    RayCaster rays;
    PatchMesh mesh;
    std::vector<std::vector<double>> factor;
};

inline Scene closedBox(const glm::vec3& size) {
    const Material wall = greyMaterial("wall", 0.5F, 1.0F);
    return boxScene(size, {wall, wall, wall, wall, wall, wall});
}

inline constexpr glm::vec3 kCube6{1.0F, 1.0F, 1.0F};
inline constexpr glm::vec3 kRoom432{4.0F, 3.0F, 2.5F};

inline double entry(const FormFactorRow& row, std::uint32_t patch) {
    for (const FormFactor& e : row.entries)
        if (e.patch == patch) return e.value;
    return 0.0;
}

/// Slope of a straight line through the logarithms of both, by least squares.
inline double logarithmicSlope(const std::vector<double>& x, const std::vector<double>& y) {
    double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        const double a = std::log(x[k]);
        const double b = std::log(y[k]);
        sx += a;
        sy += b;
        sxx += a * a;
        sxy += a * b;
    }
    const auto n = static_cast<double>(x.size());
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

} // namespace lambert
