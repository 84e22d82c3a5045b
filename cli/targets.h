#pragma once

#include <filesystem>
#include <span>
#include <vector>

namespace lambert {

/// The files a scene is read from: itself and, of an OBJ, the material libraries it names and their images. Throws
/// InputError if an OBJ cannot be read.
std::vector<std::filesystem::path> filesOfScene(const std::filesystem::path& scene);

/// To be called before any work. Throws UsageError if a target is one of the inputs or is named twice,
/// SystemError if it cannot be written. Empty paths are skipped.
void checkTargets(std::span<const std::filesystem::path> targets, std::span<const std::filesystem::path> inputs);

} // namespace lambert
