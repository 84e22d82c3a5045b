#!/usr/bin/env python3
"""Solution files: `bake --solution`, `bake --warm-start`, `compare bakes`, checkpoints of solvers."""
import csv
import os
import unittest

from lambert_cli import DATA, INPUT, OK, SYSTEM, USAGE, Gltf, ProgramTest, png_size, read_json, run

BOX = DATA / "cornell_box.obj"
SMALL = ("--resolution", "32")  # and some patches
SOLVERS = ("jacobi", "gauss-seidel", "southwell", "conjugate-gradient")


class Solution(ProgramTest):
    def solve(self, name, *options, scene=BOX):
        """The file and the report."""
        path = self.folder / name
        patches = () if "--patches" in options else ("--patches", "400")
        return path, self.bake(scene, *SMALL, *patches, *options, "--solution", path)

    def compare(self, a, b, *options):
        report = self.folder / "compared.json"
        self.run_well("compare", "bakes", a, b, "--json", report, *options)
        return read_json(report)


class Files(Solution):
    def test_hold_the_light_of_every_patch(self):
        path, report = self.solve("a.glb", "--keep-bounces")
        file = Gltf(path)
        lambert = file.json["extras"]["lambert"]
        self.assertEqual(lambert["patches"], report["patches"])
        self.assertEqual(lambert["iterations"], report["iterations"])
        self.assertEqual(lambert["energy"]["escaped"], report["energy"]["escaped"])
        self.assertEqual(len(lambert["bounces"]), len(report["bounces"]))
        area, reflectance, emitted, irradiance, radiosity = (
            file.accessor(lambert[name])
            for name in ("area", "reflectance", "emitted_radiosity", "irradiance", "radiosity"))
        flux = [0.0, 0.0, 0.0]
        for a, rho, e, light, b in zip(area, reflectance, emitted, irradiance, radiosity):
            for c in range(3):
                # B = B_e + ρ E, each rounded to single precision.
                self.assertAlmostEqual(b[c], e[c] + rho[c] * light[c], delta=3e-7 * max(b[c], 1e-6))
                flux[c] += a * (1 - rho[c]) * light[c]
        for c in range(3):
            self.assert_close(flux[c], report["energy"]["absorbed"][c], 1e-5)

    def test_are_the_same_on_any_number_of_threads_with_any_solver(self):
        for solver in SOLVERS:
            for more in ((), ("--storage", "none")):
                options = ("--solver", solver, "--tolerance", "1e-3", "--patches", "250", *more)
                first = self.solve("1.glb", *options, "--threads", "1")[0].read_bytes()
                for threads in ("2", "8"):
                    again = self.solve("n.glb", *options, "--threads", threads)[0].read_bytes()
                    self.assertTrue(again == first, (solver, more, threads))

    def test_are_refused_under_other_names(self):
        done = run("bake", BOX, *SMALL, "--solution", self.folder / "a.ply")
        self.assertEqual(done.returncode, USAGE, done.stderr)
        self.assertIn("--solution", done.stderr)

    def test_of_several_scenes_stand_under_their_names(self):
        self.run_well("bake", BOX, DATA / "furnace_box.obj", "--output-dir", self.folder, *SMALL, "--quiet",
                      "--solution", self.folder / "{}_solution.glb")
        self.assertTrue((self.folder / "cornell_box_solution.glb").exists())
        self.assertTrue((self.folder / "furnace_box_solution.glb").exists())


class WarmStart(Solution):
    def test_takes_fewer_iterations_to_the_same_light(self):
        for solver in SOLVERS:
            options = ("--solver", solver, "--tolerance", "1e-6", "--repair")
            cold_file, cold = self.solve("cold.glb", *options)
            warm_file, warm = self.solve("warm.glb", *options, "--warm-start", cold_file)
            self.assertLess(warm["iterations"], cold["iterations"] / 2, solver)
            self.assertEqual(warm["options"]["warm_start"], str(cold_file))
            # Residuals of at most 1e-6, errors below 1e-6 / (1 - 0.8): single precision is finer than both.
            self.assertLess(self.compare(cold_file, warm_file)["overall"]["relative_rms"], 1e-5, solver)

    def test_serves_another_material_of_the_same_patches(self):
        start, _ = self.solve("start.glb")
        change = ("--reflectance", "floor=0.6,0.6,0.6", "--tolerance", "1e-7")
        cold_file, cold = self.solve("cold.glb", *change)
        warm_file, warm = self.solve("warm.glb", *change, "--warm-start", start)
        self.assertLessEqual(warm["iterations"], cold["iterations"])
        self.assertLess(self.compare(cold_file, warm_file)["overall"]["relative_rms"], 1e-6)

    def test_of_another_mesh_is_an_input_error(self):
        start, _ = self.solve("start.glb")
        for scene, options in ((BOX, ("--patches", "800")), (DATA / "furnace_box.obj", ("--patches", "400"))):
            done = run("bake", scene, *SMALL, *options, "--warm-start", start, "--json", self.folder / "r.json")
            self.assertEqual(done.returncode, INPUT, done.stderr)
            self.assertIn("start.glb", done.stderr.splitlines()[-1])

    def test_of_no_solution_is_an_input_error(self):
        baked = self.folder / "baked.glb"
        self.run_well("bake", BOX, *SMALL, "-o", baked, "--quiet")
        for file in (baked, BOX, self.write("x.glb", b"glTF\2\0\0\0\xff\xff\xff\xff")):
            done = run("bake", BOX, *SMALL, "--warm-start", file, "--json", self.folder / "r.json")
            self.assertEqual(done.returncode, INPUT, done.stderr)
            self.assertFalse((self.folder / "r.json").exists())

    def test_has_no_bounces(self):
        start, _ = self.solve("start.glb")
        done = run("bake", BOX, *SMALL, "--warm-start", start, "--keep-bounces", "--json", self.folder / "r.json")
        self.assertEqual(done.returncode, USAGE, done.stderr)


class Comparison(Solution):
    def test_of_a_solution_with_itself_finds_nothing(self):
        path, _ = self.solve("a.glb")
        found = self.compare(path, path)
        self.assertTrue(found["same_patches"])
        for errors in (found["overall"], *found["channels"].values()):
            self.assertEqual((errors["rms"], errors["maximum"], errors["bias"], errors["energy_ratio"]), (0, 0, 0, 1))

    def test_finds_a_lamp_that_is_twice_as_bright(self):
        a, _ = self.solve("a.glb", "--emit", "light=1,1,1")
        b, _ = self.solve("b.glb", "--emit", "light=2,2,2")
        for quantity in ("irradiance", "radiosity"):
            errors = self.compare(a, b, "--quantity", quantity)["overall"]
            self.assert_close(errors["energy_ratio"], 2, 1e-6)
            self.assert_close(errors["bias"], errors["mean"], 1e-6)
            self.assert_close(errors["mean_absolute"], errors["mean"], 1e-6)

    def test_of_other_patches_looks_them_up(self):
        a, _ = self.solve("a.glb")
        b, _ = self.solve("b.glb", "--patches", "1600")
        found = self.compare(a, b)
        self.assertFalse(found["same_patches"])
        self.assertLess(found["unmatched_area"], 1e-6)
        # Patches of half the length: the light between them differs by some percent, that of the room hardly.
        self.assert_close(found["overall"]["energy_ratio"], 1, 0.02)
        self.assertLess(found["overall"]["relative_rms"], 0.3)

    def test_keeps_the_sides_of_surfaces_apart(self):
        scene = DATA / "table_room.obj"
        a, _ = self.solve("a.glb", "--two-sided", "--patches", "5000", scene=scene)   # so that centres sample B evenly
        b, _ = self.solve("b.glb", "--two-sided", "--patches", "900", scene=scene)
        found = self.compare(a, b)
        self.assertLess(found["unmatched_area"], 1e-3)
        # Light taken from the wrong side would not add up to what B has by its own areas.
        self.assert_close(found["overall"]["energy_ratio"], self.mean_irradiance(b) / self.mean_irradiance(a), 0.02)

    def test_finds_the_floor_under_what_stands_on_it(self):
        scene = DATA / "table_room.obj"   # one-sided: where two surfaces touch, only one of them is to be met on its front
        a, _ = self.solve("a.glb", scene=scene)
        b, _ = self.solve("b.glb", "--patches", "1600", scene=scene)
        self.assertLess(self.compare(a, b)["unmatched_area"], 1e-3)

    @staticmethod
    def mean_irradiance(path):
        file = Gltf(path)
        lambert = file.json["extras"]["lambert"]
        area, light = file.accessor(lambert["area"]), file.accessor(lambert["irradiance"])
        return sum(a * sum(e) / 3 for a, e in zip(area, light)) / sum(area)

    def test_of_another_scene_is_an_input_error(self):
        a, _ = self.solve("a.glb")
        b, _ = self.solve("b.glb", scene=DATA / "furnace_box.obj")
        done = run("compare", "bakes", a, b)
        self.assertEqual(done.returncode, INPUT, done.stderr)
        self.assertEqual(done.stdout, "")

    def test_prints_a_table_and_draws_a_picture(self):
        a, _ = self.solve("a.glb")
        b, _ = self.solve("b.glb", "--seed", "2")
        picture = self.folder / "difference.png"
        done = self.run_well("compare", "bakes", a, b, "--image", picture, "--size", "64x48", "--samples", "1", "--quiet")
        self.assertEqual([line.split()[0] for line in done.stdout.splitlines()[1:]], ["mean", "red", "green", "blue"])
        width, height = png_size(picture)
        self.assertGreaterEqual((width, height), (64, 48))  # with the scale's bar


class ComparisonFolder(Solution):
    def test_holds_a_page_a_table_and_pictures(self):
        a, _ = self.solve("a.glb", "--emit", "light=1,1,1")
        b, _ = self.solve("b.glb", "--emit", "light=2,2,2", "--patches", "900")
        out = self.folder / "new" / "out"
        found = self.compare(a, b, "-o", out, "--size", "64x48", "--samples", "1", "--quiet")
        pictures = ["a.png", "above.png", "b.png", "below.png", "difference.png"]
        self.assertEqual(sorted(os.listdir(out)), sorted(["index.html", "results.csv", "results.json", *pictures]))
        self.assertEqual(read_json(out / "results.json"), found)
        with open(out / "results.csv", newline="", encoding="utf-8") as file:
            rows = {row["channel"]: row for row in csv.DictReader(file)}
        self.assertEqual(list(rows), ["mean", "red", "green", "blue"])
        for key, value in found["overall"].items():
            self.assert_close(float(rows["mean"][key]), value, 1e-8, key)
        self.assertEqual(png_size(out / "a.png"), (64, 48))
        page = (out / "index.html").read_text(encoding="utf-8")
        self.assertEqual(page.count("<img "), len(pictures))
        for text in ("a.glb", "b.glb", "conjugate-gradient"):
            self.assertIn(text, page)
        # B is brighter nearly everywhere: nothing below, all above.
        self.assertGreater((out / "above.png").stat().st_size, (out / "below.png").stat().st_size)

    def test_that_cannot_be_written_is_refused_before_the_work(self):
        a, _ = self.solve("a.glb")
        self.write("file", b"")
        done = run("compare", "bakes", a, a, "-o", self.folder / "file")
        self.assertEqual(done.returncode, SYSTEM, done.stderr)
        done = run("compare", "bakes", a, a, "-o", self.folder / "out", "--size", "0x1")
        self.assertEqual(done.returncode, USAGE, done.stderr)
        self.assertFalse((self.folder / "out").exists())


class Checkpoint(Solution):
    def test_of_a_solve_that_was_killed_ends_with_the_same_bytes(self):
        # Shots whose rows are computed: the work is in the solve. States are written after every 25 shots.
        options = ("--patches", "400", "--hemicubes", "16", "--solver", "southwell", "--storage", "none", "--tolerance",
                   "1e-3")
        whole, report = self.solve("whole.glb", *options)
        checkpoint, killed, kept = self.folder / "state", 0, 0
        parts = self.folder / "parts.glb"
        command = ("bake", BOX, *SMALL, *options, "--solution", parts, "--json", self.folder / "parts.json", "--quiet",
                   "--checkpoint", checkpoint, "--checkpoint-interval", "0", "--resume")
        for share in (0.2, 0.3, 0.4, 0.5):
            killed += self.killed(share * report["seconds"]["total"], *command)
            kept += checkpoint.with_suffix(".solver").exists()
        self.assertGreater(killed, 0)
        self.assertGreater(kept, 0)
        self.assertEqual(run(*command).returncode, OK)
        self.assertTrue(parts.read_bytes() == whole.read_bytes())
        self.assertEqual(read_json(self.folder / "parts.json")["iterations"], report["iterations"])
        # SIGKILL in the midst of a writing leaves that file under its temporary name; no process can clean up after it.
        left = sorted(name for name in os.listdir(self.folder) if not name.startswith(".lambert-"))
        self.assertEqual(left, ["parts.glb", "parts.json", "report.json", "whole.glb"])

    def test_of_another_solver_is_a_usage_error(self):
        checkpoint = self.folder / "state"
        solver_state = self.write("state.solver", "Lambert solver checkpoint 2: of something else\n")
        command = ("bake", BOX, *SMALL, "--json", self.folder / "r.json", "--checkpoint", checkpoint)
        for more in ((), ("--resume",)):
            done = run(*command, *more)
            self.assertEqual(done.returncode, USAGE, done.stderr)
            self.assertIn("state.solver", done.stderr.splitlines()[-1])
        self.assertTrue(solver_state.exists())


if __name__ == "__main__":
    unittest.main()
