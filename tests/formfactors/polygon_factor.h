#pragma once

#include "formfactors/closed_form.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <span>

namespace lambert {

/// F_from,to: the fraction of what leaves the front of one polygon that reaches the front of the other.
inline double polygonToPolygon(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to) {
    return exchangeArea(from, to) / glm::length(polygonAreaVector(from));
}

} // namespace lambert
