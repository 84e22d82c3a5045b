#pragma once

#include "formfactors/closed_form.h"
#include "formfactors/convex_polygon.h"
#include "formfactors/patch_clusters.h"
#include "formfactors/quadrature.h"

#include <array>
#include <span>
#include <vector>

namespace lambert {

/// The order of Gauss's rule (see appendGaussPoints) that gives the exchange between two polygons, which lie in front of each
/// other's planes, to 1e-6 or less, at worst 1e-5; 0 if none up to PatchClusters::kHighestOrder does. `ratio` is the sum of
/// their radii in distances of their centres; `upright`: each keeps away from the other's plane by four of its radii.
int gaussOrder(double ratio, bool upright = false);

/// ∫∫ cos cos / π r² in m² between points over one polygon (unit `normal`) and the targets of a cluster, by its rule of this
/// order; negative where the target shows its back.
std::array<double, PatchClusters::kLanes> exchangeWithCluster(std::span<const WeightedPoint> from,
                                                              const glm::dvec3& normal,
                                                              const PatchClusters::Cluster& cluster, int order);

/// Points of rules over two polygons; keeps its memory from call to call.
struct ExchangeScratch {
    std::vector<WeightedPoint> from, to;
};

/// A_from · F_from,to in m² of two convex polygons that lie in front of each other's planes and that nothing stands between:
/// by Gauss's rule, or by the contour integral where they are close.
double convexExchange(const ConvexPolygon& from, const Plane& fromPlane, const ConvexPolygon& to, const Plane& toPlane,
                      ExchangeScratch& scratch, Care care = Care::Single);

} // namespace lambert
