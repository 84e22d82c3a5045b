#!/usr/bin/env python3
"""`lambert formfactors`: matrices and their files, groups, heat flow, points, checkpoints; and bakes from matrix files."""
import math
import signal
import subprocess
import time
import unittest

from lambert_cli import DATA, INPUT, INTERRUPTED, PROGRAM, SYSTEM, USAGE, ProgramTest, read_json, read_table, run
from test_interrupt import is_computing

try:
    import numpy
except ImportError:
    numpy = None
try:
    import scipy.io
    import scipy.sparse
except ImportError:
    scipy = None

CORNELL = DATA / "cornell_box.obj"
CUBE = DATA / "cube6.obj"  # a closed unit cube, a material per face
SQUARES = DATA / "parallel_squares.obj"
SIGMA = 5.670374419e-8
METHODS = ("auto", "hemicube", "hemisphere", "local-lines", "global-lines", "closed-form")
WITH_POINTS = ("auto", "hemicube", "hemisphere", "local-lines", "closed-form")
EFFORT = {"auto": (), "hemicube": ("--resolution", 64), "hemisphere": ("--resolution", 64), "local-lines": ("--lines", 4096),
          "global-lines": ("--lines", 2000000), "closed-form": ()}


class FormFactorsTest(ProgramTest):
    def factors(self, scene, *arguments):
        """Runs the command and returns its JSON report."""
        report = self.folder / "report.json"
        self.run_well("formfactors", scene, "--json", report, "--quiet", *arguments)
        return read_json(report)

    def refused(self, code, *arguments):
        done = run("formfactors", *arguments)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr


class Report(FormFactorsTest):
    def test_every_method_reports_its_row_sums_and_what_repair_changed(self):
        for method in METHODS:
            with self.subTest(method):
                report = self.factors(CORNELL, "--patches", 300, "--method", method, *EFFORT[method])
                self.assertEqual(report["method"], method)
                self.assertEqual(report["rays"] > 0, method != "closed-form")
                # Rays close, rounded to float; the closed form has an error of its own, 1e-4 where pairs are partly hidden.
                self.assertLess(report["row_sums"]["worst_error"], 1e-3 if method == "closed-form" else 1e-6)
                self.assertIsNone(report["repair"])
                repaired = self.factors(CORNELL, "--patches", 300, "--method", method, *EFFORT[method], "--repair")
                self.assertLess(repaired["row_sums"]["worst_error"], 1.1e-6)  # 1e-6 and rounding
                self.assertLess(repaired["reciprocity"]["rms_error"], 1e-6)
                if method in METHODS[1:4]:  # others are reciprocal, or nearly so, as they are
                    self.assertGreater(report["reciprocity"]["rms_error"], 1e-3)
                self.assertGreater(repaired["repair"]["largest_correction"], 0)

    def test_repaired_bakes_balance_their_energy(self):
        for method in METHODS:
            report = self.bake(CORNELL, "--patches", 1000, "--method", method, *EFFORT[method], "--repair",
                               "--tolerance", 1e-6)
            # What is left is the solver's residual, at most its tolerance times the ratio of all area to the light's; and what
            # the lamp's row says of the light that leaves the box, 19 % of its own, to 1 % by such efforts.
            self.assertLess(abs(report["energy"]["imbalance"]), 2e-3, method)

    def test_options_that_a_method_does_not_have_are_refused(self):
        self.assertIn("--lines", self.refused(USAGE, CUBE, "--lines", 100, "-o", self.folder / "m.npy"))
        self.assertIn("--resolution", self.refused(USAGE, CUBE, "--method", "local-lines", "--resolution", 64, "-o",
                                                   self.folder / "m.npy"))
        self.refused(USAGE, CUBE, "--resolution", 63, "-o", self.folder / "m.npy")
        self.refused(USAGE, CUBE)
        self.refused(USAGE, CUBE, "-o", self.folder / "m.dat")
        self.refused(USAGE, CUBE, "--resume", "-o", self.folder / "m.npy")

    def test_a_csv_of_too_many_patches_is_refused_before_the_work(self):
        start = time.monotonic()
        self.assertIn("5000", self.refused(USAGE, CUBE, "--patches", 20000, "--resolution", 1024, "-o",
                                           self.folder / "m.csv"))
        self.assertLess(time.monotonic() - start, 60)  # the matrix would take many minutes
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_what_does_not_fit_the_memory_limit_is_refused_before_the_work(self):
        error = self.refused(SYSTEM, CUBE, "--patches", 3000, "--resolution", 512, "--storage", "double",
                             "--memory-limit", 1e6, "-o", self.folder / "m.npy")
        self.assertIn("--memory-limit", error)
        report = self.factors(CUBE, "--patches", 1000, "--resolution", 64, "--memory-limit", 6e6, "-o",
                              self.folder / "m.npy")
        self.assertEqual(report["options"]["storage"], "compact")

    def test_old_files_stay_when_interrupted(self):
        target = self.write("m.npy", "old")
        arguments = [PROGRAM, "formfactors", str(CORNELL), "--patches", "20000", "--resolution", "512", "-o", str(target)]
        with subprocess.Popen(arguments, stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
            while process.poll() is None and not is_computing(process.pid):
                time.sleep(0.02)
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=300)
        self.assertEqual(process.returncode, INTERRUPTED, errors)
        self.assertEqual(target.read_text(), "old")
        self.assertEqual(list(self.folder.iterdir()), [target])


class Files(FormFactorsTest):
    SMALL = ("--patches", 200, "--resolution", 64)

    def write_all(self):
        names = {end: self.folder / f"m.{end}" for end in ("mtx", "npy", "csv", "txt")}
        for path in names.values():
            self.factors(CORNELL, *self.SMALL, "-o", path)
        return names

    @unittest.skipUnless(numpy, "NumPy is missing")
    def test_numpy_and_scipy_load_the_same_matrix(self):
        names = self.write_all()
        dense = numpy.load(names["npy"])
        rest = numpy.loadtxt(f"{names['npy']}.areas.csv", delimiter=",")
        self.assertEqual(dense.shape[0], dense.shape[1])
        self.assertLess(numpy.abs(dense.sum(axis=1) + rest[:, 1] + rest[:, 2] - 1).max(), 1e-6)  # float storage
        text = numpy.loadtxt(names["csv"], delimiter=",")
        self.assertLess(numpy.abs(text - dense).max(), 1e-9)  # nine digits
        if scipy:
            self.assertTrue((scipy.io.mmread(names["mtx"]).toarray() == dense).all())

    @unittest.skipUnless(scipy, "SciPy is missing")
    def test_scipy_takes_the_arrays_of_a_large_matrix(self):
        path = self.folder / "large.npy"
        report = self.factors(CUBE, "--patches", 21000, "--resolution", 16, "-o", path)
        parts = [numpy.load(self.folder / f"large.{name}.npy") for name in ("data", "indices", "indptr")]
        matrix = scipy.sparse.csr_matrix(tuple(parts), shape=(report["patches"], report["patches"]))
        self.assertEqual(matrix.nnz, report["entries"])
        self.assertLess(numpy.abs(matrix.sum(axis=1) - 1).max(), 1e-6)  # closed, float storage

    def test_bakes_from_files_are_the_bake_without(self):
        names = self.write_all()
        baked = self.folder / "direct.ply"
        self.bake(CORNELL, *self.SMALL, "-o", baked)
        for end, path in names.items():
            report = self.bake(CORNELL, "--patches", 200, "--form-factors", path, "-o", self.folder / f"{end}.ply")
            self.assertEqual(report["method"], "file")
            if end != "csv":  # holds nine digits, all others the float as it is
                self.assertEqual((self.folder / f"{end}.ply").read_bytes(), baked.read_bytes(), end)

    def test_view3d_text_written_read_and_written_again_is_the_same(self):
        first, second = self.folder / "a.txt", self.folder / "b.txt"
        self.factors(CORNELL, *self.SMALL, "-o", first)
        self.factors(CORNELL, "--patches", 200, "--form-factors", first, "-o", second)
        self.assertEqual(first.read_bytes(), second.read_bytes())
        self.assertEqual((self.folder / "a.txt.areas.csv").read_bytes(), (self.folder / "b.txt.areas.csv").read_bytes())

    def test_a_matrix_of_another_mesh_is_refused(self):
        matrix = self.folder / "m.npy"
        self.factors(CUBE, "--patches", 54, "--resolution", 32, "-o", matrix)
        for scene, patches, word in ((CUBE, 600, "patches"), (DATA / "furnace_box.obj", 0, "patches")):
            done = run("bake", scene, "--patches", patches, "--form-factors", matrix, "--json", self.folder / "r.json")
            self.assertEqual(done.returncode, INPUT, done.stderr)
            self.assertIn(word, done.stderr)
        areas = self.folder / "m.npy.areas.csv"
        areas.write_text(areas.read_text().replace("0,0", "0.5,0", 1))
        done = run("bake", CUBE, "--patches", 54, "--form-factors", matrix, "--json", self.folder / "r.json")
        self.assertEqual(done.returncode, INPUT, done.stderr)
        done = run("bake", CUBE, "--form-factors", matrix, "--method", "hemicube", "--json", self.folder / "r.json")
        self.assertEqual(done.returncode, USAGE, done.stderr)


class Groups(FormFactorsTest):
    def heat(self, scene, temperatures, *arguments):
        report = self.factors(scene, "--group-by", "material", "--temperatures",
                              self.write("temperatures.csv", temperatures), *arguments)
        return report, {group["name"]: group for group in report["groups"]}

    def test_faces_of_a_cube_see_each_other_by_a_fifth(self):
        table = self.folder / "groups.csv"
        report = self.factors(CUBE, "--patches", 600, "--group-by", "material", "--repair", "-o", table)
        expected = 0.19982490  # opposed unit squares; neighbours 0.20004377 (Howell's catalogue C-11 and C-14)
        for i, group in enumerate(report["groups"]):
            self.assert_close(group["area"], 1, 1e-6)
            self.assert_close(sum(group["factors"]), 1, 1e-6)
            self.assert_close(group["factors"][i ^ 1], expected, 2e-3, group["name"])  # hemicubes of 128 pixels
        lines = [line.split(",") for line in table.read_text().splitlines() if not line.startswith("#")]
        self.assertEqual(lines[0][:3], ["group", "area", "F to x0"])
        self.assertEqual(lines[0][-2:], ["row_sum", "reciprocity_error"])
        self.assertEqual(len(lines), 7)
        self.assert_close(float(lines[1][3]), expected, 2e-3)

    def test_the_table_stands_on_stdout(self):
        done = self.run_well("formfactors", CUBE, "--patches", 54, "--resolution", 32, "--group-by", "node", "--quiet")
        self.assertIn("F from", done.stdout)

    def test_tables_say_how_far_rows_and_pairs_can_be_trusted(self):
        small = (CUBE, "--patches", 54, "--resolution", 32, "--group-by", "node")
        report = self.factors(*small)
        printed = self.run_well("formfactors", *small).stdout
        for word in ("(sum)", "(asymmetry)", "reciprocity: A F of both directions"):
            self.assertIn(word, printed)
        for group in report["groups"]:
            self.assertAlmostEqual(group["row_sum"], 1, 6)  # rows of hemicubes are stored as floats
            # Nine hemicubes of 32 pixels: some tenths of a percent, and no more than the worst pair of all.
            self.assertLessEqual(0, group["reciprocity_error"])
            self.assertLessEqual(group["reciprocity_error"], report["group_reciprocity"]["worst_error"])
        self.assertLess(report["group_reciprocity"]["worst_error"], .02)
        self.assertLessEqual(report["group_reciprocity"]["rms_error"], report["group_reciprocity"]["worst_error"])
        repaired = self.factors(*small, "--repair")
        self.assertLess(repaired["group_reciprocity"]["worst_error"], 1e-6)

    def test_black_cube_gives_off_what_its_factors_say(self):
        # One face hot, all others cold and black: Q = σ T⁴ (1 − F_11), to each other face its factor's part.
        lines = "".join(f"{name},0,1\n" for name in ("x1", "y0", "y1", "z0", "z1"))
        report, groups = self.heat(CUBE, "x0,1000,1\n" + lines, "--patches", 600)
        self.assert_close(groups["x0"]["watts"], SIGMA * 1e12, 1e-6)
        self.assert_close(groups["x1"]["watts"], -SIGMA * 1e12 * 0.19982490, 2e-3)
        self.assertLess(abs(report["heat_flow"]["sum_watts"]), 2e-6 * SIGMA * 1e12)

    def test_a_plane_grey_surface_among_black_ones(self):
        # It sees only the others, and these give back nothing of what it gives: Q = ε σ (T1⁴ − T2⁴), exactly.
        walls = "".join(f"{name},300,1\n" for name in ("x1", "y0", "y1", "z0", "z1"))
        _, groups = self.heat(CUBE, "group,kelvin,emissivity\nx0,500,0.3\n" + walls, "--patches", 600)
        self.assert_close(groups["x0"]["watts"], 0.3 * SIGMA * (500**4 - 300**4), 2e-6)

    def test_wide_grey_plates(self):
        # Q / A = σ (T1⁴ − T2⁴) / (1/ε1 + 1/ε2 − 1) but near the edges: 10 m wide, 2 cm apart.
        x, y, z = (0, 10), (0, 0.02), (0, 10)
        corners = "".join(f"v {x[a]} {y[b]} {z[c]}\n" for a in (0, 1) for b in (0, 1) for c in (0, 1))
        faces = "usemtl low\nf 1 2 6 5\nusemtl high\nf 3 7 8 4\nusemtl sides\nf 1 3 4 2\nf 5 6 8 7\nf 1 5 7 3\nf 2 4 8 6\n"
        scene = self.write("plates.obj", corners + faces)
        self.assertEqual(self.factors(scene, "--patches", 0, "--resolution", 16)["back"], 0)  # fronts face inward
        _, groups = self.heat(scene, "low,400,0.8\nhigh,300,0.4\nsides,adiabatic\n", "--patches", 800)
        exact = 100 * SIGMA * (400**4 - 300**4) / (1 / 0.8 + 1 / 0.4 - 1)
        self.assert_close(groups["low"]["watts"], exact, 5e-3)
        self.assert_close(groups["high"]["watts"], -exact, 5e-3)

    def test_an_isothermal_enclosure_exchanges_nothing(self):
        lines = "".join(f"{name},400,{e}\n" for name, e in zip(("x0", "x1", "y0", "y1", "z0", "z1"),
                                                             (0.1, 1, 0.5, 0.02, 0.3, 0.9)))
        _, groups = self.heat(CUBE, lines, "--patches", 600)
        for group in groups.values():
            self.assertLess(abs(group["watts"]), 2e-6 * SIGMA * 400**4)  # rows are closed to 1e-6

    def test_adiabatic_walls_are_walls_that_reflect_all(self):
        plates = "x0,600,1\nx1,400,1\n"
        walls = ("y0", "y1", "z0", "z1")
        _, groups = self.heat(CUBE, plates + "".join(f"{name},adiabatic\n" for name in walls), "--patches", 600)
        _, white = self.heat(CUBE, plates + "".join(f"{name},77,0\n" for name in walls), "--patches", 600)
        flow = groups["x0"]["watts"]
        self.assert_close(flow, white["x0"]["watts"], 1e-8)  # the solver's tolerance is 1e-10
        self.assert_close(groups["x1"]["watts"], -flow, 1e-5)
        self.assertLess(flow, SIGMA * (600**4 - 400**4))
        self.assertGreater(flow, 0.2 * SIGMA * (600**4 - 400**4))  # what goes without the walls
        middle = ((600**4 + 400**4) / 2) ** 0.25  # by symmetry
        for name in walls:
            self.assertLess(abs(groups[name]["watts"]), 1e-5 * flow)
            self.assertTrue(groups[name]["adiabatic"])
            self.assert_close(groups[name]["kelvin"], middle, 2e-3)

    def test_an_open_square_radiates_to_the_environment(self):
        materials = [g["name"] for g in self.factors(SQUARES, "--patches", 200, "--group-by", "material")["groups"]]
        lines = "".join(f"{name},500,0.7\n" for name in materials)
        report, groups = self.heat(SQUARES, lines + "environment,500\n", "--patches", 200)
        area = sum(group["area"] for group in groups.values())
        for group in groups.values():
            self.assertLess(abs(group["watts"]), 2e-6 * SIGMA * 500**4 * area)
        report, groups = self.heat(SQUARES, lines, "--patches", 200)
        lost = sum(group["watts"] for group in groups.values())
        self.assert_close(lost, -report["heat_flow"]["environment_watts"], 1e-5)
        self.assertGreater(lost, 0)

    def test_files_of_temperatures_that_cannot_be_used(self):
        for content, word in (("x0,400,0.5\n", "x1"), ("x0,-4,0.5\n", ":1:"), ("x0,400,1.5\n", "emissivity"),
                              ("nobody,400,0.5\nx0,4,1", "nobody"), ("x0,400,1\nx0,300,1\n", "twice"),
                              ("x0,400\n", "emissivity")):
            with self.subTest(content):
                error = self.refused(INPUT, CUBE, "--patches", 54, "--resolution", 32, "--group-by", "material",
                                     "--temperatures", self.write("t.csv", "# kelvin\n" + content))
                self.assertIn(word.replace(":1:", ":2:"), error)


class Points(FormFactorsTest):
    def test_every_method_finds_the_factor_above_a_square(self):
        # A point over the middle of a unit cube's floor, facing the ceiling at distance 1/2: four corners, each
        # F = 1/(2π) [X/√(1+X²) atan(Y/√(1+X²)) + Y/√(1+Y²) atan(X/√(1+Y²))] with X = Y = 1.
        exact = 4 * (2 / math.sqrt(2) * math.atan(1 / math.sqrt(2))) / (2 * math.pi)
        points = self.write("points.csv", "0.5,0.5,0.5,0,1,0\n0.5,0.5,0.5,0,2,0\n")
        for method in WITH_POINTS:
            with self.subTest(method):
                table = self.folder / "out.csv"
                report = self.factors(CUBE, "--patches", 0, "--method", method, "--points", points, "-o", table)
                rows = read_table(table)
                self.assertEqual((report["points"], len(rows), len(rows[0])), (2, 2, report["patches"]))
                # Rows are by polygon: the top face is the largest. Tolerance: 1/256 of the edge's pixels, measured 5e-4; exact
                # but for single precision.
                self.assert_close(max(rows[0]), exact, 1e-6 if method == "closed-form" else 3e-3, method)
                self.assert_close(sum(rows[0]), 1, 1e-6)
                rest = read_table(self.folder / "out.csv.points.csv")
                self.assertEqual(rest[0], [0.5, 0.5, 0.5, 0, 1, 0, 0, 0])

    def test_points_go_with_neither_groups_nor_repair(self):
        points = self.write("points.csv", "0.5,0.5,0.5,0,1,0\n")
        self.refused(USAGE, CUBE, "--points", points, "--group-by", "node")
        self.refused(USAGE, CUBE, "--points", points, "--repair")
        self.refused(USAGE, CUBE, "--points", points, "-o", self.folder / "m.txt")


class Checkpoints(FormFactorsTest):
    WORK = (CORNELL, "--patches", 3000, "--resolution", 128, "--quiet")

    LINES = (CORNELL, "--patches", 3000, "--method", "global-lines", "--lines", 15_000_000, "--quiet")

    def stop(self, number, checkpoint, target, work=WORK):
        """Starts the work and ends it by a signal once rows, or counts of lines, are in the file."""
        arguments = [PROGRAM, "formfactors", *map(str, work), "-o", str(target), "--checkpoint", str(checkpoint),
                     "--checkpoint-interval", "0.05"]
        with subprocess.Popen(arguments, stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
            while process.poll() is None and not (checkpoint.exists() and checkpoint.stat().st_size > 200_000):
                time.sleep(0.01)
            process.send_signal(number)
            _, errors = process.communicate(timeout=300)
        self.assertEqual(process.returncode, INTERRUPTED if number == signal.SIGINT else -number, errors)
        self.assertFalse(target.exists())

    def test_a_run_that_was_killed_ends_with_the_same_bytes(self):
        whole, target, checkpoint = (self.folder / name for name in ("whole.npy", "m.npy", "rows"))
        self.factors(*self.WORK, "-o", whole)
        for number in (signal.SIGKILL, signal.SIGINT):
            with self.subTest(number):
                self.stop(number, checkpoint, target)
                report = self.factors(*self.WORK, "-o", target, "--checkpoint", checkpoint, "--resume", "--threads", 1)
                self.assertGreater(report["resumed_rows"], 0)
                self.assertEqual(target.read_bytes(), whole.read_bytes())
                self.assertFalse(checkpoint.exists())
                target.unlink()

    def test_so_do_global_lines(self):
        whole, target, checkpoint = (self.folder / name for name in ("whole.npy", "m.npy", "counts"))
        for line_set in ("chords", "bundles"):
            work = (*self.LINES, "--line-set", line_set)
            self.factors(*work, "-o", whole)
            for number in (signal.SIGKILL, signal.SIGINT):
                with self.subTest(f"{line_set}, {number}"):
                    self.stop(number, checkpoint, target, work)
                    report = self.factors(*work, "-o", target, "--checkpoint", checkpoint, "--resume", "--threads", 1)
                    self.assertGreater(report["resumed_lines"], 0)
                    self.assertEqual(target.read_bytes(), whole.read_bytes())
                    self.assertFalse(checkpoint.exists())
                    target.unlink()

    def test_damaged_or_other_counts_of_lines_are_refused(self):
        target, checkpoint = self.folder / "m.npy", self.folder / "counts"
        self.stop(signal.SIGKILL, checkpoint, target, self.LINES)
        resume = ("-o", target, "--checkpoint", checkpoint, "--resume")
        self.refused(USAGE, *self.LINES, *resume, "--seed", 2)
        self.refused(USAGE, *self.LINES, *resume, "--line-set", "bundles")
        self.refused(USAGE, *self.LINES, *resume, "--patches", 200)
        content = checkpoint.read_bytes()
        for damaged in (content[:-7], content[:len(content) // 2] + b"x" + content[len(content) // 2 + 1:]):
            checkpoint.write_bytes(damaged)
            self.assertIn("remove it", self.refused(INPUT, *self.LINES, *resume))
            self.assertEqual(checkpoint.read_bytes(), damaged)

    def test_a_torn_or_changed_end_is_computed_again(self):
        whole, target, checkpoint = (self.folder / name for name in ("whole.npy", "m.npy", "rows"))
        self.factors(*self.WORK, "-o", whole)
        self.stop(signal.SIGKILL, checkpoint, target)
        content = bytearray(checkpoint.read_bytes())
        for damaged in (content[:-7], content[:len(content) // 2] + b"x" + content[len(content) // 2 + 1:], content[:60]):
            checkpoint.write_bytes(damaged)
            self.factors(*self.WORK, "-o", target, "--checkpoint", checkpoint, "--resume")
            self.assertEqual(target.read_bytes(), whole.read_bytes())

    def test_a_checkpoint_of_something_else_is_refused_and_kept(self):
        target, checkpoint = self.folder / "m.npy", self.folder / "rows"
        self.stop(signal.SIGKILL, checkpoint, target)
        content = checkpoint.read_bytes()
        resume = ("-o", target, "--checkpoint", checkpoint, "--resume")
        self.refused(USAGE, *self.WORK, *resume, "--seed", 2)
        self.refused(USAGE, *self.WORK[:4], 64, *resume)
        self.refused(USAGE, *self.WORK, *resume, "--storage", "double")
        self.refused(USAGE, *self.WORK, *resume, "--reflectance", "floor=0.1,0.1,0.1")
        self.refused(USAGE, *self.WORK, *resume[:-1])  # no --resume: nothing is overwritten
        self.assertEqual(checkpoint.read_bytes(), content)
        other = self.write("other", "not a checkpoint\n")
        self.refused(USAGE, *self.WORK, "-o", target, "--checkpoint", other, "--resume")
        self.assertEqual(other.read_text(), "not a checkpoint\n")

    def test_bakes_go_on_too(self):
        checkpoint, baked = self.folder / "rows", self.folder / "box.ply"
        work = ("bake", CORNELL, "--patches", 3000, "--method", "hemicube", "--quiet")
        self.run_well(*work, "-o", self.folder / "whole.ply")
        self.stop(signal.SIGKILL, checkpoint, self.folder / "m.npy")
        self.run_well(*work, "-o", baked, "--resolution", 128, "--checkpoint", checkpoint, "--resume")
        self.assertEqual(baked.read_bytes(), (self.folder / "whole.ply").read_bytes())
        self.assertFalse(checkpoint.exists())


if __name__ == "__main__":
    unittest.main()
