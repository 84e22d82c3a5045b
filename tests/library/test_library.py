#!/usr/bin/env python3
"""The library as another program has it: installed and in the build, found by find_package, with the bytes of `lambert bake`."""
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

LAMBERT = os.environ["LAMBERT"]
DATA = Path(os.environ["LAMBERT_DATA"])
BUILD = Path(os.environ["LAMBERT_BUILD"])
HERE = Path(__file__).resolve().parent
EXAMPLES = HERE.parents[1] / "examples"


def run(*words, **options):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, **options)


class Library(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.root = Path(cls.temporary.name)
        done = run("cmake", "--install", BUILD, "--prefix", cls.root / "first")
        assert done.returncode == 0, done.stderr
        (cls.root / "first").rename(cls.root / "installed")  # the tree may be moved
        cls.example = cls.built(EXAMPLES, "outside", cls.root / "installed") / "bake_scene"

    @classmethod
    def built(cls, source, name, prefix):
        """What is built of a copy of a folder against the library at `prefix`."""
        shutil.copytree(source, cls.root / name)
        for words in (("-G", "Ninja", "-S", cls.root / name, "-B", cls.root / name / "build", f"-DCMAKE_PREFIX_PATH={prefix}",
                       "-DCMAKE_BUILD_TYPE=Debug"), ("--build", cls.root / name / "build")):
            done = run("cmake", *words)
            assert done.returncode == 0, done.stdout + done.stderr
        return cls.root / name / "build"

    def expect_same_bytes(self, program, scene, extension):
        ours, theirs = self.root / "ours" / f"baked.{extension}", self.root / "theirs" / f"baked.{extension}"
        for folder in (ours.parent, theirs.parent):
            folder.mkdir(exist_ok=True)
        done = run(program, scene, theirs)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("patches", done.stdout)
        self.assertEqual(run(LAMBERT, "bake", scene, "-o", ours, "--quiet").returncode, 0)
        self.assertEqual(ours.read_bytes(), theirs.read_bytes(), f"{scene.name} as {extension}")

    def test_writes_what_the_program_writes(self):
        self.expect_same_bytes(self.example, DATA / "cube6.obj", "ply")
        self.expect_same_bytes(self.example, DATA / "textured_room.gltf", "glb")  # reads images

    def test_the_program_works_where_it_is_installed(self):
        picture = self.root / "box.png"
        done = run(self.root / "installed/bin/lambert", "bake", DATA / "cornell_box.gltf", "--patches", 100, "--image", picture)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(picture.read_bytes().startswith(b"\x89PNG"))

    def test_installed_files_know_nothing_of_the_build(self):
        for file in ("bin/lambert", "lib/x86_64-linux-gnu/liblambert.so", "lib/liblambert.so"):
            if (self.root / "installed" / file).exists():
                self.assertNotIn(str(BUILD), run("readelf", "-d", self.root / "installed" / file).stdout, file)

    def test_is_found_in_the_build_too(self):
        self.expect_same_bytes(self.built(EXAMPLES, "in_build", BUILD) / "bake_scene", DATA / "tetrahedron.obj", "obj")

    def test_several_threads_may_bake_at_once(self):
        done = run(self.built(HERE / "at_once", "at_once", self.root / "installed") / "at_once",
                   DATA / "cornell_box.gltf", DATA / "textured_room.gltf", DATA / "table_room.gltf")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_failures_are_one_line(self):
        done = run(self.example, self.root / "none.obj", self.root / "a.glb")
        self.assertEqual((done.returncode, done.stderr), (1, f"\nbake_scene: {self.root}/none.obj: no such file\n"))
        done = run(self.example, DATA / "cube6.obj", self.root / "no folder" / "a.glb")
        self.assertEqual(done.returncode, 1)
        self.assertIn("no folder", done.stderr)

    def test_the_header_is_enough(self):
        program = self.root / "factors.cpp"
        program.write_text(FACTORS)
        (self.root / "factors").mkdir()
        (self.root / "factors" / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(f CXX)\nfind_package(lambert REQUIRED)\n"
            f"add_executable(f {program})\ntarget_link_libraries(f PRIVATE lambert::lambert)\n")
        build = self.root / "factors" / "build"
        for words in (("-G", "Ninja", "-S", build.parent, "-B", build, f"-DCMAKE_PREFIX_PATH={self.root / 'installed'}"), ("--build", build)):
            done = run("cmake", *words)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        done = run(build / "f", DATA / "cube6.obj")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout, "6 patches, rows sum to 1\nstopped\nbad setting\n")


FACTORS = r"""
#include <lambert/lambert.h>
#include <cmath>
#include <cstdio>
using namespace lambert::library;
int main(int, char** arguments) {
    const Scene scene = readScene(arguments[1]);
    const FormFactors factors = formFactors(scene, {.patches = 0});
    const std::size_t count = factors.area.size();
    double worst = 0;
    for (std::size_t i = 0; i < count; ++i) {
        double sum = factors.back[i] + factors.out[i];
        for (std::size_t k = factors.row[i]; k < factors.row[i + 1]; ++k) sum += factors.value[k];
        worst = std::fmax(worst, std::fabs(sum - 1) - factors.error[i]);
    }
    std::printf("%zu patches, %s\n", count, worst < 1e-6 ? "rows sum to 1" : "rows do not sum to 1");
    try {
        bake(scene, {.progress = [](std::string_view, double) { return false; }});
    } catch (const Failure& failure) {
        std::puts(failure.kind() == Failure::Kind::Stopped ? "stopped" : failure.what());
    }
    try {
        bake(scene, {.quality = "best"});
    } catch (const Failure& failure) {
        std::puts(failure.kind() == Failure::Kind::Setting ? "bad setting" : failure.what());
    }
}
"""

if __name__ == "__main__":
    unittest.main()
