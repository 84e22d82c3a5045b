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
            {"width", picture.size.width},
            {"height", picture.size.height}};
}

Json optionsJson(const BakeReportInput& in) {
    const SolvedScene& solved = in.solved;
    Json options = sceneOptionsJson(in.scene, in.read.overrides);
    const double length = solved.meshReport.patchLength;
    options["patch_length"] = std::isfinite(length) ? Json(length) : Json(nullptr);
    options["whole_contacts"] = in.transport.wholeContacts;
    options["crease_angle"] = in.transport.creaseAngle;
    const bool gathers = in.baked == nullptr || in.baked->gather;
    options["reconstruction"] = gathers ? "gather" : "average";
    options["gather_error"] =
        gathers
            ? Json(gatherOptions(in.transport, in.run, in.baked != nullptr ? FinalGatherOptions{}.error : kProbeError)
                       .error)
            : Json(nullptr);
    const FormFactorsUsed* const used = solved.formFactors();
    options.update(methodOptionsJson(in.options.method, used != nullptr ? used->plan : std::nullopt));
    options.update(lightOptionsJson(in.transport.light, in.options.directLight));
    options["quality"] = in.transport.quality;
    if (const auto* factors = std::get_if<FormFactorLight>(&in.options.method))
        options.update(solverOptionsJson(factors->solver));
    options["warm_start"] = in.transport.warmStart.empty() ? Json(nullptr) : Json(in.transport.warmStart.string());
    options["threads"] = threadCount();
    return options;
}

Json inputJson(const BakeReportInput& in) {
    return {{"polygons", in.read.inputPolygons},
            {"non_finite", in.read.nonFinitePolygons},
            {"degenerate", in.read.degeneratePolygons},
            {"split", in.read.splitPolygons},
            {"collapsed", in.solved.prepareReport.collapsedPolygons},
            {"duplicates", in.solved.prepareReport.duplicatePolygons},
            {"merged_sheets", in.solved.prepareReport.mergedSheets},
            {"covered", in.solved.prepareReport.cover.coveredPolygons},
            {"cut_by_coplanar", in.solved.prepareReport.cover.cutPolygons},
            {"coplanar_overlaps", overlapsJson(*in.solved.scene, in.solved.prepareReport.cover)},
            {"edge_crossings", in.solved.prepareReport.edgeCrossings},
            {"joined_pairs", in.solved.prepareReport.joinedPairs}};
}

Json meshJson(const SolvedScene& solved, const BakedScene* baked) {
    Json json = {{"undivided_polygons", solved.meshReport.undividedPolygons},
                 {"undivided_area", solved.meshReport.undividedArea},
                 {"contact_polygons", solved.meshReport.contactPolygons},
                 {"ignored_contact_polygons", solved.meshReport.ignoredContactPolygons},
                 {"near_contact_polygons", solved.meshReport.nearContactPolygons},
                 {"near_contact_patches", solved.meshReport.nearContactPatches},
                 {"near_contact_budget", solved.meshReport.nearContactBudget},
                 {"degenerate_patches", solved.meshReport.degeneratePatches},
                 {"hidden_patches", std::count(solved.mesh.hidden.begin(), solved.mesh.hidden.end(), true)}};
    if (baked != nullptr) json["separated_faces"] = baked->separatedFaces;
    return json;
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

Json gatherJson(const GatherReport& gather) {
    return {{"vertices", gather.vertices},
            {"rays", gather.rays},
            {"relative_error", gather.error},
            {"largest_relative_error", gather.largestError}};
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

Json methodOptionsJson(const LightMethod& method, const std::optional<TransportPlan>& plan) {
    if (const auto* lights = std::get_if<InstantRadiosityOptions>(&method)) return instantRadiosityOptionsJson(*lights);
    if (const auto* lines = std::get_if<LineSolverOptions>(&method)) return lineSolverOptionsJson(*lines);
    return matrixOptionsJson(std::get<FormFactorLight>(method).formFactors, plan);
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

std::string methodName(const LightMethod& method, const SolvedScene& solved) {
    if (std::holds_alternative<std::monostate>(solved.account)) return "none";
    if (solved.instantRadiosity() != nullptr) return std::string(kInstantRadiosity);
    if (const auto* lines = std::get_if<LineSolverOptions>(&method))
        return lines->lines == RelaxationLines::Global ? "global-lines" : "local-lines";
    const auto& plan = solved.formFactors()->plan;
    return plan ? std::string(nameOf(plan->options.method)) : "file";
}

std::string solverName(const LightMethod& method) {
    if (const auto* factors = std::get_if<FormFactorLight>(&method)) return std::string(nameOf(factors->solver.method));
    const auto* lines = std::get_if<LineSolverOptions>(&method);
    return lines != nullptr ? std::string(nameOf(lines->solver)) : "none";
}

std::vector<MaterialLight> materialLight(const SolvedScene& solved) {
    const PatchMesh& mesh = solved.mesh;
    std::vector<MaterialLight> lights(solved.scene->materials.size());
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        MaterialLight& light = lights[mesh.material[i]];
        const auto area = static_cast<double>(mesh.area[i]);
        // A second side of the same material is no second face.
        if (!mesh.isBack(i) || solved.scene->polygons[mesh.polygon[i]].material != mesh.material[i]) light.area += area;
        light.meanIrradiance += area * solved.solution.irradiance[i];
        light.meanRadiosity += area * solved.solution.radiosity[i];
    }
    // What others cover in its plane has no patches and receives nothing; but the back of what is two-sided may still show.
    if (const CoverReport& cover = solved.prepareReport.cover; cover.takenAway)
        for (const CoplanarOverlap& overlap : cover.overlaps)
            if (!solved.scene->materials[overlap.lowerMaterial].twoSided ||
                overlap.lowerMaterial == overlap.upperMaterial)
                lights[overlap.lowerMaterial].area += overlap.area;
    std::vector<MaterialLight> used;
    for (std::size_t m = 0; m < lights.size(); ++m) {
        if (!(lights[m].area > 0.0)) continue;
        lights[m].name = solved.scene->materials[m].name;
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
    const SolvedScene& solved = in.solved;
    const FormFactorsUsed unused{};
    const FormFactorsUsed& rows = solved.formFactors() != nullptr ? *solved.formFactors() : unused;
    Json report;
    report["scene"] = in.scene.path.string();
    report["patches"] = solved.mesh.size();
    if (in.baked != nullptr) report["vertices"] = in.baked->baked.positions.size();
    report["method"] = methodName(in.options.method, solved);
    report["solver"] = solverName(in.options.method);
    report["iterations"] = solved.instantRadiosity() != nullptr ? Json(nullptr) : Json(solved.solution.iterations);
    report["residual"] = solved.instantRadiosity() != nullptr ? Json(nullptr) : Json(solved.solution.residual);
    report["history"] = historyJson(solved.solution);
    if (solved.stochastic() != nullptr) report["stochastic"] = stochasticJson(*solved.stochastic());
    if (solved.instantRadiosity() != nullptr)
        report["instant_radiosity"] = instantRadiosityJson(*solved.instantRadiosity());
    if (in.baked != nullptr && in.baked->gather) report["gather"] = gatherJson(*in.baked->gather);
    if (!solved.solution.bounces.empty()) report["bounces"] = bouncesJson(solved.mesh, solved.solution);
    report["rays"] = solved.rayCount;
    report["peak_memory_bytes"] = peakMemoryBytes();
    report["options"] = optionsJson(in);
    report["seed"] = in.run.seed;
    report["version"] = LAMBERT_VERSION;
    report["camera"] = in.picture ? cameraJson(*in.picture, *solved.scene) : Json(nullptr);
    report["exposure_ev"] = in.exposure ? Json(*in.exposure) : Json(nullptr);
    report["input"] = inputJson(in);
    report["mesh"] = meshJson(solved, in.baked);
    report["form_factors"] = {{"entries", rows.entries},
                              {"bytes", rows.bytes},
                              {"largest_closure_error", rows.largestClosureError},
                              {"mean_row_error", rows.meanError},
                              {"largest_row_error", rows.largestError},
                              {"back_face_fraction", solved.blackBacks.rays},
                              {"repair", repairJson(rows.repair)}};
    report["seconds"] = {{"read", in.readSeconds},
                         {"mesh", solved.seconds.mesh},
                         {"form_factors", solved.seconds.formFactors},
                         {"direct_light", solved.seconds.directLight},
                         {"solve", solved.seconds.solve},
                         {"bake", in.baked != nullptr ? in.baked->bakeSeconds : 0.0},
                         {"write", in.writeSeconds},
                         {"total", in.totalSeconds}};
    report["energy"] = energyJson(solved.solution.energy);
    report["energy"]["imbalance_before_repair"] =
        solved.energyCheck.beforeRepair ? Json(*solved.energyCheck.beforeRepair) : Json(nullptr);
    report["back_faces"] = backFacesJson(solved.blackBacks);
    Json materials = Json::array();
    for (const MaterialLight& light : materialLight(solved))
        materials.push_back({{"name", light.name},
                             {"area", light.area},
                             {"mean_irradiance", jsonVector(light.meanIrradiance)},
                             {"mean_radiosity", jsonVector(light.meanRadiosity)}});
    report["materials"] = materials;
    Json warnings = Json::array();
    for (const auto* list : {&in.read.warnings, &solved.warnings})
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
