#include "reader_checks.h"

#include <cstdlib>

namespace lambert {
namespace {

/// Reads well-known scenes from the folder that the environment variable LAMBERT_SCENES names, if it is set.
class SceneFiles : public testing::Test {
protected:
    void SetUp() override {
        const char* folder = std::getenv("LAMBERT_SCENES");
        if (folder == nullptr) GTEST_SKIP() << "LAMBERT_SCENES is not set";
        scenes = folder;
    }

    std::filesystem::path scenes;
};

TEST_F(SceneFiles, AllAreReadWithAnArea) {
    int count = 0;
    for (const char* folder : {"staircase", "conference", "cornell_mcguire", "holodeck", "analytic"}) {
        if (!std::filesystem::is_directory(scenes / folder)) continue;
        for (const auto& entry : std::filesystem::directory_iterator(scenes / folder)) {
            const std::string extension = entry.path().extension().string();
            if (extension != ".obj" && extension != ".glb") continue;
            SCOPED_TRACE(entry.path().string());
            const ReadResult result = readScene(entry.path());
            EXPECT_GT(result.scene.polygons.size(), 0U);
            EXPECT_GT(totalArea(result.scene), 0.0);
            EXPECT_EQ(result.report.nonFinitePolygons, 0U);
            ++count;
        }
    }
    EXPECT_GT(count, 0);
}

TEST_F(SceneFiles, ObjAndGlbOfTheSameSceneHaveTheSameArea) {
    for (const char* folder : {"staircase", "analytic"}) {
        if (!std::filesystem::is_directory(scenes / folder)) continue;
        for (const auto& entry : std::filesystem::directory_iterator(scenes / folder)) {
            std::filesystem::path twin = entry.path();
            if (twin.extension() != ".obj" || !std::filesystem::exists(twin.replace_extension(".glb"))) continue;
            SCOPED_TRACE(twin.string());
            const double area = totalArea(readScene(entry.path()).scene);
            EXPECT_NEAR(totalArea(readScene(twin).scene), area,
                        1e-5 * area); // single precision, decimal digits
        }
    }
}

} // namespace
} // namespace lambert
