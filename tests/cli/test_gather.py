#!/usr/bin/env python3
"""`lambert bake --reconstruction gather`: what it writes, says and refuses."""
import unittest

from lambert_cli import DATA, USAGE, ProgramTest, run

FEW = ("--patches", 400, "--solver", "stochastic", "--target-error", 0.05)


class Gather(ProgramTest):
    def gathered(self, scene, *options):
        return self.bake(scene, "-o", self.folder / "baked.ply", *FEW, *options)

    def test_the_report_says_what_it_took_and_how_good_it_is(self):
        report = self.gathered(DATA / "cornell_box.obj", "--reconstruction", "gather")
        gather = report["gather"]
        self.assertEqual(report["options"]["reconstruction"], "gather")
        self.assertEqual(report["options"]["gather_error"], 0.01)
        self.assertGreater(gather["vertices"], 400)
        self.assertGreaterEqual(gather["rays"], 128 * gather["vertices"])
        self.assertGreater(gather["relative_error"], 0)
        # In a box where light varies slowly every vertex is as good as asked for, or has taken all the rays there are.
        self.assertLess(gather["largest_relative_error"], 0.03)

    def test_a_smaller_error_takes_more_rays(self):
        coarse = self.gathered(DATA / "cornell_box.obj", "--reconstruction", "gather", "--gather-error", 0.05)["gather"]
        fine = self.gathered(DATA / "cornell_box.obj", "--reconstruction", "gather", "--gather-error", 0.003)["gather"]
        self.assertLess(fine["relative_error"], coarse["relative_error"])
        self.assertGreater(fine["rays"], 2 * coarse["rays"])

    def test_without_it_there_is_no_gather_to_report(self):
        report = self.gathered(DATA / "cornell_box.obj")
        self.assertNotIn("gather", report)
        self.assertEqual(report["options"]["reconstruction"], "average")
        self.assertIsNone(report["options"]["gather_error"])

    def test_each_light_alone_is_gathered_too(self):
        report = self.gathered(DATA / "table_room.gltf", "--reconstruction", "gather", "--per-light")
        self.assertGreater(len(report["lights"]), 1)

    def test_an_error_that_nothing_heeds_is_a_mistake(self):
        done = run("bake", DATA / "cornell_box.obj", "-o", self.folder / "x.glb", "--gather-error", 0.1)
        self.assertEqual(done.returncode, USAGE)
        self.assertIn("--gather-error: means nothing without --reconstruction gather", done.stderr)


if __name__ == "__main__":
    unittest.main()
