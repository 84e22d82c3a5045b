#include "meshing/contacts.h"

#include "meshing/plane_frame.h"
#include "meshing/prepare.h"

#include <algorithm>
#include <cmath>

namespace lambert {

std::vector<PlanarContact> findContacts(const Scene& scene, const BoxIndex& index) {
    const float tolerance = 2.0F * weldTolerance(scene);
    std::vector<PlanarContact> contacts;
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < scene.polygons.size(); ++i) {
        const Polygon& polygon = scene.polygons[i];
        index.meeting(boundsOf(scene, polygon).grownBy(tolerance), found);
        if (found.size() <= static_cast<std::size_t>(polygon.size())) continue;
        const PlaneFrame frame = planeFrame(scene, polygon);
        const std::vector<glm::dvec2> border = frame.outline(scene, polygon);
        PlanarContact contact{i, {}, tolerance};
        bool touched = false;
        for (const std::uint32_t vertex : found) {
            if (std::find(polygon.vertices.begin(), polygon.vertices.end(), vertex) != polygon.vertices.end()) continue;
            const glm::vec3 p = scene.positions[vertex];
            if (std::abs(frame.height(p)) > static_cast<double>(tolerance)) continue;
            const double depth = depthInside(border, frame.project(p));
            if (depth < -static_cast<double>(tolerance)) continue;
            touched = true; // inside, or on the border, whence an edge may cross the polygon
            if (depth > static_cast<double>(tolerance)) contact.vertices.push_back(vertex);
        }
        if (touched) contacts.push_back(std::move(contact));
    }
    return contacts;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> contactLines(const PlanarContact& contact, const Scene& scene,
                                                                  const EdgeDivision& division) {
    const Polygon& polygon = scene.polygons[contact.polygon];
    const PlaneFrame frame = planeFrame(scene, polygon);
    const std::vector<glm::dvec2> border = frame.outline(scene, polygon);
    // Vertices of the scene on the border count as ends too.
    std::vector<std::uint32_t> ends = contact.vertices;
    for (int k = 0; k < polygon.size(); ++k)
        for (const std::uint32_t vertex : division.side(polygon, k).vertices)
            if (vertex < scene.positions.size()) ends.push_back(vertex);
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());

    std::vector<std::pair<std::uint32_t, std::uint32_t>> lines;
    for (const std::uint32_t end : ends) {
        for (const std::uint32_t segment : division.segmentsAt(end)) {
            const auto [a, b] = division.segment(segment);
            if (a != end || !std::binary_search(ends.begin(), ends.end(), b)) continue;
            const glm::dvec2 middle = 0.5 * (frame.project(scene.positions[a]) + frame.project(scene.positions[b]));
            if (depthInside(border, middle) <= static_cast<double>(contact.tolerance)) continue; // along the border
            const std::vector<std::uint32_t> vertices = division.segmentVertices(segment);
            for (std::size_t k = 0; k + 1 < vertices.size(); ++k) lines.emplace_back(vertices[k], vertices[k + 1]);
        }
    }
    return lines;
}

} // namespace lambert
