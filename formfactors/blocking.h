#pragma once

#include "formfactors/convex_polygon.h"
#include "formfactors/occluders.h"

#include <span>

namespace lambert {

bool allAbove(const Plane& plane, std::span<const glm::dvec3> points, double height);
bool allBelow(const Plane& plane, std::span<const glm::dvec3> points, double height);

/// What an occluder does to the lines between two polygons: it hides none (Clear) or all of them, or that is not known.
enum class Blocking { Clear, Hidden, Unknown };

/// A quick test. Each polygon lies in front of the other's plane. What is nearer to a plane than `tolerance` (metres) counts
/// as in it.
Blocking blocking(const ConvexPolygon& from, const Plane& fromPlane, const ConvexPolygon& to, const Plane& toPlane,
                  const Occluder& occluder, double tolerance);

} // namespace lambert
