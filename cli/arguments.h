#pragma once

#include "baking/bake_scene.h"
#include "baking/write_baked.h"
#include "cli/scene_arguments.h"
#include "rendering/camera_rays.h"
#include "scene/scene_reader.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lambert {

/// What the user typed, by topic. Every command adds the groups that apply to it.

struct TransportArguments {
    std::string quality = "normal";
    std::optional<double> patchLength;
    std::optional<std::size_t> patches;
    bool wholeContacts = false;
    double creaseAngle = 30.0; //!< degrees
    std::string method = "hemicube";
    std::optional<int> resolution;
    std::string rotation = "random";
    double memoryLimit = 8.0 * 1073741824.0;
    std::string solver = "jacobi";
    std::optional<double> tolerance;
    int bounces = 0;
};

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

void addMeshArguments(CLI::App& command, TransportArguments& arguments);
void addTransportArguments(CLI::App& command, TransportArguments& arguments); ///< and those of the mesh
void addRunArguments(CLI::App& command, RunArguments& arguments);
void addCameraArguments(CLI::App& command, PictureArguments& arguments);  ///< size and camera
void addPictureArguments(CLI::App& command, PictureArguments& arguments); ///< and file and samples

/// Throws UsageError.
BakeOptions bakeOptions(const TransportArguments& arguments, const RunArguments& run);

struct Picture {
    std::filesystem::path path;
    int width = 0;
    int height = 0;
    Camera camera;
    int samples = 0;
};

/// The picture's size and camera: the named one, the one by --eye, the scene's first, or a default one.
Picture picture(const PictureArguments& arguments, const Scene& scene, const RayCaster& rays);

/// Rays that the picture takes; 0 without one. Throws UsageError.
double pictureRays(const PictureArguments& arguments);

/// Check what can be checked of a picture before any work, and once the scene is read. Throw UsageError.
void checkPicture(const PictureArguments& arguments);
void checkCamera(const PictureArguments& arguments, const Scene& scene);

/// "x,y,z" as a vector. Throws UsageError that names the option.
glm::vec3 parseVector(const std::string& text, const std::string& option);

/// Applies --threads.
void applyThreads(const RunArguments& run);

/// Log lines on stderr, unless --quiet.
void logLine(const RunArguments& run, const std::string& line);
void warnLine(const std::string& line);

/// Logs what a scene was changed by, and its warnings.
void logReport(const RunArguments& run, const ReadReport& report);

} // namespace lambert
