#include "meshing/patch_pieces.h"

#include "meshing/plane_frame.h"

namespace lambert {

namespace {

using Points = std::vector<glm::dvec2>;

/// Area, and the centroid times it; of either orientation.
struct Moments {
    double area = 0.0;
    glm::dvec2 first{0.0};

    explicit Moments(const Points& border) {
        for (std::size_t k = 2; k < border.size(); ++k) {
            const double twice = cross(border[k - 1] - border[0], border[k] - border[0]);
            area += 0.5 * twice;
            first += twice / 6.0 * (border[0] + border[k - 1] + border[k]);
        }
    }
};

/// What lies to the left of the line from `from` to `to` (Sutherland, Hodgman 1974).
Points leftOf(const Points& border, const glm::dvec2& from, const glm::dvec2& to) {
    const auto side = [&](const glm::dvec2& p) { return cross(to - from, p - from); };
    Points result;
    for (std::size_t k = 0; k < border.size(); ++k) {
        const glm::dvec2& a = border[k];
        const glm::dvec2& b = border[(k + 1) % border.size()];
        const double sideA = side(a);
        const double sideB = side(b);
        if (sideA >= 0.0) result.push_back(a);
        if ((sideA > 0.0 && sideB < 0.0) || (sideA < 0.0 && sideB > 0.0))
            result.push_back(a + sideA / (sideA - sideB) * (b - a));
    }
    return result;
}

/// A triangle of the polygon in its plane.
struct Triangle {
    std::array<std::size_t, 3> corners;
    std::array<glm::dvec2, 3> points;

    glm::dvec3 weights(const glm::dvec2& p) const {
        const auto& [a, b, c] = points;
        const double whole = cross(b - a, c - a);
        const double second = cross(p - a, c - a) / whole;
        const double third = cross(b - a, p - a) / whole;
        return {1.0 - second - third, second, third};
    }
};

PatchPiece pieceOf(const Triangle& triangle, const Points& border, double patchArea) {
    PatchPiece piece;
    piece.corners = triangle.corners;
    for (const glm::dvec2& p : border) piece.border.push_back(triangle.weights(p));
    const Moments moments(border);
    if (moments.area != 0.0 && patchArea != 0.0) {
        piece.share = moments.area / patchArea;
        piece.centroid = triangle.weights(moments.first / moments.area);
    } else {
        for (const glm::dvec3& weights : piece.border)
            piece.centroid += weights / static_cast<double>(piece.border.size());
    }
    return piece;
}

} // namespace

std::vector<PatchPiece> patchPieces(const Scene& scene, const PatchMesh& mesh, std::size_t patch) {
    const Polygon& polygon = scene.polygons[mesh.polygon[patch]];
    const PlaneFrame frame = planeFrame(scene, polygon);
    const auto triangle = [&](std::size_t a, std::size_t b, std::size_t c) {
        Triangle result{{a, b, c}, {}};
        for (std::size_t k = 0; k < 3; ++k)
            result.points[k] = frame.project(corner(scene, polygon, static_cast<int>(result.corners[k])));
        return result;
    };
    Points border;
    for (int k = 0; k < mesh.cornerCount(patch); ++k) border.push_back(frame.project(mesh.position(patch, k)));
    const double area = Moments(border).area;
    if (!polygon.isQuad()) return {pieceOf(triangle(0, 1, 2), border, area)};

    const Triangle one = triangle(0, 1, 3);
    const Triangle two = triangle(2, 3, 1);
    std::vector<PatchPiece> pieces;
    for (const Triangle& half : {one, two}) {
        const Points inside = leftOf(border, half.points[1], half.points[2]);
        if (Moments(inside).area != 0.0) pieces.push_back(pieceOf(half, inside, area));
    }
    if (pieces.empty()) pieces.push_back(pieceOf(one, border, area));
    return pieces;
}

} // namespace lambert
