#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// For every position the index of the position that stands for it: the first one (in order) that is no farther away
/// than `tolerance` (metres, > 0). A representative stands for itself. Non-finite positions are left alone.
std::vector<std::uint32_t> weldPositions(std::span<const glm::vec3> positions, float tolerance);

} // namespace lambert
