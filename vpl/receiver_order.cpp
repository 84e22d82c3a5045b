#include "vpl/receiver_order.h"

#include "core/box.h"

#include <glm/common.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace lambert {

namespace {

constexpr int kBits = 16;

/// A number below 2^21 with two zeros before each of its bits.
std::uint64_t spread(std::uint64_t bits) {
    bits = (bits | bits << 32) & 0x001F00000000FFFFULL;
    bits = (bits | bits << 16) & 0x001F0000FF0000FFULL;
    bits = (bits | bits << 8) & 0x100F00F00F00F00FULL;
    bits = (bits | bits << 4) & 0x10C30C30C30C30C3ULL;
    return (bits | bits << 2) & 0x1249249249249249ULL;
}

/// 0 to 5: the signed axis nearest to a direction.
std::uint64_t facing(const glm::vec3& normal) {
    const glm::vec3 size = glm::abs(normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return static_cast<std::uint64_t>(2 * axis + (normal[axis] < 0.0F ? 1 : 0));
}

} // namespace

std::vector<std::uint32_t> receiverOrder(std::span<const Receiver> receivers) {
    Box<glm::vec3> box;
    for (const Receiver& receiver : receivers) box.add(receiver.position);
    const glm::vec3 size = box.size();
    const float longest = std::max({size.x, size.y, size.z, std::numeric_limits<float>::min()});
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(receivers.size());
    for (std::uint32_t i = 0; i < keys.size(); ++i) {
        const glm::vec3 cell = ((1 << kBits) - 1) / longest * (receivers[i].position - box.lower);
        std::uint64_t key = facing(receivers[i].normal) << (3 * kBits);
        for (int axis = 0; axis < 3; ++axis) key |= spread(static_cast<std::uint64_t>(cell[axis])) << axis;
        keys[i] = {key, i};
    }
    std::sort(keys.begin(), keys.end());
    std::vector<std::uint32_t> order(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) order[i] = keys[i].second;
    return order;
}

} // namespace lambert
