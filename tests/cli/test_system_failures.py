#!/usr/bin/env python3
"""What is no fault of scene or user ends with exit code 4 and one line: the old results are whole, nothing is left behind."""
import os
import resource
import subprocess
import sys
import unittest
from pathlib import Path

from lambert_cli import DATA, OK, PROGRAM, SYSTEM, ProgramTest, run

BOX = DATA / "cornell_box.obj"
TINY = ("--patches", "0", "--resolution", "16", "--quiet", "--size", "64x64")
# Each kind of result, and all files that it consists of.
RESULTS = {"glb": ("-o", "x.glb"), "gltf": ("-o", "x.gltf"), "ply": ("-o", "x.ply"), "obj": ("-o", "x.obj"),
           "png": ("--image", "x.png"), "exr": ("--image", "x.exr"), "json": ("--json", "x.json")}
FILES = {kind: ("x.obj", "x.mtl") if kind == "obj" else (options[1],) for kind, options in RESULTS.items()}


class SystemFailureTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.place = self.folder

    def listing(self):
        return {path.name: path.read_bytes() if path.is_file() else None for path in self.place.iterdir()}

    def assert_fails(self, *arguments, says="", **more):
        before = self.listing()
        done = run("bake", BOX, *arguments, *TINY, cwd=self.place, **more)
        lines = [line for line in done.stderr.splitlines() if not line.startswith("warning: ")]
        self.assertEqual(done.returncode, SYSTEM, f"{arguments}: {done.stderr}")
        self.assertEqual(len(lines), 1, done.stderr)
        self.assertTrue(lines[0].startswith("lambert: "), lines[0])
        self.assertIn(says, lines[0])
        self.assertEqual(self.listing(), before, arguments)


class NoSpace(SystemFailureTest):
    def leave_old_files(self, kind):
        for name in FILES[kind]:
            (self.place / name).write_text("old")

    def test_file_that_may_not_grow_keeps_every_old_file(self):
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (300, 300))
        for kind, options in RESULTS.items():
            with self.subTest(kind):
                self.leave_old_files(kind)
                self.assert_fails(*options, says=f"x.{kind}" if kind != "obj" else "x.", preexec_fn=limit)

    def test_second_of_two_files_that_belong_together_fails(self):
        # The library of the Cornell box has about 500 bytes and fits, the OBJ has more and does not.
        self.leave_old_files("obj")
        self.assert_fails(*RESULTS["obj"], says="x.obj",
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000)))

    def test_results_larger_than_the_limit_are_what_fails(self):
        """The limits of the tests above are below what is written: the same run without them succeeds."""
        for options in RESULTS.values():
            self.assertEqual(run("bake", BOX, *options, *TINY, cwd=self.place).returncode, OK)
        for kind in RESULTS:
            self.assertGreater(sum((self.place / name).stat().st_size for name in FILES[kind]), 300)
        self.assertLess((self.place / "x.mtl").stat().st_size, 2000)
        self.assertGreater((self.place / "x.obj").stat().st_size, 2000)

    def test_disk_that_is_full(self):
        """Runs this test again where the folder is a file system of 8 kB, which only a namespace of its own lets us mount."""
        if "LAMBERT_FULL_DISK" in os.environ:
            self.place = Path(os.environ["LAMBERT_FULL_DISK"])
            (self.place / "ballast").write_bytes(b"x" * 8192)
            for kind, options in RESULTS.items():
                with self.subTest(kind):
                    self.assert_fails(*options, says="No space left")
            return
        inside = (f'mount -t tmpfs -o size=8k lambert "{self.folder}" && LAMBERT_FULL_DISK="{self.folder}" exec '
                  f'"{sys.executable}" "{__file__}" NoSpace.test_disk_that_is_full')
        can_mount = subprocess.run(["unshare", "-rm", "mount", "-t", "tmpfs", "lambert", self.folder], capture_output=True)
        if can_mount.returncode != 0:
            self.skipTest("mounting in a namespace of one's own is not permitted")
        done = subprocess.run(["unshare", "-rm", "sh", "-c", inside], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)


class NoAccess(SystemFailureTest):
    def test_target_that_is_a_folder(self):
        for kind, options in RESULTS.items():
            with self.subTest(kind):
                (self.place / FILES[kind][-1]).mkdir()
                self.assert_fails(*options, says=FILES[kind][-1])
                (self.place / FILES[kind][-1]).rmdir()

    def test_folder_that_may_not_be_written(self):
        if os.geteuid() == 0:
            self.skipTest("permissions do not bind root")
        (self.place / "locked").mkdir(mode=0o500)
        for kind, (option, name) in RESULTS.items():
            with self.subTest(kind):
                self.assert_fails(option, f"locked/{name}", says=f"locked/x.{kind}")

    def test_folder_in_which_nobody_can_create_files(self):
        self.assert_fails("-o", "/proc/self/x.glb", says="/proc/self/x.glb")


class NoReader(ProgramTest):
    def test_pipe_that_is_closed_early_is_an_error_and_the_result_whole(self):
        reading, writing = os.pipe()
        os.close(reading)
        with os.fdopen(writing, "wb") as stdout:
            done = run("bake", BOX, "-o", self.folder / "x.glb", *TINY[:4], stdout=stdout)
        self.assertEqual(done.returncode, SYSTEM, done.stderr)
        self.assertEqual([line for line in done.stderr.splitlines() if line.startswith("lambert: ")],
                         ["lambert: standard output cannot be written"])
        self.assertEqual(run("info", self.folder / "x.glb").returncode, OK)
        self.assertEqual([path.name for path in self.folder.iterdir()], ["x.glb"])

    def test_reader_that_takes_one_line(self):
        done = subprocess.run(f'"{PROGRAM}" info "{BOX}" | head -1', shell=True, capture_output=True, text=True)
        self.assertTrue(done.stdout.startswith("scene"), done.stdout)
        self.assertIn(done.stderr, ("", "lambert: standard output cannot be written\n"))


if __name__ == "__main__":
    unittest.main()
