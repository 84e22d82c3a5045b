#!/usr/bin/env python3
"""`lambert bake` as a user meets it: the files it writes, their content, and what its options do."""
import math
import unittest

from lambert_cli import DATA, SMALL, Gltf, Ply, ProgramTest, materials, png_size, read_json, run

CORNELL_GLTF = DATA / "cornell_box.gltf"
CORNELL_OBJ = DATA / "cornell_box.obj"
PARALLEL_F = 0.1998248957  # opposed unit squares at distance 1 (data/reference/analytic.json)


class EveryOutputAtOnce(ProgramTest):
    """One bake of each of the two Cornell boxes to everything there is."""
    NAMES = ("box.glb", "box.gltf", "box.ply", "box.obj", "box.mtl")

    def bake_all(self, scene, image, *options):
        outputs = [word for name in self.NAMES[:4] for word in ("-o", self.folder / name)]
        return self.bake(scene, *SMALL, *outputs, "--image", self.folder / image, "--size", "64x48", *options)

    def test_all_files_are_there_and_nothing_else(self):
        for scene, image in ((CORNELL_GLTF, "box.png"), (CORNELL_OBJ, "box.exr")):
            self.bake_all(scene, image)
            self.assertTrue((self.folder / image).stat().st_size > 0)
        expected = sorted((*self.NAMES, "box.png", "box.exr", "report.json"))
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), expected)
        self.assertEqual(png_size(self.folder / "box.png"), (64, 48))
        self.assertEqual((self.folder / "box.exr").read_bytes()[:4], b"\x76\x2f\x31\x01")

    def test_glb_and_gltf_hold_finite_radiosity_and_displayable_colours(self):
        report = self.bake_all(CORNELL_GLTF, "box.png")
        for name in ("box.glb", "box.gltf"):
            gltf = Gltf(self.folder / name)
            for primitive in gltf.primitives():
                radiosity = gltf.json["accessors"][primitive["attributes"]["_RADIOSITY"]]
                self.assertEqual((radiosity["componentType"], radiosity["type"]), (5126, "VEC3"))
                vertices = len(gltf.accessor(primitive["attributes"]["POSITION"]))
                self.assertLess(max(gltf.accessor(primitive["indices"])), vertices)
            values = [value for b in gltf.attribute("_RADIOSITY") for value in b]
            self.assertTrue(all(math.isfinite(value) and value >= 0 for value in values))
            self.assertGreater(max(values), 17 * math.pi)  # the light's own: π L_e, and a little that it reflects
            self.assertTrue(all(0 <= value <= 1 for colour in gltf.attribute("COLOR_0") for value in colour))
            self.assert_close(gltf.extras()["exposure_ev"], report["exposure_ev"], 1e-6)
            self.assertEqual(gltf.extras()["quantity"], "radiosity")

    def test_glb_colour_is_radiance_times_the_exposure(self):
        self.bake_all(CORNELL_GLTF, "box.png", "--exposure", "-1.5")
        gltf = Gltf(self.folder / "box.glb")
        self.assertEqual(gltf.extras()["exposure_ev"], -1.5)
        for radiosity, colour in zip(gltf.attribute("_RADIOSITY"), gltf.attribute("COLOR_0")):
            for b, shown in zip(radiosity, colour):
                self.assertAlmostEqual(shown, min(1, b / math.pi * 2 ** -1.5), delta=1e-3)

    def test_ply_has_colours_radiosity_and_one_face_per_patch(self):
        report = self.bake_all(CORNELL_GLTF, "box.png")
        ply = Ply(self.folder / "box.ply")
        self.assertEqual(ply.header[:2], ["ply", "format binary_little_endian 1.0"])
        for name in ("red", "green", "blue"):
            self.assertIn(f"property uchar {name}", ply.header)
        for channel in "rgb":
            self.assertIn(f"property float radiosity_{channel}", ply.header)
        self.assertEqual(len(ply.faces), report["patches"] - report["mesh"]["hidden_patches"])
        self.assertGreater(report["mesh"]["hidden_patches"], 0)  # what the blocks stand on
        self.assertLessEqual(len(ply.vertices), report["vertices"])

    def test_obj_names_its_mtl_and_colours_its_vertices(self):
        report = self.bake_all(CORNELL_GLTF, "box.png")
        lines = (self.folder / "box.obj").read_text().splitlines()
        self.assertIn("mtllib box.mtl", lines)
        self.assertEqual({len(line.split()) for line in lines if line.startswith("v ")}, {7})
        self.assertEqual(sum(line.startswith("f ") for line in lines),
                         report["patches"] - report["mesh"]["hidden_patches"])
        defined = {line[7:] for line in (self.folder / "box.mtl").read_text().splitlines() if line.startswith("newmtl ")}
        self.assertLessEqual({line[7:] for line in lines if line.startswith("usemtl ")}, defined)

    def test_irradiance_adds_its_attribute_and_leaves_radiosity(self):
        self.bake_all(CORNELL_GLTF, "box.png")
        radiosity = Gltf(self.folder / "box.glb").attribute("_RADIOSITY")
        self.bake_all(CORNELL_GLTF, "box.png", "--quantity", "irradiance")
        gltf = Gltf(self.folder / "box.glb")
        self.assertEqual(gltf.attribute("_RADIOSITY"), radiosity)
        self.assertEqual(len(gltf.attribute("_IRRADIANCE")), len(radiosity))
        self.assertEqual(gltf.extras()["quantity"], "irradiance")
        self.assertIn("property float irradiance_r", Ply(self.folder / "box.ply").header)


class TheReport(ProgramTest):
    def test_holds_what_is_promised(self):
        report = self.bake(CORNELL_OBJ, *SMALL)
        self.assertLessEqual({"scene", "patches", "vertices", "method", "solver", "iterations", "residual", "rays",
                              "peak_memory_bytes", "options", "seed", "version", "camera", "seconds", "energy",
                              "materials"}, set(report))
        self.assertLessEqual({"read", "mesh", "form_factors", "solve", "bake", "write", "total"}, set(report["seconds"]))
        for term in ("emitted", "received", "absorbed", "back_faces", "escaped"):
            self.assertEqual(len(report["energy"][term]), 3)
        for material in report["materials"]:
            self.assertLessEqual({"name", "area", "mean_irradiance", "mean_radiosity"}, set(material))
        self.assertEqual(list(materials(report)),
                         ["floor", "ceiling", "light", "back", "right", "left", "short", "tall"])

    def test_energy_terms_balance_to_the_printed_imbalance(self):
        done = self.run_well("bake", CORNELL_OBJ, "--patches", "1000", "--resolution", "64", "--json",
                             self.folder / "report.json")
        energy = read_json(self.folder / "report.json")["energy"]
        gained = [e + r for e, r in zip(energy["emitted"], energy["received"])]
        lost = [sum(terms) for terms in zip(energy["absorbed"], energy["back_faces"], energy["escaped"])]
        for g, l in zip(gained, lost):
            self.assert_close(l, g, 0.01)  # hemicubes' rows are not exactly reciprocal; 0.5 % is lost at this size
        self.assertAlmostEqual(energy["imbalance"], 1 - sum(lost) / sum(gained), delta=1e-9)
        printed = float(done.stdout.split("energy imbalance")[1].split(",")[0])
        self.assert_close(printed, energy["imbalance"], 0.06)  # two digits are printed

    def test_emitted_is_pi_times_radiance_times_area(self):
        report = self.bake(CORNELL_OBJ, *SMALL)
        for found, radiance in zip(report["energy"]["emitted"], (17, 12, 4)):
            self.assert_close(found, math.pi * radiance * 0.13 * 0.105, 1e-5)

    def test_gltf_and_obj_of_one_scene_agree(self):
        first, second = (materials(self.bake(scene, "--patches", "1000", "--resolution", "64"))
                         for scene in (CORNELL_GLTF, CORNELL_OBJ))
        self.assertEqual(set(first), set(second))
        for name in first:
            self.assert_close(first[name]["area"], second[name]["area"], 1e-5, name)
            # The files divide the same surfaces differently, and 1000 patches are few: each alone errs by about 1 %.
            for found, expected in zip(first[name]["mean_irradiance"], second[name]["mean_irradiance"]):
                self.assert_close(found, expected, 0.03, name)

    def test_radiosity_is_emission_plus_reflected_irradiance(self):
        found = materials(self.bake(CORNELL_OBJ, *SMALL))
        for name, reflectance, emitted in (("left", (.63, .065, .05), (0, 0, 0)), ("light", (.78,) * 3, (17, 12, 4))):
            for b, e, rho, l in zip(found[name]["mean_radiosity"], found[name]["mean_irradiance"], reflectance, emitted):
                self.assert_close(b, math.pi * l + rho * e, 1e-3, name)

    def test_picture_is_taken_by_the_scenes_camera_or_the_one_by_eye(self):
        picture = ("--image", self.folder / "box.png", "--size", "32x32", *SMALL)
        self.assertEqual(self.bake(CORNELL_GLTF, *picture)["camera"]["name"], "camera")
        by_eye = self.bake(CORNELL_GLTF, *picture, "--eye", "0.2,0.3,-0.5", "--look-at", "0.2,0.3,1", "--fov", "60")
        for found, expected in zip(by_eye["camera"]["eye"], (0.2, 0.3, -0.5)):
            self.assertAlmostEqual(found, expected, places=6)
        self.assertAlmostEqual(by_eye["camera"]["vertical_fov_degrees"], 60, places=3)
        self.assertIsNone(self.bake(CORNELL_GLTF, *SMALL)["camera"])


class TheMesh(ProgramTest):
    # Unequal triangles and a quad, so that each polygon is known by its corners.
    SCENE = """mtllib strips.mtl
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 2
v 3 0 2
v 0 4 2
v 5 0 5
v 5 1 5
v 6 1 5
v 6 0 5
usemtl lamp
f 4 5 6
f 1 2 3
f 7 8 9 10
"""
    LIBRARY = "newmtl lamp\nKd .5 .5 .5\nKe 1 1 1\n"

    def polygons(self):
        vertices = [tuple(map(float, line.split()[1:])) for line in self.SCENE.splitlines() if line.startswith("v ")]
        return [{vertices[int(index) - 1] for index in line.split()[1:]}
                for line in self.SCENE.splitlines() if line.startswith("f ")]

    def strips(self, *options):
        self.write("strips.mtl", self.LIBRARY)
        scene = self.write("strips.obj", self.SCENE)
        report = self.bake(scene, "--patches", "0", "--resolution", "16", "-o", self.folder / "out.ply", *options)
        return report, Ply(self.folder / "out.ply")

    def test_no_patches_keeps_the_polygons_in_file_order(self):
        report, ply = self.strips()
        self.assertEqual(report["patches"], 3)
        self.assertEqual([set(ply.corners(face)) for face in range(3)], self.polygons())

    def test_second_sides_follow_all_fronts(self):
        report, ply = self.strips("--two-sided")
        self.assertEqual(report["patches"], 6)
        self.assertEqual([set(ply.corners(face)) for face in range(6)], 2 * self.polygons())

    def test_no_patches_keeps_the_quads_of_a_cube(self):
        report = self.bake(DATA / "cube6.obj", "--patches", "0", "--resolution", "16")
        self.assertEqual(report["patches"], 6)

    def test_patch_length_bounds_every_edge(self):
        report = self.bake(CORNELL_OBJ, "--patch-length", "0.06", "--resolution", "16", "-o", self.folder / "box.ply")
        self.assertEqual(report["options"]["patch_length"], 0.06)
        ply = Ply(self.folder / "box.ply")
        for face in range(len(ply.faces)):
            corners = ply.corners(face)
            for a, b in zip(corners, corners[1:] + corners[:1]):
                self.assertLessEqual(math.dist(a, b), 0.06 * 1.5)  # an inner edge may be a diagonal

    def test_patches_are_about_as_many_as_asked_for(self):
        for asked in (500, 2000):
            report = self.bake(CORNELL_OBJ, "--patches", asked, "--resolution", "16")
            self.assert_close(report["patches"], asked, 0.3)

    def test_area_does_not_depend_on_the_number_of_patches(self):
        areas = [materials(self.bake(CORNELL_OBJ, "--patches", n, "--resolution", "16")) for n in (0, 400)]
        for name in areas[0]:
            self.assert_close(areas[0][name]["area"], areas[1][name]["area"], 1e-5, name)


class TheLight(ProgramTest):
    ONE = DATA / "parallel_squares.obj"  # `a` emits the radiosity 1, both reflect 0.5
    FINE = ("--patch-length", "0.1", "--resolution", "128")

    def test_one_bounce_is_direct_light(self):
        found = materials(self.bake(self.ONE, *self.FINE, "--bounces", "1"))
        self.assert_close(found["b"]["mean_irradiance"][0], PARALLEL_F, 0.005)  # as `verify` allows

    def test_two_and_all_bounces_follow_the_series(self):
        # Between two patches of constant radiosity E_b = F B_a and B_a = 1 + ρ F B_b; the squares' radiosity is not
        # constant, but what is reflected back is 1 % of the light, and its variation a fraction of that.
        f, rho = PARALLEL_F, 0.5
        all_bounces = f / (1 - (rho * f) ** 2)
        two = materials(self.bake(self.ONE, *self.FINE, "--bounces", "2"))
        self.assert_close(two["a"]["mean_irradiance"][0], f * rho * f, 0.03)
        everything = materials(self.bake(self.ONE, *self.FINE))
        self.assert_close(everything["b"]["mean_irradiance"][0], all_bounces, 0.007)

    def test_light_scales_with_the_emitter(self):
        once, twice = (materials(self.bake(self.ONE, *SMALL, "--emit", f"a={e},{2 * e},0")) for e in (1, 2))
        for first, second in zip(once["b"]["mean_irradiance"], twice["b"]["mean_irradiance"]):
            self.assert_close(second, 2 * first, 1e-6)
        self.assertEqual(once["b"]["mean_irradiance"][2], 0)

    def test_emit_lights_a_scene_without_light(self):
        self.write("dark.mtl", (DATA / "parallel_squares.mtl").read_text().replace("0.318309886184", "0"))
        scene = self.write("dark.obj", self.ONE.read_text().replace("parallel_squares.mtl", "dark.mtl"))
        self.assertEqual(run("bake", scene, "-o", self.folder / "x.glb", *SMALL).returncode, 3)
        found = materials(self.bake(scene, *self.FINE, "--bounces", "1", "--emit", f"a={1 / math.pi},0,0"))
        self.assert_close(found["b"]["mean_irradiance"][0], PARALLEL_F, 0.005)
        self.assertEqual(found["b"]["mean_irradiance"][1:], [0, 0])

    def test_reflectance_replaces_the_files(self):
        found = materials(self.bake(DATA / "furnace_box.obj", *SMALL, "--reflectance", "wall=0.75,0.5,0"))
        for b, expected in zip(found["wall"]["mean_radiosity"], (4, 2, 1)):  # B_e / (1 - ρ)
            self.assert_close(b, expected, 1e-3)

    def test_two_sided_emits_twice(self):
        one, two = (self.bake(self.ONE, *self.FINE, *option) for option in ((), ("--two-sided",)))
        self.assertEqual(two["patches"], 2 * one["patches"])
        self.assert_close(materials(two)["a"]["area"], materials(one)["a"]["area"], 1e-6)
        self.assert_close(two["energy"]["emitted"][0], 2 * one["energy"]["emitted"][0], 1e-6)
        self.assert_close(sum(two["energy"][term][0] for term in ("absorbed", "back_faces", "escaped")),
                          two["energy"]["emitted"][0], 0.01)

    def test_unit_changes_lengths_and_flux_but_not_irradiance(self):
        metres, half, *others = (self.bake(CORNELL_OBJ, *SMALL, "--unit", unit) for unit in (1, 0.5, 0.001, 1e-8))
        for first, second in zip(metres["materials"], half["materials"]):  # a power of two: no digit changes
            self.assertEqual(second["mean_irradiance"], first["mean_irradiance"], first["name"])
            self.assertEqual(second["area"], first["area"] / 4, first["name"])
        for unit, scaled in zip((0.001, 1e-8), others):
            for first, second in zip(metres["materials"], scaled["materials"]):
                self.assert_close(second["area"], unit ** 2 * first["area"], 1e-4, first["name"])
                # Rounding makes another mesh, and with it other random rotations: about 1 % with so few patches and rays.
                self.assert_close(second["mean_irradiance"][0], first["mean_irradiance"][0], 0.04, first["name"])

    def test_what_is_baked_of_a_tiny_scene_can_be_read(self):
        target = self.folder / "tiny.ply"
        report = self.bake(CORNELL_OBJ, "--unit", 1e-9, "--patches", 3000, "--resolution", 8, "-o", target)
        patches = report["patches"] - report["mesh"]["hidden_patches"]
        self.assertGreater(patches, 2500)
        self.assertIn(f"; {patches} in the file", run("info", target).stdout)
        failed = run("bake", CORNELL_OBJ, "--unit", 1e-10, "-o", target)
        self.assertEqual(failed.returncode, 3)
        self.assertIn("found a scene of 9.61e-11 m, expected at least 1e-10 m", failed.stderr)

    def test_exposure_by_hand_and_auto(self):
        for typed, expected in (("2", 2), ("+2.5", 2.5), ("-3", -3)):
            self.assertEqual(self.bake(self.ONE, *SMALL, "--exposure", typed)["exposure_ev"], expected)
        bright, dim = (self.bake(CORNELL_OBJ, *SMALL, "--emit", f"light={l},{l},{l}")["exposure_ev"] for l in (16, 1))
        self.assertAlmostEqual(dim - bright, 4, places=3)  # a sixteenth of the light takes four stops


if __name__ == "__main__":
    unittest.main()
