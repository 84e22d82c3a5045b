#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <vector>

namespace lambert {

/// To be called before any work. Throws UsageError if a target is one of the inputs or is named twice,
/// SystemError if it cannot be written. Empty paths are skipped.
void checkTargets(std::span<const std::filesystem::path> targets, std::span<const std::filesystem::path> inputs);

/// For ReadOptions::onFile: throws UsageError if a scene consists of one of the targets.
std::function<void(const std::filesystem::path&)> sparing(std::vector<std::filesystem::path> targets);

} // namespace lambert
