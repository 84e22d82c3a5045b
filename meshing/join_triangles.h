#pragma once

#include "scene/scene.h"

#include <cstddef>

namespace lambert {

/// Joins coplanar pairs of triangles that make a good quad, see pairTriangles, into one polygon each, and returns their
/// number. Only triangles of the same node and materials are joined, and of those with surfaces only where these agree along
/// the shared edge. It becomes the quad's diagonal between the corners 1 and 3, so that what varies over the quad is what
/// varied over its triangles.
std::size_t joinTriangles(Scene& scene);

} // namespace lambert
