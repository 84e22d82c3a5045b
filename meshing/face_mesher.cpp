#include "meshing/face_mesher.h"

#include "core/box.h"
#include "core/triangulation.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

constexpr double kClearance = 0.5;     ///< lattice points keep this far from lines, in spacings
constexpr double kShortestPart = 0.25; ///< of a line at its ends, of the others

double distanceToSegment(glm::dvec2 point, glm::dvec2 a, glm::dvec2 b) {
    const glm::dvec2 direction = b - a;
    const double squaredLength = glm::dot(direction, direction);
    const double t = squaredLength > 0.0 ? glm::clamp(glm::dot(point - a, direction) / squaredLength, 0.0, 1.0) : 0.0;
    return glm::distance(point, a + t * direction);
}

using Line = std::array<std::uint32_t, 2>;

/// The lattice over the polygon's bounding rectangle: which of its points lie inside, clear of all lines.
class Lattice {
public:
    Lattice(std::span<const glm::dvec2> border, double spacing) {
        Box<glm::dvec2> box;
        for (const glm::dvec2& p : border) box.add(p);
        lower_ = box.lower;
        const glm::dvec2 size = box.size();
        for (int axis = 0; axis < 2; ++axis) {
            const double cells = std::clamp(std::ceil(size[axis] / spacing - 1e-3), 1.0, 65535.0);
            count_[axis] = static_cast<std::size_t>(cells);
            step_[axis] = size[axis] / cells;
        }
        clear_.assign(count_[0] * count_[1], true);
    }

    /// Points closer to the line than the clearance are out.
    void avoid(glm::dvec2 a, glm::dvec2 b) {
        const glm::dvec2 margin = kClearance * step_;
        const double clearance = kClearance * std::min(step_.x, step_.y);
        const auto first = cell(glm::min(a, b) - margin, 0.0);
        const auto last = cell(glm::max(a, b) + margin, 1.0);
        for (std::size_t j = first[1]; j <= last[1]; ++j)
            for (std::size_t i = first[0]; i <= last[0]; ++i)
                if (distanceToSegment(point(i, j), a, b) < clearance) clear_[j * count_[0] + i] = false;
    }

    /// Appends the points inside the border. Scanline by scanline: even-odd over the crossings with the border.
    void fill(std::span<const glm::dvec2> border, std::vector<glm::dvec2>& points) const {
        std::vector<double> crossings;
        for (std::size_t j = 1; j < count_[1]; ++j) {
            const double y = point(0, j).y;
            crossings.clear();
            for (std::size_t k = 0; k < border.size(); ++k) {
                const glm::dvec2 a = border[k];
                const glm::dvec2 b = border[(k + 1) % border.size()];
                if ((a.y <= y) != (b.y <= y)) crossings.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
            }
            std::sort(crossings.begin(), crossings.end());
            for (std::size_t i = 1; i < count_[0]; ++i) {
                const double x = point(i, j).x;
                const auto passed = std::lower_bound(crossings.begin(), crossings.end(), x) - crossings.begin();
                if (passed % 2 == 1 && clear_[j * count_[0] + i]) points.push_back(point(i, j));
            }
        }
    }

private:
    glm::dvec2 point(std::size_t i, std::size_t j) const {
        return lower_ + glm::dvec2(static_cast<double>(i), static_cast<double>(j)) * step_;
    }
    std::array<std::size_t, 2> cell(glm::dvec2 p, double roundUp) const {
        std::array<std::size_t, 2> result{};
        for (int axis = 0; axis < 2; ++axis) {
            const double value = std::floor((p[axis] - lower_[axis]) / step_[axis]) + roundUp;
            result[static_cast<std::size_t>(axis)] = static_cast<std::size_t>(
                std::clamp(value, 0.0, static_cast<double>(count_[static_cast<std::size_t>(axis)] - 1)));
        }
        return result;
    }

    glm::dvec2 lower_, step_;
    std::array<std::size_t, 2> count_{};
    std::vector<bool> clear_;
};

double signedArea(std::span<const glm::dvec2> loop) {
    double twice = 0.0;
    for (std::size_t k = 0; k < loop.size(); ++k) twice += cross(loop[k], loop[(k + 1) % loop.size()]);
    return 0.5 * twice;
}

/// The outline in its plane: border vertices first, then the other ends of contacts, then points that are no vertices yet.
struct FlatOutline {
    std::vector<std::uint32_t> vertices;
    std::vector<glm::dvec2> points;
    std::vector<Line> contacts; ///< and other lines; indices into the above
};

/// Adds lines, divided so that no part is longer than `spacing`; where they follow the same edge, at the same places along it.
void addLines(const FaceLines& lines, std::size_t borderCount, double spacing, FlatOutline& flat) {
    std::vector<std::uint32_t> index(lines.points.size(), kNone);
    const auto border = std::span(flat.vertices).first(borderCount);
    for (std::size_t i = 0; i < lines.points.size(); ++i) {
        if (!lines.onBorder[i]) continue;
        const auto at = std::find(border.begin(), border.end(), lines.vertices[i]);
        if (at != border.end()) index[i] = static_cast<std::uint32_t>(at - border.begin());
    }
    for (const FaceLine& line : lines.lines) {
        const auto ends = {line.from, line.to};
        if (std::any_of(ends.begin(), ends.end(), [&](auto i) { return lines.onBorder[i] && index[i] == kNone; }))
            continue;
        for (const std::uint32_t i : ends) {
            if (index[i] != kNone) continue;
            index[i] = static_cast<std::uint32_t>(flat.points.size());
            flat.points.push_back(lines.points[i]);
        }
        std::uint32_t last = index[line.from];
        if (last == index[line.to]) continue;
        const double parts = std::max(1.0, std::ceil(line.edgeLength / spacing - 1e-3));
        const double direction = line.end > line.start ? 1.0 : -1.0;
        const double first = direction * line.start * parts, end = direction * line.end * parts;
        for (double stop = std::ceil(first + kShortestPart); stop < end - kShortestPart; stop += 1.0) {
            flat.points.push_back(
                glm::mix(lines.points[line.from], lines.points[line.to], (stop - first) / (end - first)));
            flat.contacts.push_back({last, static_cast<std::uint32_t>(flat.points.size() - 1)});
            last = static_cast<std::uint32_t>(flat.points.size() - 1);
        }
        flat.contacts.push_back({last, index[line.to]});
    }
}

FlatOutline flatten(const FaceOutline& outline, std::span<const glm::vec3> positions) {
    FlatOutline flat;
    flat.vertices = outline.border;
    std::vector<std::uint32_t> contactVertices;
    for (const auto& [a, b] : outline.contacts) contactVertices.insert(contactVertices.end(), {a, b});
    std::sort(contactVertices.begin(), contactVertices.end());
    contactVertices.erase(std::unique(contactVertices.begin(), contactVertices.end()), contactVertices.end());
    std::vector<std::pair<std::uint32_t, std::uint32_t>> onBorder;
    for (std::uint32_t i = 0; i < outline.border.size(); ++i) onBorder.emplace_back(outline.border[i], i);
    std::sort(onBorder.begin(), onBorder.end());

    std::vector<std::uint32_t> flatIndex;
    for (const std::uint32_t vertex : contactVertices) {
        const auto it = std::lower_bound(onBorder.begin(), onBorder.end(), std::pair(vertex, 0U));
        if (it != onBorder.end() && it->first == vertex) {
            flatIndex.push_back(it->second);
        } else {
            flatIndex.push_back(static_cast<std::uint32_t>(flat.vertices.size()));
            flat.vertices.push_back(vertex);
        }
    }
    const auto indexOf = [&](std::uint32_t vertex) {
        const auto it = std::lower_bound(contactVertices.begin(), contactVertices.end(), vertex);
        return flatIndex[static_cast<std::size_t>(it - contactVertices.begin())];
    };
    for (const auto& [a, b] : outline.contacts) flat.contacts.push_back({indexOf(a), indexOf(b)});
    for (const std::uint32_t vertex : flat.vertices) flat.points.push_back(outline.frame.project(positions[vertex]));
    return flat;
}

} // namespace

std::vector<Corners> gridFace(const std::array<std::vector<std::uint32_t>, 4>& sides,
                              std::span<const glm::vec3> positions, std::vector<glm::vec3>& added) {
    const std::size_t columns = sides[0].size() - 1;
    const std::size_t rows = sides[1].size() - 1;
    std::array<glm::dvec3, 4> corner;
    for (std::size_t k = 0; k < 4; ++k) corner[k] = glm::dvec3(positions[sides[k].front()]);
    const auto firstInner = static_cast<std::uint32_t>(positions.size());
    for (std::size_t j = 1; j < rows; ++j) {
        for (std::size_t i = 1; i < columns; ++i) {
            const double s = static_cast<double>(i) / static_cast<double>(columns);
            const double t = static_cast<double>(j) / static_cast<double>(rows);
            added.emplace_back(glm::mix(glm::mix(corner[0], corner[1], s), glm::mix(corner[3], corner[2], s), t));
        }
    }
    const auto vertex = [&](std::size_t i, std::size_t j) {
        if (j == 0) return sides[0][i];
        if (j == rows) return sides[2][columns - i];
        if (i == 0) return sides[3][rows - j];
        if (i == columns) return sides[1][j];
        return firstInner + static_cast<std::uint32_t>((j - 1) * (columns - 1) + (i - 1));
    };
    std::vector<Corners> quads;
    quads.reserve(columns * rows);
    for (std::size_t j = 0; j < rows; ++j)
        for (std::size_t i = 0; i < columns; ++i)
            quads.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    return quads;
}

std::optional<std::vector<Corners>> triangulateFace(const FaceOutline& outline, double spacing,
                                                    std::span<const glm::vec3> positions,
                                                    std::vector<glm::vec3>& added) {
    FlatOutline flat = flatten(outline, positions);
    const std::size_t borderCount = outline.border.size();
    const std::size_t known = flat.points.size();
    if (outline.lines != nullptr) addLines(*outline.lines, borderCount, spacing, flat);
    const std::vector<glm::dvec2> border(flat.points.begin(),
                                         flat.points.begin() + static_cast<std::ptrdiff_t>(borderCount));
    if (std::isfinite(spacing)) {
        Lattice lattice(border, spacing);
        for (std::size_t k = 0; k < borderCount; ++k) lattice.avoid(border[k], border[(k + 1) % borderCount]);
        for (const auto& [a, b] : flat.contacts) lattice.avoid(flat.points[a], flat.points[b]);
        lattice.fill(border, flat.points);
    }
    const auto triangles = triangulatePolygon(flat.points, borderCount, flat.contacts);
    if (!triangles) return std::nullopt;
    double covered = 0.0;
    for (const auto& t : *triangles)
        covered += 0.5 * cross(flat.points[t[1]] - flat.points[t[0]], flat.points[t[2]] - flat.points[t[0]]);
    const double area = signedArea(border);
    if (!(std::abs(covered - area) <= 1e-6 * area)) return std::nullopt;

    // Vertices are numbered as in `flat` until the faces are done.
    std::vector<glm::vec3> at;
    at.reserve(flat.points.size());
    for (const std::uint32_t vertex : flat.vertices) at.push_back(positions[vertex]);
    for (std::size_t i = known; i < flat.points.size(); ++i) {
        flat.vertices.push_back(static_cast<std::uint32_t>(positions.size() + i - known));
        at.push_back(outline.frame.lift(flat.points[i]));
    }
    std::vector<Corners> faces;
    faces.reserve(triangles->size());
    for (const auto& [a, b, c] : *triangles) faces.push_back({a, b, c, kNone});
    std::vector<std::pair<std::uint32_t, std::uint32_t>> fixed;
    for (const auto& [a, b] : flat.contacts) fixed.push_back(edgeKey(a, b));
    std::sort(fixed.begin(), fixed.end());
    pairTriangles(faces, std::vector<std::uint32_t>(faces.size(), 0), at, fixed);
    for (Corners& face : faces)
        for (std::uint32_t& vertex : face)
            if (vertex != kNone) vertex = flat.vertices[vertex];
    added.assign(at.begin() + static_cast<std::ptrdiff_t>(known), at.end());
    return faces;
}

} // namespace lambert
