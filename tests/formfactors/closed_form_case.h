#pragma once

#include "core/sample_points.h"
#include "formfactors/closed_form.h"
#include "formfactors/closed_form_method.h"
#include "meshing/build_patch_mesh.h"
#include "meshing/prepare.h"
#include "polygon_factor.h"
#include "tests/scene/grid_scene.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

namespace lambert {

/// A scene whose polygons are the patches.
struct ClosedFormCase {
    explicit ClosedFormCase(const Scene& source, double error = 1e-4)
        : scene(prepareScene(source)), rays(scene), mesh(wholePolygons(scene)), method(mesh, rays, {.error = error}) {}

    static PatchMesh wholePolygons(const Scene& scene) {
        MeshOptions options;
        options.patches = 0;
        Progress progress;
        return buildPatchMesh(scene, options, progress);
    }

    /// F_ij + back + out of one row, dense: back at [size], out at [size + 1].
    std::vector<double> row(std::uint32_t patch) const {
        RowAccumulator accumulator(mesh.size());
        method.row(patch, accumulator);
        FormFactorRow row;
        accumulator.take(row);
        std::vector<double> dense(mesh.size() + 2, 0.0);
        for (const FormFactor& e : row.entries) dense[e.patch] = e.value;
        dense[mesh.size()] = row.back;
        dense[mesh.size() + 1] = row.out;
        return dense;
    }
    double sum(const std::vector<double>& row) const {
        double total = 0.0;
        for (std::size_t j = 0; j <= mesh.size(); ++j) total += row[j];
        return total;
    }
    std::vector<glm::dvec3> polygon(std::size_t i) const {
        std::vector<glm::dvec3> points;
        for (int k = 0; k < mesh.cornerCount(i); ++k) points.emplace_back(mesh.position(i, k));
        return points;
    }
    bool touch(std::size_t i, std::size_t j) const {
        for (int a = 0; a < mesh.cornerCount(i); ++a)
            for (int b = 0; b < mesh.cornerCount(j); ++b)
                if (mesh.position(i, a) == mesh.position(j, b)) return true;
        return false;
    }

    Scene scene;
    RayCaster rays;
    PatchMesh mesh;
    ClosedForm method;
};

/// Gives a quad, the only one of its material, a texture whose left half lets light pass.
inline void openLeftHalf(Scene& scene, Polygon& quad) {
    Material& leaf = scene.materials[quad.material];
    leaf.opacityTexture.texture = 0;
    leaf.opacityCutoff = 0.5F;
    scene.textures.push_back(
        std::make_shared<Texture>("half", 2, 1, std::vector<std::uint8_t>{255, 255, 255, 0, 255, 255, 255, 255}));
    SurfaceCorners surface;
    surface.uv = {glm::vec2(0, 1), glm::vec2(1, 1), glm::vec2(1, 0), glm::vec2(0, 0)};
    quad.surface = static_cast<std::uint32_t>(scene.surfaces.size());
    scene.surfaces.push_back(surface);
}

/// A box that floats in the unit cube.
inline constexpr glm::dvec3 kBoxLow{0.35, 0.3, 0.4}, kBoxHigh{0.65, 0.6, 0.7};

/// ∫∫ cos cos / π r² of what a test of segments lets pass, by Sobol points over both patches: shares nothing with the method.
inline double sampledFactor(const ClosedFormCase& c, std::size_t i, std::size_t j,
                            const std::function<bool(const glm::dvec3&, const glm::dvec3&)>& visible,
                            std::uint32_t count) {
    const SamplePoints points(Sampler::Sobol, count, 4, 17);
    const auto pi = c.polygon(i), pj = c.polygon(j);
    const auto at = [](const std::vector<glm::dvec3>& q, double u, double v) {
        return q[0] + u * (q[1] - q[0]) + v * (q[3] - q[0]); // parallelograms
    };
    const glm::dvec3 normalI = glm::normalize(polygonAreaVector(pi)), normalJ = glm::normalize(polygonAreaVector(pj));
    double sum = 0.0;
    for (std::uint32_t k = 0; k < count; ++k) {
        const glm::dvec3 x = at(pi, points.at(k, 0), points.at(k, 1)), y = at(pj, points.at(k, 2), points.at(k, 3));
        const glm::dvec3 d = y - x;
        const double squared = glm::dot(d, d);
        const double cosines = -glm::dot(normalI, d) * glm::dot(normalJ, d);
        if (cosines > 0.0 && glm::dot(normalI, d) > 0.0 && visible(x, y)) sum += cosines / (squared * squared);
    }
    return sum / count * glm::length(polygonAreaVector(pj)) / std::numbers::pi;
}

/// F_ij of parallelograms as the mean of point-to-polygon factors over i, by double exponential quadrature (H. Takahasi,
/// M. Mori 1974), which converges whatever the integrand does at i's border: shares no formula with contour integrals.
inline double averagedFactor(const ClosedFormCase& c, std::size_t i, std::size_t j) {
    constexpr int kHalf = 24;
    constexpr double kStep = 2.8 / kHalf; // ends 1e-11 from the border
    std::vector<std::pair<double, double>> nodes;
    double weights = 0.0;
    for (int k = -kHalf; k <= kHalf; ++k) {
        const double u = 1.0 / (1.0 + std::exp(-std::numbers::pi * std::sinh(kStep * k)));
        nodes.emplace_back(u, u * (1.0 - u) * std::cosh(kStep * k));
        weights += nodes.back().second;
    }
    const auto from = c.polygon(i), to = c.polygon(j);
    const glm::dvec3 normal = glm::normalize(polygonAreaVector(from));
    double sum = 0.0;
    for (const auto& [u, weightU] : nodes)
        for (const auto& [v, weightV] : nodes)
            sum += weightU * weightV *
                   pointToPolygon(from[0] + u * (from[1] - from[0]) + v * (from[3] - from[0]), normal, to);
    return sum / (weights * weights);
}

/// Whether the segment passes by the floating box (before a map).
inline bool passesBox(const glm::dvec3& x, const glm::dvec3& y) {
    double enter = 0.0, leave = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (kBoxLow[axis] - x[axis]) / (y[axis] - x[axis]);
        const double b = (kBoxHigh[axis] - x[axis]) / (y[axis] - x[axis]);
        if (y[axis] == x[axis]) {
            if (x[axis] <= kBoxLow[axis] || x[axis] >= kBoxHigh[axis]) return true;
            continue;
        }
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return leave - enter <= 1e-9;
}

} // namespace lambert
