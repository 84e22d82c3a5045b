#include "baking/exposure.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

namespace lambert {

namespace {

constexpr double kPercentile = 0.99;
constexpr double kStrayShare = 1e-7;  ///< of the brightest face
constexpr double kDisplayValue = 0.9; ///< of the percentile

struct FaceValue {
    double value; ///< largest channel
    double area;
};

/// Without holes.
double faceArea(const BakedMesh& mesh, std::size_t face) {
    const auto& corners = mesh.faces[face];
    const auto position = [&](std::size_t k) { return glm::dvec3(mesh.positions[corners[k]]); };
    const glm::dvec3 diagonal = position(2) - position(0);
    const glm::dvec3 other = mesh.isQuad(face) ? position(3) - position(1) : position(2) - position(1);
    const double opacity = mesh.opacity.empty() ? 1.0 : static_cast<double>(mesh.opacity[face]);
    return opacity * 0.5 * glm::length(glm::cross(diagonal, other));
}

double faceValue(const BakedMesh& mesh, std::size_t face, Quantity quantity) {
    const std::size_t count = mesh.isQuad(face) ? 4 : 3;
    glm::dvec3 sum(0.0);
    for (std::size_t k = 0; k < count; ++k) sum += glm::dvec3(shownRadiance(mesh, mesh.faces[face][k], quantity));
    return std::max({sum.x, sum.y, sum.z}) / static_cast<double>(count);
}

/// The lit faces in order of their value, and the area of all faces, lit or not.
struct Histogram {
    std::vector<FaceValue> lit;
    double area = 0.0;
};

Histogram collect(const BakedMesh& mesh, Quantity quantity, bool withEmitters) {
    Histogram histogram;
    histogram.lit.reserve(mesh.faces.size());
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        if (!withEmitters && isEmitter(mesh, face)) continue;
        const double area = faceArea(mesh, face);
        histogram.area += area;
        if (const double value = faceValue(mesh, face, quantity); value > 0.0) histogram.lit.push_back({value, area});
    }
    // Less is what rays bring that slip between polygons; a face with nothing else is not lit.
    double brightest = 0.0;
    for (const FaceValue& face : histogram.lit) brightest = std::max(brightest, face.value);
    std::erase_if(histogram.lit, [&](const FaceValue& face) { return face.value < kStrayShare * brightest; });
    std::sort(histogram.lit.begin(), histogram.lit.end(), [](const FaceValue& a, const FaceValue& b) {
        return std::tie(a.value, a.area) < std::tie(b.value, b.area);
    });
    return histogram;
}

double percentile(const Histogram& histogram) {
    double litArea = 0.0;
    for (const FaceValue& face : histogram.lit) litArea += face.area;
    double brighter = (1.0 - kPercentile) * histogram.area;
    if (brighter >= litArea) brighter = (1.0 - kPercentile) * litArea;
    for (auto face = histogram.lit.rbegin(); face != histogram.lit.rend(); ++face) {
        brighter -= face->area;
        if (brighter < 0.0) return face->value;
    }
    return histogram.lit.empty() ? 0.0 : histogram.lit.front().value;
}

} // namespace

float automaticExposure(const BakedMesh& mesh, Quantity quantity) {
    Histogram histogram = collect(mesh, quantity, false);
    if (histogram.area <= 0.0) histogram = collect(mesh, quantity, true);
    const double value = percentile(histogram);
    return value > 0.0 ? static_cast<float>(std::log2(kDisplayValue / value)) : 0.0F;
}

Rgb displayColour(const Rgb& radiance, float ev) {
    // In double: a float overflows at 2^128, and 0 · inf is not a colour.
    const double gain = std::exp2(static_cast<double>(ev));
    Rgb colour;
    for (int c = 0; c < 3; ++c)
        colour[c] = static_cast<float>(std::clamp(static_cast<double>(radiance[c]) * gain, 0.0, 1.0));
    return colour;
}

} // namespace lambert
