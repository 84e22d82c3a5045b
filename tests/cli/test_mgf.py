#!/usr/bin/env python3
"""MGF scenes, as a user meets them."""
import unittest

from lambert_cli import DATA, INPUT, OK, SMALL, USAGE, ProgramTest, materials, read_json, run

TRIANGLE = "v a =\nv b =\n\tp 1 0 0\nv c =\n\tp 0 1 0\nm lamp =\n\ted 10\nf a b c\n"


class Mgf(ProgramTest):
    def compare(self, name, tolerance, *options):
        """The light of one of our scenes, read from MGF and from OBJ."""
        obj, mgf = (materials(self.bake(DATA / f"{name}.{end}", *options)) for end in ("obj", "mgf"))
        self.assertEqual(list(mgf), list(obj))
        for material in obj:
            for found, expected in zip(mgf[material]["mean_irradiance"], obj[material]["mean_irradiance"]):
                self.assert_close(found, expected, tolerance, f"{name} {material}")

    def test_same_polygons_have_the_same_light_as_from_obj(self):
        # The colours take the way through CIE x, y and back: 12 digits in the file, then single precision.
        self.compare("cornell_box", 1e-4, "--patches", "0", "--rotation", "fixed")
        self.compare("cube6", 1e-4, "--patches", "0", "--rotation", "fixed")

    def test_default_bakes_have_the_same_light_as_from_obj(self):
        self.compare("cornell_box", 5e-3)

    def test_classic_room_bakes_without_losing_energy(self):
        report = self.bake(DATA / "classic_room.mgf", "--curve-segments", "12", "--resolution", "64", "--patches", "3000")
        # Measured: 1.9 %, and 0.1 % with 12,000 patches and all segments; the bulbs are small beside the patches around.
        self.assertLess(abs(report["energy"]["imbalance"]), .05)
        self.assertLess(report["form_factors"]["back_face_fraction"], .01)
        for name, material in materials(report).items():
            self.assertTrue(all(e > 0 for e in material["mean_irradiance"]), name)  # nothing is in the dark

    def test_info_probe_and_bake_read_mgf(self):
        scene = self.write("scene.MGF", TRIANGLE)
        self.run_well("info", scene, "--json", self.folder / "info.json")
        (lamp,) = read_json(self.folder / "info.json")["materials"]
        self.assertEqual((lamp["name"], lamp["area"], lamp["two_sided"]), ("lamp", .5, True))
        points = self.write("points.csv", ".2,.2,1,0,0,-1\n")
        self.run_well("probe", scene, points, "-o", self.folder / "out.csv")
        self.bake(scene, "-o", self.folder / "out.glb", *SMALL)

    def test_curve_segments_and_units_apply(self):
        scene = self.write("can.mgf", "m lamp =\n\ted 10\nv a =\nv b =\n\tp 0 0 1\ncyl a 1 b\n")
        for options, polygons, height in (((), 24, 1), (("--curve-segments", "48", "--unit", ".0254"), 48, .0254)):
            self.run_well("info", scene, "--json", self.folder / "info.json", *options)
            report = read_json(self.folder / "info.json")
            self.assertEqual(report["quads"], polygons)
            self.assert_close(report["bounds"]["upper"][2], height, 1e-6)
        for wrong in ("7", "2", "x", "-4", "2000"):
            done = run("info", scene, "--curve-segments", wrong)
            self.assertEqual(done.returncode, USAGE)
            self.assertIn("--curve-segments", done.stderr)

    def test_included_files_are_not_overwritten(self):
        scene = self.write("scene.mgf", "i sub/part.mgf\n" + TRIANGLE)
        (self.folder / "sub").mkdir()
        part = self.write("sub/part.mgf", "i ../last.glb\n")
        last = self.write("last.glb", "# an MGF file by another name\n" + TRIANGLE)
        for target in (scene, part, last):
            before = target.read_bytes()
            done = run("info", scene, "--json", target)
            self.assertEqual(done.returncode, USAGE, done.stderr)
            self.assertIn("would overwrite", done.stderr)
            self.assertEqual(target.read_bytes(), before)
        self.assertEqual(run("info", scene, "--json", self.folder / "new.json").returncode, OK)

    def test_errors_name_file_and_line(self):
        self.write("part.mgf", "\n\nsph nowhere 1\n")
        done = run("info", self.write("scene.mgf", "# 1\ni part.mgf\n"))
        self.assertEqual(done.returncode, INPUT)
        self.assertIn('part.mgf:3: found "nowhere", expected a vertex that is defined before', done.stderr)
        done = run("info", self.write("scene.mgf", "# 1\ni absent.mgf\n"))
        self.assertEqual(done.returncode, INPUT)
        self.assertIn("scene.mgf:2: ", done.stderr)


if __name__ == "__main__":
    unittest.main()
