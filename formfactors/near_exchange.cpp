#include "formfactors/near_exchange.h"

#include "formfactors/closed_form.h"
#include "formfactors/gauss_exchange.h"
#include "formfactors/quadrature.h"

#include <cmath>
#include <vector>

namespace lambert {

namespace {

constexpr double kAgreement = 1e-3;   ///< of two rules, so that the finer one is taken to be right to a part of it
constexpr double kSmallFactor = 1e-6; ///< rules are right enough

/// ∫ of what points of one polygon see of the other, in m², by a rule of this order.
double meanOverPoints(const ConvexPolygon& outer, const glm::dvec3& normal, const ConvexPolygon& inner, int order,
                      std::vector<WeightedPoint>& points) {
    points.clear();
    appendGaussPoints(outer.points(), order, points);
    double sum = 0.0;
    for (const auto& [x, weight] : points) sum += weight * pointToVisiblePolygon(x, normal, inner.points());
    return sum;
}

} // namespace

double nearExchange(const ConvexPolygon& from, const Plane& fromPlane, const ConvexPolygon& to, const Plane& toPlane,
                    ExchangeScratch& scratch) {
    const glm::dvec3 fromCentre = from.centre(), toCentre = to.centre();
    const double fromRadius = from.radiusAround(fromCentre), toRadius = to.radiusAround(toCentre);
    const bool fromIsSmaller = fromRadius < toRadius;
    const double smaller = fromIsSmaller ? fromRadius : toRadius;
    const ConvexPolygon& outer = fromIsSmaller ? from : to;
    const ConvexPolygon& inner = fromIsSmaller ? to : from;
    const glm::dvec3& normal = fromIsSmaller ? fromPlane.normal : toPlane.normal;
    const double gap = (glm::distance(fromCentre, toCentre) - fromRadius - toRadius) / (2.0 * smaller);
    // A rule of order n errs by ρ^(−2n), ρ = 2 gap + √(4 gap² + 1).
    const int order = gap > 1.4 ? 2 : gap > 0.7 ? 3 : 4;
    const double mean = meanOverPoints(outer, normal, inner, order, scratch.from);
    if (gap > 0.4 || mean < kSmallFactor * smaller * smaller) return mean;
    // Neighbours that share an edge are smooth too, others need the contour integral.
    const double finer = meanOverPoints(outer, normal, inner, 6, scratch.from);
    return std::abs(mean - finer) < kAgreement * finer
               ? finer
               : convexExchange(from, fromPlane, to, toPlane, scratch, Care::Rough);
}

} // namespace lambert
