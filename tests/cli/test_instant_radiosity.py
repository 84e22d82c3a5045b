#!/usr/bin/env python3
"""`lambert bake --method instant-radiosity`: agreement with form factors, what it reports, what it refuses."""
import unittest

from lambert_cli import DATA, INPUT, USAGE, Gltf, ProgramTest, materials, png_size, read_json, run

BOX = DATA / "cornell_box.obj"
METHOD = ("--method", "instant-radiosity")


class Light(ProgramTest):
    def assert_agreement(self, scene, *options, vpls=2048):
        """Of all light, and of the mean irradiance of materials with 3 % of the area and more.

        2048 particles: over seeds the light of all surfaces scatters by 1.3 %, that of single large materials by up to 2.5 %;
        three standard deviations. (Of small materials near a lamp it scatters by 10 %.) Local lines are good for 0.3 %."""
        expected = materials(self.bake(scene, *options, "--method", "local-lines", "--lines", "4096"))
        found = materials(self.bake(scene, *options, *METHOD, "--vpls", vpls, "--compensate"))
        self.assertEqual(list(found), list(expected))
        area = sum(material["area"] for material in found.values())
        for channel in range(3):
            light, exact = (sum(m["area"] * m["mean_irradiance"][channel] for m in table.values())
                            for table in (found, expected))
            self.assert_close(light, exact, 0.04, (scene.name, channel))
            for name, material in found.items():
                if material["area"] > 0.03 * area:
                    self.assert_close(material["mean_irradiance"][channel], expected[name]["mean_irradiance"][channel], 0.08,
                                      (scene.name, name))

    def test_of_the_cornell_box_is_that_of_form_factors(self):
        self.assert_agreement(BOX, "--patches", "1000")

    def test_of_a_room_with_four_lamps_is_that_of_form_factors(self):
        self.assert_agreement(DATA / "table_room.obj", "--patches", "2000")

    def test_of_two_sided_surfaces_is_that_of_form_factors(self):
        self.assert_agreement(BOX, "--patches", "2000", "--two-sided")

    def test_of_textures_and_holes_is_that_of_form_factors(self):
        self.assert_agreement(DATA / "textured_room.gltf", "--patches", "2000")

    def test_of_lights_without_area_is_that_of_form_factors(self):
        self.assert_agreement(DATA / "window_room.gltf", "--patches", "2000")

    def test_of_the_sky_is_that_of_form_factors(self):
        # One in twenty of the sky's particles comes through the window.
        self.assert_agreement(DATA / "window_room.gltf", "--patches", "1000", "--sky", "20,30,40", "--emit", "panel=0,0,0",
                              vpls=32768)

    def test_does_not_depend_on_the_walk(self):
        walks = [materials(self.bake(BOX, "--patches", "500", *METHOD, *options))
                 for options in ((), ("--walk", "roulette"), ("--walk", "fixed", "--bounces", "12"))]
        for walk in walks[1:]:
            for name, material in walk.items():
                for value, other in zip(material["mean_irradiance"], walks[0][name]["mean_irradiance"]):
                    self.assert_close(value, other, 0.06, name)  # 4096 particles

    def test_is_the_same_on_any_number_of_threads(self):
        def bake(threads):
            target = self.folder / f"{threads}.glb"
            report = self.bake(BOX, "--patches", "500", *METHOD, "--vpls", "500", "--compensate", "--threads", threads,
                               "-o", target)
            return target.read_bytes(), report["materials"], report["energy"], report["instant_radiosity"]
        self.assertEqual(bake(1), bake(3))

    def test_depends_on_the_seed(self):
        one, two = (self.bake(BOX, "--patches", "500", *METHOD, "--vpls", "500", "--seed", s) for s in (1, 2))
        self.assertNotEqual(one["materials"], two["materials"])


class Report(ProgramTest):
    def test_says_what_became_of_the_light(self):
        report = self.bake(BOX, "--patches", "500", *METHOD, "--vpls", "2000", "--clamp", "2", "--compensate")
        self.assertEqual((report["method"], report["solver"]), ("instant-radiosity", "none"))
        self.assertIsNone(report["residual"])
        options = report["options"]
        self.assertEqual({key: options[key] for key in ("vpls", "walk", "bounces", "clamp", "compensate", "sampler")},
                         {"vpls": 2000, "walk": "quasi", "bounces": None, "clamp": 2, "compensate": True,
                          "sampler": "halton"})
        found = report["instant_radiosity"]
        self.assertEqual(found["particles"][0], 2000)
        self.assertEqual(sorted(found["particles"], reverse=True), found["particles"])
        self.assertLessEqual(found["vpls"], sum(found["particles"]))
        energy = report["energy"]
        for channel in range(3):
            emitted = energy["emitted"][channel]
            self.assertEqual(energy["received"][channel], 0)
            # A lamp of 17 W/(m² sr) as red, green and blue of 0.13 m x 0.105 m.
            self.assert_close(emitted, materials(report)["light"]["mean_radiosity"][channel]
                              * materials(report)["light"]["area"], 0.2)
            self.assertLess(found["lost"][channel], 0.01 * emitted)
            self.assertGreater(found["cut"][channel], 0.05 * emitted)
            # Recovery has its noise.
            self.assert_close(found["recovered"][channel], found["cut"][channel], 0.1)
        self.assertLess(abs(energy["imbalance"]), 0.02)

    def test_counts_what_a_bound_takes_away(self):
        bounded = self.bake(BOX, "--patches", "500", *METHOD, "--vpls", "2000", "--clamp", "2")
        free = self.bake(BOX, "--patches", "500", *METHOD, "--vpls", "2000", "--clamp", "none")
        self.assertEqual(free["options"]["clamp"], "none")
        self.assertEqual(free["instant_radiosity"]["cut"], [0, 0, 0])
        flux = [sum(m["area"] * m["mean_irradiance"][0] for m in r["materials"]) for r in (bounded, free)]
        self.assert_close(flux[1] - flux[0], bounded["instant_radiosity"]["cut"][0], 1e-5)
        self.assertEqual(bounded["instant_radiosity"]["recovered"], [0, 0, 0])

    def test_of_short_walks_says_what_they_lose(self):
        report = self.bake(BOX, "--patches", "500", *METHOD, "--vpls", "2000", "--walk", "fixed", "--bounces", "1")
        self.assertEqual(report["options"]["bounces"], 1)
        self.assertEqual(len(report["instant_radiosity"]["particles"]), 2)
        self.assertGreater(report["instant_radiosity"]["lost"][0], 0.1 * report["energy"]["emitted"][0])
        self.assertGreater(report["energy"]["imbalance"], 0.1)


class Files(ProgramTest):
    def test_are_those_of_any_bake(self):
        names = ("box.glb", "box.gltf", "box.ply", "box.obj")
        outputs = [word for name in names for word in ("-o", self.folder / name)]
        solution = self.folder / "solution.glb"
        report = self.bake(BOX, "--patches", "300", *METHOD, "--vpls", "300", *outputs, "--image", self.folder / "box.png",
                           "--size", "64x48", "--solution", solution)
        self.assertEqual(png_size(self.folder / "box.png"), (64, 48))
        self.assertEqual(len(Gltf(self.folder / "box.glb").attribute("_RADIOSITY")) > 0, True)
        for name in names:
            self.assertGreater((self.folder / name).stat().st_size, 0)
        # The same patches, so that the solution can be compared and begun from.
        reference = self.folder / "reference.glb"
        self.bake(BOX, "--patches", "300", "--solution", reference, "--warm-start", solution)
        done = self.run_well("compare", "bakes", reference, solution, "--json", self.folder / "compare.json")
        self.assertIn("instant-radiosity", (self.folder / "compare.json").read_text())
        self.assertEqual(report["patches"], Gltf(solution).extras().get("patches", report["patches"]), done.stdout)

    def test_of_a_batch(self):
        self.run_well("bake", BOX, DATA / "cube6.obj", "--output-dir", self.folder / "out", *METHOD, "--vpls", "2000",
                      "--patches", "100", "--json", self.folder / "runs.json", "--quiet")
        runs = read_json(self.folder / "runs.json")["runs"]
        self.assertEqual([entry["method"] for entry in runs], 2 * ["instant-radiosity"])
        self.assertTrue((self.folder / "out" / "cube6.glb").exists())

    def test_of_a_probe(self):
        points = self.write("points.csv", "0.278,0,0.28,0,1,0\n0.278,0.3,0.1,0,1,0\n")
        table = {}
        for options in ((), (*METHOD, "--compensate")):
            done = self.run_well("probe", BOX, points, "--patches", "1500", *options)
            table[options] = [[float(v) for v in line.split(",")] for line in done.stdout.splitlines() if line[0] != "#"]
        for found, expected in zip(*table.values()):
            for k in (6, 7, 8):
                self.assert_close(found[k], expected[k], 0.05, found)  # of 4096 particles, as above


class DryRun(ProgramTest):
    def test_predicts_rays_and_seconds(self):
        options = ("--patches", "1500", *METHOD, "--vpls", "8000")
        predicted = self.bake(BOX, *options, "--dry-run")
        baked = self.bake(BOX, *options)
        self.assertEqual(predicted["status"], "predicted")
        self.assertEqual(predicted["patches"], baked["patches"])
        self.assertEqual(predicted["options"]["vpls"], 8000)
        self.assert_close(predicted["rays"], baked["rays"], 0.1)
        # Times on a machine with other work.
        self.assertLess(predicted["seconds"]["total"], 5 * baked["seconds"]["total"])
        self.assertGreater(predicted["seconds"]["total"], 0.2 * baked["seconds"]["total"])


class Options(ProgramTest):
    def assert_refused(self, *options, says):
        result = run("bake", BOX, *options, "-o", self.folder / "x.glb")
        self.assertEqual(result.returncode, USAGE, (options, result.stderr))
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        self.assertIn(says, result.stderr)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_of_other_methods_are_refused(self):
        for options in (("--resolution", "64"), ("--hemicubes", "2"), ("--rotation", "fixed"), ("--lines", "100"),
                        ("--line-set", "bundles"), ("--form-factor-error", "1e-3"), ("--storage", "float"),
                        ("--memory-limit", "1e9"), ("--repair",), ("--form-factors", "f.mtx"), ("--checkpoint", "c"),
                        ("--solver", "jacobi"), ("--tolerance", "0.1"), ("--relaxation", "1.2"), ("--rays", "1e6"),
                        ("--target-error", "0.1"), ("--keep-bounces",), ("--warm-start", "s.glb"), ("--per-light",),
                        ("--sampler", "sobol"), ("--bounces", "2")):
            self.assert_refused(*METHOD, *options, says=options[0])

    def test_of_instant_radiosity_are_refused_without_it(self):
        for options in (("--vpls", "100"), ("--walk", "quasi"), ("--clamp", "none"), ("--compensate",)):
            for method in ((), ("--method", "local-lines"), ("--solver", "stochastic")):
                self.assert_refused(*method, *options, says=options[0])

    def test_out_of_range_are_refused(self):
        for options in (("--vpls", "0"), ("--vpls", "16777217"), ("--vpls", "-1"), ("--walk", "slow"), ("--clamp", "0"),
                        ("--clamp", "-1"), ("--clamp", "nan"), ("--clamp", "inf"), ("--clamp", "much"), ("--clamp", "")):
            self.assert_refused(*METHOD, *options, says=options[0])
        self.assert_refused(*METHOD, "--clamp", "none", "--compensate", says="--compensate")
        self.assert_refused(*METHOD, "--walk", "fixed", "--bounces", "127", says="--bounces")

    def test_of_other_commands_do_not_know_it(self):
        for command in (("formfactors", BOX), ("compare", "formfactors", BOX, "-o", self.folder / "out")):
            self.assertEqual(run(*command, *METHOD).returncode, USAGE)

    def test_a_scene_without_light_is_refused(self):
        result = run("bake", BOX, *METHOD, "--emit", "light=0,0,0", "-o", self.folder / "x.glb")
        self.assertEqual(result.returncode, INPUT, result.stderr)
        self.assertIn("--emit", result.stderr)


if __name__ == "__main__":
    unittest.main()
