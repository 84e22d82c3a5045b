#pragma once

#include "baking/bake_scene.h"
#include "baking/write_baked.h"
#include "cli/light_arguments.h"
#include "cli/scene_arguments.h"
#include "lighting/quality.h"
#include "picture/camera_rays.h"
#include "rendering/render.h"
#include "scene/reading.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lambert {

/// What the user typed, by topic. Every command adds the groups that apply to it.

struct TransportArguments {
    std::string quality = "normal";
    std::optional<double> patchLength;
    std::optional<std::size_t> patches;
    bool wholeContacts = false;
    double creaseAngle = 30.0; //!< degrees
    std::optional<double> gatherError;
    // Form factors; see cli/transport_arguments.cpp
    std::optional<std::string> method;
    std::optional<int> resolution, hemicubes;
    std::optional<std::string> rotation;
    std::optional<std::uint32_t> lines;
    std::optional<std::string> sampler, lineSet;
    std::optional<double> formFactorError;
    std::string storage = "auto";
    double memoryLimit = 8.0 * 1073741824.0;
    bool repair = false;
    std::filesystem::path formFactors; //!< a matrix file; empty: computed
    std::filesystem::path checkpoint;
    bool resume = false;
    double checkpointInterval = 60.0; //!< seconds
    LightArguments light;
    // Solution; see cli/solver_arguments.cpp
    std::optional<std::string> solver;
    std::optional<double> tolerance, relaxation;
    std::optional<double> rays; //!< of the solvers without form factors
    std::optional<double> targetError;
    int bounces = 0;
    bool keepBounces = false;
    std::filesystem::path warmStart; //!< a solution file; empty: none
    // Instant radiosity; see cli/vpl_arguments.cpp
    std::optional<std::uint32_t> vpls;
    std::optional<std::string> walk, clamp;
    bool compensate = false;
};

/// The --method that needs no form factors and no solver.
inline constexpr std::string_view kInstantRadiosity = "instant-radiosity";
bool usesVirtualLights(const TransportArguments& arguments);

struct RunArguments {
    std::uint64_t seed = 1;
    int threads = 0;
    std::filesystem::path json;
    bool quiet = false;
};

struct PictureArguments {
    std::filesystem::path path;
    std::string size = "512x512";
    std::string camera, eye, lookAt, up = "0,1,0";
    std::optional<double> fov;
    int samples = 4;
};

/// `patches`: what --help says of their number unless given.
void addMeshArguments(CLI::App& command, TransportArguments& arguments,
                      const std::string& patches = "theirs and a quarter or 5000 more");
/// `methods`: allowed with --method.
void addFormFactorArguments(CLI::App& command, TransportArguments& arguments,
                            const std::vector<std::string>& methods = methodNames());
void addSolverArguments(CLI::App& command, TransportArguments& arguments);
void addInstantRadiosityArguments(CLI::App& command, TransportArguments& arguments);
void addTransportArguments(CLI::App& command, TransportArguments& arguments); ///< all of these, a matrix file, creases
void addRunArguments(CLI::App& command, RunArguments& arguments);
void addCameraArguments(CLI::App& command, PictureArguments& arguments);  ///< size and camera
void addPictureArguments(CLI::App& command, PictureArguments& arguments); ///< and file and samples

/// The options that belong together, checked. Throw UsageError.
MeshOptions meshOptions(const TransportArguments& arguments);
MatrixSource matrixSource(const TransportArguments& arguments, const RunArguments& run);
/// For one of solverNames().
SolverOptions solverOptions(const TransportArguments& arguments);
/// For one of lineSolverNames(): throws UsageError also for options of form factors.
LineSolverOptions lineSolverOptions(const TransportArguments& arguments, const RunArguments& run);
/// For --method instant-radiosity: throws UsageError also for options of form factors and solvers.
InstantRadiosityOptions instantRadiosityOptions(const TransportArguments& arguments, const RunArguments& run);
/// The bound that --clamp gives, kUnbounded for none. Throws UsageError.
double geometricBound(const std::string& text);
/// For other methods: throws UsageError if an option of instant radiosity is given.
void refuseInstantRadiosity(const TransportArguments& arguments);
CheckpointOptions checkpointOptions(const TransportArguments& arguments);
SolveOptions solveOptions(const TransportArguments& arguments, const RunArguments& run);
ReconstructionOptions reconstructionOptions(const TransportArguments& arguments);
/// `error`: aimed at in normal quality unless told otherwise.
FinalGatherOptions gatherOptions(const TransportArguments& arguments, const RunArguments& run,
                                 double error = FinalGatherOptions{}.error);
inline constexpr double kProbeError = 0.003; //!< sensors are few

/// Appends the files, other than the scene's, that are read.
void addTransportInputs(const TransportArguments& arguments, std::vector<std::filesystem::path>& inputs);

/// For reports: the options in force, and what a repair had to change (null: none was asked for).
nlohmann::ordered_json matrixOptionsJson(const MatrixSource& source, const std::optional<TransportPlan>& plan);
nlohmann::ordered_json solverOptionsJson(const SolverOptions& options);
nlohmann::ordered_json lineSolverOptionsJson(const LineSolverOptions& options);
nlohmann::ordered_json instantRadiosityOptionsJson(const InstantRadiosityOptions& options);
std::string repairText(const RepairReport& repair); ///< one line
nlohmann::ordered_json repairJson(const std::optional<RepairReport>& repair);

struct Picture {
    std::filesystem::path path;
    PictureSize size;
    Camera camera;
};

/// The picture's size and camera: the named one, the one by --eye, the scene's first, or a default one.
Picture picture(const PictureArguments& arguments, const Scene& scene, const RayCaster& rays);

/// Rays that the picture takes; 0 without one. Throws UsageError.
double pictureRays(const PictureArguments& arguments);

/// Check what can be checked of a picture before any work, and once the scene is read. Throw UsageError.
void checkPicture(const PictureArguments& arguments);
void checkCamera(const PictureArguments& arguments, const Scene& scene);

/// "a,b,c" as a, b and c.
std::vector<std::string> separated(const std::string& text, char separator = ',');
/// "1,2.5,-3" as numbers, which are finite; nothing for any other text.
std::optional<std::vector<double>> numbersOf(const std::string& text, char separator = ',');
/// "x,y,z" as a vector. Throws UsageError that names the option.
glm::dvec3 parseVector(const std::string& text, const std::string& option);

/// Log lines on stderr, made printable; the first not under --quiet.
void logLine(const RunArguments& run, const std::string& line);
void warnLine(const std::string& line);

/// Logs what a scene was changed by, and its warnings.
void logReport(const RunArguments& run, const ReadReport& report);

} // namespace lambert
