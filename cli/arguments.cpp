#include "cli/arguments.h"
#include "cli/terminal_text.h"
#include "cli/validators.h"

#include "core/error.h"
#include "picture/image.h"
#include "rendering/default_camera.h"
#include "scene/words.h"

#include <boost/algorithm/string/split.hpp>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lambert {

void addMeshArguments(CLI::App& command, TransportArguments& a, const std::string& patches) {
    command.option_defaults()->group("Mesh");
    command
        .add_option(
            "--quality", a.quality,
            "preview, normal or high: patches, resolution, rays to the sky and tolerance, unless given [normal]")
        ->check(CLI::IsMember({"preview", "normal", "high"}));
    auto* length = command.add_option("--patch-length", a.patchLength, "Longest edge of a patch")->type_name("METRES");
    addNumber(command, "--patches", a.patches,
              fmt::format("About so many patches; 0 keeps the input's polygons [{}]", patches), "N", 0.0, 2e8)
        ->excludes(length);
    command.add_flag("--whole-contacts", a.wholeContacts,
                     "Do not divide surfaces along the outlines of what stands on them or hovers over them");
}

void addTransportArguments(CLI::App& command, TransportArguments& a) {
    addMeshArguments(command, a);
    std::vector<std::string> methods = methodNames();
    methods.emplace_back(kInstantRadiosity);
    addFormFactorArguments(command, a, methods);
    command
        .add_option(
            "--form-factors", a.formFactors,
            "Takes the form factors from a file that `lambert formfactors` or another program wrote for this mesh")
        ->type_name("MATRIX")
        ->group("Transport");
    addNumber(command, "--crease-angle", a.creaseAngle, "Light is not averaged across sharper edges [30]", "DEGREES",
              0.0, 180.0)
        ->group("Solution");
    addNumber(
        command, "--gather-error", a.gatherError,
        "Aimed at where light is gathered: standard error at a point, relative to its light, 1e-4 to 1 [0.01; probe: "
        "0.003; half with --quality high]",
        "E", 1e-4, 1.0)
        ->group("Solution");
    addLightArguments(command, a.light);
    addSolverArguments(command, a);
    addInstantRadiosityArguments(command, a);
}

void addRunArguments(CLI::App& command, RunArguments& a) {
    command.option_defaults()->group("Run");
    addNumber(command, "--seed", a.seed, "Of all random numbers [1]", "S", 0.0, 18446744073709551615.0);
    addNumber(command, "--threads", a.threads, "0: one per processor [0]", "N", 0, 1024);
    command.add_option("--json", a.json, "Writes the report as JSON")->type_name("FILE");
    command.add_flag("--quiet", a.quiet, "Only errors and warnings");
}

void addPictureArguments(CLI::App& command, PictureArguments& a) {
    command.option_defaults()->group("Picture");
    command.add_option("--image", a.path, "Renders the baked mesh: linear .exr or tone-mapped .png")->type_name("FILE");
    addCameraArguments(command, a);
    command.add_option("--samples", a.samples, "Rays per pixel along each axis, 1 to 64 [4]")->check(between(1, 64));
}

void addCameraArguments(CLI::App& command, PictureArguments& a) {
    command.option_defaults()->group("Picture");
    command.add_option("--size", a.size, "[512x512]")->type_name("WxH");
    auto* camera = command.add_option("--camera", a.camera, "A camera of the scene, by name")->type_name("NAME");
    auto* eye = command.add_option("--eye", a.eye, "Where a camera of one's own stands, in metres")
                    ->type_name("x,y,z")
                    ->excludes(camera);
    auto* lookAt = command.add_option("--look-at", a.lookAt, "What it looks at")->type_name("x,y,z")->needs(eye);
    eye->needs(lookAt);
    command.add_option("--up", a.up, "[0,1,0]")->type_name("x,y,z")->needs(eye);
    command.add_option("--fov", a.fov, "Vertical field of view [45]")->type_name("DEGREES")->needs(eye);
}

std::vector<std::string> separated(const std::string& text, char separator) {
    std::vector<std::string> parts;
    boost::split(parts, text, [=](char c) { return c == separator; });
    return parts;
}

std::optional<std::vector<double>> numbersOf(const std::string& text, char separator) {
    std::vector<double> numbers;
    for (const std::string& part : separated(text, separator)) {
        const auto number = parseNumber(part);
        if (!number || !std::isfinite(*number)) return std::nullopt;
        numbers.push_back(*number);
    }
    return numbers;
}

glm::dvec3 parseVector(const std::string& text, const std::string& option) {
    const auto numbers = numbersOf(text);
    if (!numbers || numbers->size() != 3)
        throw UsageError(fmt::format("{}: found \"{}\", expected three numbers like 1,2.5,-3", option, text));
    return {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

MeshOptions meshOptions(const TransportArguments& a) {
    MeshOptions options;
    options.patchLength = a.patchLength;
    options.refinement = qualityOf(a.quality).refinement;
    if (a.patchLength && !(*a.patchLength > 0.0))
        throw UsageError(fmt::format("--patch-length: found {}, allowed is a number above 0", *a.patchLength));
    options.patches = a.patches;
    options.splitContacts = !a.wholeContacts;
    return options;
}

CheckpointOptions checkpointOptions(const TransportArguments& a) {
    return {a.checkpoint, a.resume, a.checkpointInterval, LAMBERT_VERSION};
}

SolveOptions solveOptions(const TransportArguments& a, const RunArguments& run) {
    SolveOptions options;
    options.mesh = meshOptions(a);
    checkLights(a.light);
    options.directLight = {
        .points = a.light.points, .skyRays = a.light.skyRays.value_or(qualityOf(a.quality).skyRays), .seed = run.seed};
    options.checkpoint = checkpointOptions(a);
    if (usesVirtualLights(a)) {
        options.method = instantRadiosityOptions(a, run);
        return options;
    }
    refuseInstantRadiosity(a);
    if (a.solver && lineSolverByName(*a.solver))
        options.method = lineSolverOptions(a, run);
    else
        options.method = FormFactorLight{matrixSource(a, run), solverOptions(a), a.warmStart};
    return options;
}

ReconstructionOptions reconstructionOptions(const TransportArguments& a) {
    return {.creaseAngle = static_cast<float>(a.creaseAngle * std::numbers::pi / 180.0),
            .keepHidden = a.patches == std::size_t{0}}; // the caller's mesh
}

FinalGatherOptions gatherOptions(const TransportArguments& a, const RunArguments& run, double error) {
    return {.error = a.gatherError.value_or(qualityOf(a.quality).gatherErrors * error), .seed = run.seed};
}

namespace {

std::array<int, 2> parseSize(const std::string& text) {
    const auto size = numbersOf(text, 'x');
    const auto allowed = [](double pixels) {
        return pixels >= 1.0 && pixels <= 32768.0 && pixels == std::floor(pixels);
    };
    if (!size || size->size() != 2 || !std::all_of(size->begin(), size->end(), allowed))
        throw UsageError(fmt::format("--size: found \"{}\", expected WIDTHxHEIGHT, each from 1 to 32768", text));
    return {static_cast<int>((*size)[0]), static_cast<int>((*size)[1])};
}

const Camera& namedCamera(const std::string& name, const Scene& scene) {
    const auto it = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                 [&](const Camera& camera) { return camera.name == name; });
    if (it != scene.cameras.end()) return *it;
    std::vector<std::string> names;
    for (const Camera& camera : scene.cameras) names.push_back(camera.name);
    throw UsageError(fmt::format("--camera: the scene has no camera \"{}\"{}{}", name,
                                 names.empty() ? " and no other" : ", but ", fmt::join(names, ", ")));
}

/// The camera of --eye, whose places are the file's, in a scene with this origin.
Camera typedCamera(const PictureArguments& a, const glm::dvec3& origin) {
    const auto place = [&](const std::string& text, const char* option) {
        return glm::vec3(parseVector(text, option) - origin);
    };
    return lookAtCamera(place(a.eye, "--eye"), place(a.lookAt, "--look-at"), glm::vec3(parseVector(a.up, "--up")),
                        static_cast<float>(a.fov.value_or(45.0)));
}

} // namespace

void checkCamera(const PictureArguments& a, const Scene& scene) {
    if (!a.path.empty() && !a.camera.empty()) namedCamera(a.camera, scene);
}

double pictureRays(const PictureArguments& a) {
    if (a.path.empty()) return 0.0;
    const auto [width, height] = parseSize(a.size);
    return static_cast<double>(width) * height * a.samples * a.samples;
}

void checkPicture(const PictureArguments& a) {
    if (a.path.empty()) return;
    imageFormatOf(a.path);
    parseSize(a.size);
    if (a.eye.empty()) return;
    // The scene's origin is not known yet, and far from it single precision might not tell the two places apart.
    const glm::dvec3 eye = parseVector(a.eye, "--eye"), lookAt = parseVector(a.lookAt, "--look-at");
    const double apart = glm::distance(eye, lookAt);
    const bool farAway = apart > 0.0 && apart < 1e-3 * glm::length(eye);
    typedCamera(a, farAway ? eye : glm::dvec3(0.0));
}

Picture picture(const PictureArguments& a, const Scene& scene, const RayCaster& rays) {
    const auto [width, height] = parseSize(a.size);
    Picture result{a.path, {width, height, a.samples}, {}};
    if (!a.eye.empty()) {
        result.camera = typedCamera(a, scene.origin);
    } else if (!a.camera.empty()) {
        result.camera = namedCamera(a.camera, scene);
    } else if (!scene.cameras.empty()) {
        result.camera = scene.cameras.front();
    } else {
        result.camera = defaultCamera(scene, rays, static_cast<float>(width) / static_cast<float>(height));
    }
    return result;
}

void logLine(const RunArguments& run, const std::string& line) {
    if (!run.quiet) writeLog(printable(line) + "\n");
}

void warnLine(const std::string& line) { writeLog("warning: " + printable(line) + "\n"); }

void logReport(const RunArguments& run, const ReadReport& report) {
    if (!report.overrides.file.empty())
        logLine(run, fmt::format("{}: changes the scene (--no-overrides ignores it)", report.overrides.file.string()));
    for (const std::string& warning : report.warnings) warnLine(warning);
}

} // namespace lambert
