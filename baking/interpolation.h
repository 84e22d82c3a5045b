#pragma once

#include "meshing/patch_mesh.h"

#include <array>

namespace lambert {

/// One weight per corner of a patch, each in [0, 1], their sum 1; the fourth of a triangle is 0.
using InterpolationWeights = std::array<double, 4>;

/// The weights with which the values at the corners of `patch` make the value at `point` (metres, in the
/// patch or within rounding of it; a point outside gets the value of a point on the border). Barycentric on
/// triangles, inverse bilinear on quads: linear along every edge, so that neighbours agree on the edge they
/// share.
InterpolationWeights interpolationWeights(const PatchMesh& mesh, std::uint32_t patch, const glm::vec3& point);

} // namespace lambert
