#!/usr/bin/env python3
"""`lambert bake --solver`: the same light whatever the solver, what each reports, and what is refused."""
import unittest

from lambert_cli import DATA, MISSED, SYSTEM, USAGE, ProgramTest, materials, read_json, run

BOX = DATA / "cornell_box.obj"
SOLVERS = ("jacobi", "gauss-seidel", "southwell", "conjugate-gradient")
SMALL = ("--patches", "400", "--resolution", "32")


class Light(ProgramTest):
    def test_is_the_same_whatever_the_solver(self):
        # Repaired rows are reciprocal: then shooting and gathering solve the same equation.
        reports = {solver: self.bake(BOX, *SMALL, "--repair", "--solver", solver, "--tolerance", "1e-7")
                   for solver in SOLVERS}
        for solver, report in reports.items():
            self.assertEqual(report["solver"], solver)
            self.assertLessEqual(report["residual"], 1e-7)
            self.assertEqual(report["history"][-1]["iteration"], report["iterations"])
            self.assertEqual(report["history"][-1]["residual"], report["residual"])
            # All that is reflected; the light of the lamp is found apart, and what of it leaves the box by its coarse row.
            self.assertLess(abs(report["energy"]["imbalance"]), 2e-3)
            for name, material in materials(report).items():
                for value, expected in zip(material["mean_irradiance"],
                                           materials(reports["jacobi"])[name]["mean_irradiance"]):
                    self.assert_close(value, expected, 1e-5, (solver, name))

    def test_comes_without_a_matrix_within_a_memory_limit_that_no_matrix_fits(self):
        options = (*SMALL, "--solver", "southwell", "--memory-limit", "100000")
        refused = run("bake", BOX, *options, "--json", self.folder / "refused.json")
        self.assertEqual(refused.returncode, SYSTEM, refused.stderr)
        computed = self.bake(BOX, *options, "--storage", "none")
        stored = self.bake(BOX, *SMALL, "--solver", "southwell", "--storage", "double")
        self.assertEqual(computed["materials"], stored["materials"])  # to the last bit
        self.assertEqual(computed["iterations"], stored["iterations"])
        self.assertEqual(computed["form_factors"]["bytes"], 0)
        self.assertEqual(computed["options"]["storage"], "none")

    def test_without_a_matrix_is_that_of_any_number_of_threads(self):
        options = (*SMALL, "--solver", "southwell", "--storage", "none")
        one, three = (self.bake(BOX, *options, "--threads", n) for n in (1, 3))
        self.assertEqual(one["materials"], three["materials"])
        self.assertEqual(one["energy"], three["energy"])


class Bounces(ProgramTest):
    def test_are_reported_one_by_one(self):
        # In the furnace of ρ = 1/2 each bounce reflects half of the one before; B_e = 1 on 13 m².
        report = self.bake(DATA / "furnace_box.obj", "--patches", "100", "--resolution", "32", "--bounces", "5",
                           "--keep-bounces")
        self.assertEqual(report["solver"], "jacobi")
        self.assertEqual(len(report["bounces"]), 5)
        for k, bounce in enumerate(report["bounces"]):
            for channel in bounce["reflected"]:
                self.assert_close(channel, 13 * 0.5 ** (k + 1), 1e-5, k)

    def test_are_not_reported_unless_kept(self):
        self.assertNotIn("bounces", self.bake(BOX, *SMALL))


class Options(ProgramTest):
    def refused(self, word, *options):
        done = run("bake", BOX, *SMALL, *options, "--json", self.folder / "r.json")
        self.assertEqual(done.returncode, USAGE, done.stderr)
        self.assertIn(word, done.stderr)

    def test_of_other_solvers_are_usage_errors(self):
        self.refused("--bounces", "--solver", "gauss-seidel", "--bounces", "2")
        self.refused("--bounces", "--solver", "southwell", "--bounces", "2")
        self.refused("--keep-bounces", "--solver", "conjugate-gradient", "--keep-bounces")
        self.refused("--relaxation", "--solver", "jacobi", "--relaxation", "1.2")
        self.refused("--relaxation", "--relaxation", "1.2")
        self.refused("--relaxation", "--solver", "gauss-seidel", "--relaxation", "2")
        self.refused("--tolerance", "--solver", "southwell", "--tolerance", "0")

    def test_that_need_a_matrix_are_usage_errors_without_one(self):
        for option in (("--repair",), ("--method", "global-lines"),
                       ("--form-factors", self.folder / "f.mtx")):
            self.refused(option[0] if option[0] != "--method" else "global-lines", "--storage", "none", *option)
        done = run("formfactors", BOX, *SMALL, "--storage", "none", "-o", self.folder / "f.mtx")
        self.assertEqual(done.returncode, USAGE, done.stderr)

    def test_in_force_are_in_the_report(self):
        options = self.bake(BOX, *SMALL, "--solver", "gauss-seidel", "--relaxation", "1.1")["options"]
        self.assertEqual((options["relaxation"], options["bounces"], options["keep_bounces"]), (1.1, 0, False))

    def test_a_tolerance_that_rounding_does_not_allow_misses_the_target(self):
        report = self.folder / "r.json"
        done = run("bake", BOX, *SMALL, "--tolerance", "1e-30", "--json", report)
        self.assertEqual(done.returncode, MISSED, done.stderr)
        self.assertLess(read_json(report)["residual"], 1e-13)


if __name__ == "__main__":
    unittest.main()
