#include "ply_test.h"

#include <fmt/format.h>

#include <cstdint>
#include <limits>

namespace lambert {
namespace {

using PlyErrors = PlyTest;

TEST_F(PlyErrors, RejectsCloudsOfPoints) {
    expectError(plyText(kVertices, kCorners),
                "scene.ply: found 4 vertices and no faces, expected faces: points have no");
    expectError(plyText(kVertices + "element face 0\nproperty list uchar int vertex_indices\n", kCorners), "no faces");
    expectError(
        plyText(kVertices + "element tristrips 1\nproperty list int int vertex_indices\n", kCorners + "3 0 1 2\n"),
        "triangle strips are not read");
    expectError(plyText("element vertex 0\nproperty float x\n" + kFaces, "3 0 0 0\n"), "1 faces and no vertices");
    expectError(plyText(kFaces, "3 0 0 0\n"), "1 faces and no vertices");
}

TEST_F(PlyErrors, RejectsIndicesOutsideTheVerticesWithFaceAndLine) {
    const auto faces = [](const std::string& body) {
        return plyText(kVertices + "element face 2\nproperty list uchar int vertex_indices\n",
                       kCorners + "3 0 1 2\n" + body);
    };
    expectError(faces("3 0 1 4\n"), "scene.ply:15: face 1: found the vertex 4, expected 0 to 3");
    expectError(faces("3 0 1 -1\n"), "face 1: found the vertex -1");
    expectError(faces("3 0 1 4294967296\n"), "face 1: found the vertex 4294967296");
    expectError(faces("3 0 1 1e300\n"), "found the vertex 1e+300");
    expectError(faces("3 0 1 nan\n"), "found the vertex nan");
    expectError(faces("3 0 1 1.5\n"), "found the vertex 1.5");
    Bytes body;
    body.put<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}).put<std::uint8_t>({3}).put<std::int32_t>({0, 1, -7});
    expectError("ply\nformat binary_little_endian 1.0\n" + kVertices + kFaces + "end_header\n" + body.text,
                "scene.ply: face 0: found the vertex -7, expected 0 to 3");
}

TEST_F(PlyErrors, RejectsListsLongerThanTheFile) {
    const auto face = [](const std::string& length, const std::string& body) {
        return plyText(kVertices + "element face 1\nproperty list " + length + " int vertex_indices\n",
                       kCorners + body);
    };
    expectError(face("uint", "1000000000 0 1 2\n"), "face 0: found 1e+09 as the length of vertex_indices, expected");
    expectError(face("int", "-1 0 1 2\n"), "found -1 as the length of vertex_indices");
    expectError(face("int", "nan 0 1 2\n"), "found nan as the length");
    expectError(face("int", "2.5 0 1 2\n"), "found 2.5 as the length");
    for (const bool bigEndian : {false, true})
        for (const std::int32_t length : {1000000000, -1, 4, std::numeric_limits<std::int32_t>::min()}) {
            Bytes body(bigEndian);
            body.put<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}).put<std::int32_t>({length, 0, 1, 2});
            expectError(fmt::format("ply\nformat binary_{}_endian 1.0\n{}element face 1\n"
                                    "property list int int vertex_indices\nend_header\n",
                                    bigEndian ? "big" : "little", kVertices) +
                            body.text,
                        "as the length of vertex_indices, expected a whole number up to 3");
        }
}

TEST_F(PlyErrors, RejectsPolygonsOfTooManyVertices) {
    std::string face = "65537";
    for (int k = 0; k < 65537; ++k) face += fmt::format(" {}", k % 4);
    expectError(plyText(kVertices + "element face 1\nproperty list int int vertex_index\n", kCorners + face),
                "face 0: found 65537 vertices, expected at most 65536");
}

TEST_F(PlyErrors, RejectsCountsThatDoNotFitIntoTheFile) {
    const std::string types = "property float x\nproperty float y\nproperty float z\n";
    for (const std::string count : {"1000000000", "4294967296", "18446744073709551615"}) {
        expectError(plyText("element vertex " + count + "\n" + types + kFaces, kCorners + "4 0 1 2 3\n"),
                    "scene.ply:3: found \"element vertex " + count + "\", expected at most");
        expectError("ply\nformat binary_little_endian 1.0\n" + kVertices + "element face " + count +
                        "\nproperty list uchar int vertex_indices\nend_header\n" + std::string(48, '\0'),
                    "scene.ply:7: found \"element face " + count + "\", expected at most 0");
    }
    expectError(plyText("element vertex 18446744073709551616\n", ""), "expected element NAME COUNT");
    expectError(plyText("element vertex -1\n", ""), "expected element NAME COUNT");
}

TEST_F(PlyErrors, RejectsEveryTruncation) {
    Bytes body;
    body.put<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}).put<std::uint8_t>({4}).put<std::int32_t>({0, 1, 2, 3});
    const std::string binary =
        "ply\nformat binary_little_endian 1.0\n" + kVertices + kFaces + "end_header\n" + body.text;
    for (std::size_t size = 1; size < binary.size(); ++size) expectError(binary.substr(0, size), "scene.ply");
    for (std::size_t size = 1; size + 2 < kQuad.size(); ++size) expectError(kQuad.substr(0, size), "scene.ply");
}

TEST_F(PlyErrors, RejectsMalformedFilesWithLineAndText) {
    expectError("", "the file is empty");
    expectError("plyx\nformat ascii 1.0\n", "scene.ply:1: found \"plyx\", expected ply");
    expectError("solid x\n", "scene.ply:1: found \"solid x\"");
    expectError(std::string("\x00\xFF\x01", 3) + std::string(100000, '\x07'), "scene.ply:1: found \"?");
    expectError("ply\n", "found no end_header in the first 1 lines");
    expectError("ply\nelement vertex 0\nend_header\n", "expected a line \"format\" before it");
    expectError("ply\nformat binary_middle_endian 1.0\n", "scene.ply:2: found \"format binary_middle_endian 1.0\"");
    expectError("ply\nformat\n", "scene.ply:2: found \"format\"");
    expectError(plyText("element vertex\n", ""), "scene.ply:3: found \"element vertex\", expected element NAME COUNT");
    expectError(plyText("element vertex x\n", ""), "expected element NAME COUNT");
    expectError(plyText("property float x\n", ""), "expected an element before it");
    expectError(plyText(kVertices + kVertices, ""),
                "scene.ply:7: found \"element vertex 4\", expected each element only once");
    expectError(plyText(kVertices + "property quad w\n", ""),
                "scene.ply:7: found \"property quad w\", expected a type");
    expectError(plyText(kVertices + "property float\n", ""), "expected property TYPE NAME");
    expectError(plyText(kVertices + "property list uchar vertex_indices\n", ""), "expected property TYPE NAME");
    expectError(plyText(kVertices + "property list float int x\n", ""), "an integer type for the length");
    expectError(plyText(kVertices + "elements face 1\n", ""),
                "scene.ply:7: found \"elements face 1\", expected format");
    expectError(plyText("element vertex 4\nproperty float x\nproperty list uchar int y\nproperty float z\n" + kFaces,
                        "0 0 0\n0 0 0\n0 0 0\n0 0 0\n0\n"),
                "scene.ply:3: found \"element vertex\", expected its properties x, y and z");
    expectError(plyText(kVertices + "element face 1\nproperty list uchar int corners\n", kCorners + "4 0 1 2 3\n"),
                "scene.ply:7: found \"element face\", expected its list vertex_indices or vertex_index");
    expectError(plyText(kVertices + kFaces, "0 0 0\n1 O 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"),
                "scene.ply:11: vertex 1: found \"O\", expected a number");
    expectError(plyText(kVertices + kFaces, kCorners + "4 0 1 2\n"), "face 0: found 4 as the length");
    std::string lines;
    for (int k = 0; k < 20000; ++k) lines += "comment\n";
    expectError(plyText(lines, ""), "found no end_header in the first 10000 lines");
}

} // namespace
} // namespace lambert
