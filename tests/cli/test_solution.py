#!/usr/bin/env python3
"""Solution files: `bake --solution`."""
import unittest

from lambert_cli import DATA, USAGE, Gltf, ProgramTest, run

BOX = DATA / "cornell_box.obj"
SMALL = ("--resolution", "32")  # and some patches
SOLVERS = ("jacobi", "gauss-seidel", "southwell", "conjugate-gradient")


class Solution(ProgramTest):
    def solve(self, name, *options, scene=BOX):
        """The file and the report."""
        path = self.folder / name
        patches = () if "--patches" in options else ("--patches", "400")
        return path, self.bake(scene, *SMALL, *patches, *options, "--solution", path)


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


if __name__ == "__main__":
    unittest.main()
