#pragma once

#include "baking/bake_scene.h"
#include "baking/write_baked.h"
#include "cli/bake_arguments.h"
#include "cli/scene_log.h"
#include "core/error.h"
#include "core/progress.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lambert {

/// One scene and what its bake writes.
struct BakeJob {
    struct Output {
        std::filesystem::path path;
        BakedFormat format;
    };
    std::filesystem::path scene;
    std::vector<Output> outputs;
    std::filesystem::path image;    //!< or empty
    std::filesystem::path solution; //!< or empty
    std::filesystem::path log;      //!< or empty
};

/// How the job's scene is read.
SceneArguments sceneOf(const BakeArguments& arguments, const BakeJob& job);

/// The files with the light: an OBJ comes with an MTL, then the picture and the solution. The log is not among them.
std::vector<std::filesystem::path> resultFiles(const BakeJob& job);

/// What a job is computed from: the scene's files, and those that options name.
std::vector<std::filesystem::path> filesRead(const BakeArguments& arguments, const BakeJob& job);

/// Whether all result files are there and none is older than one of the files that the scene is read from.
bool isUpToDate(const BakeArguments& arguments, const BakeJob& job);

/// How one bake ended, or is predicted to end.
struct BakeOutcome {
    ExitCode exitCode = ExitCode::Ok;
    nlohmann::ordered_json report; //!< see docs/output.md
    std::string summary;           //!< of the light, for a person; several lines
    std::size_t patches = 0;
    std::uint64_t rays = 0;
    double seconds = 0.0;
    std::uint64_t peakMemory = 0;    //!< bytes
    std::optional<double> imbalance; //!< of the energy; that before repair if it is the worse one
};

/// What the arguments of a bake say, once and for all its jobs.
struct BakePlan {
    BakeOptions options;
    BakeOutputOptions output;      //!< but for an automatic exposure
    std::optional<float> exposure; //!< EV; none: automatic
};

/// Throws UsageError for what can be known to be wrong before a scene is read.
BakePlan planOf(const BakeArguments& arguments);

/// Reads, bakes, and writes the job's result files. Throws what these throw; then nothing, or not all, is written.
BakeOutcome bakeJob(const BakeArguments& arguments, const BakePlan& plan, const BakeJob& job, SceneLog& log,
                    Progress& progress);

/// Reads and meshes the scene and predicts the rest; writes nothing.
BakeOutcome predictJob(const BakeArguments& arguments, const BakePlan& plan, const BakeJob& job, SceneLog& log,
                       Progress& progress);

} // namespace lambert
