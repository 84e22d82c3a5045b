#include "core/random.h"
#include "scene/example_scenes.h"
#include "scene/rays/ray_caster.h"

#include <gtest/gtest.h>

namespace lambert {
namespace {

glm::vec3 randomPoint(std::uint32_t index, float scale) {
    const auto bits = philox({index, 0, 0, 0}, 3);
    return scale * (2.0F * glm::vec3(uniformFloat(bits[0]), uniformFloat(bits[1]), uniformFloat(bits[2])));
}

// Rays between random points of a room with a box, at three scales. Half of the packets share their origin.
TEST(ShadowPacket, FindsWhatSingleRaysFind) {
    for (const float scale : {1e-6F, 1.0F, 1e6F}) {
        Scene scene = roomWithBoxScene();
        for (glm::vec3& position : scene.positions) position *= scale;
        const RayCaster rays(scene);
        int occluded = 0;
        for (std::uint32_t k = 0; k < 500; ++k) {
            ShadowPacket packet;
            std::array<Ray, 16> single;
            for (std::uint32_t lane = 0; lane < 16; ++lane) {
                const glm::vec3 origin = randomPoint(k % 2 == 0 ? 32 * k : 32 * k + 2 * lane, scale);
                const glm::vec3 direction = randomPoint(32 * k + 2 * lane + 1, scale) - origin;
                single[lane] = {origin, direction, 0.999F};
                packet.originX[lane] = origin.x;
                packet.originY[lane] = origin.y;
                packet.originZ[lane] = origin.z;
                packet.directionX[lane] = direction.x;
                packet.directionY[lane] = direction.y;
                packet.directionZ[lane] = direction.z;
                packet.maxDistance[lane] = 0.999F;
                packet.active[lane] = lane % 5 == 4 ? 0 : -1;
            }
            rays.occluded(packet);
            for (std::uint32_t lane = 0; lane < 16; ++lane) {
                const bool expected = lane % 5 != 4 && rays.occluded(single[lane]);
                ASSERT_EQ(packet.occluded[lane], expected) << k << " " << lane << " " << scale;
                occluded += expected ? 1 : 0;
            }
        }
        EXPECT_GT(occluded, 200); // the box is not small
    }
}

} // namespace
} // namespace lambert
