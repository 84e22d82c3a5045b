#!/usr/bin/env python3
"""`lambert bake --solver stochastic` and `random-walk`: agreement with form factors, what they report, what they refuse."""
import unittest

from lambert_cli import DATA, MISSED, USAGE, ProgramTest, materials, run

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


if __name__ == "__main__":
    unittest.main()
