#include "vpl/instant_radiosity_method.h"

#include <gtest/gtest.h>

namespace lambert {
namespace {

TEST(VplMethod, LadderRisesByFoursWithinTheBounds) {
    const InstantRadiosityMethod method({});
    EXPECT_EQ(method.ladder(1024.0), (std::vector<double>{64, 256, 1024, 4096, 16384}));
    EXPECT_EQ(method.ladder(4.0), (std::vector<double>{1, 4, 16, 64}));
    EXPECT_EQ(method.ladder(16777216.0).back(), 16777216.0);
}

TEST(VplMethod, InstantRadiosityIsKnownAtPointsWithoutAPicture) {
    for (const Approximation& approximation : InstantRadiosityMethod({}).approximations())
        EXPECT_FALSE(approximation.onPicturesOnly) << approximation.part;
    EXPECT_EQ(InstantRadiosityMethod({}).seeds(16), 16);
}

} // namespace
} // namespace lambert
