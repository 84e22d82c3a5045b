/// Point to polygon: J. H. Lambert, Photometria, 1760; D. R. Baum, H. E. Rushmeier, J. M. Winget, "Improving radiosity
/// solutions through the use of analytically determined form-factors", SIGGRAPH 1989, equation 12.
/// Polygon to polygon: the double contour integral, E. M. Sparrow, "A new and simpler formulation for radiative angle
/// factors", J. Heat Transfer 85, 1963; its inner integral in closed form, the outer by quadrature.
#include "formfactors/closed_form.h"

#include "formfactors/quadrature.h"

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lambert {

namespace {

/// A piece whose distance to the singularity is this many times its length needs so many Gauss points for 1e-14: the error
/// falls as ρ^(−2n), ρ = 2q + √(4q² + 1).
constexpr double kFar = 2.0;  // 8 points
constexpr double kNear = 0.5; // 16 points
/// Radians: edges turned by less are taken as parallel. Single precision turns those of small patches as far as the second.
constexpr double kRounding = 1e-14;
constexpr double kSingleRounding = 1e-5;
/// With such a gap, in radii, 8 Gauss points per axis are exact to 1e-13.
constexpr double kApart = 3.0;

struct Segment {
    glm::dvec3 begin;
    glm::dvec3 direction; ///< unit length
    double length;

    glm::dvec3 at(double s) const { return begin + s * direction; }
};

std::vector<Segment> edges(std::span<const glm::dvec3> polygon) {
    std::vector<Segment> result;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const glm::dvec3 along = polygon[(k + 1) % polygon.size()] - polygon[k];
        const double length = glm::length(along);
        if (length > 0.0) result.push_back({polygon[k], along / length, length});
    }
    return result;
}

/// A sphere around a polygon's vertices.
struct Ball {
    glm::dvec3 centre{0.0};
    double radius = 0.0;

    explicit Ball(std::span<const glm::dvec3> polygon) {
        for (const glm::dvec3& p : polygon) centre += p / static_cast<double>(polygon.size());
        for (const glm::dvec3& p : polygon) radius = std::max(radius, glm::distance(p, centre));
    }
};

/// Gauss points over the triangles of a fan, 8 per axis of each; weights are signed: a concave polygon's fan overlaps itself.
std::vector<WeightedPoint> gaussPoints(std::span<const glm::dvec3> polygon, const glm::dvec3& unitNormal) {
    std::vector<WeightedPoint> result;
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
        const std::array triangle{polygon[0], polygon[k], polygon[k + 1]};
        const std::size_t first = result.size();
        appendGaussPoints(triangle, 8, result);
        if (glm::dot(polygonAreaVector(triangle), unitNormal) < 0.0)
            for (std::size_t i = first; i < result.size(); ++i) result[i].weight = -result[i].weight;
    }
    return result;
}

/// ∫∫ cos cos / π r² over two polygons far from each other.
double farExchangeArea(std::span<const glm::dvec3> a, std::span<const glm::dvec3> b) {
    const glm::dvec3 normalA = glm::normalize(polygonAreaVector(a));
    const glm::dvec3 normalB = glm::normalize(polygonAreaVector(b));
    const std::vector<WeightedPoint> pointsB = gaussPoints(b, normalB);
    double sum = 0.0;
    for (const auto& [x, weightX] : gaussPoints(a, normalA)) {
        double atX = 0.0;
        for (const auto& [y, weightY] : pointsB) {
            const glm::dvec3 d = y - x;
            const double squared = glm::dot(d, d);
            atX -= weightY * glm::dot(normalA, d) * glm::dot(normalB, d) / (squared * squared);
        }
        sum += weightX * atX;
    }
    return std::max(0.0, sum / std::numbers::pi);
}

/// ∫ ln r along the edge, r the distance from x.
double logIntegral(const glm::dvec3& x, const Segment& edge) {
    const glm::dvec3 toBegin = edge.begin - x;
    const double t0 = glm::dot(toBegin, edge.direction);
    const double t1 = t0 + edge.length;
    const double height = glm::length(toBegin - t0 * edge.direction);
    const auto primitive = [height](double t) {
        const double squared = t * t + height * height;
        return squared > 0.0 ? 0.5 * t * std::log(squared) - t : 0.0;
    };
    const double angle = std::atan2(height * edge.length, height * height + t0 * t1);
    return primitive(t1) - primitive(t0) + height * angle;
}

double distanceToSegment(const glm::dvec3& x, const Segment& segment) {
    const double t = std::clamp(glm::dot(x - segment.begin, segment.direction), 0.0, segment.length);
    return glm::distance(x, segment.at(t));
}

/// Where along `a` the two lines come closest, and where the ends of `b` project to: singularities lie above these.
std::array<double, 3> closestPlaces(const Segment& a, const Segment& b) {
    const double along0 = glm::dot(b.begin - a.begin, a.direction);
    const double cosine = glm::dot(a.direction, b.direction);
    const double sineSquared = 1.0 - cosine * cosine;
    double approach = along0;
    if (sineSquared > 1e-12) {
        const double along1 = glm::dot(b.begin - a.begin, b.direction);
        approach = (along0 - cosine * along1) / sineSquared;
    }
    return {along0, along0 + cosine * b.length, approach};
}

/// The same for edges of one direction: ln r depends on the difference u of the places only, and
/// 1/4 (u² − h²) ln(u² + h²) − 3/4 u² + h u atan(u/h) has it as its second derivative.
double parallelEdgesIntegral(const Segment& a, const Segment& b) {
    // By the middle of b, about which a small angle is as good as turned away.
    const glm::dvec3 toB = b.at(0.5 * b.length) - a.begin;
    const double along = glm::dot(toB, a.direction);
    const double height = glm::length(toB - along * a.direction);
    const double start = along - 0.5 * b.length;
    const auto primitive = [height](double u) {
        const double squared = u * u + height * height;
        if (!(squared > 0.0)) return 0.0;
        return 0.25 * (u * u - height * height) * std::log(squared) - 0.75 * u * u + height * u * std::atan2(u, height);
    };
    return primitive(start + b.length) + primitive(start - a.length) - primitive(start + b.length - a.length) -
           primitive(start);
}

/// ∫∫ ln r over two edges.
double edgePairIntegral(const Segment& a, const Segment& b, Care care) {
    using namespace boost::math::quadrature;
    const glm::dvec3 sine = glm::cross(a.direction, b.direction);
    const double straight = care == Care::Full ? kRounding : kSingleRounding;
    if (glm::dot(sine, sine) < straight * straight) return parallelEdgesIntegral(a, b);
    const auto integrand = [&](double s) { return logIntegral(a.at(s), b); };
    // Edges that are perpendicular but for rounding count for so little that a rough value will do.
    if (care != Care::Full && std::abs(glm::dot(a.direction, b.direction)) < 10.0 * kSingleRounding)
        return gauss<double, 7>::integrate(integrand, 0.0, a.length);
    std::array<double, 5> cuts{};
    std::size_t count = 1;
    for (const double place : closestPlaces(a, b)) cuts[count++] = std::clamp(place, 0.0, a.length);
    cuts[count] = a.length;
    std::sort(cuts.begin(), cuts.end());

    // Between the cuts the distance to b has its minimum at an end.
    double sum = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
        const double length = cuts[k + 1] - cuts[k];
        if (!(length > 0.0)) continue;
        const double near = std::min(distanceToSegment(a.at(cuts[k]), b), distanceToSegment(a.at(cuts[k + 1]), b));
        if (near > kFar * length) {
            sum += gauss<double, 8>::integrate(integrand, cuts[k], cuts[k + 1]);
        } else if (near > kNear * length || care == Care::Rough) {
            sum += gauss<double, 16>::integrate(integrand, cuts[k], cuts[k + 1]);
        } else {
            static tanh_sinh<double> endpointSingular; // thread-safe, though Boost 1.74 does not say const
            sum += endpointSingular.integrate(integrand, cuts[k], cuts[k + 1], care == Care::Full ? 1e-13 : 1e-8);
        }
    }
    return sum;
}

/// γ / |a × b| of the angle γ between a and b, which are not parallel.
double angleOverCross(double crossSquared, double dot) {
    if (dot > 0.0 && crossSquared < 0.04 * dot * dot) {
        // atan(t) / t by its series: seven terms leave 1e-12 of it.
        const double t = crossSquared / (dot * dot);
        const double series =
            1.0 -
            t * (1.0 / 3 - t * (1.0 / 5 - t * (1.0 / 7 - t * (1.0 / 9 - t * (1.0 / 11 - t * (1.0 / 13 - t / 15))))));
        return series / dot;
    }
    const double sine = std::sqrt(crossSquared);
    return std::atan2(sine, dot) / sine;
}

} // namespace

glm::dvec3 polygonAreaVector(std::span<const glm::dvec3> polygon) {
    glm::dvec3 sum(0.0);
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
        sum += glm::cross(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]);
    return 0.5 * sum;
}

std::vector<glm::dvec3> clippedToHalfSpace(std::span<const glm::dvec3> polygon, const glm::dvec3& point,
                                           const glm::dvec3& normal) {
    double extent = 0.0;
    for (const glm::dvec3& p : polygon) extent = std::max(extent, glm::distance(p, point));
    // Vertices that miss the plane by rounding lie in it.
    const double tolerance = 1e-12 * extent * glm::length(normal);
    std::vector<glm::dvec3> result;
    bool anyInside = false;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const glm::dvec3& a = polygon[k];
        const glm::dvec3& b = polygon[(k + 1) % polygon.size()];
        const double heightA = glm::dot(a - point, normal);
        const double heightB = glm::dot(b - point, normal);
        if (heightA >= -tolerance) result.push_back(a);
        anyInside = anyInside || heightA > tolerance;
        if ((heightA > tolerance && heightB < -tolerance) || (heightA < -tolerance && heightB > tolerance))
            result.push_back(a + heightA / (heightA - heightB) * (b - a));
    }
    if (!anyInside || result.size() < 3) result.clear();
    return result;
}

double pointToVisiblePolygon(const glm::dvec3& point, const glm::dvec3& normal, std::span<const glm::dvec3> polygon) {
    double sum = 0.0;
    glm::dvec3 a = polygon.back() - point;
    for (const glm::dvec3& vertex : polygon) {
        const glm::dvec3 b = vertex - point;
        const glm::dvec3 cross = glm::cross(a, b);
        const double crossSquared = glm::dot(cross, cross);
        if (crossSquared > 0.0) sum += glm::dot(normal, cross) * angleOverCross(crossSquared, glm::dot(a, b));
        a = b;
    }
    return std::max(0.0, -sum / (2.0 * std::numbers::pi));
}

double pointToPolygon(const glm::dvec3& point, const glm::dvec3& normal, std::span<const glm::dvec3> polygon) {
    const glm::dvec3 areaVector = polygonAreaVector(polygon);
    if (!(glm::dot(areaVector, point - polygon[0]) > 0.0)) return 0.0;
    const std::vector<glm::dvec3> visible = clippedToHalfSpace(polygon, point, normal);
    return visible.empty() ? 0.0 : pointToVisiblePolygon(point, normal, visible);
}

double exchangeArea(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to, Care care) {
    const std::vector<glm::dvec3> a = clippedToHalfSpace(from, to[0], polygonAreaVector(to));
    const std::vector<glm::dvec3> b = clippedToHalfSpace(to, from[0], polygonAreaVector(from));
    if (a.empty() || b.empty()) return 0.0;
    // The contour integral's terms cancel the more the farther the polygons are apart.
    const Ball ballA(a);
    const Ball ballB(b);
    const double gap = glm::distance(ballA.centre, ballB.centre) - ballA.radius - ballB.radius;
    if (gap > kApart * std::max(ballA.radius, ballB.radius)) return farExchangeArea(a, b);

    double sum = 0.0;
    for (const Segment& edgeA : edges(a)) {
        for (const Segment& edgeB : edges(b)) {
            const double cosine = glm::dot(edgeA.direction, edgeB.direction);
            if (cosine != 0.0) sum += cosine * edgePairIntegral(edgeA, edgeB, care);
        }
    }
    return std::max(0.0, sum / (2.0 * std::numbers::pi));
}

} // namespace lambert
