#!/usr/bin/env python3
"""What a user changes of a scene by options or by the file beside it."""
import json
import os
import unittest

from lambert_cli import DATA, INPUT, OK, SMALL, USAGE, Gltf, Ply, ProgramTest, materials, read_json, run

ROOM = """mtllib room.mtl
v 0 0 0\nv 4 0 0\nv 4 0 4\nv 0 0 4\nv 1 2 1\nv 3 2 1\nv 3 2 3\nv 1 2 3\nv 1 1 1\nv 3 1 1\nv 3 1 3\nv 1 1 3
g Floor\nusemtl wall\nf 4 3 2 1
g Lamp.1\nusemtl lamp\nf 5 6 7 8
g Shade\nusemtl shade\nf 9 10 11 12
"""
ROOM_MATERIALS = """newmtl wall\nKd .5 .5 .5\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\nnewmtl shade\nKd .7 .7 .7\n"""


class OverridesTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.room = self.write("room.obj", ROOM)
        self.write("room.mtl", ROOM_MATERIALS)

    def bake_room(self, *options):
        return self.bake(self.room, *SMALL, *options)

    def floor_light(self, *options):
        return materials(self.bake_room(*options))["wall"]["mean_irradiance"][0]

    def beside(self, content):
        return self.write("room.lambert.json", content if isinstance(content, str) else json.dumps(content))


class Nodes(OverridesTest):
    def test_excluded_node_is_not_there(self):
        report = self.bake_room("--exclude", "Sh*", "-o", self.folder / "x.ply")
        self.assertNotIn("shade", materials(report))
        self.assertEqual(report["options"]["exclude"], ["Sh*"])
        self.assertFalse(any(abs(v["y"] - 1) < 1e-6 for v in Ply(self.folder / "x.ply").vertices))
        self.assertGreater(self.floor_light("--exclude", "Shade"), self.floor_light())

    def test_occluder_blocks_light_and_is_in_no_output(self):
        files = [self.folder / f"x.{kind}" for kind in ("ply", "glb", "obj")]
        report = self.bake_room("--occlude-only", "Shade", *(o for file in files for o in ("-o", file)))
        self.assertNotIn("shade", materials(report))
        self.assertEqual(report["options"]["occlude_only"], ["Shade"])
        self.assertFalse(any(abs(v["y"] - 1) < 1e-6 for v in Ply(files[0]).vertices))
        self.assertFalse(any(abs(p[1] - 1) < 1e-6 for p in Gltf(files[1]).attribute("POSITION")))
        self.assertNotIn("shade", files[2].read_text())
        self.assertLess(self.floor_light("--occlude-only", "Shade"), 0.8 * self.floor_light("--exclude", "Shade"))

    def test_picture_shows_what_is_behind_an_occluder(self):
        # From above: the shade hides the middle of the floor unless it only blocks light.
        def picture(*options):
            self.run_well("bake", self.room, "--image", self.folder / "x.png", *SMALL, "--exclude", "Lamp.1",
                          "--emit", "wall=1,1,1", "--size", "32x32", "--eye", "2,6,2", "--look-at", "2,0,2",
                          "--up", "0,0,1", "--exposure", "0", "--bounces", "1", *options)
            return (self.folder / "x.png").read_bytes()
        self.assertEqual(picture("--occlude-only", "Shade"), picture("--exclude", "Shade"))
        self.assertNotEqual(picture("--occlude-only", "Shade"), picture())

    def test_exclusion_wins_over_occlusion(self):
        self.assertEqual(self.floor_light("--exclude", "Shade", "--occlude-only", "S*"),
                         self.floor_light("--exclude", "Shade"))

    def test_info_and_probe_know_the_options(self):
        self.run_well("info", self.room, "--exclude", "Shade", "--json", self.folder / "info.json")
        self.assertEqual(materials(read_json(self.folder / "info.json"))["shade"]["polygons"], 0)
        self.write("p.csv", "2,0,2,0,1,0\n")
        self.run_well("probe", self.room, self.folder / "p.csv", "--occlude-only", "Shade", *SMALL)


class FileBesideTheScene(OverridesTest):
    def test_it_says_what_the_options_say(self):
        by_options = self.bake_room("--emit", "wall=2,2,2", "--reflectance", "sh*=.25,.25,.25", "--unit", "0.5",
                                    "--two-sided", "--occlude-only", "Lamp.1")
        self.beside({"unit": 0.5, "two_sided": True, "occlude_only": ["Lamp.1"],
                     "materials": {"wall": {"emit": [2, 2, 2]}, "sh*": {"reflectance": [.25, .25, .25]}}})
        by_file = self.bake_room()
        self.assertEqual(by_file["materials"], by_options["materials"])
        self.assertEqual(by_file["energy"], by_options["energy"])
        self.assertEqual(by_file["options"].pop("overrides"), str(self.folder / "room.lambert.json"))
        self.assertIsNone(by_options["options"].pop("overrides"))
        self.assertEqual(by_file["options"], by_options["options"])

    def test_options_win(self):
        self.beside({"unit": 2, "materials": {"wall": {"emit": [2, 2, 2], "two_sided": False}}, "exclude": ["Shade"]})
        report = self.bake_room("--emit", "wall=3,3,3", "--unit", "1", "--occlude-only", "Shade", "--two-sided")
        self.assertEqual(report["options"]["occlude_only"], ["Shade"])
        self.assertEqual(report["options"]["emit"], ["wall=2,2,2", "wall=3,3,3"])
        self.assertEqual(report["options"]["two_sided_materials"], {})
        os.remove(self.folder / "room.lambert.json")
        typed = self.bake_room("--emit", "wall=3,3,3", "--unit", "1", "--occlude-only", "Shade", "--two-sided")
        self.assertEqual(report["materials"], typed["materials"])

    def test_it_is_mentioned_and_can_be_ignored_or_replaced(self):
        self.beside({"exclude": ["Shade"]})
        done = self.run_well("bake", self.room, "-o", self.folder / "x.glb", *SMALL)
        self.assertIn("room.lambert.json", done.stderr)
        self.assertIn("shade", materials(self.bake_room("--no-overrides")))
        other = self.write("other.json", '{"materials": {"shade": {"two_sided": true}}}')
        report = self.bake_room("--overrides", other)
        self.assertIn("shade", materials(report))
        self.assertEqual(report["options"]["overrides"], str(other))
        self.assertEqual(report["options"]["two_sided_materials"], {"shade": True})


class Errors(OverridesTest):
    def assert_fails(self, code, *arguments, says):
        before = sorted(self.folder.iterdir())
        done = run("bake", self.room, "-o", self.folder / "x.glb", *SMALL, "--quiet", *arguments)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn(says, done.stderr)
        self.assertEqual(sorted(self.folder.iterdir()), before)

    def test_unknown_names_are_usage_errors_that_name_the_closest(self):
        self.assert_fails(USAGE, "--exclude", "Shad", says='--exclude: the scene has no node "Shad"; the closest of its 3 '
                                                           'nodes: "Shade"')
        self.assert_fails(USAGE, "--occlude-only", "X*", says='no node "X*"')
        self.assert_fails(USAGE, "--emit", "lamb=1,1,1", says='"lamp"')

    def test_nothing_left_to_be_lit(self):
        self.assert_fails(USAGE, "--exclude", "*", says="no polygon is left")
        self.assert_fails(USAGE, "--occlude-only", "*", says="no polygon is left")

    def test_options_that_exclude_each_other(self):
        self.assert_fails(USAGE, "--no-overrides", "--overrides", "x.json", says="--overrides")

    def test_wrong_file_is_an_input_error(self):
        self.assert_fails(INPUT, "--overrides", self.folder / "missing.json", says="missing.json: no such file")
        for content, says in (({"matrials": {}}, "/matrials: not known"), ({"unit": "m"}, '/unit: found "'),
                              ({"exclude": ["Nobody"]}, '/exclude/0: the scene has no node "Nobody"'),
                              ({"materials": {"lmap": {}}}, '/materials/lmap: the scene has no material "lmap"'),
                              ("{", "not valid JSON")):
            path = self.beside(content)
            self.assert_fails(INPUT, says=f"{path}: {says}" if not says.startswith("not") else says)

    def test_unit_in_the_file_of_a_gltf(self):
        for name in ("cornell_box.gltf", "cornell_box.bin"):
            if (DATA / name).exists():
                self.write(name, (DATA / name).read_bytes())
        self.room = self.folder / "cornell_box.gltf"
        self.write("cornell_box.lambert.json", '{"unit": 0.001}')
        self.assert_fails(INPUT, says="/unit: found 0.001, allowed is 1")

    def test_the_file_is_not_overwritten(self):
        self.beside({})
        for options in ((), ("--no-overrides",)):
            self.assert_fails(USAGE, "--json", self.folder / "room.lambert.json", *options, says="overwrite")
        other = self.write("other.json", "{}")
        self.assert_fails(USAGE, "--overrides", other, "--json", other, says="overwrite")

    def test_lists_take_one_value_each(self):
        done = run("bake", "--emit", "lamp=2,2,2", "--exclude", "Shade", self.room, "-o", self.folder / "x.glb", *SMALL)
        self.assertEqual(done.returncode, OK, done.stderr)


if __name__ == "__main__":
    unittest.main()
