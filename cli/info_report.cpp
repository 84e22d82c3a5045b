#include "cli/info_report.h"

#include "cli/bake_report.h"
#include "cli/overlap_text.h"
#include "cli/terminal_text.h"

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace lambert {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::size_t kNodesShown = 20;
constexpr std::size_t kShellsInJson = 100;

constexpr std::array kKinds{"point", "spot", "directional"}; ///< as PunctualLight::Kind

/// A directional light has none.
glm::dvec3 placeOf(const Scene& scene, const PunctualLight& light) {
    return light.kind == PunctualLight::Kind::Directional ? glm::dvec3(0.0) : placeInFile(scene, light.position);
}

/// A place in the file, in metres, with as many digits as tell places of the scene apart.
std::string placeText(const Scene& scene, const glm::vec3& place) {
    const glm::dvec3 p = placeInFile(scene, place);
    if (scene.origin == glm::dvec3(0.0)) return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x, p.y, p.z);
    const double size = std::max(static_cast<double>(boundsOf(scene).diagonal()), 1e-9);
    const int decimals = std::clamp(4 - static_cast<int>(std::floor(std::log10(size))), 0, 12);
    return fmt::format("({:.{}f}, {:.{}f}, {:.{}f})", p.x, decimals, p.y, decimals, p.z, decimals);
}

/// Nodes with polygons, largest area first.
std::vector<std::uint32_t> largestNodes(const SceneFacts& facts) {
    std::vector<std::uint32_t> nodes(facts.nodes.size());
    std::iota(nodes.begin(), nodes.end(), 0U);
    std::erase_if(nodes, [&](std::uint32_t node) { return facts.nodes[node].polygons == 0; });
    std::stable_sort(nodes.begin(), nodes.end(),
                     [&](auto a, auto b) { return facts.nodes[a].area > facts.nodes[b].area; });
    return nodes;
}

Json textureJson(const Scene& scene, const TextureUse& use) {
    return use ? Json(scene.textures[use.texture]->name()) : Json(nullptr);
}

Json materialJson(const InfoReportInput& in, std::size_t m) {
    const Scene& scene = in.read.scene;
    const Material& material = scene.materials[m];
    return {{"name", material.name},
            {"polygons", in.facts.materials[m].polygons},
            {"area", in.facts.materials[m].area},
            {"reflectance", jsonVector(glm::dvec3(material.reflectance))},
            {"emitted_radiance", jsonVector(glm::dvec3(material.emittedRadiance))},
            {"two_sided", material.twoSided},
            {"reflectance_texture", textureJson(scene, material.reflectanceTexture)},
            {"emission_texture", textureJson(scene, material.emissionTexture)},
            {"opacity_texture", textureJson(scene, material.opacityTexture)},
            {"holes", material.hasHoles()},
            {"occluder", material.occluder},
            {"diffuse_part_only", material.diffusePartOnly}};
}

Json inputJson(const ReadReport& report, const SceneFacts& facts) {
    return {{"polygons", report.inputPolygons},
            {"non_finite", report.nonFinitePolygons},
            {"degenerate", report.degeneratePolygons},
            {"split", report.splitPolygons},
            {"missing_images", report.missingImages},
            {"collapsed", facts.prepared.collapsedPolygons},
            {"joined_pairs", facts.prepared.joinedPairs},
            {"welded_vertices", facts.prepared.weldedVertices},
            {"duplicates", facts.prepared.duplicatePolygons},
            {"merged_sheets", facts.prepared.mergedSheets},
            {"covered", facts.prepared.cover.coveredPolygons},
            {"cut_by_coplanar", facts.prepared.cover.cutPolygons},
            {"slivers", facts.slivers}};
}

Json surfacesJson(const Scene& scene, const SurfaceCheck& surfaces) {
    Json shells = Json::array();
    for (const Shell& shell : surfaces.shells) {
        if (shells.size() == kShellsInJson) break;
        shells.push_back({{"node", scene.nodes[shell.node]},
                          {"material", scene.materials[shell.material].name},
                          {"polygons", shell.polygons},
                          {"area", shell.area},
                          {"closed", shell.isClosed()},
                          {"volume", shell.volume},
                          {"inside_out", shell.insideOut},
                          {"open_edges", shell.openEdges},
                          {"non_manifold_edges", shell.branchedEdges},
                          {"inconsistent_edges", shell.inconsistentEdges}});
    }
    return {{"open_edges", surfaces.openEdges},
            {"non_manifold_edges", surfaces.branchedEdges},
            {"inconsistent_edges", surfaces.inconsistentEdges},
            {"shells", surfaces.shells.size()},
            {"closed_shells", surfaces.closedShells},
            {"inside_out_shells", surfaces.insideOutShells},
            {"largest", shells}};
}

Json backsJson(const Scene& scene, const BackFaceSample& sample) {
    Json materials = Json::object();
    for (std::size_t m = 0; m < sample.byMaterial.size(); ++m)
        if (sample.byMaterial[m] > 0.0) materials[scene.materials[m].name] = sample.byMaterial[m];
    return {{"fraction", sample.fraction}, {"materials", materials}};
}

} // namespace

Json infoReport(const InfoReportInput& in) {
    const Scene& scene = in.read.scene;
    const SceneFacts& facts = in.facts;
    Json report;
    report["scene"] = in.path.string();
    report["version"] = LAMBERT_VERSION;
    report["bounds"] = {{"lower", jsonVector(placeInFile(scene, facts.bounds.lower))},
                        {"upper", jsonVector(placeInFile(scene, facts.bounds.upper))}};
    report["unit"] = in.read.report.overrides.metresPerUnit;
    report["unit_guesses"] = Json::array();
    for (const LengthUnit& unit : facts.units) report["unit_guesses"].push_back(unit.metres);
    report["triangles"] = facts.triangles;
    report["quads"] = facts.quads;
    report["area"] = facts.area;
    report["emitted"] = jsonVector(facts.emitted);
    report["input"] = inputJson(in.read.report, facts);
    report["coplanar_overlaps"] = overlapsJson(scene, facts.prepared.cover);
    report["surfaces"] = surfacesJson(scene, facts.surfaces);
    report["back_faces"] = backsJson(scene, facts.backs);
    report["back_faces_from_lights"] = backsJson(scene, facts.backsFromLights);
    report["materials"] = Json::array();
    for (std::size_t m = 0; m < scene.materials.size(); ++m) report["materials"].push_back(materialJson(in, m));
    report["textures"] = Json::array();
    for (const auto& texture : scene.textures)
        report["textures"].push_back(
            {{"name", texture->name()}, {"width", texture->width()}, {"height", texture->height()}});
    report["nodes"] = Json::array();
    for (const std::uint32_t node : largestNodes(facts))
        report["nodes"].push_back(
            {{"name", scene.nodes[node]}, {"polygons", facts.nodes[node].polygons}, {"area", facts.nodes[node].area}});
    report["lights"] = Json::array();
    for (const PunctualLight& light : scene.lights)
        report["lights"].push_back({{"name", light.name},
                                    {"kind", kKinds[static_cast<std::size_t>(light.kind)]},
                                    {"intensity", jsonVector(glm::dvec3(light.intensity))},
                                    {"position", jsonVector(placeOf(scene, light))},
                                    {"direction", jsonVector(glm::dvec3(light.direction))}});
    report["cameras"] = Json::array();
    for (const Camera& camera : scene.cameras)
        report["cameras"].push_back({{"name", camera.name},
                                     {"eye", jsonVector(placeInFile(scene, camera.eye))},
                                     {"direction", jsonVector(glm::dvec3(camera.direction))}});
    report["worth_a_look"] = Json::array();
    for (const Finding& finding : in.findings)
        report["worth_a_look"].push_back({{"problem", finding.problem}, {"remedy", finding.remedy}});
    report["warnings"] = in.read.report.warnings;
    return report;
}

namespace {

std::string rgb(const Rgb& c) { return fmt::format("{:.3g} {:.3g} {:.3g}", c.x, c.y, c.z); }

/// A name in a column, cut where it is too wide.
std::string column(const std::string& name, std::size_t width) {
    std::string text = printable(name);
    if (text.size() <= width) return text;
    std::size_t end = width - 3;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end; // not inside a character
    return text.substr(0, end) + "...";
}

void printSummary(const InfoReportInput& in) {
    const SceneFacts& facts = in.facts;
    const ReadReport& report = in.read.report;
    const glm::vec3 size = facts.bounds.size();
    const double unit = report.overrides.metresPerUnit;
    fmt::print("scene       {}\n", printable(in.path.string()));
    fmt::print("size        {:.4g} × {:.4g} × {:.4g} m, from {}{}\n", size.x, size.y, size.z,
               placeText(in.read.scene, facts.bounds.lower),
               unit == 1.0 ? "" : fmt::format("; {:g} m per unit of the file", unit));
    fmt::print("polygons    {} triangles, {} quads, {:.5g} m²; {} in the file\n", facts.triangles, facts.quads,
               facts.area, report.inputPolygons);
    fmt::print("dropped     {} non-finite, {} degenerate, {} less high than {:.2g} m (2e-6 of the diagonal)\n",
               report.nonFinitePolygons, report.degeneratePolygons, facts.prepared.collapsedPolygons,
               2.0F * weldTolerance(in.read.scene));
    fmt::print("changed     {} polygons split, {} vertices welded, {} triangle pairs joined\n", report.splitPolygons,
               facts.prepared.weldedVertices, facts.prepared.joinedPairs);
    fmt::print("coincident  {} duplicates (left out), {} back to back (two sides of one polygon)\n",
               facts.prepared.duplicatePolygons, facts.prepared.mergedSheets);
    fmt::print("coplanar    {} covered by others in their plane (left out), {} in part (cut)\n",
               facts.prepared.cover.coveredPolygons, facts.prepared.cover.cutPolygons);
    fmt::print("slivers     {} polygons less high than 1/10000 of their longest edge\n", facts.slivers);
    const SurfaceCheck& surfaces = facts.surfaces;
    fmt::print("surfaces    {}, {} of them closed; {} open edges, {} of three or more polygons, {} where neighbours "
               "face opposite ways\n",
               surfaces.shells.size(), surfaces.closedShells, surfaces.openEdges, surfaces.branchedEdges,
               surfaces.inconsistentEdges);
    fmt::print("backs       {:.2g} % of the rays between surfaces meet black backs, {:.2g} % of those from lights\n",
               100.0 * facts.backs.fraction, 100.0 * facts.backsFromLights.fraction);
    fmt::print("emitted     {:.5g} {:.5g} {:.5g} (r g b, W or lm)\n", facts.emitted.x, facts.emitted.y,
               facts.emitted.z);
}

void printLightsAndCameras(const Scene& scene) {
    for (const PunctualLight& light : scene.lights)
        fmt::print("light       {}: {}, {} {}\n", printable(light.name), kKinds[static_cast<std::size_t>(light.kind)],
                   rgb(light.intensity), light.kind == PunctualLight::Kind::Directional ? "lx" : "cd");
    for (const Camera& camera : scene.cameras)
        fmt::print("camera      {}: eye {}, {:.1f}° vertically\n", printable(camera.name), placeText(scene, camera.eye),
                   glm::degrees(double{camera.verticalFov}));
}

/// What a material has beside its two colours.
std::string remarks(const Scene& scene, const Material& material) {
    std::vector<std::string> words;
    const auto addTexture = [&](const char* what, const TextureUse& use) {
        if (use) words.push_back(fmt::format("{} {}", what, column(scene.textures[use.texture]->name(), 40)));
    };
    addTexture("texture", material.reflectanceTexture);
    addTexture("emission texture", material.emissionTexture);
    if (material.hasHoles()) addTexture("holes by", material.opacityTexture);
    if (material.occluder) words.emplace_back("only blocks light");
    if (material.diffusePartOnly) words.emplace_back("treated by its diffuse part");
    return fmt::format("{}", fmt::join(words, ", "));
}

void printMaterials(const InfoReportInput& in) {
    const Scene& scene = in.read.scene;
    fmt::print("\n{:<24} {:>9} {:>10}  {:<20} {:<20} sides\n", "material", "polygons", "area m²", "reflectance",
               "emitted radiance");
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        const Material& material = scene.materials[m];
        const SceneFacts::Part& part = in.facts.materials[m];
        const std::string more = remarks(scene, material);
        fmt::print("{:<24} {:>9} {:>10.4g}  {:<20} {:<20} {}{}{}\n", column(material.name, 24), part.polygons,
                   part.area, rgb(material.reflectance), rgb(material.emittedRadiance), material.twoSided ? 2 : 1,
                   more.empty() ? "" : "      ", more);
    }
    if (scene.textures.empty()) return;
    fmt::print("\n{:<40} {:>12}\n", "texture", "texels");
    for (const auto& texture : scene.textures)
        fmt::print("{:<40} {:>12}\n", column(texture->name(), 40),
                   fmt::format("{}×{}", texture->width(), texture->height()));
}

void printNodes(const InfoReportInput& in) {
    const std::vector<std::uint32_t> nodes = largestNodes(in.facts);
    const std::size_t shown = std::min(nodes.size(), kNodesShown);
    fmt::print("\n{:<24} {:>9} {:>10}{}\n", "node", "polygons", "area m²",
               shown < nodes.size() ? fmt::format("  (the {} largest of {})", shown, nodes.size()) : "");
    for (std::size_t k = 0; k < shown; ++k)
        fmt::print("{:<24} {:>9} {:>10.4g}\n", column(in.read.scene.nodes[nodes[k]], 24),
                   in.facts.nodes[nodes[k]].polygons, in.facts.nodes[nodes[k]].area);
}

} // namespace

void printInfo(const InfoReportInput& in) {
    printSummary(in);
    printLightsAndCameras(in.read.scene);
    printMaterials(in);
    printNodes(in);
    if (!in.findings.empty()) fmt::print("\nworth a look\n");
    for (const Finding& finding : in.findings) fmt::print("  {}: {}\n", printable(finding.problem), finding.remedy);
}

} // namespace lambert
