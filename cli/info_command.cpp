#include "cli/arguments.h"
#include "cli/bake_report.h"
#include "cli/commands.h"
#include "cli/targets.h"
#include "cli/terminal_text.h"

#include "meshing/build_patch_mesh.h"
#include "meshing/prepare.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

namespace lambert {

namespace {

using Json = nlohmann::ordered_json;

struct InfoArguments {
    SceneArguments scene;
    RunArguments run;
};

/// What is worth knowing of a scene before it is baked.
struct SceneFacts {
    Bounds bounds;
    std::size_t triangles = 0, quads = 0;
    std::size_t slivers = 0; ///< height below 1e-4 of the longest edge
    std::vector<std::size_t> materialPolygons;
    std::vector<double> materialArea; ///< m²
    double area = 0.0;
    RgbSum emitted{0.0}; ///< watts or lumens, fronts and second sides
    PrepareReport prepared;
};

bool isSliver(const Scene& scene, const Polygon& polygon) {
    float longest = 0.0F;
    for (int k = 0; k < polygon.size(); ++k)
        longest = std::max(longest,
                           glm::distance(corner(scene, polygon, k), corner(scene, polygon, (k + 1) % polygon.size())));
    return 2.0F * glm::length(areaVector(scene, polygon)) < 1e-4F * longest * longest;
}

/// Watts or lumens of a prepared scene, textures and holes considered.
RgbSum emittedPower(const Scene& prepared) {
    Progress progress;
    MeshOptions options;
    options.patches = 0;
    const PatchMesh mesh = buildPatchMesh(prepared, options, progress);
    RgbSum sum(0.0);
    for (std::size_t i = 0; i < mesh.size(); ++i)
        sum += static_cast<double>(mesh.area[i]) * RgbSum(mesh.emittedRadiosity[i]);
    return sum;
}

SceneFacts gather(const Scene& scene) {
    SceneFacts facts;
    facts.bounds = boundsOf(scene);
    facts.materialPolygons.assign(scene.materials.size(), 0);
    facts.materialArea.assign(scene.materials.size(), 0.0);
    for (const Polygon& polygon : scene.polygons) {
        const auto area = static_cast<double>(glm::length(areaVector(scene, polygon)));
        ++(polygon.isQuad() ? facts.quads : facts.triangles);
        facts.slivers += isSliver(scene, polygon) ? 1 : 0;
        ++facts.materialPolygons[polygon.material];
        facts.materialArea[polygon.material] += area;
        facts.area += area;
    }
    facts.emitted = emittedPower(prepareScene(scene, {}, &facts.prepared));
    return facts;
}

void print(const InfoArguments& a, const ReadResult& read, const SceneFacts& facts) {
    const Scene& scene = read.scene;
    const ReadReport& report = read.report;
    const glm::vec3 size = facts.bounds.size();
    fmt::print("scene       {}\n", oneLine(a.scene.path.string()));
    fmt::print("size        {:.4g} × {:.4g} × {:.4g} m, from ({:.4g}, {:.4g}, {:.4g})\n", size.x, size.y, size.z,
               facts.bounds.lower.x, facts.bounds.lower.y, facts.bounds.lower.z);
    if (std::max({size.x, size.y, size.z}) > 200.0F && !a.scene.unit)
        fmt::print("            large for a room: if the file is in millimetres, use --unit 0.001\n");
    fmt::print("polygons    {} triangles, {} quads, {:.5g} m²; {} in the file\n", facts.triangles, facts.quads,
               facts.area, report.inputPolygons);
    fmt::print("dropped     {} non-finite, {} degenerate, {} less high than {:.2g} m (2e-6 of the diagonal)\n",
               report.nonFinitePolygons, report.degeneratePolygons, facts.prepared.collapsedPolygons,
               2.0F * weldTolerance(scene));
    fmt::print("changed     {} polygons split, {} vertices welded, {} triangle pairs joined\n", report.splitPolygons,
               facts.prepared.weldedVertices, facts.prepared.joinedPairs);
    fmt::print("coincident  {} duplicates (left out), {} back to back (two sides of one polygon)\n",
               facts.prepared.duplicatePolygons, facts.prepared.mergedSheets);
    fmt::print("slivers     {} polygons less high than 1/10000 of their longest edge\n", facts.slivers);
    fmt::print("emitted     {:.5g} {:.5g} {:.5g} (r g b, W or lm){}\n", facts.emitted.x, facts.emitted.y,
               facts.emitted.z, facts.emitted == RgbSum(0.0) ? ": no light; give one with --emit MATERIAL=r,g,b" : "");
    for (const Camera& camera : scene.cameras)
        fmt::print("camera      {}: eye ({:.4g}, {:.4g}, {:.4g}), {:.1f}° vertically\n", oneLine(camera.name),
                   camera.eye.x, camera.eye.y, camera.eye.z,
                   static_cast<double>(camera.verticalFov) * 180.0 / std::numbers::pi);
    fmt::print("\n{:<24} {:>9} {:>10}  {:<20} {:<20} sides\n", "material", "polygons", "area m²", "reflectance",
               "emitted radiance");
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        const Material& material = scene.materials[m];
        const auto rgb = [](const Rgb& c) { return fmt::format("{:.3g} {:.3g} {:.3g}", c.x, c.y, c.z); };
        fmt::print("{:<24} {:>9} {:>10.4g}  {:<20} {:<20} {}\n", oneLine(material.name), facts.materialPolygons[m],
                   facts.materialArea[m], rgb(material.reflectance), rgb(material.emittedRadiance),
                   material.twoSided ? 2 : 1);
    }
}

Json infoReport(const InfoArguments& a, const ReadResult& read, const SceneFacts& facts) {
    Json report;
    report["scene"] = a.scene.path.string();
    report["version"] = LAMBERT_VERSION;
    report["bounds"] = {{"lower", jsonVector(glm::dvec3(facts.bounds.lower))},
                        {"upper", jsonVector(glm::dvec3(facts.bounds.upper))}};
    report["triangles"] = facts.triangles;
    report["quads"] = facts.quads;
    report["area"] = facts.area;
    report["emitted"] = jsonVector(facts.emitted);
    report["input"] = {{"polygons", read.report.inputPolygons},
                       {"non_finite", read.report.nonFinitePolygons},
                       {"degenerate", read.report.degeneratePolygons},
                       {"split", read.report.splitPolygons},
                       {"collapsed", facts.prepared.collapsedPolygons},
                       {"joined_pairs", facts.prepared.joinedPairs},
                       {"welded_vertices", facts.prepared.weldedVertices},
                       {"duplicates", facts.prepared.duplicatePolygons},
                       {"merged_sheets", facts.prepared.mergedSheets},
                       {"slivers", facts.slivers}};
    report["materials"] = Json::array();
    for (std::size_t m = 0; m < read.scene.materials.size(); ++m) {
        const Material& material = read.scene.materials[m];
        report["materials"].push_back({{"name", material.name},
                                       {"polygons", facts.materialPolygons[m]},
                                       {"area", facts.materialArea[m]},
                                       {"reflectance", jsonVector(glm::dvec3(material.reflectance))},
                                       {"emitted_radiance", jsonVector(glm::dvec3(material.emittedRadiance))},
                                       {"two_sided", material.twoSided}});
    }
    report["cameras"] = Json::array();
    for (const Camera& camera : read.scene.cameras)
        report["cameras"].push_back({{"name", camera.name},
                                     {"eye", jsonVector(glm::dvec3(camera.eye))},
                                     {"direction", jsonVector(glm::dvec3(camera.direction))}});
    report["warnings"] = read.report.warnings;
    return report;
}

ExitCode info(const InfoArguments& a) {
    checkTargets(std::array{a.run.json}, filesOfScene(a.scene.path));
    const ReadResult read = readScene(a.scene);
    for (const std::string& warning : read.report.warnings) warnLine(oneLine(warning));
    const SceneFacts facts = gather(read.scene);
    if (!a.run.json.empty()) writeJson(infoReport(a, read, facts), a.run.json);
    if (!a.run.quiet) print(a, read, facts);
    return ExitCode::Ok;
}

} // namespace

void addInfoCommand(CLI::App& program, CommandRun& run) {
    auto arguments = std::make_shared<InfoArguments>();
    CLI::App& command = *program.add_subcommand("info", "Tells what is in a scene, and what looks wrong with it");
    addSceneArguments(command, arguments->scene);
    command.add_option("--json", arguments->run.json, "Writes the report as JSON")->type_name("FILE")->group("Run");
    command.add_flag("--quiet", arguments->run.quiet, "Only errors and warnings")->group("Run");
    command.callback([arguments, &run] { run = [arguments] { return info(*arguments); }; });
}

} // namespace lambert
