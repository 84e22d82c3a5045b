#include "scene/example_scenes.h"
#include "scene/rays/line_caster.h"
#include "scene/rays/ray_caster.h"

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <vector>

namespace lambert {
namespace {

/// Rays that start in a unit box, all but one of whose coordinates are finite: Embree would abort the program.
std::vector<Ray> raysThatAreNotFinite() {
    std::vector<Ray> rays;
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity()})
        for (int axis = 0; axis < 3; ++axis)
            for (const bool origin : {true, false}) {
                Ray ray{glm::vec3(0.5F), {0.6F, 0.48F, 0.64F}};
                (origin ? ray.origin : ray.direction)[axis] = bad;
                rays.push_back(ray);
            }
    return rays;
}

Scene closedBox() {
    const Material wall = greyMaterial("wall", 0.5F, 0.0F);
    return boxScene(glm::vec3(1.0F), {wall, wall, wall, wall, wall, wall});
}

class NotFinite : public testing::Test {
protected:
    /// The ray in the lane, sound ones in all others.
    Ray rayOf(const Ray& bad, std::uint32_t lane, std::uint32_t badLane) const {
        return lane == badLane ? bad : Ray{glm::vec3(0.5F), {0.6F, 0.48F, 0.64F}};
    }
    Scene scene_ = closedBox();
};

TEST_F(NotFinite, RaysMeetNothing) {
    const RayCaster rays(scene_);
    for (const Ray& ray : raysThatAreNotFinite()) {
        EXPECT_FALSE(rays.closest(ray));
        EXPECT_FALSE(rays.occluded(ray));
    }
    EXPECT_FALSE(rays.closest({glm::vec3(0.5F), {std::numeric_limits<float>::max(), 0.0F, 0.0F}}));
}

TEST_F(NotFinite, RaysOfPacketsMeetNothingAndLeaveTheOthersAlone) {
    const RayCaster rays(scene_);
    for (const Ray& bad : raysThatAreNotFinite())
        for (const std::uint32_t badLane : {0U, 6U, 15U})
            for (const Coherence coherence : {Coherence::High, Coherence::Low}) {
                RayPacket packet;
                ShadowPacket shadow;
                RayOrigins origins;
                for (std::uint32_t lane = 0; lane < 16; ++lane) {
                    const Ray ray = rayOf(bad, lane, badLane);
                    shadow.originX[lane] = origins.x[lane] = ray.origin.x;
                    shadow.originY[lane] = origins.y[lane] = ray.origin.y;
                    shadow.originZ[lane] = origins.z[lane] = ray.origin.z;
                    shadow.directionX[lane] = packet.directionX[lane] = ray.direction.x;
                    shadow.directionY[lane] = packet.directionY[lane] = ray.direction.y;
                    shadow.directionZ[lane] = packet.directionZ[lane] = ray.direction.z;
                    shadow.maxDistance[lane] = 10.0F;
                    shadow.active[lane] = packet.active[lane] = -1;
                }
                rays.closest(origins, packet, coherence);
                rays.occluded(shadow);
                for (std::uint32_t lane = 0; lane < 16; ++lane) {
                    EXPECT_EQ(packet.polygon[lane] != kNone, lane != badLane) << lane;
                    EXPECT_EQ(shadow.occluded[lane], lane != badLane) << lane;
                }
                rays.closest(bad.origin, packet);
                for (std::uint32_t lane = 0; lane < 16; ++lane) {
                    const bool sound = glm::all(glm::lessThan(glm::abs(bad.origin), glm::vec3(1.0F)));
                    EXPECT_EQ(packet.polygon[lane] != kNone, sound && lane != badLane) << lane;
                }
            }
}

TEST_F(NotFinite, LinesCrossNothing) {
    const LineCaster lines(scene_);
    for (const Ray& bad : raysThatAreNotFinite()) {
        LinePacket packet;
        for (std::uint32_t lane = 0; lane < 16; ++lane) {
            const Ray line = rayOf(bad, lane, 3);
            packet.originX[lane] = line.origin.x;
            packet.originY[lane] = line.origin.y;
            packet.originZ[lane] = line.origin.z;
            packet.directionX[lane] = 10.0F * line.direction.x;
            packet.directionY[lane] = 10.0F * line.direction.y;
            packet.directionZ[lane] = 10.0F * line.direction.z;
            packet.active[lane] = -1;
        }
        LineCrossings crossings;
        lines.cross(packet, crossings);
        for (int lane = 0; lane < 16; ++lane) EXPECT_EQ(crossings.count(lane), lane == 3 ? 0U : 1U) << lane;
    }
}

} // namespace
} // namespace lambert
