#include "reader_checks.h"

#include <fmt/format.h>

#include <array>

namespace lambert {
namespace {

const std::string kVertices = "v a =\np 0 0 0\nn 0 0 1\nv b =\n\tp 1 0 0\nv c =\n\tp 0 1 0\n";

class MgfErrors : public ReaderTest {
protected:
    MgfErrors() : ReaderTest("scene.mgf") {}
};

TEST_F(MgfErrors, ErrorsCountContinuedLines) {
    expectError("# one \\\n two\nv a = \\\n\nf \\\n a a zz\n", "scene.mgf:5: found \"zz\", expected a vertex");
    expectError("\\\n\\\nfoo\nf a\n", "scene.mgf:4: found \"f a\"");
}

TEST_F(MgfErrors, IncludesThatCannotBeReadAreErrors) {
    expectError("# 1\ni missing.mgf\n", "scene.mgf:2: ");
    expectError("i scene.mgf\n", "found \"scene.mgf\", expected a file that does not include itself");
    folder.write("a.mgf", "i ./b.mgf\n");
    folder.write("b.mgf", "i x/../a.mgf\n");
    expectError("i a.mgf\n", "b.mgf:1: found \"x/../a.mgf\", expected a file that does not include itself");
    expectError("i /dev/zero\n", "outside the scene's folder");
    expectError("i ../other.mgf\n", "outside the scene's folder");
    expectError("i .\n", "scene.mgf:1: ");
    expectError("i\n", "found \"i\", expected i FILE");
}

TEST_F(MgfErrors, FilesEndOnlyWhatTheyBegan) {
    folder.write("end.mgf", "xf\n");
    expectError("xf -t 1 0 0\ni end.mgf\nxf\n", "end.mgf:1: found \"xf\"");
    folder.write("end.mgf", "o\n");
    expectError("o x\ni end.mgf\no\n", "end.mgf:1: found \"o\"");
    expectError(kVertices + "xf -a 3 -t 1 0 0\nf a b c\n", "scene.mgf:8: found \"xf with an array\", expected its end");
}

TEST_F(MgfErrors, MalformedEntitiesAreErrorsWithTheirPlace) {
    const std::vector<std::array<std::string, 2>> cases = {
        {"v q\n", "found \"q\", expected a vertex that is defined before"},
        {"v q = q\n", "found \"q\", expected a vertex"},
        {"v a b\n", "expected v, v NAME, v NAME = or v NAME = TEMPLATE"},
        {"c x\n", "expected a colour that is defined before"},
        {"m x = y\n", "expected a material that is defined before"},
        {"p 1 2\n", "found \"p 1 2\", expected p x y z"},
        {"p 1 2 nan\n", "found \"nan\", expected a finite number"},
        {"p 1 2 1e999\n", "found \"1e999\", expected a finite number"},
        {"n 1 2 x\n", "found \"x\", expected a finite number"},
        {"rd 1.1\n", "found \"1.1\", expected a number from 0 to 1"},
        {"rd -.1\n", "expected a number from 0 to 1"},
        {"ed -1\n", "expected lm/m²"},
        {"sides 3\n", "found \"3\", expected a whole number from 1 to 2"},
        {"rs .5\n", "expected rs SHARE ROUGHNESS"},
        {"cxy .5 .6\n", "expected cxy with x"},
        {"cxy .5 0\n", "expected cxy with x"},
        {"cct 0\n", "expected 100 to 1e9 kelvin"},
        {"cspec 400 700 1\n", "expected cspec with two wavelengths"},
        {"cspec 700 400 1 2\n", "expected cspec with the shortest"},
        {"cspec 400 700 0 0\n", "expected a colour: visible light"},
        {"cspec 900 950 1 1\n", "expected a colour: visible light"},
        {"cspec 400 700 -1 -1\n", "expected a colour: visible light"},
        {"cmix 1\n", "expected cmix with pairs"},
        {"c x =\ncmix -1 x\n", "expected a weight of 0 or more"},
        {"c x =\ncmix 0 x\n", "expected a colour: visible light"},
        {"f a b\n", "expected f with at least three vertices"},
        {"f a b q\n", "found \"q\", expected a vertex that is defined before"},
        {"fh a b c -\n", "expected fh with at least three vertices"},
        {"fh\n", "expected fh with at least three vertices"},
        {"sph a 0\n", "expected a radius other than 0"},
        {"sph a inf\n", "expected a finite number"},
        {"cyl a 1 a\n", "expected two vertices that differ"},
        {"cyl a 0 b\n", "expected a radius other than 0"},
        {"cone a 1 b -1\n", "expected two radii of the same sign"},
        {"cone a 0 b 0\n", "expected a radius other than 0"},
        {"ring b 0 1\n", "found \"b\", expected a vertex with a normal"},
        {"ring a 1 1\n", "expected an inner radius"},
        {"ring a -1 1\n", "expected an inner radius"},
        {"torus a 1 -2\n", "expected two radii of the same sign"},
        {"torus a 2 1\n", "expected an inner radius"},
        {"prism a b c 0\n", "expected a length other than 0"},
        {"prism a b 1\n", "expected prism with at least three vertices and a length"},
        {"prism a b a 1\n", "expected prism with a base that has an area"},
        {"xf\n", "expected an xf with arguments before it"},
        {"xf -t 1 2\n", "expected 3 numbers after -t"},
        {"xf -q\n", "found \"-q\", expected one of -t"},
        {"xf -s 0\n", "expected a scale other than 0"},
        {"xf -a 0\n", "expected a whole number from 1 to"},
        {"xf -a 2.5\n", "expected a whole number from 1 to"},
        {"xf -i -1\n", "expected a whole number from 0 to"},
        {"o\n", "expected an o with a name before it"},
        {"o a b\n", "expected o NAME or o"},
    };
    for (const auto& [mgf, message] : cases) {
        expectError(kVertices + mgf, message);
        expectError(kVertices + mgf, "scene.mgf:");
    }
}

TEST_F(MgfErrors, BombsAreErrorsBeforeMemoryOrPatienceEnd) {
    expectError(kVertices + "xf -a 100000 -a 100000\nf a b c\nxf\n", "expected at most 1000000 instances");
    expectError(kVertices + "xf -a 99999999999999999999\n", "expected a whole number");
    std::string nested = kVertices;
    for (int k = 0; k < 4; ++k) nested += "xf -a 1000\n";
    expectError(nested, "expected at most 1000000 instances, with the arrays around it");
    expectError(kVertices + "xf -a 1000000\nsph a 1\nxf\n", "--most-polygons allows more");

    // What a file includes allows polygons too: here a million and one more for each of these bytes.
    folder.write("comments.mgf", "#" + std::string(2000, 'x') + "\n");
    std::string scene = kVertices + "xf -a 1000 -a 1000\nf a b c\nxf\nxf -a 49000\nf a b c\nxf\n";
    expectError(scene, "--most-polygons allows more");
    EXPECT_EQ(readScene(folder.write("scene.mgf", "i comments.mgf\n" + scene)).scene.polygons.size(), 1'049'000U);

    std::string deep = kVertices;
    for (int k = 0; k < 1000; ++k) deep += "xf -t 1 0 0\n";
    expectError(deep, "expected at most 256 nested transforms");
    std::string objects;
    for (int k = 0; k < 1000; ++k) objects += "o x\n";
    expectError(objects, "expected at most 256 nested objects");

    for (int k = 0; k < 40; ++k)
        folder.write(fmt::format("f{}.mgf", k), fmt::format("i f{0}.mgf\ni f{0}.mgf\n", k + 1));
    folder.write("f40.mgf", kVertices);
    expectError("i f0.mgf\n", "expected at most 100000 included files");
    for (int k = 0; k < 100; ++k) folder.write(fmt::format("d{}.mgf", k), fmt::format("i d{}.mgf\n", k + 1));
    expectError("i d0.mgf\n", "expected at most 64 nested files");
}

TEST_F(MgfErrors, ScenesWithoutSurfacesAndOtherFilesAreErrors) {
    expectError("# nothing\n", "found no polygons");
    expectError(std::string("\x7f"
                            "ELF\0\1\2\3",
                            8),
                "found no polygons");
    expectError(kVertices + "xf -s 1e300 -s 1e300\nf a b c\nxf\n", "found no usable polygon among 1");
}

} // namespace
} // namespace lambert
