#pragma once

#include <glm/vec2.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace lambert {

/// A line that no patch of a face shall cross.
struct FaceLine {
    std::uint32_t from = 0, to = 0; //!< into FaceLines::points
    double start = 0.0, end = 1.0;  //!< where its ends lie along the edge that it follows, 0 to 1 on the edge itself
    double edgeLength = 0.0;        //!< of that edge, metres
};

/// Lines in the plane of a face; they meet at common points only.
struct FaceLines {
    std::vector<glm::dvec2> points;
    std::vector<bool> onBorder;          //!< #points
    std::vector<std::uint32_t> vertices; //!< #points, of the scene at points on the border; kNone inside
    std::vector<FaceLine> lines;
};

/// Parts of a line, from 0 to 1; empty if from >= to.
struct Interval {
    double from = -std::numeric_limits<double>::infinity();
    double to = std::numeric_limits<double>::infinity();

    /// Keeps where a + t b < limit.
    void below(double a, double b, double limit) {
        if (b > 0.0)
            to = std::min(to, (limit - a) / b);
        else if (b < 0.0)
            from = std::max(from, (limit - a) / b);
        else if (a >= limit)
            to = from;
    }
    bool isEmpty() const { return !(from < to); }
    void unite(const Interval& other) {
        if (other.isEmpty()) return;
        if (isEmpty()) *this = other;
        from = std::min(from, other.from);
        to = std::max(to, other.to);
    }
};

struct FaceSegment {
    glm::dvec2 from, to;
};

/// A line, and where it begins and ends along an edge that it follows, see FaceLine.
struct DrawnLine {
    FaceSegment segment;
    double start, end;
    double edgeLength;

    /// From and to these parts of the line, 0 to 1.
    DrawnLine part(double from, double to) const;
};

/// Removes from lines what is nearer to a segment than `distance`.
void cutAway(const FaceSegment& segment, double distance, std::vector<DrawnLine>& lines);

/// Collects lines in a face, so that they can be edges of a triangulation.
class FaceDrawing {
public:
    struct Options {
        double tolerance; //!< metres; points nearer to each other are one
        double clear;     //!< what lines keep from contacts and from borders beside them, in their own clearances
        double shallow;   //!< sine of the angle below which a border is beside a line
    };
    /// `border` is convex and counter-clockwise.
    FaceDrawing(std::span<const glm::dvec2> border, std::span<const std::pair<glm::dvec2, glm::dvec2>> contacts,
                const Options& options);

    /// What of a line lies in the face, clear of contacts and of the border; where it crosses the border, up to there.
    /// `clearance` in metres.
    void add(const DrawnLine& line, double clearance);

    /// The lines, divided where they meet each other; none if that cannot be had.
    FaceLines finish() &&;

private:
    bool clip(DrawnLine& line) const;
    void reachBorder(DrawnLine& line, double within) const;

    std::vector<glm::dvec2> border_;
    std::vector<std::pair<glm::dvec2, glm::dvec2>> contacts_;
    Options options_;
    std::vector<DrawnLine> lines_;
};

} // namespace lambert
