#include "meshing/build_patch_mesh.h"

#include "core/error.h"
#include "core/parallel.h"
#include "meshing/contacts.h"
#include "meshing/divide_polygon.h"
#include "meshing/edge_division.h"
#include "meshing/near_contacts.h"
#include "meshing/patch_mesh_builder.h"
#include "meshing/patch_surface.h"
#include "meshing/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace lambert {

namespace {

constexpr double kMostPatches = 2e8;
constexpr double kLongestOverEqual = 2.0;    ///< of a patch's length to that of as many equal squares
constexpr double kMoreThanExpected = 1.3;    ///< room that is not used stays with the system
constexpr double kDividedAtOnce = 65536;     ///< patches, so that they are hardly in memory twice
constexpr double kMostForNearContacts = 2e4; ///< patches; the time to find their lines grows with the square
constexpr double kUnrefined = std::numeric_limits<double>::infinity();

/// What stands on a polygon or hovers over it, or null.
template <class Contact>
const Contact* contactOf(const std::vector<Contact>& contacts, std::uint32_t polygon) {
    const auto it = std::lower_bound(contacts.begin(), contacts.end(), polygon,
                                     [](const Contact& contact, std::uint32_t p) { return contact.polygon < p; });
    return it != contacts.end() && it->polygon == polygon ? &*it : nullptr;
}

/// A scene to be divided, as finely as it takes.
class SceneDivision {
public:
    /// `near` are the near contacts; their vertices are in the scene.
    SceneDivision(const Scene& scene, bool splitContacts, const std::vector<NearContact>& near, Progress& progress,
                  MeshReport& report)
        : scene_(scene), index_(scene.positions), near_(near), progress_(progress), report_(report) {
        if (splitContacts) contacts_ = findContacts(scene, index_);
    }

    /// Into patches about `length` metres long, of which there will be about `expected`; an earlier division is dropped.
    void divide(double length, double expected) {
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

    std::size_t patchCount() const { return builder_->patchCount(); }
    PatchMesh finish() { return builder_->finish(progress_); }

private:
    /// How many polygons make about kDividedAtOnce patches.
    std::size_t someFrom(std::size_t first) const {
        std::size_t end = first;
        for (double patches = 0.0; end < scene_.polygons.size() && patches < kDividedAtOnce; ++end)
            patches += 1.0 + polygonArea(scene_, scene_.polygons[end]) / (report_.patchLength * report_.patchLength);
        return end - first;
    }

    void divideSome(std::size_t first, std::size_t count, const EdgeDivision& edges) {
        const std::vector<glm::vec3>& positions = builder_->positions();
        divided_.resize(count);
        parallelFor(count, 1, [&](std::size_t begin, std::size_t end, int) {
            progress_.throwIfCancelled();
            for (std::size_t k = begin; k < end; ++k) {
                const auto polygon = static_cast<std::uint32_t>(first + k);
                const NearContact* near = contactOf(near_, polygon);
                divided_[k] = dividePolygon(scene_, scene_.polygons[polygon], edges, contactOf(contacts_, polygon),
                                            near != nullptr ? &near->lines : nullptr, report_.patchLength, positions);
            }
        });
        const std::size_t known = positions.size();
        for (DividedPolygon& polygon : divided_) builder_->add(std::exchange(polygon, {}), known);
    }

    const Scene& scene_;
    VertexIndex index_;
    std::vector<PlanarContact> contacts_; ///< in the polygons' order
    const std::vector<NearContact>& near_;
    Progress& progress_;
    MeshReport& report_;
    std::optional<PatchMeshBuilder> builder_;
    std::vector<DividedPolygon> divided_;
};

PatchMesh keepPolygons(const Scene& scene, Progress& progress, MeshReport& report) {
    PatchMeshBuilder builder(scene, scene.polygons.size(), report);
    for (const Polygon& polygon : scene.polygons) builder.add(keptWhole(scene, polygon), scene.positions.size());
    report.patchLength = kUnrefined;
    return builder.finish(progress);
}

double totalArea(const Scene& scene) {
    return std::accumulate(scene.polygons.begin(), scene.polygons.end(), 0.0, [&](double sum, const Polygon& polygon) {
        if (isOccluder(scene, polygon)) return sum;
        const double area = polygonArea(scene, polygon);
        return sum + (polygon.backMaterial != kNone ? 2.0 * area : area);
    });
}

/// Polygons that will have patches.
std::size_t litPolygons(const Scene& scene) {
    return static_cast<std::size_t>(std::count_if(scene.polygons.begin(), scene.polygons.end(),
                                                  [&](const Polygon& polygon) { return !isOccluder(scene, polygon); }));
}

} // namespace

std::size_t defaultPatches(const Scene& scene, double refinement) {
    const std::size_t polygons = litPolygons(scene);
    const auto added = static_cast<double>(std::max<std::size_t>(5000, polygons / 4));
    return polygons + static_cast<std::size_t>(refinement * added);
}

namespace {

/// What the options ask for.
struct Aim {
    double patches;  ///< about so many
    double length;   ///< of as many equal squares, or as given, metres
    double polygons; ///< how many there are at least

    Aim(const Scene& scene, const MeshOptions& options) : polygons(static_cast<double>(litPolygons(scene))) {
        if (options.patchLength) {
            length = *options.patchLength;
            patches = totalArea(scene) / (length * length);
            if (patches > kMostPatches)
                throw UsageError(fmt::format("patch length {} m: would make about {:.0f} patches, allowed are {:.0f}",
                                             length, patches, kMostPatches));
        } else {
            patches = static_cast<double>(options.patches.value_or(defaultPatches(scene, options.refinement)));
            if (patches > kMostPatches)
                throw UsageError(fmt::format("patches: found {:.0f}, allowed are {:.0f}", patches, kMostPatches));
            length = std::sqrt(totalArea(scene) / patches);
        }
    }

    /// How many patches may come of what hovers: a quarter, but of what the polygons leave no more than a half.
    double forNearContacts() const {
        return std::min({kMostForNearContacts, 0.25 * patches, 0.5 * std::max(patches - polygons, 0.2 * patches)});
    }
};

/// Divides until the number is about right.
void divideToNumber(SceneDivision& division, const Aim& aim) {
    // If small polygons use up the number, or almost, the large ones must not stay whole all the same.
    const double longest = kLongestOverEqual * aim.length;
    if (aim.polygons >= aim.patches) {
        division.divide(longest, aim.polygons);
        return;
    }
    // Small polygons stay whole; what is refined beyond them grows about as 1 / length².
    double length = aim.length;
    division.divide(length, aim.patches);
    for (int attempt = 0; attempt < 5; ++attempt) {
        const auto found = static_cast<double>(division.patchCount());
        if (std::abs(found / aim.patches - 1.0) < 0.03) break;
        // With few polygons their number is no bound: two patches of a quad are not two triangles.
        const double base = aim.polygons < 0.5 * aim.patches ? 0.0 : aim.polygons;
        const double next = std::min(longest, length * std::sqrt(std::max(found - base, 1.0) / (aim.patches - base)));
        if (next == length) break;
        length = next;
        division.divide(length, aim.patches);
    }
}

/// The patches, with the material's constants for what is on them.
PatchMesh divideAsWanted(const Scene& scene, const MeshOptions& options, Progress& progress, MeshReport& counts) {
    if (options.patchLength && !(*options.patchLength > 0.0))
        throw UsageError(fmt::format("patch length: found {}, allowed is a length above 0", *options.patchLength));
    if (!options.patchLength && options.patches == std::size_t{0}) return keepPolygons(scene, progress, counts);

    const Aim aim(scene, options);
    NearContacts near;
    if (options.splitContacts) near = findNearContacts(scene, aim.length, aim.forNearContacts());
    std::optional<Scene> withVertices;
    if (!near.vertices.empty()) {
        withVertices = scene;
        withVertices->positions.insert(withVertices->positions.end(), near.vertices.begin(), near.vertices.end());
    }
    SceneDivision division(withVertices ? *withVertices : scene, options.splitContacts, near.contacts, progress,
                           counts);
    if (options.patchLength)
        division.divide(aim.length, aim.patches);
    else
        divideToNumber(division, aim);
    return division.finish();
}

} // namespace

PatchMesh buildPatchMesh(const Scene& scene, const MeshOptions& options, Progress& progress, MeshReport* report) {
    MeshReport counts;
    PatchMesh mesh = divideAsWanted(scene, options, progress, counts);
    averageSurfaces(scene, mesh);
    if (report != nullptr) *report = counts;
    return mesh;
}

} // namespace lambert
