#include "meshing/patch_mesh_builder.h"

#include "core/parallel.h"
#include "meshing/patch_locator.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <utility>

namespace lambert {

namespace {

constexpr std::size_t kLocatedAtOnce = 65536; ///< patches, so that what finds them is hardly in memory twice

} // namespace

PatchMeshBuilder::PatchMeshBuilder(const Scene& scene, std::size_t expected, MeshReport& report)
    : scene_(scene), report_(report) {
    mesh_.positions = scene.positions;
    divisions_.reserve(scene.polygons.size());
    mesh_.corners.reserve(expected);
    mesh_.centroid.reserve(expected);
    mesh_.normal.reserve(expected);
    mesh_.area.reserve(expected);
    mesh_.polygon.reserve(expected);
    mesh_.material.reserve(expected);
}

void PatchMeshBuilder::add(DividedPolygon divided, std::size_t known) {
    const Polygon& polygon = scene_.polygons[divisions_.size()];
    const auto first = static_cast<std::uint32_t>(mesh_.size());
    if (divided.faces.empty()) {
        addOccluder(divided.border);
        divisions_.push_back({first, 1, 1});
    } else {
        const auto shift = static_cast<std::uint32_t>(mesh_.positions.size() - known);
        for (Corners& face : divided.faces)
            for (std::uint32_t& vertex : face)
                if (vertex >= known && vertex != kNone) vertex += shift;
        mesh_.positions.insert(mesh_.positions.end(), divided.added.begin(), divided.added.end());
        append(divided.faces);
        const std::size_t patches = mesh_.size() - first;
        const bool isGrid = patches == divided.faces.size();
        divisions_.push_back({first, isGrid ? static_cast<std::uint32_t>(divided.columns) : 0,
                              isGrid ? static_cast<std::uint32_t>(divided.rows) : 0});
        if (polygon.backMaterial != kNone) backs_ += patches;
    }
    report_.contactPolygons += divided.contactsFollowed ? 1 : 0;
    report_.ignoredContactPolygons += divided.contactsIgnored ? 1 : 0;
    if (divided.undivided) {
        ++report_.undividedPolygons;
        report_.undividedArea += polygonArea(scene_, polygon);
    }
}

PatchMesh PatchMeshBuilder::finish(Progress& progress) {
    mesh_.frontCount = mesh_.size();
    addLookup(progress);
    for (std::uint32_t patch = 0; patch < mesh_.frontCount; ++patch) addBack(patch);
    return std::move(mesh_);
}

std::size_t PatchMeshBuilder::patchesWithoutGrid(std::size_t polygon) const {
    const std::size_t end = polygon + 1 < divisions_.size() ? divisions_[polygon + 1].first : mesh_.frontCount;
    return divisions_[polygon].columns > 0 ? 0 : end - divisions_[polygon].first;
}

void PatchMeshBuilder::addLookup(Progress& progress) {
    std::vector<PatchLocator> locators;
    for (std::size_t begin = 0, end = 0; begin < divisions_.size(); begin = end) {
        for (std::size_t patches = 0; end < divisions_.size() && patches < kLocatedAtOnce; ++end)
            patches += patchesWithoutGrid(end);
        locators.resize(end - begin);
        parallelFor(locators.size(), 1, [&](std::size_t from, std::size_t to, int) {
            progress.throwIfCancelled();
            for (std::size_t k = from; k < to; ++k)
                if (const std::size_t patches = patchesWithoutGrid(begin + k); patches > 0)
                    locators[k] = locatePatches(scene_, scene_.polygons[begin + k],
                                                std::span(mesh_.corners).subspan(divisions_[begin + k].first, patches),
                                                mesh_.positions);
        });
        for (std::size_t polygon = begin; polygon < end; ++polygon) {
            const Division& division = divisions_[polygon];
            if (division.columns > 0)
                mesh_.lookup.addGrid(scene_, scene_.polygons[polygon], division.first, division.columns, division.rows);
            else
                mesh_.lookup.addLocated(std::exchange(locators[polygon - begin], {}), division.first);
        }
    }
}

void PatchMeshBuilder::addOccluder(std::span<const std::uint32_t> border) {
    const Polygon& polygon = scene_.polygons[divisions_.size()];
    glm::vec3 centroid(0.0F);
    for (int k = 0; k < polygon.size(); ++k) centroid += corner(scene_, polygon, k);
    centroid /= static_cast<float>(polygon.size());
    for (std::size_t k = 0; k < border.size(); ++k)
        mesh_.occluderEdges.push_back({edgeKey(border[k], border[(k + 1) % border.size()]), centroid});
}

void PatchMeshBuilder::append(std::span<const Corners> faces) {
    const auto polygon = static_cast<std::uint32_t>(divisions_.size());
    const std::size_t first = mesh_.size();
    for (const Corners& corners : faces) {
        // In double: the normal of a sliver must still be a normal, Embree aborts on rays that are not finite.
        const glm::dvec3 a(mesh_.positions[corners[0]]);
        const glm::dvec3 b = glm::dvec3(mesh_.positions[corners[1]]) - a;
        const glm::dvec3 c = glm::dvec3(mesh_.positions[corners[2]]) - a;
        const glm::dvec3 d = corners[3] == kNone ? c : glm::dvec3(mesh_.positions[corners[3]]) - a;
        const glm::dvec3 one = 0.5 * glm::cross(b, c);
        const glm::dvec3 two = 0.5 * glm::cross(c, d);
        glm::dvec3 areaVector = one + two;
        const bool lastHope = &corners == &faces.back() && mesh_.size() == first;
        if (!(static_cast<float>(glm::length(areaVector)) > 0.0F)) {
            if (!lastHope) {
                ++report_.degeneratePatches;
                continue;
            }
            areaVector = glm::dvec3(lambert::areaVector(scene_, scene_.polygons[polygon]));
        }
        const double area = glm::length(areaVector);
        const double areaOne = glm::length(one);
        const double areaTwo = glm::length(two);
        const glm::dvec3 offset = (areaOne * (b + c) + areaTwo * (c + d)) / (3.0 * std::max(areaOne + areaTwo, 1e-300));
        push(corners, glm::vec3(a + offset), glm::vec3(areaVector / area), static_cast<float>(area), polygon,
             scene_.polygons[polygon].material);
    }
}

void PatchMeshBuilder::push(const Corners& corners, const glm::vec3& centroid, const glm::vec3& normal, float area,
                            std::uint32_t polygon, std::uint32_t material) {
    mesh_.corners.push_back(corners);
    mesh_.centroid.push_back(centroid);
    mesh_.normal.push_back(normal);
    mesh_.area.push_back(area);
    mesh_.polygon.push_back(polygon);
    mesh_.material.push_back(material);
}

void PatchMeshBuilder::addBack(std::uint32_t patch) {
    const std::uint32_t polygon = mesh_.polygon[patch];
    const std::uint32_t material = scene_.polygons[polygon].backMaterial;
    if (material == kNone) return;
    if (patch == 0 || mesh_.polygon[patch - 1] != polygon)
        mesh_.lookup.setBack(polygon, static_cast<std::uint32_t>(mesh_.size()));
    Corners reversed = mesh_.corners[patch];
    std::reverse(reversed.begin(), reversed.begin() + (reversed[3] == kNone ? 3 : 4));
    push(reversed, mesh_.centroid[patch], -mesh_.normal[patch], mesh_.area[patch], polygon, material);
}

} // namespace lambert
