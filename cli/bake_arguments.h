#pragma once

#include "cli/arguments.h"

#include <filesystem>
#include <string>
#include <vector>

namespace lambert {

/// What was typed after `lambert bake`.
struct BakeArguments {
    std::vector<std::filesystem::path> scenes; //!< files and folders
    SceneArguments scene;                      //!< of each of them; its path stays empty
    TransportArguments transport;
    RunArguments run;
    PictureArguments picture;                   //!< with --output-dir, "{}" in its path stands for a scene's name
    std::vector<std::filesystem::path> outputs; //!< of the one scene
    std::filesystem::path outputDir;            //!< or empty
    std::filesystem::path solution;             //!< or empty; "{}" as in the picture's path
    std::string format;
    std::string reconstruction = "average";
    std::string quantity = "radiosity";
    std::string exposure = "auto";
    bool perLight = false;
    bool skipExisting = false;
    bool dryRun = false;
};

} // namespace lambert
