#pragma once

#include "scene/reading/scene_reader.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lambert {

/// Which scene, how it is read, and what is changed of it.
struct SceneArguments {
    std::filesystem::path path;
    std::optional<double> unit;
    bool twoSided = false;
    int curveSegments = ReadOptions{}.curveSegments;
    std::size_t mostPolygons = 0;         //!< see ReadOptions
    std::vector<std::string> emit;        //!< MATERIAL=r,g,b
    std::vector<std::string> reflectance; //!< MATERIAL=r,g,b
    std::vector<std::string> exclude;     //!< nodes
    std::vector<std::string> occludeOnly; //!< nodes
    std::filesystem::path overrides;      //!< empty: the file beside the scene, if there is one
    bool noOverrides = false;
    bool strict = false;
    bool allowOutsideFiles = false;
};

void addSceneArguments(CLI::App& command, SceneArguments& arguments);
void addSceneOptions(CLI::App& command, SceneArguments& arguments); ///< the same without the scene's path

/// Reads the scene and makes the changes that the overrides file and the options ask for; options win. What was changed
/// stands in the report. Throws InputError, UsageError, Cancelled.
ReadResult readScene(const SceneArguments& arguments, Progress* progress = nullptr);

/// Whether the lengths of the scene are settled: by an option, the overrides file, or because it is glTF.
bool unitIsGiven(const SceneArguments& arguments, const AppliedOverrides& overrides);

} // namespace lambert
