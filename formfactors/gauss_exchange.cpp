#include "formfactors/gauss_exchange.h"

#include "core/vector_clones.h"
#include "formfactors/closed_form.h"

#include <algorithm>
#include <numbers>

namespace lambert {

namespace {

constexpr std::size_t kLanes = PatchClusters::kLanes;

/// Up to these ratios the orders 1, 2, ... do. Found by comparison with the contour integral on random pairs, among them
/// pairs that almost touch each other's plane; order n errs by about ratio^2n.
constexpr std::array<double, PatchClusters::kHighestOrder> kRange{0.0005, 0.05, 0.2, 0.4};
constexpr double kUprightRange = 0.068; // of order 2

LAMBERT_VECTOR_CLONES
void sumLanes(std::span<const WeightedPoint> from, const glm::dvec3& normal, const PatchClusters::Cluster& cluster,
              const PatchClusters::Points& to, double* result) {
    double sum[kLanes] = {};
    const std::size_t pointsPerLane = to.x.size();
    const auto kernel = [&](const WeightedPoint& x, std::size_t b, std::size_t lane, double& squared) {
        const double dx = to.x[b][lane] - x.point.x;
        const double dy = to.y[b][lane] - x.point.y;
        const double dz = to.z[b][lane] - x.point.z;
        squared = dx * dx + dy * dy + dz * dz;
        const double cosFrom = normal.x * dx + normal.y * dy + normal.z * dz;
        const double cosTo = cluster.normalX[lane] * dx + cluster.normalY[lane] * dy + cluster.normalZ[lane] * dz;
        return to.weight[b][lane] * cosFrom * cosTo;
    };
    for (const WeightedPoint& x : from) {
        for (std::size_t b = 0; b < pointsPerLane; b += 2) {
            for (std::size_t lane = 0; lane < kLanes; ++lane) {
                // Two fractions over a common denominator: divisions take most of the time.
                double one, two;
                const double first = kernel(x, b, lane, one), second = kernel(x, b + 1, lane, two);
                one *= one;
                two *= two;
                sum[lane] -= x.weight * (first * two + second * one) / (one * two);
            }
        }
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) result[lane] = sum[lane] * (1.0 / std::numbers::pi);
}

} // namespace

int gaussOrder(double ratio, bool upright) {
    if (upright && ratio < kUprightRange && ratio >= kRange[0]) return 2;
    for (std::size_t k = 0; k < kRange.size(); ++k)
        if (ratio < kRange[k]) return static_cast<int>(k) + 1;
    return 0;
}

std::array<double, kLanes> exchangeWithCluster(std::span<const WeightedPoint> from, const glm::dvec3& normal,
                                               const PatchClusters::Cluster& cluster, int order) {
    std::array<double, kLanes> result;
    sumLanes(from, normal, cluster, cluster.points[static_cast<std::size_t>(order - 1)], result.data());
    return result;
}

double convexExchange(const ConvexPolygon& from, const Plane& fromPlane, const ConvexPolygon& to, const Plane& toPlane,
                      ExchangeScratch& scratch, Care care) {
    const glm::dvec3 centreFrom = from.centre(), centreTo = to.centre();
    const double reach = from.radiusAround(centreFrom) + to.radiusAround(centreTo);
    const int order = gaussOrder(reach / glm::distance(centreFrom, centreTo));
    if (order == 0) return exchangeArea(from.points(), to.points(), care);
    scratch.from.clear();
    scratch.to.clear();
    appendGaussPoints(from.points(), order, scratch.from);
    appendGaussPoints(to.points(), order, scratch.to);
    double sum = 0.0;
    for (const auto& [x, weightX] : scratch.from) {
        for (const auto& [y, weightY] : scratch.to) {
            const glm::dvec3 d = y - x;
            const double squared = glm::dot(d, d);
            sum -=
                weightX * weightY * glm::dot(fromPlane.normal, d) * glm::dot(toPlane.normal, d) / (squared * squared);
        }
    }
    return std::max(0.0, sum / std::numbers::pi);
}

} // namespace lambert
