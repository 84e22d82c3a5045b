#include "gltf_test.h"

#include <glm/gtc/constants.hpp>

#include <cmath>

namespace lambert {
namespace {

using nlohmann::json;
using GltfLights = GltfTest;

/// A square with one light, which the nodes of `nodes` carry.
Square litBy(const json& light, const std::vector<json>& nodes) {
    Square square;
    square["/extensionsUsed"] = {"KHR_lights_punctual"};
    square["/extensions/KHR_lights_punctual/lights"] = json::array({light});
    for (json node : nodes) {
        node["extensions"]["KHR_lights_punctual"]["light"] = 0;
        square["/scenes/0/nodes"].push_back(square["/nodes"].size());
        square["/nodes"].push_back(node);
    }
    return square;
}

TEST_F(GltfLights, StandWhereTheirNodesAre) {
    const double half = std::sqrt(0.5);
    const ReadResult result =
        read(litBy({{"type", "spot"},
                    {"name", "lamp"},
                    {"color", {1, 0.5, 0}},
                    {"intensity", 40},
                    {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}},
                   {{{"translation", {1, 2, 3}}, {"scale", {2, 2, 2}}}, {{"rotation", {-half, 0, 0, half}}}}));
    EXPECT_TRUE(result.report.warnings.empty());
    ASSERT_EQ(result.scene.lights.size(), 2U);
    const PunctualLight& first = result.scene.lights[0];
    EXPECT_EQ(first.name, "lamp");
    EXPECT_EQ(first.kind, PunctualLight::Kind::Spot);
    EXPECT_EQ(first.position, glm::vec3(1, 2, 3));
    EXPECT_EQ(first.direction, glm::vec3(0, 0, -1));
    EXPECT_EQ(first.intensity, Rgb(40, 20, 0));
    EXPECT_EQ(first.innerConeAngle, 0.25F);
    EXPECT_EQ(first.outerConeAngle, 0.5F);
    // The second looks down: -Z turned by -90 degrees around X.
    EXPECT_NEAR(glm::distance(result.scene.lights[1].direction, glm::vec3(0, -1, 0)), 0.0F, 1e-6F);
}

TEST_F(GltfLights, HaveTheDefaultsOfTheFormat) {
    const Scene point = read(litBy({{"type", "point"}}, {{{"name", "bulb"}}})).scene;
    ASSERT_EQ(point.lights.size(), 1U);
    EXPECT_EQ(point.lights[0].name, "bulb");
    EXPECT_EQ(point.lights[0].intensity, Rgb(1.0F));
    EXPECT_EQ(point.lights[0].kind, PunctualLight::Kind::Point);
    const Scene spot = read(litBy({{"type", "spot"}, {"spot", json::object()}}, {json::object()})).scene;
    EXPECT_EQ(spot.lights[0].name, "light_0");
    EXPECT_EQ(spot.lights[0].innerConeAngle, 0.0F);
    EXPECT_EQ(spot.lights[0].outerConeAngle, glm::quarter_pi<float>());
    const Scene sun = read(litBy({{"type", "directional"}, {"intensity", 3}}, {{{"translation", {1, 1, 1}}}})).scene;
    EXPECT_EQ(sun.lights[0].kind, PunctualLight::Kind::Directional);
    EXPECT_EQ(sun.lights[0].intensity, Rgb(3.0F));
}

TEST_F(GltfLights, ASpotMayBeAsWideAsAHalfSpaceRoundedUp) {
    const Scene scene =
        read(litBy({{"type", "spot"}, {"spot", {{"innerConeAngle", 1.5707964}, {"outerConeAngle", 1.5707964}}}},
                   {json::object()}))
            .scene;
    EXPECT_EQ(scene.lights[0].outerConeAngle, glm::half_pi<float>());
    EXPECT_EQ(scene.lights[0].innerConeAngle, glm::half_pi<float>());
}

TEST_F(GltfLights, ThatHaveNoDirectionAreLeftOut) {
    const ReadResult result = read(litBy({{"type", "directional"}, {"name", "sun"}}, {{{"scale", {1, 1, 0}}}}));
    EXPECT_TRUE(result.scene.lights.empty());
    EXPECT_TRUE(hasWarning(result, "the light \"sun\" was ignored: its transform is singular"));
}

TEST_F(GltfLights, OutOfRangeAreRejectedWithTheirPath) {
    const std::string light = "/extensions/KHR_lights_punctual/lights/0";
    const auto expectLightError = [&](const json& definition, const std::string& part) {
        expectError(litBy(definition, {json::object()}), part);
    };
    expectLightError({{"type", "area"}}, light + "/type: found \"area\"");
    expectLightError({{"intensity", 1}}, light + "/type: found nothing");
    expectLightError({{"type", "point"}, {"intensity", -1}}, light + "/intensity: found -1");
    expectLightError({{"type", "point"}, {"intensity", 1e300}}, light + "/intensity: found 1e+300");
    expectLightError({{"type", "point"}, {"color", {1, 1}}}, light + "/color: found [1,1], allowed 3 numbers");
    expectLightError({{"type", "point"}, {"color", {1, -1, 1}}}, light + "/color/1: found -1");
    expectLightError({{"type", "spot"}, {"spot", {{"outerConeAngle", 2}}}}, light + "/spot/outerConeAngle: found 2");
    expectLightError({{"type", "spot"}, {"spot", {{"innerConeAngle", 1}}}}, light + "/spot/innerConeAngle: found 1");
    Square square = litBy({{"type", "point"}}, {json::object()});
    square["/nodes/1/extensions/KHR_lights_punctual/light"] = 1;
    expectError(square, "/nodes/1/extensions/KHR_lights_punctual/light: found 1, allowed 0 to 0 (lights)");
}

} // namespace
} // namespace lambert
