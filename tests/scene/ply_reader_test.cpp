#include "reader_checks.h"
#include "temporary_folder.h"

#include "scene/scene_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

namespace lambert {
namespace {

const std::string kVertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kFaces = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string kCorners = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

std::string ascii(const std::string& header, const std::string& body) {
    return "ply\nformat ascii 1.0\n" + header + "end_header\n" + body;
}

const std::string kQuad = ascii(kVertices + kFaces, kCorners + "4 0 1 2 3\n");

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

class PlyReader : public testing::Test {
protected:
    ReadResult read(const std::string& ply, const ReadOptions& options = {}) {
        return readScene(folder.write("scene.ply", ply), options);
    }
    void expectError(const std::string& ply, const std::string& part) {
        SCOPED_TRACE(ply.substr(0, 300));
        expectInputError(folder.write("scene.ply", ply), part);
    }
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
    /// The reflectance of a polygon at its corners.
    static std::vector<Rgb> reflectances(const Scene& scene, std::size_t index = 0) {
        const Polygon& polygon = scene.polygons.at(index);
        std::vector<Rgb> result;
        for (std::size_t k = 0; k < static_cast<std::size_t>(polygon.size()); ++k)
            result.push_back(scene.materials[polygon.material].reflectance *
                             scene.surfaces.at(polygon.surface).tint.at(k));
        return result;
    }
    static void expectNear(const Rgb& found, const Rgb& expected) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 2e-7); // rounding of a product of floats
    }

    TemporaryFolder folder;
};

TEST_F(PlyReader, ReadsTextWithAnyLineEndAndLayout) {
    expectQuad(kQuad);
    std::string windows, old;
    for (const char c : kQuad) {
        windows += c == '\n' ? "\r\n" : std::string(1, c);
        old += c == '\n' ? '\r' : c;
    }
    expectQuad(windows);
    expectQuad(old);
    expectQuad(ascii(kVertices + kFaces, "0 0 0 1 0 0\n1\t1 0\n\n 0 1e0 0 4 0 1 2 3"));
    expectQuad(ascii("comment c\nobj_info x y\n\n" + kVertices + "comment\n" + kFaces, kCorners + "4 0 1 2 3 rest"));
    expectQuad(ascii("comment " + std::string(100000, 'x') + "\n" + kVertices + kFaces, kCorners + "4 0 1 2 3"));
}

TEST_F(PlyReader, GivesPolygonsWithoutColoursTheDefaultMaterial) {
    const ReadResult result = read(kQuad);
    ASSERT_EQ(result.scene.materials.size(), 1U);
    EXPECT_EQ(result.scene.materials[0].name, "default");
    EXPECT_EQ(result.scene.materials[0].reflectance, Rgb(0.5F));
    EXPECT_EQ(result.scene.polygons[0].surface, kNone);
    EXPECT_EQ(result.scene.nodes, std::vector<std::string>{"default"});
    EXPECT_TRUE(result.report.warnings.empty());
}

TEST_F(PlyReader, ReadsBothByteOrders) {
    for (const bool bigEndian : {false, true}) {
        Bytes body(bigEndian);
        body.put<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}).put<std::uint8_t>({4}).put<std::int32_t>({0, 1, 2, 3});
        const std::string header = fmt::format("ply\nformat binary_{}_endian 1.0\n{}{}end_header\n",
                                               bigEndian ? "big" : "little", kVertices, kFaces);
        expectQuad(header + body.text);
        expectQuad(header + body.text + "what follows is not read");
    }
}

TEST_F(PlyReader, ReadsEveryType) {
    const auto expectTypes = [&](const std::string& coordinate, const std::string& length, const std::string& index,
                                 const auto& putCoordinates, const auto& putLength, const auto& putIndices) {
        for (const bool bigEndian : {false, true}) {
            Bytes body(bigEndian);
            putCoordinates(body);
            putLength(body);
            putIndices(body);
            expectQuad(fmt::format("ply\nformat binary_{}_endian 1.0\nelement vertex 4\nproperty {} x\nproperty {} y\n"
                                   "property {} z\nelement face 1\nproperty list {} {} vertex_index\nend_header\n",
                                   bigEndian ? "big" : "little", coordinate, coordinate, coordinate, length, index) +
                       body.text);
        }
    };
    const auto numbers = []<typename T>(T) {
        return [](Bytes& body) {
            body.put<T>({T(0), T(0), T(0), T(1), T(0), T(0), T(1), T(1), T(0), T(0), T(1), T(0)});
        };
    };
    const auto length = []<typename T>(T) { return [](Bytes& body) { body.put<T>({T(4)}); }; };
    const auto indices = []<typename T>(T) { return [](Bytes& body) { body.put<T>({T(0), T(1), T(2), T(3)}); }; };
    const auto expectType = [&](const std::string& name, const std::string& other, auto t) {
        for (const std::string& type : {name, other}) {
            expectTypes(type, "uchar", "int", numbers(t), length(std::uint8_t{}), indices(std::int32_t{}));
            expectTypes("float", "uchar", type, numbers(float{}), length(std::uint8_t{}), indices(t));
            if (std::is_integral_v<decltype(t)>)
                expectTypes("double", type, "uint", numbers(double{}), length(t), indices(std::uint32_t{}));
        }
    };
    expectType("char", "int8", std::int8_t{});
    expectType("uchar", "uint8", std::uint8_t{});
    expectType("short", "int16", std::int16_t{});
    expectType("ushort", "uint16", std::uint16_t{});
    expectType("int", "int32", std::int32_t{});
    expectType("uint", "uint32", std::uint32_t{});
    expectType("float", "float32", float{});
    expectType("double", "float64", double{});
}

TEST_F(PlyReader, PassesOverUnknownElementsAndProperties) {
    const std::string header =
        "element camera 1\nproperty float focus\nproperty list uchar float lens\n"
        "element nothing 1000000000000\n"
        "element vertex 4\nproperty list uchar short bones\nproperty double x\nproperty uchar w\n"
        "property float y\nproperty float z\nproperty float confidence\n"
        "element face 1\nproperty list ushort float weights\nproperty int flags\n"
        "property list uchar int vertex_indices\nproperty float quality\n"
        "element edge 1\nproperty int vertex1\n";
    expectQuad(ascii(header, "0.5 2 1 2\n0 0 7 0 0 1\n1 9 1 7 0 0 1\n2 9 9 1 7 1 0 1\n0 0 7 1 0 1\n"
                             "3 .1 .2 .3 -1 4 0 1 2 3 1.5\n0\n"));
    Bytes body;
    body.put<float>({0.5F}).put<std::uint8_t>({2}).put<float>({1, 2});
    for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        body.put<std::uint8_t>({1}).put<std::int16_t>({9}).put<double>({double(x)}).put<std::uint8_t>({7});
        body.put<float>({float(y), 0, 1});
    }
    body.put<std::uint16_t>({2}).put<float>({1, 2}).put<std::int32_t>({-1});
    body.put<std::uint8_t>({4}).put<std::int32_t>({0, 1, 2, 3}).put<float>({1.5F});
    expectQuad("ply\nformat binary_little_endian 1.0\n" + header + "end_header\n" + body.text);
}

TEST_F(PlyReader, ReadsFacesThatComeBeforeTheVertices) {
    expectQuad(ascii(kFaces + "element edge 1\nproperty int a\n" + kVertices, "4 0 1 2 3\n8\n" + kCorners));
    Bytes body;
    body.put<std::uint8_t>({4}).put<std::int32_t>({0, 1, 2, 3}).put<std::int32_t>({8});
    body.put<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    expectQuad("ply\nformat binary_little_endian 1.0\n" + kFaces + "element edge 1\nproperty int a\n" + kVertices +
               "end_header\n" + body.text);
}

TEST_F(PlyReader, ReadsBinaryDataThatBeginsWithALineFeed) {
    // The first byte of the first number is 0x0A.
    Bytes body;
    body.put<std::int16_t>({10, 0, 0, 11, 0, 0, 11, 1, 0, 10, 1, 0}).put<std::uint8_t>({4, 0, 1, 2, 3});
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        std::string ply;
        for (const std::string line :
             {"ply", "format binary_little_endian 1.0", "element vertex 4", "property short x", "property short y",
              "property short z", "element face 1", "property list uchar uchar vertex_indices", "end_header"})
            ply += line + end;
        const Scene scene = read(ply + body.text).scene;
        EXPECT_EQ(corner(scene, scene.polygons.at(0), 0), glm::vec3(10, 0, 0));
    }
}

TEST_F(PlyReader, AppliesMetresPerUnitInDoublePrecision) {
    const std::string ply =
        ascii("element vertex 3\nproperty double x\nproperty double y\nproperty double z\n" + kFaces,
              "0 0 0\n1000 0 0\n0 1000 0\n3 0 1 2\n");
    const Scene scene = read(ply, {.metresPerUnit = 0.001}).scene;
    EXPECT_EQ(corner(scene, scene.polygons[0], 1).x, 1.0F);
    EXPECT_THROW(read(ply, {.metresPerUnit = -1.0}), UsageError);
}

TEST_F(PlyReader, SplitsLargePolygonsAndCountsThoseWithoutArea) {
    const std::string header = "element vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
                               "element face 6\nproperty list uchar int vertex_indices\n";
    const ReadResult result = read(ascii(header, "0 0 0\n1 0 0\n1 1 0\n.5 2 0\n0 1 0\nnan 0 0\n"
                                                 "5 0 1 2 3 4\n0\n1 0\n2 0 1\n3 0 0 1\n3 0 1 5\n"));
    EXPECT_EQ(result.scene.polygons.size(), 3U);
    EXPECT_NEAR(totalArea(result.scene), 1.5, 1e-6);
    EXPECT_EQ(result.report.inputPolygons, 6U);
    EXPECT_EQ(result.report.splitPolygons, 1U);
    EXPECT_EQ(result.report.degeneratePolygons, 4U);
    EXPECT_EQ(result.report.nonFinitePolygons, 1U);
}

TEST_F(PlyReader, KeepsFacesThatShareAnEdgeWithManyOthers) {
    const std::string header = "element vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
                               "element face 4\nproperty list uchar int vertex_indices\n";
    const std::string body = "0 0 0\n1 0 0\n0 1 0\n0 -1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n3 0 1 4\n3 0 1 2\n";
    EXPECT_EQ(read(ascii(header, body)).scene.polygons.size(), 4U);
}

TEST_F(PlyReader, TakesBytesAsSrgbAndRealNumbersAsLinearReflectance) {
    const std::string names[] = {"red", "green", "blue"};
    const auto header = [&](const std::string& type, const std::string& prefix = "") {
        std::string result = kVertices;
        for (const std::string& name : names) result += "property " + type + " " + prefix + name + "\n";
        return result + "property uchar alpha\n" + kFaces;
    };
    const auto coloured = [&](const std::string& type, const std::string& prefix, const std::string& colour) {
        std::string body;
        for (const std::string corner : {"0 0 0", "1 0 0", "1 1 0", "0 1 0"}) body += corner + " " + colour + " 255\n";
        return read(ascii(header(type, prefix), body + "4 0 1 2 3\n"));
    };
    // 188 is the code of 0.5 and 99 that of 1/8, both by hand from the sRGB formula and rounded to a byte.
    const Rgb bytes(static_cast<float>(srgbDecoded(188 / 255.0)), static_cast<float>(srgbDecoded(99 / 255.0)), 0.0F);
    EXPECT_NEAR(bytes.x, 0.5, 0.004);
    EXPECT_NEAR(bytes.y, 0.125, 0.002);
    for (const std::string prefix : {"", "diffuse_"}) {
        SCOPED_TRACE(prefix);
        for (const Rgb& found : reflectances(coloured("uchar", prefix, "188 99 0").scene)) expectNear(found, bytes);
        for (const Rgb& found : reflectances(coloured("int", prefix, "188 99 0").scene)) expectNear(found, bytes);
        for (const Rgb& found : reflectances(coloured("ushort", prefix, "48316 25443 0").scene))
            expectNear(found, bytes);
        for (const std::string type : {"float", "double"}) {
            const ReadResult result = coloured(type, prefix, "0.123456 0.5 0.98");
            for (const Rgb& found : reflectances(result.scene)) expectNear(found, Rgb(0.123456F, 0.5F, 0.98F));
            EXPECT_TRUE(result.report.warnings.empty());
        }
    }
    const ReadResult white = coloured("uchar", "", "255 255 255");
    for (const Rgb& found : reflectances(white.scene)) EXPECT_EQ(found, Rgb(0.99F));
    EXPECT_TRUE(hasWarning(white, "4 colours were clamped to 0 ... 0.99"));
    for (const Rgb& found : reflectances(coloured("float", "", "nan -1 7").scene)) EXPECT_EQ(found, Rgb(0, 0, 0.99F));
}

TEST_F(PlyReader, KeepsEachVertexColourAtItsCorner) {
    const Scene scene = read(ascii(kVertices + "property float r\nproperty float g\nproperty float b\n" + kFaces,
                                   "0 0 0 .1 0 0\n1 0 0 .2 0 0\n1 1 0 .3 0 0\n0 1 0 .4 0 0\n4 2 3 0 1\n"))
                            .scene;
    const std::vector<Rgb> found = reflectances(scene);
    ASSERT_EQ(found.size(), 4U);
    for (std::size_t k = 0; k < 4; ++k) expectNear(found[k], Rgb(std::array{.3F, .4F, .1F, .2F}[k], 0, 0));
    EXPECT_EQ(scene.materials.size(), 1U);
    EXPECT_EQ(scene.materials[0].name, "default");
}

TEST_F(PlyReader, PrefersColoursOfFacesToThoseOfVertices) {
    const std::string colour = "property float red\nproperty float green\nproperty float blue\n";
    const std::string header =
        kVertices + colour + "element face 2\n" + colour + "property list uchar int vertex_indices\n";
    const Scene scene = read(ascii(header, "0 0 0 1 1 1\n1 0 0 1 1 1\n1 1 0 1 1 1\n0 1 0 1 1 1\n"
                                           ".5 .25 0 4 0 1 2 3\n0 .25 .5 3 0 1 2\n"))
                            .scene;
    for (const Rgb& found : reflectances(scene, 0)) expectNear(found, Rgb(.5F, .25F, 0));
    for (const Rgb& found : reflectances(scene, 1)) expectNear(found, Rgb(0, .25F, .5F));
}

TEST_F(PlyReader, DoesNotTakeBakedLightForEmission) {
    const std::string colour = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    const ReadResult result = read(ascii(kVertices + colour + "property float radiosity_r\n" + kFaces,
                                         "0 0 0 9 9 9 5\n1 0 0 9 9 9 5\n1 1 0 9 9 9 5\n0 1 0 9 9 9 5\n4 0 1 2 3\n"));
    EXPECT_EQ(result.scene.materials[0].emittedRadiance, Rgb(0));
    EXPECT_TRUE(hasWarning(result, "holds baked light"));
}

/// A picture of one red and one green texel.
const std::string kPicture = "P6\n2 1\n255\n" + std::string("\xFF\0\0\0\xFF\0", 6);

TEST_F(PlyReader, ReadsTexturesWithCoordinatesAtVertices) {
    folder.write("my picture.ppm", kPicture);
    for (const auto& [u, v] : {std::pair{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}) {
        SCOPED_TRACE(u);
        const ReadResult result = read(ascii(fmt::format("comment TextureFile my picture.ppm\n{}property float {}\n"
                                                         "property float {}\n{}",
                                                         kVertices, u, v, kFaces),
                                             "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 .75\n4 0 1 2 3\n"));
        const Scene& scene = result.scene;
        EXPECT_TRUE(result.report.warnings.empty());
        ASSERT_EQ(scene.materials.size(), 1U);
        EXPECT_EQ(scene.materials[0].name, "default");
        EXPECT_EQ(scene.materials[0].reflectance, Rgb(kMaxReflectance));
        ASSERT_TRUE(scene.materials[0].reflectanceTexture);
        EXPECT_EQ(scene.textures.at(0)->width(), 2);
        const SurfaceCorners& surface = scene.surfaces.at(scene.polygons[0].surface);
        EXPECT_EQ(surface.uv[0], glm::vec2(0, 1)); // below is 1: a texture's v grows downwards
        EXPECT_EQ(surface.uv[2], glm::vec2(1, 0));
        EXPECT_EQ(surface.uv[3], glm::vec2(0, .25F));
        EXPECT_EQ(surface.tint[0], Rgb(1));
    }
}

TEST_F(PlyReader, ReadsSeveralTexturesWithCoordinatesAtFaces) {
    folder.write("a.ppm", kPicture);
    folder.write("b.ppm", kPicture);
    const std::string header = "comment TextureFile a.ppm\ncomment TextureFile b.ppm\n" + kVertices +
                               "element face 4\nproperty list uchar int vertex_indices\n"
                               "property list uchar float texcoord\nproperty int texnumber\n";
    const Scene scene = read(ascii(header, kCorners + "3 0 1 2 6 0 0 1 0 1 1 1\n3 0 1 2 6 0 0 1 0 .5 .5 0\n"
                                                      "3 0 1 2 6 0 0 1 0 1 1 -1\n3 0 1 2 0 0\n"))
                            .scene;
    std::string names;
    for (const Polygon& polygon : scene.polygons) names += scene.materials[polygon.material].name + " ";
    EXPECT_EQ(names, "b.ppm a.ppm default default ");
    EXPECT_EQ(scene.surfaces.at(scene.polygons[1].surface).uv[2], glm::vec2(.5F, .5F));
    EXPECT_EQ(scene.polygons[2].surface, kNone);
    const std::string wrong = "3 0 1 2 6 0 0 1 0 1 1 0\n3 0 1 2 0 0\n3 0 1 2 0 0\n";
    expectError(ascii(header, kCorners + "3 0 1 2 6 0 0 1 0 1 1 2\n" + wrong),
                "face 0: found the image 2, expected -1 to 1");
    expectError(ascii(header, kCorners + "3 0 1 2 4 0 0 1 0 0\n" + wrong),
                "face 0: found 4 texture coordinates, expected 6");
}

TEST_F(PlyReader, WarnsOfImagesThatCannotBeUsed) {
    const std::string coordinates = "property float s\nproperty float t\n";
    const std::string body = "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 .75\n4 0 1 2 3\n";
    const std::string missing = ascii("comment TextureFile none.png\n" + kVertices + coordinates + kFaces, body);
    const ReadResult result = read(missing);
    EXPECT_TRUE(hasWarning(result, "none.png"));
    EXPECT_EQ(result.scene.materials[0].reflectance, Rgb(0.5F));
    EXPECT_THROW(read(missing, {.strict = true}), InputError);
    folder.write("a.ppm", kPicture);
    EXPECT_TRUE(hasWarning(read(ascii("comment TextureFile a.ppm\n" + kVertices + kFaces, kCorners + "4 0 1 2 3\n")),
                           "images without texture coordinates were ignored"));
}

TEST_F(PlyReader, RejectsCloudsOfPoints) {
    expectError(ascii(kVertices, kCorners), "scene.ply: found 4 vertices and no faces, expected faces: points have no");
    expectError(ascii(kVertices + "element face 0\nproperty list uchar int vertex_indices\n", kCorners), "no faces");
    expectError(
        ascii(kVertices + "element tristrips 1\nproperty list int int vertex_indices\n", kCorners + "3 0 1 2\n"),
        "triangle strips are not read");
    expectError(ascii("element vertex 0\nproperty float x\n" + kFaces, "3 0 0 0\n"), "1 faces and no vertices");
    expectError(ascii(kFaces, "3 0 0 0\n"), "1 faces and no vertices");
}

TEST_F(PlyReader, RejectsIndicesOutsideTheVerticesWithFaceAndLine) {
    const auto faces = [](const std::string& body) {
        return ascii(kVertices + "element face 2\nproperty list uchar int vertex_indices\n",
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

TEST_F(PlyReader, RejectsListsLongerThanTheFile) {
    const auto face = [](const std::string& length, const std::string& body) {
        return ascii(kVertices + "element face 1\nproperty list " + length + " int vertex_indices\n", kCorners + body);
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

TEST_F(PlyReader, RejectsPolygonsOfTooManyVertices) {
    std::string face = "65537";
    for (int k = 0; k < 65537; ++k) face += fmt::format(" {}", k % 4);
    expectError(ascii(kVertices + "element face 1\nproperty list int int vertex_index\n", kCorners + face),
                "face 0: found 65537 vertices, expected at most 65536");
}

TEST_F(PlyReader, RejectsCountsThatDoNotFitIntoTheFile) {
    const std::string types = "property float x\nproperty float y\nproperty float z\n";
    for (const std::string count : {"1000000000", "4294967296", "18446744073709551615"}) {
        expectError(ascii("element vertex " + count + "\n" + types + kFaces, kCorners + "4 0 1 2 3\n"),
                    "scene.ply:3: found \"element vertex " + count + "\", expected at most");
        expectError("ply\nformat binary_little_endian 1.0\n" + kVertices + "element face " + count +
                        "\nproperty list uchar int vertex_indices\nend_header\n" + std::string(48, '\0'),
                    "scene.ply:7: found \"element face " + count + "\", expected at most 0");
    }
    expectError(ascii("element vertex 18446744073709551616\n", ""), "expected element NAME COUNT");
    expectError(ascii("element vertex -1\n", ""), "expected element NAME COUNT");
}

TEST_F(PlyReader, RejectsEveryTruncation) {
    Bytes body;
    body.put<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}).put<std::uint8_t>({4}).put<std::int32_t>({0, 1, 2, 3});
    const std::string binary =
        "ply\nformat binary_little_endian 1.0\n" + kVertices + kFaces + "end_header\n" + body.text;
    for (std::size_t size = 1; size < binary.size(); ++size) expectError(binary.substr(0, size), "scene.ply");
    for (std::size_t size = 1; size + 2 < kQuad.size(); ++size) expectError(kQuad.substr(0, size), "scene.ply");
}

TEST_F(PlyReader, RejectsMalformedFilesWithLineAndText) {
    expectError("", "the file is empty");
    expectError("plyx\nformat ascii 1.0\n", "scene.ply:1: found \"plyx\", expected ply");
    expectError("solid x\n", "scene.ply:1: found \"solid x\"");
    expectError(std::string("\x00\xFF\x01", 3) + std::string(100000, '\x07'), "scene.ply:1: found \"?");
    expectError("ply\n", "found no end_header in the first 1 lines");
    expectError("ply\nelement vertex 0\nend_header\n", "expected a line \"format\" before it");
    expectError("ply\nformat binary_middle_endian 1.0\n", "scene.ply:2: found \"format binary_middle_endian 1.0\"");
    expectError("ply\nformat\n", "scene.ply:2: found \"format\"");
    expectError(ascii("element vertex\n", ""), "scene.ply:3: found \"element vertex\", expected element NAME COUNT");
    expectError(ascii("element vertex x\n", ""), "expected element NAME COUNT");
    expectError(ascii("property float x\n", ""), "expected an element before it");
    expectError(ascii(kVertices + kVertices, ""),
                "scene.ply:7: found \"element vertex 4\", expected each element only once");
    expectError(ascii(kVertices + "property quad w\n", ""), "scene.ply:7: found \"property quad w\", expected a type");
    expectError(ascii(kVertices + "property float\n", ""), "expected property TYPE NAME");
    expectError(ascii(kVertices + "property list uchar vertex_indices\n", ""), "expected property TYPE NAME");
    expectError(ascii(kVertices + "property list float int x\n", ""), "an integer type for the length");
    expectError(ascii(kVertices + "elements face 1\n", ""), "scene.ply:7: found \"elements face 1\", expected format");
    expectError(ascii("element vertex 4\nproperty float x\nproperty list uchar int y\nproperty float z\n" + kFaces,
                      "0 0 0\n0 0 0\n0 0 0\n0 0 0\n0\n"),
                "scene.ply:3: found \"element vertex\", expected its properties x, y and z");
    expectError(ascii(kVertices + "element face 1\nproperty list uchar int corners\n", kCorners + "4 0 1 2 3\n"),
                "scene.ply:7: found \"element face\", expected its list vertex_indices or vertex_index");
    expectError(ascii(kVertices + kFaces, "0 0 0\n1 O 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"),
                "scene.ply:11: vertex 1: found \"O\", expected a number");
    expectError(ascii(kVertices + kFaces, kCorners + "4 0 1 2\n"), "face 0: found 4 as the length");
    std::string lines;
    for (int k = 0; k < 20000; ++k) lines += "comment\n";
    expectError(ascii(lines, ""), "found no end_header in the first 10000 lines");
}

TEST_F(PlyReader, ReportsVerticesAndFacesAsProgress) {
    struct Recorder : Progress {
        std::string stages;
        void onBegin(std::string_view stage, std::uint64_t total) override {
            stages += fmt::format("{} {}; ", stage, total);
        }
    } progress;
    read(kQuad, {.progress = &progress});
    EXPECT_EQ(progress.stages, "read vertex 4; read face 1; ");
    progress.cancel();
    EXPECT_THROW(read(kQuad, {.progress = &progress}), Cancelled);
}

} // namespace
} // namespace lambert
