#include "baking/vertex_places.h"

#include "formfactors/matrix_quality.h"
#include "meshing/patch_offset.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace lambert {

namespace {

constexpr float kSamePlane = 0.999F; ///< cosine of the angle between the normals of patches of one plane

} // namespace

VertexPlaces::VertexPlaces(const RayCaster& rays, const PatchMesh& mesh, const BakedMesh& baked,
                           std::span<const float> covered)
    : rays_(rays), mesh_(mesh), baked_(baked), covered_(covered), around_(mesh, baked) {}

bool VertexPlaces::isOpen(std::uint32_t corner) const {
    return !mesh_.isHidden(corner / 4) && static_cast<double>(covered_[corner / 4]) <= kCovered;
}

double VertexPlaces::weightOf(std::uint32_t corner) const {
    const std::uint32_t patch = corner / 4;
    return static_cast<double>(mesh_.area[patch]) * angleAt(mesh_, patch, static_cast<int>(corner % 4)) *
           (1.0 - static_cast<double>(covered_[patch]));
}

/// Whether patches lie all around the vertex: each edge that one of them begins there, another one ends.
bool VertexPlaces::isClosedFan(std::size_t vertex) const {
    const auto corners = around_.of(vertex);
    const auto neighbour = [&](std::uint32_t corner, std::uint32_t step) {
        const auto count = static_cast<std::uint32_t>(mesh_.cornerCount(corner / 4));
        return baked_.faces[corner / 4][(corner % 4 + step) % count];
    };
    const auto last = [&](std::uint32_t corner) {
        return neighbour(corner, static_cast<std::uint32_t>(mesh_.cornerCount(corner / 4)) - 1);
    };
    return std::ranges::all_of(corners, [&](std::uint32_t a) {
        return std::ranges::any_of(corners, [&](std::uint32_t b) { return last(b) == neighbour(a, 1); });
    });
}

void VertexPlaces::of(std::size_t vertex, std::vector<VertexPlace>& places) const {
    places.clear();
    const auto corners = around_.of(vertex);
    if (std::ranges::all_of(corners, [&](std::uint32_t corner) { return isOpen(corner); }) && isClosedFan(vertex)) {
        float lift = 0.0F;
        for (const std::uint32_t corner : corners) lift = std::max(lift, patchOriginOffset(rays_, mesh_, corner / 4));
        places.push_back({{baked_.positions[vertex], baked_.normals[vertex], lift}, corners.front() / 4, 1.0});
        return;
    }
    std::vector<std::uint32_t> open;
    for (const std::uint32_t corner : corners)
        if (isOpen(corner)) open.push_back(corner);
    std::ranges::stable_sort(open, [&](std::uint32_t a, std::uint32_t b) { return weightOf(a) > weightOf(b); });
    double all = 0.0;
    for (const std::uint32_t corner : open) {
        const double weight = weightOf(corner);
        all += weight;
        const auto same = std::ranges::find_if(places, [&](const VertexPlace& place) {
            return glm::dot(mesh_.normal[corner / 4], place.point.normal) > kSamePlane;
        });
        if (same != places.end()) {
            same->weight += weight;
            continue;
        }
        places.push_back({pointInside(rays_, mesh_, corner / 4, baked_.positions[vertex]), corner / 4, weight});
    }
    for (VertexPlace& place : places)
        place.weight = all > 0.0 ? place.weight / all : 1.0 / static_cast<double>(places.size());
}

VertexPlace VertexPlaces::inside(std::size_t vertex, float share) const {
    const auto corners = around_.of(vertex);
    const auto best = std::ranges::max_element(
        corners, [&](std::uint32_t a, std::uint32_t b) { return covered_[a / 4] > covered_[b / 4]; });
    return {pointInside(rays_, mesh_, *best / 4, baked_.positions[vertex], share), *best / 4, 1.0};
}

} // namespace lambert
