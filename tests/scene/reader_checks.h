#pragma once

#include "core/error.h"
#include "scene/reading/scene_reader.h"
#include "tests/core/temporary_folder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <string>

namespace lambert {

inline double totalArea(const Scene& scene) {
    double sum = 0.0;
    for (const Polygon& polygon : scene.polygons) sum += polygonArea(scene, polygon);
    return sum;
}

inline bool hasWarning(const ReadResult& result, const std::string& part) {
    for (const std::string& warning : result.report.warnings)
        if (warning.find(part) != std::string::npos) return true;
    return false;
}

/// Expects an InputError of one line that names the file and contains `part`.
inline void expectInputError(const std::filesystem::path& file, const std::string& part) {
    try {
        readScene(file);
        ADD_FAILURE() << "no error; expected one with: " << part;
    } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.rfind(file.parent_path().string(), 0), 0U) << message;
        EXPECT_NE(message.find(part), std::string::npos) << message << "\nexpected: " << part;
        for (const char c : message) EXPECT_GE(static_cast<unsigned char>(c), 0x20) << message;
        EXPECT_LT(message.size(), 500U) << message;
    }
}

/// Expects the triangle (0, 0, 0), (1, 0, 0), (0, 1, 0) and nothing else.
inline void expectUnitTriangle(const Scene& scene) {
    ASSERT_EQ(scene.polygons.size(), 1U);
    EXPECT_FALSE(scene.polygons[0].isQuad());
    EXPECT_EQ(corner(scene, scene.polygons[0], 0), glm::vec3(0, 0, 0));
    EXPECT_EQ(corner(scene, scene.polygons[0], 1), glm::vec3(1, 0, 0));
    EXPECT_EQ(corner(scene, scene.polygons[0], 2), glm::vec3(0, 1, 0));
}

/// Reads files of one format whose content is given.
class ReaderTest : public testing::Test {
protected:
    explicit ReaderTest(std::string fileName) : fileName_(std::move(fileName)) {}

    ReadResult read(const std::string& content, const ReadOptions& options = {}) {
        return readScene(folder.write(fileName_, content), options);
    }
    void expectError(const std::string& content, const std::string& part) {
        SCOPED_TRACE(content.substr(0, 300));
        expectInputError(folder.write(fileName_, content), part);
    }

    TemporaryFolder folder;

private:
    std::string fileName_;
};

} // namespace lambert
