#include "meshing/divide_polygon.h"

#include <array>
#include <utility>

namespace lambert {

namespace {

/// A polygon's sides with all vertices on them, and what follows from them.
struct DividedBorder {
    std::array<EdgeDivision::Side, 4> sides;
    FaceOutline outline;
    bool whole = true; ///< no vertex but the corners

    DividedBorder(const Scene& scene, const Polygon& polygon, const EdgeDivision& division,
                  const PlanarContact* contact, const FaceLines* lines) {
        for (int k = 0; k < polygon.size(); ++k) {
            auto& side = sides[static_cast<std::size_t>(k)];
            side = division.side(polygon, k);
            outline.border.insert(outline.border.end(), side.vertices.begin(), side.vertices.end() - 1);
            whole = whole && side.vertices.size() == 2;
        }
        if (contact != nullptr) outline.contacts = contactLines(*contact, scene, division);
        outline.lines = lines;
        whole = whole && isEmpty();
    }

    /// Whether a quad can be a grid: nothing stands on it, and opposite sides are divided alike.
    bool isGrid() const {
        const auto alike = [this](std::size_t k) {
            return sides[k].segments == 1 && sides[k + 2].segments == 1 &&
                   sides[k].vertices.size() == sides[k + 2].vertices.size();
        };
        return isEmpty() && alike(0) && alike(1);
    }

private:
    bool isEmpty() const { return outline.contacts.empty() && outline.lines == nullptr; }
};

} // namespace

DividedPolygon keptWhole(const Scene& scene, const Polygon& polygon) {
    DividedPolygon result;
    if (isOccluder(scene, polygon)) {
        result.border.assign(polygon.vertices.begin(), polygon.vertices.begin() + polygon.size());
    } else {
        result.faces = {polygon.vertices};
        result.columns = result.rows = 1;
    }
    return result;
}

DividedPolygon dividePolygon(const Scene& scene, const Polygon& polygon, const EdgeDivision& division,
                             const PlanarContact* contact, const FaceLines* lines, double length,
                             std::span<const glm::vec3> positions) {
    DividedPolygon result;
    DividedBorder border(scene, polygon, division, contact, lines);
    FaceOutline& outline = border.outline;
    if (isOccluder(scene, polygon)) {
        result.border = std::move(outline.border);
        return result;
    }
    if (border.whole) return keptWhole(scene, polygon);
    const auto& sides = border.sides;
    if (polygon.isQuad() && border.isGrid()) {
        result.faces = gridFace({sides[0].vertices, sides[1].vertices, sides[2].vertices, sides[3].vertices}, positions,
                                result.added);
        result.columns = sides[0].vertices.size() - 1;
        result.rows = sides[1].vertices.size() - 1;
        return result;
    }
    outline.frame = planeFrame(scene, polygon);
    auto faces = triangulateFace(outline, length, positions, result.added);
    if (!faces && outline.lines != nullptr) {
        outline.lines = nullptr;
        faces = triangulateFace(outline, length, positions, result.added);
    }
    const bool hasContacts = !outline.contacts.empty();
    const bool contactsIgnored = hasContacts && !faces;
    if (contactsIgnored) {
        outline.contacts.clear();
        faces = triangulateFace(outline, length, positions, result.added);
    }
    if (faces)
        result.faces = std::move(*faces);
    else
        result = keptWhole(scene, polygon);
    result.undivided = !faces;
    result.contactsFollowed = hasContacts && !contactsIgnored;
    result.contactsIgnored = contactsIgnored;
    return result;
}

} // namespace lambert
