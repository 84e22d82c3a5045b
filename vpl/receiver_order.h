#pragma once

#include "vpl/receiver.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// The indices of receivers in an order in which neighbours follow each other and look the same way: rays from one point to
/// successive ones stay close together. By the axis nearest to the normal, then along a Morton curve of 2^16 cells per axis.
std::vector<std::uint32_t> receiverOrder(std::span<const Receiver> receivers);

} // namespace lambert
