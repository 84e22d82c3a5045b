#include "cli/bake_report.h"
#include "cli/commands.h"
#include "cli/formfactors_report.h"
#include "cli/overlap_text.h"
#include "cli/points_file.h"
#include "cli/scene_files.h"
#include "cli/targets.h"
#include "cli/terminal_progress.h"
#include "cli/terminal_text.h"

#include "core/parallel.h"
#include "core/process.h"
#include "core/stopwatch.h"
#include "core/whole_file.h"
#include "formfactors/matrix_file.h"
#include "lighting/factor_diagnosis.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

namespace lambert {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

struct FormFactorsArguments {
    SceneArguments scene;
    TransportArguments transport;
    RunArguments run;
    fs::path output;
    fs::path points;
    std::string groupBy;
    fs::path temperatures;
};

/// What is asked for, of three.
enum class Task { Matrix, Groups, Points };

Task taskOf(const FormFactorsArguments& a) {
    if (!a.points.empty()) return Task::Points;
    return a.groupBy.empty() ? Task::Matrix : Task::Groups;
}

/// Throws UsageError for what can be known to be wrong before the scene is read.
void check(const FormFactorsArguments& a) {
    const Task task = taskOf(a);
    if (task == Task::Points) {
        if (!a.groupBy.empty()) throw UsageError("--points: has no groups (--group-by)");
        if (const auto method = methodByName(a.transport.method.value_or("hemicube")); !hasPointRows(*method))
            throw UsageError(fmt::format("--points: the method {} has no factors from points; allowed are hemicube, "
                                         "hemisphere, local-lines and closed-form",
                                         nameOf(*method)));
        if (a.transport.repair || !a.transport.checkpoint.empty() || !a.transport.formFactors.empty())
            throw UsageError("--points: leave out --repair, --checkpoint and --form-factors, which are for patches");
        if (!a.output.empty() && matrixFormatOf(a.output) == MatrixFormat::View3D)
            throw UsageError(a.output.string() + ": View3D's format holds square matrices, not rows of points");
    }
    if (task == Task::Groups && !a.output.empty() && matrixFormatOf(a.output) != MatrixFormat::Csv)
        throw UsageError(fmt::format("-o: found \"{}\", the table of groups is written as .csv", a.output.string()));
    if (task == Task::Matrix && a.output.empty() && a.run.json.empty())
        throw UsageError("nothing to write: give -o MATRIX, --group-by, --points or --json FILE");
    if (task != Task::Groups && !a.output.empty()) checkMatrixFile(a.output, 0);
}

void checkFiles(const FormFactorsArguments& a) {
    std::vector<fs::path> inputs = inputFiles(a.scene);
    for (const fs::path& input : {a.points, a.temperatures, a.transport.formFactors})
        if (!input.empty()) inputs.push_back(input);
    std::vector<fs::path> targets{a.run.json, a.transport.checkpoint, a.output};
    if (!a.output.empty() && taskOf(a) == Task::Matrix) targets.push_back(matrixFiles(a.output, 0).back());
    if (!a.output.empty() && taskOf(a) == Task::Points) targets.push_back(pointRowFiles(a.output).back());
    checkTargets(targets, inputs);
}

/// One run of the command: what it found, on its way into files and the report.
struct Run {
    const FormFactorsArguments& a;
    const MatrixSource source;
    TerminalProgress& progress;
    ReadResult read{};
    MeshedScene scene{};
    std::string comment{}; //!< heads the files
    Json seconds = Json::object();
    Json report = Json::object();
    std::vector<std::string> warnings{};
    std::unique_ptr<MatrixCheckpoint> checkpoint{};
    ExitCode exitCode = ExitCode::Ok;

    void warn(const std::string& text) {
        warnings.push_back(text);
        warnLine(text);
    }
    void setComment(const std::string& method) {
        comment = printable(fmt::format("scene {}, {}, {} patches, lambert {}", a.scene.path.string(), method,
                                        scene.mesh.size(), LAMBERT_VERSION));
    }
};

void warnOfBacks(Run& run, double back) {
    if (back > 0.01)
        run.warn(
            fmt::format("{:.1f} % of the rays meet black back faces, `lambert info` names their materials: turn their "
                        "polygons, or make them two-sided (--two-sided)",
                        100.0 * back));
}

void readAndMesh(Run& run) {
    Stopwatch watch;
    run.read = readScene(run.a.scene, &run.progress);
    run.seconds["read"] = watch.lap();
    logReport(run.a.run, run.read.report);
    run.warnings = run.read.report.warnings;
    run.scene = meshScene(run.read.scene, meshOptions(run.a.transport), run.progress);
    const CoverReport& cover = run.scene.prepareReport.cover;
    if (const std::string overlaps = overlapText(*run.scene.scene, cover); !overlaps.empty()) {
        if (cover.takenAway)
            logLine(run.a.run, overlaps);
        else
            run.warn(overlaps);
    }
    run.seconds["mesh"] = watch.lap();
}

/// Rows of the points. Throws UsageError if the method has none.
void computePoints(Run& run) {
    Stopwatch watch;
    const std::vector<SensorPoint> sensors = readPoints(run.a.points);
    const std::vector<ProbePoint> points = pointsInScene(sensors, *run.scene.scene);
    // A few points are no matrix: only the largest effort of the preset bounds them.
    TransportOptions options = run.source.transport;
    options.mostRays = std::numeric_limits<double>::infinity();
    options.memoryLimit = std::numeric_limits<std::uint64_t>::max();
    const TransportPlan plan = planTransport(options, run.scene.mesh, *run.scene.rays, run.progress);
    const auto method = makeMethod(plan, run.scene.mesh, *run.scene.rays);
    FormFactorMatrix matrix(points.size(), options.storage.value_or(MatrixStorage::Float));
    std::vector<RowAccumulator> accumulators(static_cast<std::size_t>(threadCount()),
                                             RowAccumulator(run.scene.mesh.size()));
    // Rays must not meet the surface that their point lies on.
    const float offset = method->raysPerRow() > 0 ? run.scene.rays->originOffset(0.0F) : 0.0F;
    run.progress.begin("form factors", points.size());
    parallelFor(points.size(), 1, [&](std::size_t begin, std::size_t end, int worker) {
        FormFactorRow row;
        for (std::size_t k = begin; k < end; ++k) {
            const glm::vec3 normal = glm::normalize(points[k].normal);
            RowAccumulator& accumulator = accumulators[static_cast<std::size_t>(worker)];
            method->pointRow(points[k].position + offset * normal, normal, static_cast<std::uint32_t>(k), accumulator);
            accumulator.take(row);
            matrix.setRow(k, row);
        }
        run.progress.advance(end - begin);
    });
    run.progress.end();
    run.seconds["form_factors"] = watch.lap();

    run.setComment(plan.effort());
    std::string remainders = "# x,y,z,nx,ny,nz,F_back,F_out\n";
    for (std::size_t k = 0; k < points.size(); ++k) {
        const auto& [p, n] = sensors[k];
        remainders +=
            fmt::format("{},{},{},{},{},{},{},{}\n", p.x, p.y, p.z, n.x, n.y, n.z, matrix.back(k), matrix.out(k));
    }
    if (!run.a.output.empty())
        writePointRows(run.a.output, matrix, run.scene.mesh.size(), remainders, run.comment, run.progress);
    run.seconds["write"] = watch.lap();
    run.report = {{"method", nameOf(options.method)},
                  {"points", points.size()},
                  {"patches", run.scene.mesh.size()},
                  {"rays", method->raysPerRow() * points.size()},
                  {"entries", matrix.entryCount()}};
    run.report["options"] = matrixOptionsJson(run.source, plan);
    if (!run.a.run.quiet)
        fmt::print("{} points, {} patches, {}\n", points.size(), run.scene.mesh.size(), plan.effort());
}

/// What something stands on sees only the inside of that.
void leaveOutCovered(Run& run, const FormFactorMatrix& matrix, PatchGroups& groups) {
    double area = 0.0;
    for (std::size_t i = 0; i < groups.group.size(); ++i) {
        if (matrix.back(i) <= kCovered) continue;
        groups.group[i] = kNoGroup;
        area += static_cast<double>(run.scene.mesh.area[i]);
    }
    if (area > 0.0)
        logLine(run.a.run, fmt::format("{:.4g} m² lie inside other objects or under them and are in no group", area));
}

void warnOfLostHeat(Run& run, const std::optional<TransportPlan>& plan, const HeatFlow& heat, double lost) {
    double largest = std::abs(heat.environmentFlow);
    for (const double flow : heat.flow) largest = std::max(largest, std::abs(flow));
    if (std::abs(lost) <= kImbalanceTold * largest) return;
    run.warn(fmt::format("heat flow: before repair the flows sum to {:.3g} W, {:.2g} % of the largest one: {}", lost,
                         100.0 * std::abs(lost) / largest, causeAndRemedy(plan, false)));
}

void reportGroups(Run& run, const SceneMatrix& obtained, const PatchGroups& groups,
                  const std::optional<Temperatures>& temperatures) {
    const FormFactorMatrix& matrix = obtained.matrix;
    const std::vector<double>& deficit = obtained.deficit;
    const PatchMesh& mesh = run.scene.mesh;
    GroupReport report{
        groups, groupFactors(matrix, mesh.area, groups.group, groups.names.size()), temperatures, {}, {}};
    if (temperatures) {
        HeatFlowOptions options;
        options.environment = temperatures->environment;
        report.heat = solveHeatFlow(matrix, mesh.area, groups.group, temperatures->surfaces, options, run.progress);
        if (report.heat->residual > options.tolerance) {
            run.warn(fmt::format("heat flow: residual {:.2g} is above {:.2g} after {} iterations",
                                 report.heat->residual, options.tolerance, report.heat->iterations));
            run.exitCode = ExitCode::TargetMissed;
        }
        report.heatLostByFactors =
            std::inner_product(deficit.begin(), deficit.end(), report.heat->radiosity.begin(), 0.0);
        warnOfLostHeat(run, obtained.plan, *report.heat, *report.heatLostByFactors);
    }
    if (!run.a.output.empty()) writeWholeFile(run.a.output, groupCsv(report, run.comment));
    if (run.a.output.empty() || !run.a.run.quiet) fmt::print("{}", groupTable(report));
    run.report.update(groupJson(report));
}

std::string summaryOf(const MatrixQuality& q, std::size_t patches) {
    return fmt::format("{} patches, {} factors, {:.4g} MiB; {}row sums off by {:.2g} RMS, {:.2g} at most; reciprocity "
                       "error {:.2g}{}\n",
                       patches, q.entries, static_cast<double>(q.bytes) / 1048576.0,
                       q.largestError > 0.0 ? fmt::format("rows known to {:.2g} in the mean, {:.2g} at worst; ",
                                                          q.meanError, q.largestError)
                                            : std::string(),
                       q.closureRms, q.closureWorst, q.reciprocityRms,
                       q.comparedRows < patches ? fmt::format(" (of {} rows)", q.comparedRows) : "");
}

void computePatches(Run& run) {
    const FormFactorsArguments& a = run.a;
    const PatchMesh& mesh = run.scene.mesh;
    if (taskOf(a) == Task::Matrix && !a.output.empty()) checkMatrixFile(a.output, mesh.size());
    std::optional<PatchGroups> groups;
    std::optional<Temperatures> temperatures;
    if (taskOf(a) == Task::Groups)
        groups = groupPatches(run.scene, a.groupBy == "material" ? GroupBy::Material : GroupBy::Node);
    if (!a.temperatures.empty()) temperatures = readTemperatures(a.temperatures, groups->names);

    Stopwatch watch;
    SceneMatrix obtained =
        obtainMatrix(run.source, checkpointOptions(a.transport), mesh, *run.scene.rays, run.progress);
    run.seconds["form_factors"] = watch.lap();
    if (obtained.plan)
        logLine(a.run,
                fmt::format("{} patches, {}: {:.3g} rays, {:.1f} s", mesh.size(), obtained.plan->effort(),
                            static_cast<double>(obtained.plan->rays), run.seconds["form_factors"].get<double>()));
    if (obtained.repair) logLine(a.run, repairText(*obtained.repair));
    if (obtained.repair)
        for (const std::string& text : repairWarnings(obtained.plan, *obtained.repair)) run.warn(text);
    run.setComment(obtained.plan ? obtained.plan->effort() : "from " + a.transport.formFactors.string());
    const MatrixQuality quality = assessMatrix(obtained.matrix, mesh.area);
    warnOfBacks(run, quality.openBack);

    run.report = {{"method", obtained.plan ? nameOf(obtained.plan->options.method) : "file"},
                  {"patches", mesh.size()},
                  {"rays", obtained.plan ? obtained.plan->rays : 0}};
    run.report.update(qualityJson(quality));
    run.report["repair"] = repairJson(obtained.repair);
    run.report["options"] = matrixOptionsJson(run.source, obtained.plan);
    run.seconds["assess"] = watch.lap();
    if (groups) leaveOutCovered(run, obtained.matrix, *groups);
    if (groups) reportGroups(run, obtained, *groups, temperatures);
    if (!groups && !a.run.quiet) fmt::print("{}", summaryOf(quality, mesh.size()));
    if (!groups && !a.output.empty()) {
        run.progress.begin("write", 0);
        PatchMatrix patches{std::move(obtained.matrix), {mesh.area.begin(), mesh.area.end()}};
        for (const Rgb& rho : run.scene.optics.reflectance)
            patches.emissivity.push_back(
                1.0 - (static_cast<double>(rho.x) + static_cast<double>(rho.y) + static_cast<double>(rho.z)) / 3.0);
        writeMatrix(a.output, patches, run.comment, run.progress);
        run.progress.end();
    }
    run.seconds["write"] = watch.lap();
    if (obtained.checkpoint) {
        if (obtained.checkpoint->rows)
            run.report["resumed_rows"] = obtained.checkpoint->rows->restoredRows();
        else
            run.report["resumed_lines"] = obtained.checkpoint->restoredLines;
        run.checkpoint = std::move(obtained.checkpoint);
    }
}

void writeReport(Run& run, double seconds) {
    const FormFactorsArguments& a = run.a;
    Json options = sceneOptionsJson(a.scene, run.read.report.overrides);
    const double length = run.scene.meshReport.patchLength;
    options["patch_length"] = std::isfinite(length) ? Json(length) : Json(nullptr);
    options["whole_contacts"] = a.transport.wholeContacts;
    options["quality"] = a.transport.quality;
    options.update(run.report["options"]);
    options["threads"] = threadCount();
    run.seconds["total"] = seconds;
    Json report{{"scene", a.scene.path.string()}};
    run.report["options"] = options;
    report.update(run.report);
    report["peak_memory_bytes"] = peakMemoryBytes();
    report["seed"] = a.run.seed;
    report["version"] = LAMBERT_VERSION;
    report["seconds"] = run.seconds;
    report["warnings"] = run.warnings;
    writeJson(report, a.run.json);
}

ExitCode formFactors(const FormFactorsArguments& a) {
    check(a);
    MatrixSource source = matrixSource(a.transport, a.run);
    if (!source.transport.stored) throw UsageError("--storage none: is for solvers; form factors are a matrix");
    if (!a.temperatures.empty()) source.repair = true; // or flows do not add up
    checkFiles(a);
    setThreadCount(a.run.threads);
    TerminalProgress progress(a.run.quiet);
    const Stopwatch total;
    Run run{a, source, progress};
    readAndMesh(run);
    if (taskOf(a) == Task::Points)
        computePoints(run);
    else
        computePatches(run);
    if (!a.run.json.empty()) writeReport(run, total.seconds());
    if (run.checkpoint) run.checkpoint->remove();
    return run.exitCode;
}

} // namespace

void addFormFactorsCommand(CLI::App& program, CommandRun& run) {
    auto arguments = std::make_shared<FormFactorsArguments>();
    CLI::App& command =
        *program.add_subcommand("formfactors", "Form factors (view factors): matrix, groups, heat flow");
    addSceneArguments(command, arguments->scene);
    command.option_defaults()->group("Form factors");
    command
        .add_option(
            "-o,--output", arguments->output,
            "The matrix: .mtx (Matrix Market), .npy (NumPy), .csv or .txt (View3D); with --group-by the table as "
            ".csv")
        ->type_name("FILE");
    command
        .add_option("--form-factors", arguments->transport.formFactors,
                    "Reads the matrix from such a file instead of computing it")
        ->type_name("MATRIX");
    command
        .add_option("--points", arguments->points,
                    "Factors from points instead of patches, one row each; CSV with x,y,z,nx,ny,nz in metres")
        ->type_name("FILE");
    auto* groupBy = command
                        .add_option("--group-by", arguments->groupBy,
                                    "Sums factors and exchange areas over groups: material or node")
                        ->check(CLI::IsMember({"material", "node"}))
                        ->type_name("WHAT");
    command
        .add_option("--temperatures", arguments->temperatures,
                    "Net radiative heat of each group; CSV with group,kelvin,emissivity (kelvin or adiabatic), and "
                    "environment,kelvin; repairs the factors")
        ->needs(groupBy)
        ->type_name("FILE");
    addMeshArguments(command, arguments->transport);
    addFormFactorArguments(command, arguments->transport);
    addRunArguments(command, arguments->run);
    command.callback([arguments, &run] { run = [arguments] { return formFactors(*arguments); }; });
}

} // namespace lambert
