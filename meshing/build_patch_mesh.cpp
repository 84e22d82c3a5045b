#include "meshing/build_patch_mesh.h"

#include "core/error.h"
#include "meshing/contacts.h"
#include "meshing/edge_division.h"
#include "meshing/face_mesher.h"
#include "meshing/patch_surface.h"
#include "meshing/prepare.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace lambert {

namespace {

constexpr double kMostPatches = 2e8;
constexpr double kLongestOverEqual = 2.0; ///< of a patch's length to that of as many equal squares
constexpr double kMoreThanExpected = 1.3; ///< room that is not used stays with the system
constexpr double kUnrefined = std::numeric_limits<double>::infinity();

/// Collects the patches of one polygon after the other.
class PatchMeshBuilder {
public:
    /// `expected` patches, about.
    PatchMeshBuilder(const Scene& scene, std::size_t expected, MeshReport& report) : scene_(scene), report_(report) {
        mesh_.positions = scene.positions;
        mesh_.corners.reserve(expected);
        mesh_.centroid.reserve(expected);
        mesh_.normal.reserve(expected);
        mesh_.area.reserve(expected);
        mesh_.reflectance.reserve(expected);
        mesh_.emittedRadiosity.reserve(expected);
        mesh_.polygon.reserve(expected);
        mesh_.material.reserve(expected);
    }

    std::vector<glm::vec3>& positions() { return mesh_.positions; }

    void addWhole(std::uint32_t polygon) { addGrid(polygon, {scene_.polygons[polygon].vertices}, 1, 1); }

    void addGrid(std::uint32_t polygon, const std::vector<Corners>& faces, std::size_t columns, std::size_t rows) {
        const std::size_t first = mesh_.size();
        append(polygon, faces);
        if (mesh_.size() - first == faces.size())
            mesh_.lookup.addGrid(scene_, scene_.polygons[polygon], static_cast<std::uint32_t>(first),
                                 static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(rows));
        else
            addLocated(polygon, first);
    }

    /// A polygon without patches, whose `border` is divided like that of any other.
    void addOccluder(std::uint32_t polygon, const std::vector<std::uint32_t>& border) {
        const Polygon& source = scene_.polygons[polygon];
        mesh_.lookup.addGrid(scene_, source, static_cast<std::uint32_t>(mesh_.size()), 1, 1);
        glm::vec3 centroid(0.0F);
        for (int k = 0; k < source.size(); ++k) centroid += corner(scene_, source, k);
        centroid /= static_cast<float>(source.size());
        for (std::size_t k = 0; k < border.size(); ++k)
            mesh_.occluderEdges.push_back({edgeKey(border[k], border[(k + 1) % border.size()]), centroid});
    }

    void addFaces(std::uint32_t polygon, const std::vector<Corners>& faces) {
        const std::size_t first = mesh_.size();
        append(polygon, faces);
        addLocated(polygon, first);
    }

    PatchMesh finish() {
        mesh_.frontCount = mesh_.size();
        for (std::uint32_t patch = 0; patch < mesh_.frontCount; ++patch) addBack(patch);
        return std::move(mesh_);
    }

private:
    void addLocated(std::uint32_t polygon, std::size_t first) {
        mesh_.lookup.addPatches(scene_, scene_.polygons[polygon], static_cast<std::uint32_t>(first),
                                std::span(mesh_.corners).subspan(first), mesh_.positions);
    }

    void append(std::uint32_t polygon, const std::vector<Corners>& faces) {
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
            const glm::dvec3 offset =
                (areaOne * (b + c) + areaTwo * (c + d)) / (3.0 * std::max(areaOne + areaTwo, 1e-300));
            push(corners, glm::vec3(a + offset), glm::vec3(areaVector / area), static_cast<float>(area), polygon,
                 scene_.polygons[polygon].material);
        }
    }

    void push(const Corners& corners, const glm::vec3& centroid, const glm::vec3& normal, float area,
              std::uint32_t polygon, std::uint32_t materialIndex) {
        const Material& material = scene_.materials[materialIndex];
        mesh_.corners.push_back(corners);
        mesh_.centroid.push_back(centroid);
        mesh_.normal.push_back(normal);
        mesh_.area.push_back(area);
        mesh_.reflectance.push_back(material.reflectance);
        mesh_.emittedRadiosity.push_back(std::numbers::pi_v<float> * material.emittedRadiance);
        mesh_.polygon.push_back(polygon);
        mesh_.material.push_back(materialIndex);
    }

    void addBack(std::uint32_t patch) {
        const std::uint32_t polygon = mesh_.polygon[patch];
        const std::uint32_t material = scene_.polygons[polygon].backMaterial;
        if (material == kNone) return;
        if (patch == 0 || mesh_.polygon[patch - 1] != polygon)
            mesh_.lookup.setBack(polygon, static_cast<std::uint32_t>(mesh_.size()));
        Corners reversed = mesh_.corners[patch];
        std::reverse(reversed.begin(), reversed.begin() + (reversed[3] == kNone ? 3 : 4));
        push(reversed, mesh_.centroid[patch], -mesh_.normal[patch], mesh_.area[patch], polygon, material);
    }

    const Scene& scene_;
    MeshReport& report_;
    PatchMesh mesh_;
};

/// A polygon's sides with all vertices on them, and what follows from them.
struct DividedBorder {
    std::array<EdgeDivision::Side, 4> sides;
    FaceOutline outline;
    bool whole = true; ///< no vertex but the corners

    DividedBorder(const Scene& scene, const Polygon& polygon, const EdgeDivision& division,
                  const PlanarContact* contact) {
        for (int k = 0; k < polygon.size(); ++k) {
            auto& side = sides[static_cast<std::size_t>(k)];
            side = division.side(polygon, k);
            outline.border.insert(outline.border.end(), side.vertices.begin(), side.vertices.end() - 1);
            whole = whole && side.vertices.size() == 2;
        }
        if (contact != nullptr) outline.contacts = contactLines(*contact, scene, division);
        whole = whole && outline.contacts.empty();
    }

    /// Whether a quad can be a grid: nothing stands on it, and opposite sides are divided alike.
    bool isGrid() const {
        const auto alike = [this](std::size_t k) {
            return sides[k].segments == 1 && sides[k + 2].segments == 1 &&
                   sides[k].vertices.size() == sides[k + 2].vertices.size();
        };
        return outline.contacts.empty() && alike(0) && alike(1);
    }
};

void dividePolygon(std::uint32_t index, const Scene& scene, const EdgeDivision& division, const PlanarContact* contact,
                   PatchMeshBuilder& builder, MeshReport& report) {
    const Polygon& polygon = scene.polygons[index];
    DividedBorder border(scene, polygon, division, contact);
    if (isOccluder(scene, polygon)) {
        builder.addOccluder(index, border.outline.border);
        return;
    }
    if (border.whole) {
        builder.addWhole(index);
        return;
    }
    const auto& sides = border.sides;
    if (polygon.isQuad() && border.isGrid()) {
        const auto faces =
            gridFace({sides[0].vertices, sides[1].vertices, sides[2].vertices, sides[3].vertices}, builder.positions());
        builder.addGrid(index, faces, sides[0].vertices.size() - 1, sides[1].vertices.size() - 1);
        return;
    }
    FaceOutline& outline = border.outline;
    outline.frame = planeFrame(scene, polygon);
    auto faces = triangulateFace(outline, report.patchLength, builder.positions());
    if (!outline.contacts.empty()) ++(faces ? report.contactPolygons : report.ignoredContactPolygons);
    if (!faces && !outline.contacts.empty()) {
        outline.contacts.clear();
        faces = triangulateFace(outline, report.patchLength, builder.positions());
    }
    if (faces) {
        builder.addFaces(index, *faces);
    } else {
        ++report.undividedPolygons;
        report.undividedArea += polygonArea(scene, polygon);
        builder.addWhole(index);
    }
}

/// One division of the scene at a given target length, into about `expected` patches.
PatchMesh divide(const Scene& scene, const VertexIndex& index, const std::vector<PlanarContact>& contacts,
                 double length, double expected, Progress& progress, MeshReport& report) {
    report = MeshReport{};
    report.patchLength = length;
    PatchMeshBuilder builder(scene, static_cast<std::size_t>(kMoreThanExpected * expected), report);
    const EdgeDivision division(scene, index, length, builder.positions());
    auto contact = contacts.begin(); // in the polygons' order, like the loop
    for (std::uint32_t i = 0; i < scene.polygons.size(); ++i) {
        if (i % 1024 == 0) progress.throwIfCancelled();
        const bool touched = contact != contacts.end() && contact->polygon == i;
        dividePolygon(i, scene, division, touched ? &*contact++ : nullptr, builder, report);
    }
    return builder.finish();
}

PatchMesh keepPolygons(const Scene& scene, MeshReport& report) {
    PatchMeshBuilder builder(scene, scene.polygons.size(), report);
    for (std::uint32_t i = 0; i < scene.polygons.size(); ++i) {
        const Polygon& polygon = scene.polygons[i];
        if (isOccluder(scene, polygon))
            builder.addOccluder(i, {polygon.vertices.begin(), polygon.vertices.begin() + polygon.size()});
        else
            builder.addWhole(i);
    }
    report.patchLength = kUnrefined;
    return builder.finish();
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

/// The patches, with the material's constants for what is on them.
PatchMesh divideAsWanted(const Scene& scene, const MeshOptions& options, Progress& progress, MeshReport& counts) {
    if (options.patchLength && !(*options.patchLength > 0.0))
        throw UsageError(fmt::format("patch length: found {}, allowed is a length above 0", *options.patchLength));
    if (!options.patchLength && options.patches == std::size_t{0}) return keepPolygons(scene, counts);

    const VertexIndex index(scene.positions);
    const std::vector<PlanarContact> contacts =
        options.splitContacts ? findContacts(scene, index) : std::vector<PlanarContact>{};
    if (options.patchLength) {
        const double predicted = totalArea(scene) / (*options.patchLength * *options.patchLength);
        if (predicted > kMostPatches)
            throw UsageError(fmt::format("patch length {} m: would make about {:.0f} patches, allowed are {:.0f}",
                                         *options.patchLength, predicted, kMostPatches));
        return divide(scene, index, contacts, *options.patchLength, predicted, progress, counts);
    }
    const auto wanted = static_cast<double>(options.patches.value_or(defaultPatches(scene, options.refinement)));
    if (wanted > kMostPatches)
        throw UsageError(fmt::format("patches: found {:.0f}, allowed are {:.0f}", wanted, kMostPatches));
    const auto polygons = static_cast<double>(litPolygons(scene));
    // If small polygons use up the number, or almost, the large ones must not stay whole all the same.
    const double equal = std::sqrt(totalArea(scene) / wanted);
    const double longest = kLongestOverEqual * equal;
    if (polygons >= wanted) return divide(scene, index, contacts, longest, polygons, progress, counts);

    // Small polygons stay whole; what is refined beyond them grows about as 1 / length².
    double length = equal;
    PatchMesh mesh = divide(scene, index, contacts, length, wanted, progress, counts);
    for (int attempt = 0; attempt < 5; ++attempt) {
        const auto found = static_cast<double>(mesh.size());
        if (std::abs(found / wanted - 1.0) < 0.03) break;
        // With few polygons their number is no bound: two patches of a quad are not two triangles.
        const double base = polygons < 0.5 * wanted ? 0.0 : polygons;
        const double next = std::min(longest, length * std::sqrt(std::max(found - base, 1.0) / (wanted - base)));
        if (next == length) break;
        length = next;
        mesh = PatchMesh(); // two of them would take twice the memory
        mesh = divide(scene, index, contacts, length, wanted, progress, counts);
    }
    return mesh;
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
