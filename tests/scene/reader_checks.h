#pragma once

#include "core/error.h"
#include "scene/scene_reader.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <string>

namespace lambert {

inline double totalArea(const Scene& scene) {
    double sum = 0.0;
    for (const Polygon& polygon : scene.polygons) sum += double{glm::length(areaVector(scene, polygon))};
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

} // namespace lambert
