#pragma once

#include "scene/rays/ray_caster.h"
#include "vpl/receiver.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace lambert {

inline constexpr std::size_t kMostInBlock = 512; ///< receivers; with their sums they fit the first-level cache
inline constexpr int kLanes = ShadowPacket::kSize;
/// Cosines below this are taken for 0: between points of one plane they are rounding.
inline constexpr float kGrazing = 1e-5F;

/// What a block's receivers reflect toward their eyes.
struct ReceiverBlockGloss {
    std::array<glm::dvec3, kMostInBlock> axis; ///< the eye's direction, mirrored
    std::array<glm::dvec3, kMostInBlock>
        scale{}; ///< ρ_s / cosθ_eye; black for receivers without gloss, or seen from below
    std::array<double, kMostInBlock> exponent{};
    std::array<glm::dvec3, kMostInBlock> radiance{};

    /// Nothing if none of them has gloss.
    static std::unique_ptr<ReceiverBlockGloss> of(std::span<const Receiver> receivers,
                                                  std::span<const std::uint32_t> indices);
};

/// Neighbouring receivers, laid out for vector code and filled up to whole packets with ones that nothing reaches.
struct alignas(64) ReceiverBlock {
    float x[kMostInBlock], y[kMostInBlock], z[kMostInBlock];
    float normalX[kMostInBlock], normalY[kMostInBlock], normalZ[kMostInBlock];
    float endX[kMostInBlock], endY[kMostInBlock], endZ[kMostInBlock]; ///< of the shadow rays
    double red[kMostInBlock], green[kMostInBlock], blue[kMostInBlock];
    double cutRed[kMostInBlock], cutGreen[kMostInBlock], cutBlue[kMostInBlock];
    float term[kMostInBlock]; ///< G of the light at hand, without a bound; 0 where no light arrives
    std::uint16_t lit[kMostInBlock + 1];
    int size = 0;
    std::unique_ptr<ReceiverBlockGloss> gloss{}; ///< nothing if no receiver of the block has any

    void load(std::span<const Receiver> receivers, std::span<const std::uint32_t> indices) {
        gloss = ReceiverBlockGloss::of(receivers, indices);
        size = static_cast<int>((indices.size() + kLanes - 1) / kLanes) * kLanes;
        for (std::size_t i = 0; i < static_cast<std::size_t>(size); ++i) {
            const bool filled = i < indices.size();
            const Receiver& receiver = receivers[indices[filled ? i : 0]];
            const glm::vec3 normal = filled ? receiver.normal : glm::vec3(0.0F);
            const glm::vec3 end = receiver.position + receiver.lift * receiver.normal;
            x[i] = receiver.position.x;
            y[i] = receiver.position.y;
            z[i] = receiver.position.z;
            normalX[i] = normal.x;
            normalY[i] = normal.y;
            normalZ[i] = normal.z;
            endX[i] = end.x;
            endY[i] = end.y;
            endZ[i] = end.z;
            red[i] = green[i] = blue[i] = cutRed[i] = cutGreen[i] = cutBlue[i] = 0.0;
        }
    }
};

} // namespace lambert
