#pragma once

#include "reader_checks.h"

#include "scene/scene_builder.h"

#include <algorithm>
#include <cstring>
#include <initializer_list>
#include <string>

namespace lambert {

inline const std::string kVertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
inline const std::string kFaces = "element face 1\nproperty list uchar int vertex_indices\n";
inline const std::string kCorners = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

inline std::string plyText(const std::string& header, const std::string& body) {
    return "ply\nformat ascii 1.0\n" + header + "end_header\n" + body;
}

inline const std::string kQuad = plyText(kVertices + kFaces, kCorners + "4 0 1 2 3\n");

/// Appends numbers as a binary PLY holds them.
class Bytes {
public:
    explicit Bytes(bool bigEndian = false) : bigEndian_(bigEndian) {}

    template <typename T>
    Bytes& put(std::initializer_list<T> values) {
        for (const T value : values) {
            std::string bytes(sizeof value, '\0');
            std::memcpy(bytes.data(), &value, sizeof value);
            if (bigEndian_) std::reverse(bytes.begin(), bytes.end());
            text += bytes;
        }
        return *this;
    }

    std::string text;

private:
    bool bigEndian_;
};

/// Reads PLY files given as text.
class PlyTest : public ReaderTest {
protected:
    PlyTest() : ReaderTest("scene.ply") {}

    /// Expects the one quad of kQuad.
    void expectQuad(const std::string& ply) {
        SCOPED_TRACE(ply.substr(0, 400));
        const Scene scene = read(ply).scene;
        ASSERT_EQ(scene.polygons.size(), 1U);
        ASSERT_TRUE(scene.polygons[0].isQuad());
        EXPECT_EQ(corner(scene, scene.polygons[0], 0), glm::vec3(0, 0, 0));
        EXPECT_EQ(corner(scene, scene.polygons[0], 1), glm::vec3(1, 0, 0));
        EXPECT_EQ(corner(scene, scene.polygons[0], 2), glm::vec3(1, 1, 0));
        EXPECT_EQ(corner(scene, scene.polygons[0], 3), glm::vec3(0, 1, 0));
    }
};

} // namespace lambert
