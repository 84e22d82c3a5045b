#pragma once

#include "formfactors/convex_polygon.h"
#include "formfactors/gauss_exchange.h"
#include "formfactors/occluders.h"
#include "formfactors/visible_parts.h"

#include <span>
#include <vector>

namespace lambert {

/// Two convex polygons of which each lies in front of the other's plane, and what may stand between them.
struct OccludedPair {
    const ConvexPolygon& from;
    const Plane& fromPlane; ///< unit normal
    const ConvexPolygon& to;
    const Plane& toPlane;                   ///< unit normal
    const Occluder* firstOccluder;          //!< of the list that Occluder::neighbour counts in
    std::span<const glm::dvec3> directions; //!< of Occluder::extents
    std::vector<const Occluder*>& occluders;
    double tolerance; ///< metres; what is nearer to a plane counts as in it
};

/// Removes the occluders that cannot stand between the two, with a quick test. Returns false if one of them surely hides each
/// polygon from the other wholly.
bool dropClearOccluders(OccludedPair& pair);

/// Keeps its memory from call to call.
struct VisibleExchangeScratch {
    VisibleParts::Scratch parts;
    std::vector<WeightedPoint> points;
    ExchangeScratch exchange;
};

/// A_from · F_from,to in m² of what is visible. `unoccluded` is what it would be without occluders. The relative error aimed
/// at is that of the visible part, but no less than a hundredth of the error that it would make of the unoccluded.
///
/// From a point the visible part of a polygon is exact. Over `from` it is smooth between the lines where a corner and an edge
/// of `to` and of an occluder come into line: these divide `from` into cells, which are integrated by Gauss rules and
/// subdivided until two rules agree.
double visibleExchange(const OccludedPair& pair, double unoccluded, double relativeError,
                       VisibleExchangeScratch& scratch);

} // namespace lambert
