#pragma once

#include "meshing/contact_strips.h"

#include <glm/vec2.hpp>

#include <span>
#include <utility>
#include <vector>

namespace lambert {

struct PlanarSegment {
    glm::dvec2 from, to;
};

/// A line, and where it begins and ends along an edge that it follows, see FaceLine.
struct PlanarLine {
    PlanarSegment segment;
    double start, end;
    double edgeLength;

    /// From and to these parts of the line, 0 to 1.
    PlanarLine part(double from, double to) const;
};

/// Removes from lines what is nearer to a segment than `distance`.
void cutAway(const PlanarSegment& segment, double distance, std::vector<PlanarLine>& lines);

/// Collects lines in a face, so that they can be edges of a triangulation.
class PlanarLines {
public:
    struct Options {
        double tolerance; //!< metres; points nearer to each other are one
        double clear;     //!< what lines keep from contacts and from borders beside them, in their own clearances
        double shallow;   //!< sine of the angle below which a border is beside a line
    };
    /// `border` is convex and counter-clockwise.
    PlanarLines(std::span<const glm::dvec2> border, std::span<const std::pair<glm::dvec2, glm::dvec2>> contacts,
                const Options& options);

    /// What of a line lies in the face, clear of contacts and of the border; where it crosses the border, up to there.
    /// `clearance` in metres.
    void add(const PlanarLine& line, double clearance);

    /// The lines, divided where they meet each other.
    FaceLines finish() &&;

private:
    bool clip(PlanarLine& line) const;
    void reachBorder(PlanarLine& line, double within) const;
    double depth(glm::dvec2 point) const;
    std::uint32_t pointAt(glm::dvec2 point);
    void divideAt(std::size_t line, std::vector<std::pair<double, std::uint32_t>> stops,
                  std::vector<FaceLine>& divided) const;

    std::vector<glm::dvec2> border_;
    std::vector<std::pair<glm::dvec2, glm::dvec2>> contacts_;
    Options options_;
    std::vector<PlanarLine> lines_;
    FaceLines result_;
};

} // namespace lambert
