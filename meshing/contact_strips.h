#pragma once

#include "meshing/face_lines.h"

#include <glm/vec2.hpp>

#include <span>
#include <utility>

namespace lambert {

/// A piece of the outline of what hovers over a face, in the face's plane.
struct HoveringEdge {
    glm::dvec2 from, to;
    double gap = 0.0; //!< metres to the face, > 0
    int levels = 0;   //!< most strips on each side of it
};

struct StripOptions {
    double length = 0.0; //!< of a patch, metres; strips are up to half as wide, and half as wide again towards the edge
    double tolerance = 0.0; //!< metres; points nearer to each other than this are one
    int levels = 8;         //!< most strips on one side of an edge
};

/// How many strips an edge at this gap gets on each side. The first is half as wide as the gap.
int stripLevels(double gap, const StripOptions& options);

/// About how many patches lie beside the lines of contactStrips on a face without end.
double patchesAlong(std::span<const HoveringEdge> edges, const StripOptions& options);

/// Lines along the hovering edges and at distances from them, on both sides, that double from half the gap to half a patch's
/// length.
/// Light between two faces at a small gap is even but for a rim about as wide as the gap, and so is the darkness beside a lamp
/// that hangs below a ceiling: patches that end at these lines, however long, resolve both.
///
/// `border` is the face, convex and counter-clockwise; lines are cut off there and end on it. Lines keep clear of `contacts`,
/// pairs of points, which divide the face as well.
FaceLines contactStrips(std::span<const glm::dvec2> border, std::span<const HoveringEdge> edges,
                        std::span<const std::pair<glm::dvec2, glm::dvec2>> contacts, const StripOptions& options);

} // namespace lambert
