#!/usr/bin/env python3
"""`lambert bake SCENE... --output-dir DIR`: many scenes in one run, some of them broken, interrupted, and taken up again."""
import os
import resource
import shutil
import signal
import subprocess
import unittest

from lambert_cli import DATA, INPUT, INTERRUPTED, OK, PROGRAM, SYSTEM, USAGE, ProgramTest, read_json, run

# A cube of 1 m has 150 patches.
FEW = ("--patch-length", "0.2", "--resolution", "64")
FACES = ((1, 3, 7, 5), (2, 6, 8, 4), (1, 5, 6, 2), (3, 4, 8, 7), (1, 2, 4, 3), (5, 7, 8, 6))
HEADING = "scene status patches rays seconds memory MB imbalance warnings"


def box(size, lamp="lamp"):
    """A closed box seen from inside, its ceiling a lamp."""
    lines = ["mtllib box.mtl"]
    lines += [f"v {size * (k & 1)} {size * (k >> 1 & 1)} {size * (k >> 2)}" for k in range(8)]
    for k, face in enumerate(FACES):
        lines.append(f"usemtl {lamp if k == 3 else 'wall'}")
        lines.append("f " + " ".join(map(str, face)))
    return "\n".join(lines) + "\n"


class BatchTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.scenes = self.folder / "scenes"
        self.scenes.mkdir()
        self.library()

    def library(self, folder=""):
        self.write(f"scenes/{folder}box.mtl", "newmtl wall\nKd .5 .5 .5\nnewmtl lamp\nKd .5 .5 .5\nKe 3 2 1\n")

    def write(self, name, content):
        (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
        return super().write(name, content)

    def batch(self, code, *arguments):
        """Runs it in the folder; the report's runs by the scenes' names, and what was printed."""
        done = run("bake", *arguments, "--json", "report.json", *FEW, cwd=self.folder)
        self.assertEqual(done.returncode, code, done.stderr)
        runs = {entry["scene"]: entry for entry in read_json(self.folder / "report.json")["runs"]}
        return runs, done

    def assert_refused(self, code, *arguments, says):
        before = self.listing()
        done = run("bake", *arguments, *FEW, cwd=self.folder)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        for text in (says,) if isinstance(says, str) else says:
            self.assertIn(text, done.stderr)
        self.assertEqual((done.stdout, self.listing()), ("", before))

    def listing(self, folder=""):
        """Every file under a folder with its bytes."""
        root = self.folder / folder
        return {str(path.relative_to(root)): path.read_bytes() for path in root.rglob("*") if path.is_file()}


class TwelveScenesThreeBroken(BatchTest):
    BROKEN = {"scenes/02.obj": "02.obj:2", "scenes/b/07.gltf": "07.gltf", "scenes/b/11.obj": "no light"}

    def setUp(self):
        super().setUp()
        self.library("b/")
        names = [f"{'b/' if k > 6 else ''}{k:02}" for k in range(1, 13)]
        for k, name in enumerate(names, 1):
            self.write(f"scenes/{name}.obj", box(7 if k == 4 else 0.5 + 0.05 * k))
        self.write("scenes/02.obj", "v 0 0 0\nv 1 x 0\n")
        (self.scenes / "b/07.obj").unlink()
        self.write("scenes/b/07.gltf", '{"asset": {"version": "2.0"}, "scenes": [')
        self.write("scenes/b/11.obj", box(1, lamp="wall"))
        self.good = [name for name in names if not any(f"/{name[-2:]}." in broken for broken in self.BROKEN)]

    def test_nine_are_baked_and_three_explained(self):
        runs, done = self.batch(INPUT, "scenes", "--output-dir", "out", "--image", "pictures/{}.png", "--size", "16x16")
        self.assertEqual(len(runs), 12)
        self.assertEqual(list(runs), sorted(runs))
        table = done.stdout.splitlines()
        self.assertEqual(" ".join(table[0].split()), HEADING)
        self.assertEqual(len(table), 14)
        self.assertIn("12 scenes: 9 baked, 3 failed", table[-1])
        for (scene, entry), line in zip(runs.items(), table[1:]):
            status, log = ("failed", "error: ") if scene in self.BROKEN else ("baked", "energy imbalance")
            self.assertEqual((entry["status"], line.split()[:2]), (status, [scene, status]))
            self.assertIn(log, (self.folder / scene.replace("scenes", "out", 1)).with_suffix(".log").read_text())
        for scene, says in self.BROKEN.items():
            self.assertIn(says, runs[scene]["error"])
            self.assertEqual((runs[scene]["exit_code"], runs[scene]["outputs"]), (INPUT, []))
            self.assertEqual(sum(says in line for line in done.stderr.splitlines()), 1)
            self.assertTrue(any(says in line for line in table))
        for name in self.good:
            entry = runs[f"scenes/{name}.obj"]
            self.assertEqual(entry["outputs"], [f"out/{name}.glb", f"pictures/{name}.png"])
            self.assertEqual((entry["error"], entry["exit_code"]), (None, OK))
            self.assertGreater(entry["patches"], 40)
            self.assertEqual(entry["warnings"], [])
        self.assertEqual(sorted(self.listing("pictures")), sorted(f"{name}.png" for name in self.good))
        self.assertEqual({name for name in self.listing("out") if name.endswith(".glb")},
                         {f"{name}.glb" for name in self.good})

    def start(self, *arguments):
        return subprocess.Popen([PROGRAM, "bake", "scenes", *FEW, *arguments], cwd=self.folder, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def test_interrupted_in_the_fourth_and_started_again_it_ends_the_same(self):
        self.batch(INPUT, "scenes", "--output-dir", "whole")
        with self.start("--output-dir", "parts", "--json", "report.json") as process:
            try:
                # The fourth is read, and its 7400 patches are ahead.
                while not process.stderr.readline().startswith("[4/12]"):
                    self.assertIsNone(process.poll())
                process.send_signal(signal.SIGINT)
                output, errors = process.communicate(timeout=300)
            finally:
                process.kill()
        self.assertEqual(process.returncode, INTERRUPTED, errors)
        self.assertEqual(errors.splitlines()[-1], "lambert: interrupted")
        self.assertIn("12 scenes: 2 baked, 1 failed, 1 interrupted, 8 not run", output)
        runs = read_json(self.folder / "report.json")["runs"]
        self.assertEqual([entry["status"] for entry in runs],
                         ["baked", "failed", "baked", "interrupted"] + ["not run"] * 8)
        self.assertEqual(sorted(self.listing("parts")), ["01.glb", "01.log", "02.log", "03.glb", "03.log"])

        runs, _ = self.batch(INPUT, "scenes", "--output-dir", "parts", "--skip-existing")
        statuses = [entry["status"] for entry in runs.values()]
        self.assertEqual(statuses[:4], ["skipped", "failed", "skipped", "baked"])
        self.assertEqual(statuses.count("baked"), 7)
        self.assertEqual(self.listing("parts"), self.listing("whole"))

    def test_two_runs_into_one_folder_do_no_harm(self):
        self.batch(INPUT, "scenes", "--output-dir", "alone")
        processes = [self.start("--output-dir", "both", *options) for options in ((), ("--skip-existing",))]
        for process in processes:
            with process:
                _, errors = process.communicate(timeout=600)
                self.assertEqual(process.returncode, INPUT, errors)
        self.assertEqual(self.listing("both"), self.listing("alone"))


class WhichScenes(BatchTest):
    def test_folder_is_searched_for_scenes_and_nothing_else(self):
        for name in ("b.obj", "a/c.obj", "a/.hidden.obj", ".git/d.obj", "out/e.obj"):
            self.write(f"scenes/{name}", box(0.5))
        self.write("scenes/notes.txt", "no scene")
        self.write("scenes/wall.png", "no image")
        shutil.copy(DATA / "furnace_box.gltf", self.scenes / "a" / "B.gltf")
        self.library("a/")
        runs, _ = self.batch(OK, "scenes", "--output-dir", "scenes/out", "--format", "ply")
        self.assertEqual(list(runs), ["scenes/a/B.gltf", "scenes/a/c.obj", "scenes/b.obj"])
        self.assertEqual({name for name in self.listing("scenes/out") if name.endswith(".ply")},
                         {"a/B.ply", "a/c.ply", "b.ply"})

    def test_names_are_relative_to_what_the_arguments_have_in_common(self):
        for name in ("x/one.obj", "x/y/two.obj", "z/three.obj"):
            self.write(f"scenes/{name}", box(0.5))
            self.library(name[:name.rindex("/") + 1])
        runs, _ = self.batch(OK, "scenes/x/one.obj", "./scenes/x/y/", "scenes/z/../z/three.obj", "--output-dir", "out",
                             "--quiet")
        self.assertEqual([entry["outputs"] for entry in runs.values()],
                         [["out/x/one.glb"], ["out/x/y/two.glb"], ["out/z/three.glb"]])

    def test_missing_file_is_a_failed_scene(self):
        self.write("scenes/a.obj", box(0.5))
        runs, _ = self.batch(INPUT, "scenes/missing.obj", "scenes/a.obj", "--output-dir", "out")
        self.assertEqual([entry["status"] for entry in runs.values()], ["failed", "baked"])

    def test_memory_that_one_scene_lacks_is_there_for_the_next(self):
        limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (10 ** 9, 10 ** 9))
        if run("--version", preexec_fn=limit).returncode != OK:
            self.skipTest("the program does not start in 1 GB of address space (a sanitizer's build)")
        self.write("scenes/a.obj", box(100))  # 1.5 million patches
        self.write("scenes/b.obj", box(0.5))
        done = run("bake", "scenes", "--output-dir", "out", "--threads", "2", "--memory-limit", "1e18", *FEW,
                   cwd=self.folder, preexec_fn=limit)
        self.assertEqual(done.returncode, SYSTEM, done.stderr)
        self.assertIn("scenes/a.obj: not enough memory", done.stderr)
        self.assertIn("2 scenes: 1 baked, 1 failed", done.stdout)

    def test_report_of_one_scene_is_the_plain_object(self):
        self.write("scenes/a.obj", box(0.5))
        self.run_well("bake", self.scenes / "a.obj", "--output-dir", self.folder / "out", "--json",
                      self.folder / "one.json", "--quiet", *FEW)
        self.assertEqual(read_json(self.folder / "one.json")["status"], "baked")
        self.assertEqual(sorted(self.listing("out")), ["a.glb", "a.log"])


class Refused(BatchTest):
    def setUp(self):
        super().setUp()
        self.write("scenes/a.obj", box(0.5))
        self.write("scenes/b.obj", box(0.5))

    def test_two_scenes_of_one_name(self):
        shutil.copy(DATA / "furnace_box.gltf", self.scenes / "a.gltf")
        self.assert_refused(USAGE, "scenes", "--output-dir", "out", says=("a.gltf", "a.obj", "out/a.glb"))
        self.assert_refused(USAGE, "scenes/a.obj", "scenes", "--output-dir", "out", says="scenes/a.obj and scenes/a.")

    def test_targets_that_do_not_fit_several_scenes(self):
        self.assert_refused(USAGE, "scenes", says="--output-dir")
        self.assert_refused(USAGE, "scenes", "--json", "x.json", says="--output-dir")
        self.assert_refused(USAGE, "scenes/a.obj", "scenes/b.obj", "-o", "x.glb", says="--output-dir")
        self.assert_refused(USAGE, "scenes/a.obj", "-o", "x.glb", "--output-dir", "out", says="--output")
        self.assert_refused(USAGE, "scenes", "--output-dir", "out", "--image", "x.png", says="{}")
        self.assert_refused(USAGE, "scenes", "--output-dir", "out", "--image", "{}.jpg", says=".png")

    def test_overwriting_what_is_read(self):
        for options in (("--output-dir", "scenes", "--format", "obj"), ("--output-dir", "o", "--json", "scenes/box.mtl")):
            self.assert_refused(USAGE, "scenes/a.obj", "scenes/b.obj", *options, says="would overwrite")
        self.assert_refused(USAGE, "scenes", "--output-dir", "scenes", says="is searched")
        self.assert_refused(USAGE, "scenes/a.obj", "scenes/b.obj", "--output-dir", "o", "--json", "o/b.log",
                            says="o/b.log")

    def test_folder_without_scenes(self):
        self.write("empty/notes.txt", "")
        self.assert_refused(INPUT, "empty", "--output-dir", "out", says="found no scene")

    def test_output_folder_that_cannot_be(self):
        self.assert_refused(SYSTEM, "scenes", "--output-dir", "scenes/a.obj/out", says="scenes/a.obj/out")


class SkipExisting(BatchTest):
    ARGUMENTS = ("scenes", "--output-dir", "out", "--skip-existing", "--format", "obj", "--image", "out/{}.png", "--size",
                 "16x16")

    def statuses(self):
        return [entry["status"] for entry in self.batch(OK, *self.ARGUMENTS)[0].values()]

    def test_only_what_is_missing_or_older_than_the_scenes_files_is_baked(self):
        for name in "ab":
            self.write(f"scenes/{name}.obj", box(0.5))
        self.assertEqual(self.statuses(), ["baked", "baked"])
        before = self.listing("out")
        self.assertEqual(self.statuses(), ["skipped", "skipped"])
        for missing in ("a.obj", "a.mtl", "a.png"):
            (self.folder / "out" / missing).unlink()
            self.assertEqual(self.statuses(), ["baked", "skipped"], missing)
        self.assertEqual(self.listing("out"), before)
        later = (self.folder / "out/b.png").stat().st_mtime + 1
        os.utime(self.scenes / "b.obj", (later, later))
        self.assertEqual(self.statuses(), ["skipped", "baked"])
        os.utime(self.scenes / "b.obj", (1, 1))
        os.utime(self.scenes / "box.mtl", (later + 1000, later + 1000))
        self.assertEqual(self.statuses(), ["baked", "baked"])

    def test_one_scene(self):
        scene, target = self.write("scenes/a.obj", box(0.5)), self.folder / "a.glb"
        for status in ("baked", "skipped"):
            done = self.run_well("bake", scene, "-o", target, "--skip-existing", *FEW)
            self.assertIn(f"1 scene: 1 {status}", done.stdout)


class DryRun(BatchTest):
    def test_predicts_and_writes_nothing(self):
        self.write("scenes/a.obj", box(1))
        self.write("scenes/b.obj", box(1.5))
        self.write("scenes/c.obj", "v x\n")
        before = self.listing()
        done = run("bake", "scenes", "--output-dir", "out", "--dry-run", *FEW, cwd=self.folder)
        self.assertEqual((done.returncode, self.listing()), (INPUT, before), done.stderr)
        self.assertIn("3 scenes: 2 predicted, 1 failed; a bake takes about", done.stdout)
        self.assertFalse((self.folder / "out").exists())

        predicted, _ = self.batch(INPUT, "scenes", "--dry-run")
        baked, _ = self.batch(INPUT, "scenes", "--output-dir", "out")
        for scene in ("scenes/a.obj", "scenes/b.obj"):
            self.assertEqual(predicted[scene]["status"], "predicted")
            for key in ("patches", "rays"):
                self.assertEqual(predicted[scene][key], baked[scene][key])
            self.assertGreater(predicted[scene]["seconds"]["total"], 0)
            self.assertGreater(predicted[scene]["peak_memory_bytes"], 1e6)
        self.assertEqual(predicted["scenes/c.obj"]["status"], "failed")


class Quality(BatchTest):
    def report(self, *options):
        return self.bake(self.write("scenes/a.obj", box(1)), "--resolution", "16", *options)

    def test_presets_change_patches_tolerance_and_sky_rays_and_options_win(self):
        preview, normal = self.report("--quality", "preview"), self.report("--quality", "normal")
        self.assertEqual(normal["patches"], self.report()["patches"])
        self.assert_close(preview["patches"], 1006, 0.05)
        self.assert_close(normal["patches"], 5006, 0.05)
        self.assertEqual([r["options"]["tolerance"] for r in (preview, normal)], [1e-3, 1e-4])
        self.assertEqual([r["options"]["sky_rays"] for r in (preview, normal)], [512, 4096])
        finer = self.report("--quality", "preview", "--patches", "200", "--tolerance", "1e-2", "--sky-rays", "64")
        self.assert_close(finer["patches"], 200, 0.1)
        self.assertEqual(finer["options"]["tolerance"], 1e-2)
        self.assertEqual(finer["options"]["sky_rays"], 64)
        self.assertEqual(finer["options"]["quality"], "preview")


if __name__ == "__main__":
    unittest.main()
