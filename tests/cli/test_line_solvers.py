#!/usr/bin/env python3
"""`lambert bake --solver stochastic` and `random-walk`: agreement with form factors, what they report, what they refuse."""
import os
import unittest

from lambert_cli import DATA, INPUT, MISSED, OK, USAGE, ProgramTest, materials, read_json, run

BOX = DATA / "cornell_box.obj"


class Light(ProgramTest):
    def test_is_that_of_form_factors(self):
        # The error of 1 % is that of the patches; the mean of a material's tens to hundreds of patches errs far less, that of
        # the lamp's two as much as theirs. Hemicubes err by up to 0.2 %.
        expected = materials(self.bake(BOX, "--patches", "1500"))
        for options in (("stochastic", "--target-error", "0.01"),
                        ("stochastic", "--target-error", "0.01", "--method", "global-lines"),
                        ("random-walk", "--rays", "4e6")):
            found = materials(self.bake(BOX, "--patches", "1500", "--solver", *options))
            for name, material in found.items():
                for value, exact in zip(material["mean_irradiance"], expected[name]["mean_irradiance"]):
                    self.assert_close(value, exact, 0.05 if name == "light" else 0.01, (options, name))

    def test_is_that_of_any_number_of_threads(self):
        options = ("--patches", "300", "--solver", "stochastic", "--rays", "1e5")
        one, three = (self.bake(BOX, *options, "--threads", n) for n in (1, 3))
        self.assertEqual(one["materials"], three["materials"])
        self.assertEqual(one["stochastic"], three["stochastic"])


class Memory(ProgramTest):
    def test_of_a_whole_bake_grows_by_at_most_400_bytes_per_patch(self):
        # Each thread that gets to run adds a few megabytes of its own, whatever the number of patches: a busy machine runs more.
        few, many = (self.bake(BOX, "--patches", n, "--solver", "stochastic", "--rays", "1e5", "--threads", "1",
                               "-o", self.folder / "baked.glb") for n in (100_000, 300_000))
        bytes_per_patch = (many["peak_memory_bytes"] - few["peak_memory_bytes"]) / (many["patches"] - few["patches"])
        self.assertLessEqual(bytes_per_patch, 400)


class SolutionFile(ProgramTest):
    def test_is_read_again(self):
        for solver in ("stochastic", "random-walk"):
            file = self.folder / (solver + ".glb")
            report = self.bake(BOX, "--patches", "300", "--solver", solver, "--rays", "1e5", "--solution", file)
            self.run_well("compare", "bakes", file, file, "--json", self.folder / "compared.json")
            self.assertEqual(read_json(self.folder / "compared.json")["a"]["solver"], solver)
            self.assertEqual([step["iteration"] for step in report["history"]], list(range(2, 9)))


class TargetError(ProgramTest):
    def test_is_reached(self):
        report = self.bake(BOX, "--patches", "300", "--solver", "stochastic", "--target-error", "0.05")
        self.assertTrue(report["stochastic"]["target_reached"])
        self.assertLessEqual(report["stochastic"]["upper_relative_error"], 0.05)
        self.assertGreater(report["stochastic"]["relative_error"], 0.005)
        self.assertEqual(report["options"]["target_error"], 0.05)
        self.assertEqual((report["solver"], report["method"]), ("stochastic", "local-lines"))

    def test_that_is_missed_is_said_to_be(self):
        result = run("bake", BOX, "--patches", "300", "--solver", "stochastic", "--target-error", "0.001", "--rays", "20000",
                     "-o", self.folder / "missed.glb")
        self.assertEqual(result.returncode, MISSED, result.stderr)
        self.assertIn("--target-error", result.stderr)
        self.assertTrue((self.folder / "missed.glb").exists())


class Options(ProgramTest):
    def test_of_form_factors_are_refused(self):
        for options in (("--resolution", "64"), ("--method", "hemicube"), ("--tolerance", "0.1"), ("--sampler", "halton"),
                        ("--storage", "float"), ("--repair",), ("--target-error", "1.5"), ("--bounces", "2")):
            result = run("bake", BOX, "--solver", "stochastic", *options, "-o", self.folder / "x.glb")
            self.assertEqual(result.returncode, USAGE, (options, result.stderr))
            self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
            self.assertFalse((self.folder / "x.glb").exists())

    def test_of_lines_mean_nothing_to_others(self):
        for option in ("--rays", "--target-error"):
            self.assertEqual(run("bake", BOX, option, "0.5", "--json", self.folder / "x.json").returncode, USAGE)


class Checkpoint(ProgramTest):
    # Some seconds of one thread; states are written after every iteration, or every half a million walks.
    VARIANTS = (("stochastic", "--rays", "1.6e7"), ("stochastic", "--rays", "8e6", "--method", "global-lines"),
                ("random-walk", "--rays", "8e6"))

    def command(self, name, *options):
        return ("bake", BOX, "--patches", "1000", "--solution", self.folder / (name + ".glb"), "--json",
                self.folder / (name + ".json"), "--quiet", "--solver", *options)

    def keeping(self, *options):
        return (*self.command("parts", *options), "--checkpoint", self.folder / "state", "--checkpoint-interval", "0")

    def bytes_of(self, name):
        return (self.folder / (name + ".glb")).read_bytes()

    def test_of_a_solve_that_was_killed_ends_with_the_same_bytes(self):
        for options in self.VARIANTS:
            self.run_well(*self.command("whole", *options))
            report = read_json(self.folder / "whole.json")
            killed = kept = 0
            for share in (0.3, 0.5, 0.7, 0.9):
                killed += self.killed(share * report["seconds"]["total"], *self.keeping(*options), "--resume")
                kept += (self.folder / "state.solver").exists()
            self.assertGreater(killed, 0, options)
            self.assertGreater(kept, 0, options)
            self.assertEqual(run(*self.keeping(*options), "--resume").returncode, OK)
            self.assertTrue(self.bytes_of("parts") == self.bytes_of("whole"), options)
            parts = read_json(self.folder / "parts.json")
            self.assertEqual(parts["stochastic"], report["stochastic"])
            self.assertEqual(parts["rays"], report["rays"])
            self.assertFalse((self.folder / "state.solver").exists())

    def test_is_of_each_light_too(self):
        lights = ("--per-light", "--emit", "floor=0.1,0.1,0.2")
        options = ("stochastic", "--rays", "4e6", *lights)
        self.run_well(*self.command("whole", *options), "-o", self.folder / "whole_baked.glb")
        total = read_json(self.folder / "whole.json")["seconds"]["total"]
        more = ("-o", self.folder / "parts_baked.glb", "--resume")
        seen = set()
        for share in (0.5, 0.7, 0.9):
            self.killed(share * total, *self.keeping(*options), *more)
            seen.update(path.name for path in self.folder.glob("state.solver*"))
        self.assertIn("state.solver", seen)
        self.run_well(*self.keeping(*options), *more)
        for path in self.folder.glob("whole*.glb"):
            other = path.with_name(path.name.replace("whole", "parts"))
            self.assertTrue(other.read_bytes() == path.read_bytes(), path.name)
        self.assertEqual([name for name in os.listdir(self.folder) if name.startswith("state")], [])

    def kept_state(self, options):
        """A state that a killed run has left."""
        for seconds in (0.5, 1, 2, 4, 8):
            if self.killed(seconds, *self.keeping(*options), "--resume") and (self.folder / "state.solver").exists():
                return (self.folder / "state.solver").read_bytes()
        return self.fail("no state was written")

    def test_that_is_damaged_is_an_input_error(self):
        options = ("stochastic", "--rays", "3e7")
        sound = self.kept_state(options)
        body = sound.index(b"\n") + 1
        for damaged in (sound[:body], sound[:body + 3], sound[:len(sound) // 2], sound[:-1], sound + b"x",
                        *(sound[:at] + bytes([sound[at] ^ 4]) + sound[at + 1:]
                          for at in (body, body + 7, len(sound) // 2, len(sound) - 1))):
            self.write("state.solver", damaged)
            done = run(*self.keeping(*options), "--resume")
            self.assertEqual(done.returncode, INPUT, done.stderr)
            self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
            self.assertIn("state.solver", done.stderr)

    def test_of_another_run_is_a_usage_error(self):
        options = ("stochastic", "--rays", "3e7")
        sound = self.kept_state(options)
        for other in (("stochastic", "--rays", "4e7"), ("random-walk", "--rays", "3e7"), (*options, "--seed", "2"),
                      (*options, "--method", "global-lines"), (*options, "--target-error", "0.01"),
                      (*options, "--sampler", "random"), (*options, "--reflectance", "floor=0.1,0.1,0.1"),
                      (*options, "--two-sided")):
            done = run(*self.keeping(*other), "--resume")
            self.assertEqual(done.returncode, USAGE, (other, done.stderr))
            self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        self.assertEqual(run(*self.keeping(*options)).returncode, USAGE)  # without --resume
        self.assertEqual((self.folder / "state.solver").read_bytes(), sound)


if __name__ == "__main__":
    unittest.main()
