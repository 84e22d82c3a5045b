#include "scene/overrides.h"

#include "core/error.h"
#include "scene/example_scenes.h"
#include "scene/name_match.h"
#include "scene/reading/overrides_file.h"
#include "tests/core/temporary_folder.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <memory>

namespace lambert {
namespace {

using Treatment = NodeOverride::Treatment;

/// Two textured and tinted squares, "lamp" on node "Lamp.1" and "wall" on node "Wall".
Scene twoSquares() {
    const std::array<glm::vec3, 4> square{glm::vec3(0, 0, 0), {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const std::array materials{greyMaterial("lamp", 0.5F, 1.0F), greyMaterial("wall", 0.5F)};
    Scene scene = quadScene(std::array{square, square}, materials);
    scene.nodes = {"Lamp.1", "Wall"};
    scene.polygons[1].node = 1;
    for (std::uint32_t i = 0; i < 2; ++i) {
        SurfaceCorners surface;
        surface.tint.fill(Rgb(0.25F));
        scene.surfaces.push_back(surface);
        scene.polygons[i].surface = i;
        Material& material = scene.materials[i];
        material.reflectanceTexture.texture = material.emissionTexture.texture = material.opacityTexture.texture = 0;
        material.opacityCutoff = 0.5F;
    }
    scene.textures.push_back(std::make_shared<Texture>("white", 1, 1, std::vector<std::uint8_t>(4, 255)));
    return scene;
}

MaterialOverride reflectanceOf(std::string name, float value) {
    return {std::move(name), {"--reflectance"}, std::nullopt, Rgb(value), std::nullopt};
}

template <typename Error>
std::string messageOf(const std::function<void()>& act) {
    try {
        act();
    } catch (const Error& error) {
        return error.what();
    }
    return "no such error";
}

TEST(NameMatch, StarStandsForAnyCharacters) {
    for (const char* pattern : {"Lamp.001", "Lamp*", "*001", "*", "L*0*1", "Lamp.001*", "**"})
        EXPECT_TRUE(matchesPattern("Lamp.001", pattern)) << pattern;
    for (const char* pattern : {"", "Lamp", "lamp*", "*1 ", "L?mp.001", "*2*", "Lamp.001*1"})
        EXPECT_FALSE(matchesPattern("Lamp.001", pattern)) << pattern;
    EXPECT_TRUE(matchesPattern("", "*"));
    EXPECT_TRUE(matchesPattern("", ""));
}

TEST(NameMatch, ANameWithAStarCanBeMeantAlone) {
    const std::vector<std::string> names{"a*", "ab", "a*"};
    EXPECT_EQ(matchingNames(names, "a*"), (std::vector<std::uint32_t>{0, 2}));
    EXPECT_EQ(matchingNames(names, "a*b*"), (std::vector<std::uint32_t>{1}));
}

TEST(NameMatch, ClosestNamesNeedTheFewestChanges) {
    const std::vector<std::string> names{"ceiling", "LAMP", "lamps", "wall", "lamps"};
    EXPECT_EQ(closestNames("lamp", names, 2), (std::vector<std::string>{"LAMP", "lamps"}));
    EXPECT_EQ(closestNames("lamp", names, 9).size(), 4U);
    EXPECT_TRUE(closestNames("lamp", {}, 3).empty());
}

TEST(Overrides, ReflectanceReplacesTextureAndTintAndKeepsHoles) {
    Scene scene = twoSquares();
    applyOverrides(scene, {{reflectanceOf("wall", 0.75F)}, {}});
    EXPECT_EQ(scene.materials[1].reflectance, Rgb(0.75F));
    EXPECT_FALSE(scene.materials[1].reflectanceTexture);
    EXPECT_TRUE(scene.materials[1].emissionTexture);
    EXPECT_TRUE(scene.materials[1].hasHoles());
    EXPECT_EQ(scene.surfaces[1].tint[0], Rgb(1.0F));
    EXPECT_TRUE(scene.materials[0].reflectanceTexture);
    EXPECT_EQ(scene.surfaces[0].tint[0], Rgb(0.25F));
}

TEST(Overrides, EmissionReplacesItsTextureOnly) {
    Scene scene = twoSquares();
    applyOverrides(scene, {{{"*", {"--emit"}, Rgb(3.0F), std::nullopt, std::nullopt}}, {}});
    for (const Material& material : scene.materials) {
        EXPECT_EQ(material.emittedRadiance, Rgb(3.0F));
        EXPECT_FALSE(material.emissionTexture);
        EXPECT_TRUE(material.reflectanceTexture);
    }
    EXPECT_EQ(scene.surfaces[0].tint[0], Rgb(0.25F));
}

TEST(Overrides, LaterOneWins) {
    Scene scene = twoSquares();
    applyOverrides(scene, {{reflectanceOf("*", 0.1F), reflectanceOf("wall", 0.2F)}, {}});
    EXPECT_EQ(scene.materials[0].reflectance, Rgb(0.1F));
    EXPECT_EQ(scene.materials[1].reflectance, Rgb(0.2F));
    scene.polygons.push_back(scene.polygons[0]);
    scene.polygons.back().node = 2;
    scene.nodes.emplace_back("Lit");
    applyOverrides(scene, {{},
                           {{"Wall", {"--exclude"}, Treatment::Exclude},
                            {"Lamp.1", {"--occlude-only"}, Treatment::OccludeOnly},
                            {"Wall", {"--occlude-only"}, Treatment::OccludeOnly},
                            {"Lamp*", {"--exclude"}, Treatment::Exclude}}});
    ASSERT_EQ(scene.polygons.size(), 2U);
    EXPECT_TRUE(isOccluder(scene, scene.polygons[0]));
    EXPECT_EQ(scene.nodes[scene.polygons[0].node], "Wall");
}

TEST(Overrides, ExcludedNodeHasNoPolygons) {
    Scene scene = twoSquares();
    applyOverrides(scene, {{}, {{"Lamp*", {"--exclude"}, Treatment::Exclude}}});
    ASSERT_EQ(scene.polygons.size(), 1U);
    EXPECT_EQ(scene.nodes[scene.polygons[0].node], "Wall");
}

TEST(Overrides, OccluderIsBlackAndKeepsItsHoles) {
    Scene scene = twoSquares();
    scene.materials[0].twoSided = true;
    applyOverrides(scene, {{}, {{"Lamp.1", {"--occlude-only"}, Treatment::OccludeOnly}}});
    const Material& black = scene.materials[scene.polygons[0].material];
    EXPECT_TRUE(isOccluder(scene, scene.polygons[0]));
    EXPECT_EQ(black.reflectance, Rgb(0.0F));
    EXPECT_EQ(black.emittedRadiance, Rgb(0.0F));
    EXPECT_FALSE(black.twoSided);
    EXPECT_TRUE(black.hasHoles());
    EXPECT_FALSE(isOccluder(scene, scene.polygons[1]));
    EXPECT_EQ(scene.materials[0].emittedRadiance, twoSquares().materials[0].emittedRadiance); // others may use it
}

TEST(Overrides, UnknownNameIsAnErrorThatNamesTheClosest) {
    Scene scene = twoSquares();
    const std::string typed = messageOf<UsageError>([&] { applyOverrides(scene, {{reflectanceOf("wal", 0.5F)}, {}}); });
    EXPECT_EQ(typed,
              "--reflectance: the scene has no material \"wal\"; the closest of its 2 materials: \"wall\", \"lamp\"");
    const NodeOverride inFile{"Wal*x", {"room.lambert.json: /exclude/0", true}, Treatment::Exclude};
    const std::string read = messageOf<InputError>([&] { applyOverrides(scene, {{}, {inFile}}); });
    EXPECT_TRUE(read.starts_with("room.lambert.json: /exclude/0: the scene has no node \"Wal*x\"")) << read;
}

TEST(Overrides, ASceneWithoutLitPolygonsIsRefused) {
    for (const Treatment treatment : {Treatment::Exclude, Treatment::OccludeOnly}) {
        Scene scene = twoSquares();
        EXPECT_THROW(applyOverrides(scene, {{}, {{"*", {"--exclude"}, treatment}}}), UsageError);
    }
}

TEST(OverridesFile, EveryKeyIsRead) {
    const TemporaryFolder folder;
    const auto path = folder.write("room.lambert.json", R"({
        "unit": 0.001, "two_sided": false,
        "materials": {"lamp": {"emit": [1, 2.5, 3], "two_sided": true}, "w/all": {"reflectance": [0, 0.5, 0.99]}},
        "exclude": ["A*"], "occlude_only": ["Ab", "B"]})");
    const OverridesFile file = readOverridesFile(path);
    EXPECT_EQ(file.metresPerUnit, 0.001);
    EXPECT_EQ(file.twoSided, false);
    ASSERT_EQ(file.overrides.materials.size(), 2U);
    EXPECT_EQ(file.overrides.materials[0].emittedRadiance, Rgb(1.0F, 2.5F, 3.0F));
    EXPECT_EQ(file.overrides.materials[0].twoSided, true);
    EXPECT_FALSE(file.overrides.materials[0].reflectance);
    EXPECT_EQ(file.overrides.materials[1].reflectance, Rgb(0.0F, 0.5F, 0.99F));
    EXPECT_EQ(file.overrides.materials[1].source.place, path.string() + ": /materials/w~1all");
    ASSERT_EQ(file.overrides.nodes.size(), 3U);
    EXPECT_EQ(file.overrides.nodes.back().name, "A*"); // applied last: what is excluded is not there
    EXPECT_EQ(file.overrides.nodes.back().treatment, Treatment::Exclude);
}

TEST(OverridesFile, StandsBesideTheScene) {
    EXPECT_EQ(overridesFileBeside("folder/room.v2.obj"), "folder/room.v2.lambert.json");
}

TEST(OverridesFile, WrongContentIsNamedWithItsPath) {
    const TemporaryFolder folder;
    const std::pair<const char*, const char*> wrong[]{
        {R"({"units": 1})", "/units: not known"},
        {R"({"materials": {"a": {"colour": 1}}})", "/materials/a/colour: not known"},
        {R"({"unit": "mm"})", "/unit: found"},
        {R"({"unit": 0})", "/unit: found"},
        {R"({"unit": 1e999})", "not valid JSON"},
        {R"({"two_sided": 1})", "/two_sided: found"},
        {R"({"materials": []})", "/materials: found"},
        {R"({"materials": {"a": 1}})", "/materials/a: found"},
        {R"({"materials": {"a": {"emit": [1, 2]}}})", "/materials/a/emit: found"},
        {R"({"materials": {"a": {"emit": [1, 2, null]}}})", "/materials/a/emit: found"},
        {R"({"materials": {"a": {"emit": [1, 2, -1]}}})", "/materials/a/emit: found"},
        {R"({"materials": {"a": {"reflectance": [1, 1, 1]}}})", "allowed [r, g, b], three numbers from 0 to 0.99"},
        {R"({"exclude": "a"})", "/exclude: found"},
        {R"({"exclude": ["a", 1]})", "/exclude/1: found"},
        {R"([])", "found \"[]\""},
        {R"({"a": )", "not valid JSON"},
        {"", "empty"}};
    for (const auto& [content, says] : wrong) {
        const auto path = folder.write("x.lambert.json", content);
        const std::string message = messageOf<InputError>([&] { readOverridesFile(path); });
        EXPECT_TRUE(message.starts_with(path.string())) << message;
        EXPECT_NE(message.find(says), std::string::npos) << message;
    }
}

TEST(OverridesFile, DeepNestingIsRefused) {
    const TemporaryFolder folder;
    const std::string deep(1'000'000, '[');
    EXPECT_NE(messageOf<InputError>([&] { readOverridesFile(folder.write("x.lambert.json", deep)); }).find("deep"),
              std::string::npos);
}

} // namespace
} // namespace lambert
