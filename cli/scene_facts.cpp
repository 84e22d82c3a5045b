#include "cli/scene_facts.h"

#include "cli/overlap_text.h"
#include "core/text.h"
#include "meshing/build_patch_mesh.h"
#include "meshing/patch_optics.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <numbers>
#include <set>

namespace lambert {

namespace {

constexpr double kBackFaces = 0.01;      // of the rays: as where a bake warns
constexpr double kBackFacesLight = 0.05; // of the emitted light
constexpr double kBlackShare = 0.01;     // of the area
constexpr double kTinyShare = 0.05;      // of the polygons
constexpr std::size_t kNamesShown = 3;

bool isSliver(const Scene& scene, const Polygon& polygon) {
    const double longest = longestEdge(scene, polygon);
    return 2.0 * polygonArea(scene, polygon) < 1e-4 * longest * longest;
}

void add(SceneFacts::Part& part, double area) {
    ++part.polygons;
    part.area += area;
}

/// "a", "b", "c" and 4 more; a name that occurs several times counts once.
std::string nameList(const std::vector<std::string>& names) {
    std::vector<std::string> shown;
    std::set<std::string> different(names.begin(), names.end());
    for (const std::string& name : names) {
        if (shown.size() == kNamesShown || different.empty()) break;
        if (different.erase(name) > 0) shown.push_back(inQuotes(name));
    }
    std::string text = fmt::format("{}", fmt::join(shown, ", "));
    return different.empty() ? text : text + fmt::format(" and {} more", different.size());
}

/// One of what `noun` names, or several.
std::string count(std::size_t number, const char* noun) {
    return fmt::format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

class Findings {
public:
    Findings(const ReadResult& read, const SceneFacts& facts)
        : scene_(read.scene), report_(read.report), facts_(facts) {}

    std::vector<Finding> collect(bool unitIsGiven) {
        lookAtLight();
        lookAtSize(unitIsGiven);
        lookAtBacks();
        lookAtShells();
        lookAtMaterials();
        lookAtInput();
        return std::move(found_);
    }

private:
    void note(std::string problem, std::string remedy) { found_.push_back({std::move(problem), std::move(remedy)}); }

    void lookAtLight() {
        if (facts_.emitted == glm::dvec3(0.0) && scene_.lights.empty())
            note("there is no light", "give a material one with --emit MATERIAL=r,g,b, or a sky with --sky");
        for (const LostLight& lost : facts_.lostLight) note("as good as " + lost.problem, lost.remedy);
    }

    void lookAtSize(bool unitIsGiven) {
        const glm::vec3 size = facts_.bounds.size();
        const double longest = static_cast<double>(std::max({size.x, size.y, size.z}));
        if (!unitIsGiven && !facts_.units.empty()) {
            std::vector<std::string> units;
            for (const LengthUnit& unit : facts_.units)
                units.push_back(fmt::format("--unit {} if these are {}", unit.metres, unit.name));
            note(fmt::format("a room of {:.4g} m is unlikely", longest), fmt::format("{}", fmt::join(units, ", ")));
        } else if (isUnusualSize(longest)) {
            note(fmt::format("unusually {}: {:.3g} m", longest < 1.0 ? "small" : "large", longest),
                 "check the scale of the file; --unit METRES, where it is not glTF");
        }
    }

    void lookAtBacks() {
        const char* remedy =
            "turn its polygons, or make it two-sided: --two-sided for all, \"two_sided\" in the overrides "
            "file for this one";
        if (const std::uint32_t most = facts_.backsFromLights.mostMet();
            facts_.backsFromLights.fraction > kBackFacesLight && most != kNone)
            note(fmt::format("{:.0f} % of the emitted light meets black backs at once, most of it of material {}",
                             100.0 * facts_.backsFromLights.fraction, inQuotes(scene_.materials[most].name)),
                 remedy);
        if (const std::uint32_t most = facts_.backs.mostMet(); facts_.backs.fraction > kBackFaces && most != kNone)
            note(fmt::format("{:.2g} % of the rays between surfaces meet black backs, most of them of material {}",
                             100.0 * facts_.backs.fraction, inQuotes(scene_.materials[most].name)),
                 remedy);
    }

    void lookAtShells() {
        std::vector<std::string> insideOut, inconsistent;
        for (const Shell& shell : facts_.surfaces.shells) {
            if (shell.insideOut) insideOut.push_back(scene_.nodes[shell.node]);
            if (shell.inconsistentEdges > 0) inconsistent.push_back(scene_.nodes[shell.node]);
        }
        if (!insideOut.empty())
            note(fmt::format("{} with the fronts inside: {}", count(insideOut.size(), "closed object"),
                             nameList(insideOut)),
                 "turn the polygons, or use --two-sided");
        if (!inconsistent.empty())
            note(fmt::format("{} where neighbours face opposite ways: {}",
                             count(facts_.surfaces.inconsistentEdges, "edge"), nameList(inconsistent)),
                 "make the normals consistent in the modeller, or use --two-sided");
    }

    void lookAtMaterials() {
        std::vector<std::string> partial, black;
        double blackArea = 0.0;
        for (std::size_t m = 0; m < scene_.materials.size(); ++m) {
            const Material& material = scene_.materials[m];
            if (facts_.materials[m].polygons == 0 || material.occluder) continue;
            if (material.diffusePartOnly) partial.push_back(material.name);
            if (material.reflectance != Rgb(0.0F) || material.emittedRadiance != Rgb(0.0F)) continue;
            black.push_back(material.name);
            blackArea += facts_.materials[m].area;
        }
        if (!partial.empty())
            note(fmt::format("{} treated by the diffuse part: {}; gloss, mirror and glass are left out",
                             count(partial.size(), "material"), nameList(partial)),
                 "--reflectance MATERIAL=r,g,b if that is too dark");
        if (blackArea > kBlackShare * facts_.area)
            note(fmt::format("{:.2g} % of the area is black: {}", 100.0 * blackArea / facts_.area, nameList(black)),
                 "--reflectance MATERIAL=r,g,b");
    }

    void lookAtInput() {
        if (report_.missingImages > 0)
            note(fmt::format("{} could not be read", count(report_.missingImages, "image")),
                 "see the warnings; --allow-outside-files if it lies outside the scene's folder");
        if (report_.nonFinitePolygons > 0)
            note(fmt::format("{} left out: a coordinate is not a finite number",
                             count(report_.nonFinitePolygons, "polygon")),
                 "repair the file");
        if (static_cast<double>(facts_.prepared.collapsedPolygons) >
            kTinyShare * static_cast<double>(report_.inputPolygons))
            note(
                fmt::format("{} of {} polygons are left out as too small to matter: less high than 2e-6 of the scene's "
                            "diagonal",
                            facts_.prepared.collapsedPolygons, report_.inputPolygons),
                "if something is missing, --exclude what lies far away");
        if (facts_.prepared.duplicatePolygons > 0)
            note(fmt::format("{} left out: another has the same vertices and side",
                             count(facts_.prepared.duplicatePolygons, "polygon")),
                 "nothing, where it is the same surface twice");
        if (const std::string overlaps = overlapText(scene_, facts_.prepared.cover); !overlaps.empty())
            note(overlaps, "move what lies on top by .1 mm where another should show, or --exclude NODE");
        if (facts_.prepared.cover.undecidedPolygons > 0)
            note(fmt::format("{} in one plane with others that overlap it cannot be told apart",
                             count(facts_.prepared.cover.undecidedPolygons, "polygon")),
                 "move one of them by .1 mm, or --exclude NODE");
    }

    const Scene& scene_;
    const ReadReport& report_;
    const SceneFacts& facts_;
    std::vector<Finding> found_;
};

/// Watts or lumens of a prepared scene, textures and holes considered.
glm::dvec3 emittedPower(const Scene& prepared) {
    Progress progress;
    MeshOptions options;
    options.patches = 0;
    const PatchMesh mesh = buildPatchMesh(prepared, options, progress);
    const PatchOptics optics = patchOptics(prepared, mesh);
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < mesh.size(); ++i)
        sum += static_cast<double>(mesh.area[i]) * glm::dvec3(optics.emittedRadiosity[i]);
    return sum;
}

} // namespace

SceneFacts gatherFacts(const Scene& scene, Progress& progress) {
    SceneFacts facts;
    facts.bounds = boundsOf(scene);
    facts.materials.resize(scene.materials.size());
    facts.nodes.resize(scene.nodes.size());
    for (const Polygon& polygon : scene.polygons) {
        const auto area = polygonArea(scene, polygon);
        ++(polygon.isQuad() ? facts.quads : facts.triangles);
        facts.slivers += isSliver(scene, polygon) ? 1 : 0;
        add(facts.materials[polygon.material], area);
        add(facts.nodes[polygon.node], area);
        facts.area += area;
    }
    const glm::vec3 size = facts.bounds.size();
    facts.units = guessUnits(static_cast<double>(std::max({size.x, size.y, size.z})));

    progress.begin("check", 3);
    const Scene prepared = prepareScene(scene, {}, &facts.prepared);
    facts.emitted = emittedPower(prepared);
    progress.advance();
    facts.surfaces = checkSurfaces(prepared);
    progress.advance();
    const RayCaster rays(prepared);
    facts.backs = sampleBackFaces(rays);
    facts.backsFromLights = sampleBackFacesFromLights(rays);
    facts.lostLight = findLostLight(rays);
    progress.advance();
    progress.end();
    return facts;
}

std::vector<Finding> worthALook(const ReadResult& read, const SceneFacts& facts, bool unitIsGiven) {
    return Findings(read, facts).collect(unitIsGiven);
}

} // namespace lambert
