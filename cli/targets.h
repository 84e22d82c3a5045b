#pragma once

#include <filesystem>
#include <span>

namespace lambert {

/// To be called before any work. Throws UsageError if a target is one of the inputs or is named twice,
/// SystemError if it cannot be written. Empty paths are skipped.
void checkTargets(std::span<const std::filesystem::path> targets, std::span<const std::filesystem::path> inputs);

} // namespace lambert
