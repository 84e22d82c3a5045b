#pragma once

#include "formfactors/convex_polygon.h"
#include "formfactors/gauss_exchange.h"

namespace lambert {

/// A_from F_from,to in m² of convex polygons that are near each other, each in front of the other's plane, if nothing stands
/// between: to about 1e-3, or where rules of quadrature fail to 1e-4.
double nearExchange(const ConvexPolygon& from, const Plane& fromPlane, const ConvexPolygon& to, const Plane& toPlane,
                    ExchangeScratch& scratch);

} // namespace lambert
