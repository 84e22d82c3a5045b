#pragma once

#include "formfactors/occluders.h"

#include <cstdint>
#include <vector>

namespace lambert {

/// What another occluder in the same plane, which covers part of one, hides of that part.
enum class CoveredSide {
    Front, ///< its front stands against this one's front, and one of the two bounds a solid
    Back,  ///< their backs are towards each other: a thin wall of two sheets
    Both   ///< it faces the same way and comes earlier in the list
};

struct CoplanarContact {
    std::uint32_t occluder; ///< the other one
    CoveredSide hides;
};

/// Per occluder the others that lie within `tolerance` (metres) of its plane and overlap it. Those with holes cover nothing.
std::vector<std::vector<CoplanarContact>> findCoplanarContacts(const std::vector<Occluder>& occluders,
                                                               double tolerance);

/// Divides a polygon in the plane of `cover` along the outline of that. Either part may be empty; what reaches past the
/// outline by less than `tolerance` counts as covered.
void divideByCover(const ConvexPolygon& polygon, const Occluder& cover, double tolerance,
                   std::vector<ConvexPolygon>& outside, ConvexPolygon& covered);

} // namespace lambert
