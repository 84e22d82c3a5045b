#!/usr/bin/env python3
"""Energy that does not add up: what `bake` and `probe` say of it, and how they end."""
import unittest

from lambert_cli import MISSED, OK, ProgramTest, read_json, read_table, run

# A closed room of 2 m with a white lamp of two sides 10 cm below its ceiling.
ROOM = """mtllib room.mtl
v 0 0 0
v 2 0 0
v 2 2 0
v 0 2 0
v 0 0 2
v 2 0 2
v 2 2 2
v 0 2 2
v .4 .4 1.9
v 1.6 .4 1.9
v 1.6 1.6 1.9
v .4 1.6 1.9
usemtl wall
f 1 2 3 4
f 5 8 7 6
f 1 5 6 2
f 4 3 7 8
f 1 4 8 5
f 2 6 7 3
usemtl lamp
f 9 10 11 12
f 12 11 10 9
"""
MATERIALS = "newmtl wall\nKd .9 .9 .9\nnewmtl lamp\nKd .95 .95 .95\nKe 1 1 1\n"
# One viewpoint per patch, and no division of the ceiling along the lamp's outline.
COARSE = ("--patches", "30", "--whole-contacts", "--method", "hemicube", "--resolution", "8", "--quiet")


class BalanceTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("room.mtl", MATERIALS)
        self.scene = self.write("room.obj", ROOM)

    def baked(self, code, *options):
        """The report, once all that is printed has been looked at."""
        done = run("bake", self.scene, "-o", self.folder / "room.glb", "--json", self.folder / "report.json", *options)
        self.assertEqual(done.returncode, code, done.stderr)
        report = read_json(self.folder / "report.json")
        printed = [line.removeprefix(f"warning: {self.scene}: ") for line in done.stderr.splitlines()]
        self.assertEqual(printed, report["warnings"])
        self.assertTrue((self.folder / "room.glb").stat().st_size > 0)
        return report


class Bake(BalanceTest):
    def test_poor_form_factors_are_told_of_and_miss_the_target(self):
        report = self.baked(MISSED, *COARSE)
        energy = report["energy"]
        self.assertGreater(abs(energy["imbalance"]), .05)
        # The same but for the residual of 1e-4, of light that is passed on 1 / (1 - .9) times.
        self.assertAlmostEqual(energy["imbalance_before_repair"], energy["imbalance"], delta=1e-3)
        self.assertEqual(len(report["warnings"]), 1)
        for text in ("form factors", "--hemicubes 4", "--solver stochastic", "exit code 1"):
            self.assertIn(text, report["warnings"][0])

    def test_a_repair_hides_nothing(self):
        report = self.baked(MISSED, *COARSE, "--repair")
        self.assertLess(abs(report["energy"]["imbalance"]), .01)  # of the lamp's own light, which is found apart
        self.assertGreater(abs(report["energy"]["imbalance_before_repair"]), .05)
        self.assertIn("before repair", report["warnings"][0])
        self.assertGreater(report["form_factors"]["repair"]["row_change"], .01)

    def test_the_way_out_leads_out(self):
        report = self.baked(OK, "--patches", "200", "--whole-contacts", "--solver", "stochastic", "--quiet")
        self.assertEqual(report["warnings"], [])
        self.assertIsNone(report["energy"]["imbalance_before_repair"])

    def test_several_scenes_say_which_one(self):
        (self.folder / "scenes").mkdir()
        self.write("scenes/room.mtl", MATERIALS)
        self.write("scenes/near.obj", ROOM)
        self.write("scenes/far.obj", ROOM.replace("1.9\n", "1\n"))
        done = run("bake", self.folder / "scenes", "--output-dir", self.folder / "out", "--json",
                   self.folder / "report.json", *COARSE[:-1])
        self.assertEqual(done.returncode, MISSED, done.stderr)
        far, near = read_json(self.folder / "report.json")["runs"]
        self.assertEqual([(r["status"], r["exit_code"]) for r in (far, near)], [("baked", OK), ("baked", MISSED)])
        self.assertEqual([line.count("missed a target") for line in done.stdout.splitlines()[1:3]], [0, 1])


class Probe(BalanceTest):
    def test_readings_are_written_and_the_target_is_missed(self):
        table = self.folder / "readings.csv"
        done = run("probe", self.scene, self.write("points.csv", "1,1,0,0,0,1\n"), "-o", table, "--json",
                   self.folder / "report.json", *COARSE)
        self.assertEqual(done.returncode, MISSED, done.stderr)
        self.assertGreater(read_table(table)[0][6], 0)
        self.assertIn("form factors", read_json(self.folder / "report.json")["warnings"][0])


if __name__ == "__main__":
    unittest.main()
