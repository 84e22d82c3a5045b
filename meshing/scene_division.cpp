#include "meshing/scene_division.h"

#include "core/parallel.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <utility>

namespace lambert {

namespace {

constexpr double kMoreThanExpected = 1.3; ///< room that is not used stays with the system
constexpr double kDividedAtOnce = 65536;  ///< patches, so that they are hardly in memory twice

/// What stands on a polygon or hovers over it, or null.
template <class Contact>
const Contact* contactOf(const std::vector<Contact>& contacts, std::uint32_t polygon) {
    const auto it = std::lower_bound(contacts.begin(), contacts.end(), polygon,
                                     [](const Contact& contact, std::uint32_t p) { return contact.polygon < p; });
    return it != contacts.end() && it->polygon == polygon ? &*it : nullptr;
}

const FaceLines* linesOf(const NearContacts& near, std::uint32_t polygon) {
    const NearContact* const contact = contactOf(near.contacts, polygon);
    return contact != nullptr ? &contact->lines : nullptr;
}

std::optional<Scene> withVertices(const Scene& scene, const std::vector<glm::vec3>& vertices) {
    if (vertices.empty()) return std::nullopt;
    Scene result = scene;
    result.positions.insert(result.positions.end(), vertices.begin(), vertices.end());
    return result;
}

/// Vertices on the border of a polygon.
std::size_t borderSize(const EdgeDivision& edges, const Polygon& polygon) {
    std::size_t size = 0;
    for (int k = 0; k < polygon.size(); ++k) size += edges.side(polygon, k).vertices.size() - 1;
    return size;
}

} // namespace

SceneDivision::SceneDivision(const Scene& scene, bool splitContacts, NearContacts near, Progress& progress,
                             MeshReport& report)
    : plain_(scene),
      splitContacts_(splitContacts),
      near_(std::move(near)),
      withVertices_(withVertices(scene, near_.vertices)),
      scene_(withVertices_ ? *withVertices_ : plain_),
      index_(boxesOf(scene_.positions)),
      progress_(progress),
      report_(report) {
    if (splitContacts) contacts_ = findContacts(scene_, index_);
}

void SceneDivision::divide(double length, double expected) {
    builder_.reset(); // two of them would take twice the memory
    report_ = MeshReport{};
    report_.patchLength = length;
    builder_.emplace(scene_, static_cast<std::size_t>(kMoreThanExpected * expected), report_);
    const EdgeDivision edges(scene_, index_, length, builder_->positions());
    for (std::size_t first = 0; first < scene_.polygons.size();) {
        const std::size_t count = someFrom(first);
        divideSome(first, count, edges);
        first += count;
    }
}

/// How many polygons make about kDividedAtOnce patches.
std::size_t SceneDivision::someFrom(std::size_t first) const {
    std::size_t end = first;
    for (double patches = 0.0; end < scene_.polygons.size() && patches < kDividedAtOnce; ++end)
        patches += 1.0 + polygonArea(scene_, scene_.polygons[end]) / (report_.patchLength * report_.patchLength);
    return end - first;
}

void SceneDivision::divideSome(std::size_t first, std::size_t count, const EdgeDivision& edges) {
    const std::vector<glm::vec3>& positions = builder_->positions();
    divided_.resize(count);
    parallelFor(count, 1, [&](std::size_t begin, std::size_t end, int) {
        progress_.throwIfCancelled();
        for (std::size_t k = begin; k < end; ++k) {
            const auto polygon = static_cast<std::uint32_t>(first + k);
            divided_[k] = dividePolygon(scene_, scene_.polygons[polygon], edges, contactOf(contacts_, polygon),
                                        linesOf(near_, polygon), report_.patchLength, positions);
        }
    });
    const std::size_t known = positions.size();
    for (DividedPolygon& polygon : divided_) builder_->add(std::exchange(polygon, {}), known);
}

void SceneDivision::countNearContacts() const {
    report_.nearContactPolygons = near_.contacts.size();
    report_.nearContactPatches = 0;
    if (near_.contacts.empty()) return;
    const BoxIndex plainIndex(boxesOf(plain_.positions));
    std::vector<PlanarContact> plainContacts;
    if (splitContacts_) plainContacts = findContacts(plain_, plainIndex);
    const double length = report_.patchLength;
    std::vector<glm::vec3> positions = scene_.positions, plainPositions = plain_.positions;
    const EdgeDivision edges(scene_, index_, length, positions);
    const EdgeDivision plainEdges(plain_, plainIndex, length, plainPositions);
    std::atomic<std::int64_t> added = 0;
    parallelFor(plain_.polygons.size(), 64, [&](std::size_t begin, std::size_t end, int) {
        progress_.throwIfCancelled();
        for (std::size_t i = begin; i < end; ++i) {
            const Polygon& polygon = plain_.polygons[i];
            const auto number = static_cast<std::uint32_t>(i);
            const FaceLines* const lines = linesOf(near_, number);
            // A division can only differ along with the lines or the border.
            if (isOccluder(plain_, polygon) ||
                (lines == nullptr && borderSize(edges, polygon) == borderSize(plainEdges, polygon)))
                continue;
            const auto with =
                dividePolygon(scene_, polygon, edges, contactOf(contacts_, number), lines, length, positions);
            const auto without = dividePolygon(plain_, polygon, plainEdges, contactOf(plainContacts, number), nullptr,
                                               length, plainPositions);
            const auto more =
                static_cast<std::int64_t>(with.faces.size()) - static_cast<std::int64_t>(without.faces.size());
            added += polygon.backMaterial != kNone ? 2 * more : more;
        }
    });
    report_.nearContactPatches = static_cast<std::size_t>(std::max<std::int64_t>(added, 0));
}

} // namespace lambert
