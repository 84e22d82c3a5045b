/// P. Andersson et al., "FLIP: a difference evaluator for alternating images", HPG 2020; sections and equations are its own.
#include "comparison/flip.h"

#include "baking/exposure.h"
#include "core/parallel.h"
#include "picture/srgb.h"

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>

namespace lambert {

namespace {

using std::numbers::pi;

// ---- Colours

/// Linear Rec. 709 to XYZ, from the primaries' chromaticities and D65 (.3127, .3290). Columns are the primaries.
const glm::dmat3& xyzOfRgb() {
    static const glm::dmat3 matrix(10135552.0 / 24577794.0, 2613072.0 / 12288897.0, 1425312.0 / 73733382.0,
                                   8788810.0 / 24577794.0, 8788810.0 / 12288897.0, 8788810.0 / 73733382.0,
                                   4435075.0 / 24577794.0, 887015.0 / 12288897.0, 70074185.0 / 73733382.0);
    return matrix;
}

/// XYZ relative to the white.
glm::dvec3 relativeXyz(const glm::dvec3& rgb) { return xyzOfRgb() * rgb / (xyzOfRgb() * glm::dvec3(1.0)); }

/// YCxCz: L*a*b* without its cube root, so that averages are those of light.
glm::dvec3 opponent(const glm::dvec3& rgb) {
    const glm::dvec3 t = relativeXyz(rgb);
    return {116.0 * t.y - 16.0, 500.0 * (t.x - t.y), 200.0 * (t.y - t.z)};
}
glm::dvec3 rgbOfOpponent(const glm::dvec3& c) {
    const double y = (c.x + 16.0) / 116.0;
    static const glm::dmat3 inverse = glm::inverse(xyzOfRgb());
    return inverse * (glm::dvec3(y + c.y / 500.0, y, y - c.z / 200.0) * (xyzOfRgb() * glm::dvec3(1.0)));
}

/// L*a*b* with the Hunt effect: colours fade with the light (equation 9).
glm::dvec3 huntLab(const glm::dvec3& rgb) {
    const glm::dvec3 t = relativeXyz(rgb);
    const auto f = [](double v) {
        constexpr double kDelta = 6.0 / 29.0;
        return v > kDelta * kDelta * kDelta ? std::cbrt(v) : v / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
    };
    const double lightness = 116.0 * f(t.y) - 16.0;
    return {lightness, 0.01 * lightness * 500.0 * (f(t.x) - f(t.y)), 0.01 * lightness * 200.0 * (f(t.y) - f(t.z))};
}

/// HyAB (equation 8).
double distance(const glm::dvec3& a, const glm::dvec3& b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// ---- Filters, all products of one along x and one along y

struct Plane {
    int width = 0, height = 0;
    std::vector<double> values;
};

using Kernel = std::vector<double>; ///< odd number of weights, the middle one at the pixel itself

double along(const Plane& plane, int x, int y, int stepX, int stepY, const Kernel& kernel) {
    const int radius = static_cast<int>(kernel.size() / 2);
    double sum = 0.0;
    for (int k = -radius; k <= radius; ++k) {
        const int u = std::clamp(x + k * stepX, 0, plane.width - 1);
        const int v = std::clamp(y + k * stepY, 0, plane.height - 1);
        sum += kernel[static_cast<std::size_t>(k + radius)] *
               plane.values[static_cast<std::size_t>(v) * static_cast<std::size_t>(plane.width) +
                            static_cast<std::size_t>(u)];
    }
    return sum;
}

Plane filtered(const Plane& plane, int stepX, int stepY, const Kernel& kernel) {
    Plane result = plane;
    parallelFor(static_cast<std::size_t>(plane.height), 8, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t y = begin; y < end; ++y)
            for (int x = 0; x < plane.width; ++x)
                result.values[y * static_cast<std::size_t>(plane.width) + static_cast<std::size_t>(x)] =
                    along(plane, x, static_cast<int>(y), stepX, stepY, kernel);
    });
    return result;
}

Plane filtered(const Plane& plane, const Kernel& alongX, const Kernel& alongY) {
    return filtered(filtered(plane, 1, 0, alongX), 0, 1, alongY);
}

Kernel kernel(int radius, const std::function<double(double)>& weight) {
    Kernel result;
    for (int k = -radius; k <= radius; ++k) result.push_back(weight(k));
    return result;
}

double sumOf(const Kernel& k) { return std::accumulate(k.begin(), k.end(), 0.0); }

/// A Gaussian of the contrast sensitivity (table 1), a √(π/b) exp(−π² r²/b), r in degrees.
struct Sensitivity {
    double a, b;
};

/// What the eye resolves of one channel: a sum of Gaussians, of weight 1 in all (section 4.1.1).
Plane blurred(const Plane& plane, const std::vector<Sensitivity>& gaussians, double pixelsPerDegree) {
    constexpr double kWidest = 0.04;
    const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(kWidest / (2.0 * pi * pi)) * pixelsPerDegree));
    Plane result{plane.width, plane.height, std::vector<double>(plane.values.size(), 0.0)};
    double total = 0.0;
    for (const auto& [a, b] : gaussians) {
        const Kernel gauss = kernel(radius, [&, width = b](double x) {
            const double degrees = x / pixelsPerDegree;
            return std::exp(-pi * pi * degrees * degrees / width);
        });
        const double weight = a * std::sqrt(pi / b);
        total += weight * sumOf(gauss) * sumOf(gauss);
        const Plane part = filtered(plane, gauss, gauss);
        for (std::size_t i = 0; i < result.values.size(); ++i) result.values[i] += weight * part.values[i];
    }
    for (double& value : result.values) value /= total;
    return result;
}

/// The sizes of edges or points at all pixels (section 4.2): gradients of Gaussians of first or second order.
Plane features(const Plane& luminance, double pixelsPerDegree, bool points) {
    constexpr double kPeakToTrough = 0.082; // degrees
    const double sigma = 0.5 * kPeakToTrough * pixelsPerDegree;
    const int radius = static_cast<int>(std::ceil(3.0 * sigma));
    const Kernel gauss = kernel(radius, [&](double x) { return std::exp(-x * x / (2.0 * sigma * sigma)); });
    Kernel derivative = kernel(radius, [&](double x) {
        const double g = std::exp(-x * x / (2.0 * sigma * sigma));
        return points ? (x * x / (sigma * sigma) - 1.0) * g : -x * g;
    });
    // In two dimensions positive weights sum to 1 and negative ones to −1; a sign does not depend on the other coordinate.
    double positive = 0.0;
    double negative = 0.0;
    for (const double w : derivative) (w > 0.0 ? positive : negative) += w;
    const double across = sumOf(gauss);
    for (double& w : derivative) w /= across * (w > 0.0 ? positive : -negative);
    Plane size = filtered(luminance, derivative, gauss);
    const Plane other = filtered(luminance, gauss, derivative);
    for (std::size_t i = 0; i < size.values.size(); ++i) size.values[i] = std::hypot(size.values[i], other.values[i]);
    return size;
}

/// A picture as FLIP sees it.
struct Seen {
    std::vector<glm::dvec3> lab; ///< blurred, see huntLab
    Plane edges, points;

    Seen(const Image& image, double pixelsPerDegree) {
        Plane channels[3];
        for (Plane& plane : channels) plane = {image.width, image.height, {}};
        Plane luminance{image.width, image.height, {}};
        for (const Rgb& pixel : image.pixels) {
            const glm::dvec3 c = opponent(glm::dvec3(pixel));
            for (int k = 0; k < 3; ++k) channels[k].values.push_back(c[k]);
            luminance.values.push_back((c.x + 16.0) / 116.0);
        }
        channels[0] = blurred(channels[0], {{1.0, 0.0047}}, pixelsPerDegree);
        channels[1] = blurred(channels[1], {{1.0, 0.0053}}, pixelsPerDegree);
        channels[2] = blurred(channels[2], {{34.1, 0.04}, {13.5, 0.025}}, pixelsPerDegree);
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            lab.push_back(huntLab(glm::clamp(
                rgbOfOpponent({channels[0].values[i], channels[1].values[i], channels[2].values[i]}), 0.0, 1.0)));
        edges = features(luminance, pixelsPerDegree, false);
        points = features(luminance, pixelsPerDegree, true);
    }
};

/// A colour difference, mapped to [0, 1] (section 4.1.3).
double colourError(const glm::dvec3& a, const glm::dvec3& b) {
    constexpr double kPower = 0.7, kKnee = 0.4, kAtKnee = 0.95;
    static const double largest = std::pow(distance(huntLab({0.0, 1.0, 0.0}), huntLab({0.0, 0.0, 1.0})), kPower);
    const double error = std::pow(distance(a, b), kPower);
    const double knee = kKnee * largest;
    return error < knee ? kAtKnee * error / knee : kAtKnee + (1.0 - kAtKnee) * (error - knee) / (largest - knee);
}

} // namespace

std::vector<float> flipMap(const Image& reference, const Image& test, double pixelsPerDegree) {
    const Seen a(reference, pixelsPerDegree);
    const Seen b(test, pixelsPerDegree);
    std::vector<float> map;
    map.reserve(a.lab.size());
    for (std::size_t i = 0; i < a.lab.size(); ++i) {
        const double feature = std::max(std::abs(a.edges.values[i] - b.edges.values[i]),
                                        std::abs(a.points.values[i] - b.points.values[i]));
        const double featureError = std::sqrt(feature / std::numbers::sqrt2); // equation 13
        map.push_back(static_cast<float>(std::pow(colourError(a.lab[i], b.lab[i]), 1.0 - featureError)));
    }
    return map;
}

double meanOf(const std::vector<float>& map) {
    double sum = 0.0;
    for (const float value : map) sum += static_cast<double>(value);
    return map.empty() ? 0.0 : sum / static_cast<double>(map.size());
}

double peakSignalToNoise(const Image& reference, const Image& test) {
    double squares = 0.0;
    for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const double d = static_cast<double>(srgbEncode(reference.pixels[i][c])) -
                             static_cast<double>(srgbEncode(test.pixels[i][c]));
            squares += d * d;
        }
    }
    const double mean = squares / (3.0 * static_cast<double>(reference.pixels.size()));
    return mean > 0.0 ? -10.0 * std::log10(mean) : std::numeric_limits<double>::infinity();
}

} // namespace lambert
