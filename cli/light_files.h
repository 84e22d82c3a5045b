#pragma once

#include "baking/bake_scene.h"
#include "baking/write_baked.h"
#include "cli/bake_job.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <span>
#include <vector>

namespace lambert {

/// One group of lights on its own, and where it was written to.
struct WrittenLight {
    const BakedLight* light;
    std::vector<std::filesystem::path> files; //!< one per output
};

/// "room.glb" and a light named "ceiling lamp": "room.light-ceiling_lamp.glb". Whatever is not a letter, digit, "-" or part of a
/// longer character becomes "_".
std::filesystem::path lightFile(const std::filesystem::path& output, const std::string& light);

/// Writes BakedScene::lights beside each output. Names that would be one file are numbered. Throws UsageError if a file to be
/// written is one of `inputs`, SystemError.
std::vector<WrittenLight> writeLights(const BakedScene& baked, std::span<const BakeJob::Output> outputs,
                                      const BakeOutputOptions& options, std::span<const std::filesystem::path> inputs);

/// The "lights" of a report.
nlohmann::ordered_json lightsJson(std::span<const WrittenLight> lights);

} // namespace lambert
