#include "meshing/build_patch_mesh.h"

#include "core/error.h"
#include "core/parallel.h"
#include "meshing/divide_polygon.h"
#include "meshing/near_contacts.h"
#include "meshing/patch_mesh_builder.h"
#include "meshing/patch_optics.h"
#include "meshing/scene_division.h"

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
constexpr double kMostForNearContacts = 2e4; ///< patches; the time to find their lines grows with the square
constexpr double kLessExpected = 0.9;        ///< of the budget for near contacts if they took more than that
constexpr int kMostAttempts = 4;             ///< to keep to it, before there are none
constexpr double kUnrefined = std::numeric_limits<double>::infinity();

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
    const double budget = aim.forNearContacts();
    std::optional<NearContactFinder> finder;
    if (options.splitContacts) finder.emplace(scene, aim.length);
    double expected = budget;
    for (int attempt = 1;; ++attempt) {
        SceneDivision division(scene, options.splitContacts, finder ? finder->find(expected) : NearContacts{}, progress,
                               counts);
        if (options.patchLength)
            division.divide(aim.length, aim.patches);
        else
            divideToNumber(division, aim);
        division.countNearContacts();
        counts.nearContactBudget = finder ? static_cast<std::size_t>(budget) : 0;
        const auto added = static_cast<double>(counts.nearContactPatches);
        if (added <= budget) return division.finish();
        expected *= attempt < kMostAttempts ? kLessExpected * budget / added : 0.0;
    }
}

} // namespace

PatchMesh buildPatchMesh(const Scene& scene, const MeshOptions& options, Progress& progress, MeshReport* report) {
    MeshReport counts;
    PatchMesh mesh = divideAsWanted(scene, options, progress, counts);
    measureHoles(scene, mesh);
    if (report != nullptr) *report = counts;
    return mesh;
}

} // namespace lambert
