#include "cli/bake_report.h"

#include "cli/overlap_text.h"
#include "core/parallel.h"
#include "core/process.h"
#include "core/whole_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lambert {

using Json = nlohmann::ordered_json;

namespace {

Json cameraJson(const Picture& picture, const Scene& scene) {
    const Camera& camera = picture.camera;
    return {{"name", camera.name},
            {"eye", jsonVector(placeInFile(scene, camera.eye))},
            {"direction", jsonVector(glm::dvec3(camera.direction))},
            {"up", jsonVector(glm::dvec3(camera.up))},
            {"vertical_fov_degrees", static_cast<double>(camera.verticalFov) * 180.0 / std::numbers::pi},
            {"width", picture.width},
            {"height", picture.height}};
}

Json optionsJson(const BakeReportInput& in) {
    const BakedScene& baked = in.baked;
    Json options = sceneOptionsJson(in.scene, in.read.overrides);
    const double length = baked.meshReport.patchLength;
    options["patch_length"] = std::isfinite(length) ? Json(length) : Json(nullptr);
    options["whole_contacts"] = in.transport.wholeContacts;
    options["crease_angle"] = in.transport.creaseAngle;
    const BakeOptions inForce = bakeOptions(in.transport, in.run);
    options.update(methodOptionsJson(inForce, baked.plan));
    options.update(lightOptionsJson(in.transport.light, inForce.directLight));
    options["quality"] = in.transport.quality;
    if (!baked.stochastic && !baked.instantRadiosity) options.update(solverOptionsJson(solverOptions(in.transport)));
    options["warm_start"] = in.transport.warmStart.empty() ? Json(nullptr) : Json(in.transport.warmStart.string());
    options["threads"] = threadCount();
    return options;
}

Json inputJson(const BakeReportInput& in) {
    return {{"polygons", in.read.inputPolygons},
            {"non_finite", in.read.nonFinitePolygons},
            {"degenerate", in.read.degeneratePolygons},
            {"split", in.read.splitPolygons},
            {"collapsed", in.baked.prepareReport.collapsedPolygons},
            {"duplicates", in.baked.prepareReport.duplicatePolygons},
            {"merged_sheets", in.baked.prepareReport.mergedSheets},
            {"covered", in.baked.prepareReport.cover.coveredPolygons},
            {"cut_by_coplanar", in.baked.prepareReport.cover.cutPolygons},
            {"coplanar_overlaps", overlapsJson(*in.baked.scene, in.baked.prepareReport.cover)},
            {"edge_crossings", in.baked.prepareReport.edgeCrossings},
            {"joined_pairs", in.baked.prepareReport.joinedPairs}};
}

Json meshJson(const BakedScene& baked) {
    return {{"undivided_polygons", baked.meshReport.undividedPolygons},
            {"undivided_area", baked.meshReport.undividedArea},
            {"contact_polygons", baked.meshReport.contactPolygons},
            {"ignored_contact_polygons", baked.meshReport.ignoredContactPolygons},
            {"near_contact_polygons", baked.meshReport.nearContactPolygons},
            {"near_contact_patches", baked.meshReport.nearContactPatches},
            {"near_contact_budget", baked.meshReport.nearContactBudget},
            {"degenerate_patches", baked.meshReport.degeneratePatches},
            {"hidden_patches", std::count(baked.mesh.hidden.begin(), baked.mesh.hidden.end(), true)},
            {"separated_faces", baked.separatedFaces}};
}

Json historyJson(const RadiositySolution& solution) {
    Json history = Json::array();
    for (const SolverStep& step : solution.history)
        history.push_back({{"iteration", step.iteration}, {"residual", step.residual}, {"seconds", step.seconds}});
    return history;
}

Json stochasticJson(const StochasticSolution& solution) {
    return {{"relative_error", solution.relativeError},
            {"upper_relative_error", solution.upperRelativeError},
            {"target_reached", solution.targetReached},
            {"sub_runs", solution.subRuns},
            {"unshot", solution.unshot},
            {"imbalance_error", solution.imbalanceError}};
}

Json instantRadiosityJson(const InstantRadiosity& light) {
    return {
        {"vpls", light.lights},           {"particles", light.particles}, {"points_per_patch", light.points},
        {"lost", jsonVector(light.lost)}, {"cut", jsonVector(light.cut)}, {"recovered", jsonVector(light.recovered)}};
}

Json bouncesJson(const PatchMesh& mesh, const RadiositySolution& solution) {
    Json bounces = Json::array();
    for (const std::vector<Rgb>& bounce : solution.bounces) {
        RgbSum flux(0.0);
        for (std::size_t i = 0; i < bounce.size(); ++i) flux += static_cast<double>(mesh.area[i]) * RgbSum(bounce[i]);
        bounces.push_back({{"reflected", jsonVector(flux)}});
    }
    return bounces;
}

Json backFacesJson(const BlackBacks& backs) {
    return {{"rays", backs.rays},
            {"light", backs.light},
            {"emission", backs.emission},
            {"material", backs.material.empty() ? Json(nullptr) : Json(backs.material)}};
}

} // namespace

Json methodOptionsJson(const BakeOptions& options, const std::optional<TransportPlan>& plan) {
    if (options.instantRadiosity) return instantRadiosityOptionsJson(*options.instantRadiosity);
    if (usesLines(options.solver.method)) return lineSolverOptionsJson(options.lineSolver);
    return matrixOptionsJson(options.formFactors, plan);
}

Json sceneOptionsJson(const SceneArguments& scene, const AppliedOverrides& overrides) {
    Json emit = Json::array(), reflectance = Json::array(), twoSided = Json::object();
    const auto setting = [](const std::string& name, const Rgb& c) {
        return fmt::format("{}={},{},{}", name, c.x, c.y, c.z);
    };
    for (const MaterialOverride& change : overrides.changes.materials) {
        if (change.emittedRadiance) emit.push_back(setting(change.name, *change.emittedRadiance));
        if (change.reflectance) reflectance.push_back(setting(change.name, *change.reflectance));
        if (change.twoSided) twoSided[change.name] = *change.twoSided;
    }
    Json exclude = Json::array(), occludeOnly = Json::array();
    for (const NodeOverride& change : overrides.changes.nodes)
        (change.treatment == NodeOverride::Treatment::Exclude ? exclude : occludeOnly).push_back(change.name);
    return {{"unit", overrides.metresPerUnit},
            {"two_sided", overrides.twoSided},
            {"two_sided_materials", twoSided},
            {"emit", emit},
            {"reflectance", reflectance},
            {"exclude", exclude},
            {"occlude_only", occludeOnly},
            {"overrides", overrides.file.empty() ? Json(nullptr) : Json(overrides.file.string())},
            {"strict", scene.strict},
            {"allow_outside_files", scene.allowOutsideFiles}};
}

Json jsonVector(const glm::dvec3& v) { return Json::array({v.x, v.y, v.z}); }

std::string methodName(const BakedScene& baked, const TransportArguments& transport) {
    if (baked.instantRadiosity) return std::string(kInstantRadiosity);
    if (baked.stochastic) return transport.method.value_or("local-lines");
    if (baked.plan) return std::string(nameOf(baked.plan->options.method));
    return transport.formFactors.empty() ? "none" : "file"; // none: there was no light to follow
}

std::string solverName(const BakedScene& baked, const TransportArguments& transport) {
    return baked.instantRadiosity ? "none" : std::string(nameOf(solverOptions(transport).method));
}

std::vector<MaterialLight> materialLight(const BakedScene& baked) {
    const PatchMesh& mesh = baked.mesh;
    std::vector<MaterialLight> lights(baked.scene->materials.size());
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        MaterialLight& light = lights[mesh.material[i]];
        const auto area = static_cast<double>(mesh.area[i]);
        // A second side of the same material is no second face.
        if (!mesh.isBack(i) || baked.scene->polygons[mesh.polygon[i]].material != mesh.material[i]) light.area += area;
        light.meanIrradiance += area * baked.solution.irradiance[i];
        light.meanRadiosity += area * baked.solution.radiosity[i];
    }
    // What others cover in its plane has no patches and receives nothing; but the back of what is two-sided may still show.
    if (const CoverReport& cover = baked.prepareReport.cover; cover.takenAway)
        for (const CoplanarOverlap& overlap : cover.overlaps)
            if (!baked.scene->materials[overlap.lowerMaterial].twoSided ||
                overlap.lowerMaterial == overlap.upperMaterial)
                lights[overlap.lowerMaterial].area += overlap.area;
    std::vector<MaterialLight> used;
    for (std::size_t m = 0; m < lights.size(); ++m) {
        if (!(lights[m].area > 0.0)) continue;
        lights[m].name = baked.scene->materials[m].name;
        lights[m].meanIrradiance /= lights[m].area;
        lights[m].meanRadiosity /= lights[m].area;
        used.push_back(lights[m]);
    }
    return used;
}

Json energyJson(const EnergyBalance& energy) {
    return {{"emitted", jsonVector(energy.emitted)},   {"received", jsonVector(energy.received)},
            {"absorbed", jsonVector(energy.absorbed)}, {"back_faces", jsonVector(energy.backFaces)},
            {"escaped", jsonVector(energy.escaped)},   {"imbalance", energy.imbalance()}};
}

Json bakeReport(const BakeReportInput& in) {
    const BakedScene& baked = in.baked;
    Json report;
    report["scene"] = in.scene.path.string();
    report["patches"] = baked.mesh.size();
    report["vertices"] = baked.baked.positions.size();
    report["method"] = methodName(baked, in.transport);
    report["solver"] = solverName(baked, in.transport);
    report["iterations"] = baked.instantRadiosity ? Json(nullptr) : Json(baked.solution.iterations);
    report["residual"] = baked.instantRadiosity ? Json(nullptr) : Json(baked.solution.residual);
    report["history"] = historyJson(baked.solution);
    if (baked.stochastic) report["stochastic"] = stochasticJson(*baked.stochastic);
    if (baked.instantRadiosity) report["instant_radiosity"] = instantRadiosityJson(*baked.instantRadiosity);
    if (!baked.solution.bounces.empty()) report["bounces"] = bouncesJson(baked.mesh, baked.solution);
    report["rays"] = baked.rayCount;
    report["peak_memory_bytes"] = peakMemoryBytes();
    report["options"] = optionsJson(in);
    report["seed"] = in.run.seed;
    report["version"] = LAMBERT_VERSION;
    report["camera"] = in.picture ? cameraJson(*in.picture, *baked.scene) : Json(nullptr);
    report["exposure_ev"] = in.exposure ? Json(*in.exposure) : Json(nullptr);
    report["input"] = inputJson(in);
    report["mesh"] = meshJson(baked);
    report["form_factors"] = {{"entries", baked.rows.entries},
                              {"bytes", baked.rows.bytes},
                              {"largest_closure_error", baked.rows.largestClosureError},
                              {"mean_row_error", baked.rows.meanError},
                              {"largest_row_error", baked.rows.largestError},
                              {"back_face_fraction", baked.blackBacks.rays},
                              {"repair", repairJson(baked.repair)}};
    report["seconds"] = {{"read", in.readSeconds},
                         {"mesh", baked.seconds.mesh},
                         {"form_factors", baked.seconds.formFactors},
                         {"direct_light", baked.seconds.directLight},
                         {"solve", baked.seconds.solve},
                         {"bake", baked.seconds.bake},
                         {"write", in.writeSeconds},
                         {"total", in.totalSeconds}};
    report["energy"] = energyJson(baked.solution.energy);
    report["energy"]["imbalance_before_repair"] =
        baked.energyCheck.beforeRepair ? Json(*baked.energyCheck.beforeRepair) : Json(nullptr);
    report["back_faces"] = backFacesJson(baked.blackBacks);
    Json materials = Json::array();
    for (const MaterialLight& light : materialLight(baked))
        materials.push_back({{"name", light.name},
                             {"area", light.area},
                             {"mean_irradiance", jsonVector(light.meanIrradiance)},
                             {"mean_radiosity", jsonVector(light.meanRadiosity)}});
    report["materials"] = materials;
    Json warnings = Json::array();
    for (const auto* list : {&in.read.warnings, &baked.warnings})
        for (const std::string& warning : *list) warnings.push_back(warning);
    report["warnings"] = warnings;
    return report;
}

std::string jsonText(const Json& json) {
    // Names in files need not be UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void writeJson(const Json& json, const std::filesystem::path& path) { writeWholeFile(path, jsonText(json)); }

} // namespace lambert
