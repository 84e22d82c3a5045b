#!/usr/bin/env python3
"""Checks of room_figures.py, row_check.py and scene_bakes.py: python3 scripts/test_room_figures.py (LAMBERT: the program)"""
import contextlib
import io
import os
import random
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import room_figures
import row_check
import scene_bakes

PROGRAM = os.environ.get("LAMBERT", str(scene_bakes.ROOT / "build/cli/lambert"))
CUBE = scene_bakes.ROOT / "data/cube6.obj"


def traced(factors, rays, chance):
    """Shares of `rays` rays that go by the factors."""
    shares = {}
    for column in chance.choices(range(len(factors)), factors, k=rays):
        shares[column] = shares.get(column, 0.0) + 1 / rays
    return list(shares.items())


class Rows(unittest.TestCase):
    def check(self, stated, true):
        """Mean bounds of 40 rows of 50 points, each with 20 rays."""
        chance, bounds = random.Random(1), []
        for _ in range(40):
            row = row_check.Row(stated, 50, 20)
            for _ in range(50):
                row.add(traced(true, 20, chance))
            bounds.append(row.bounds())
        return [sum(b[k] for b in bounds) / len(bounds) for k in (0, 1)]

    def test_right_factors_have_no_error(self):
        factors = [.4, .3, .2, .0999, .0001, 0]
        least, most2 = self.check(factors, factors)
        self.assertAlmostEqual(least, 0, delta=5e-3)  # of noise
        self.assertAlmostEqual(most2, 0, delta=3e-3)

    def test_wrong_factors_have_theirs(self):
        least, most2 = self.check([.5, .2, .2, .1], [.4, .3, .2, .1])
        self.assertAlmostEqual(least, .2, delta=.01)
        self.assertAlmostEqual(most2, .01 / .45 + .01 / .25, delta=.01)

    def test_rays_where_no_factor_is_count(self):
        least, most2 = self.check([0, .5, 0, .5], [.05, .45, .05, .45])
        self.assertTrue(.1 < least < .2)  # not all are told from noise
        self.assertGreater(most2, .04)

    def test_columns_of_few_rays_count_together(self):
        row = row_check.Row([.5, .02, .04, .22, .06, .04, .1, .02], 20, 10)
        row.shares = list(row.factors)
        row.make_bins()
        self.assertEqual(row.bin_of, [0, 1, 1, 2, 3, 4, 5, 4])
        self.assertAlmostEqual(sum(row.expected), 1, 12)

    def test_points_lie_on_their_patch(self):
        patches = row_check.Patches.__new__(row_check.Patches)
        patches.origin, patches.corners = [1, 0, 0], [0, 1, 2, 3, 0, 1, 2, 0xFFFFFFFF]
        patches.positions = [0, 0, 0, 2, 0, 0, 2, 1, 0, 0, 1, 0]
        places = [[float(x) for x in line.split(",")] for line in patches.points(0, 2000, random.Random(1))]
        self.assertTrue(all(1 <= x <= 3 and 0 <= y <= 1 and z == 0 for x, y, z, *_ in places))
        self.assertAlmostEqual(sum(place[0] for place in places) / 2000, 2, delta=.06)
        self.assertTrue(all(place[5] > 0 for place in places))
        self.assertEqual(len(patches.points(1, 10, random.Random(1))), 10)


class Tables(unittest.TestCase):
    def test_standard_error_of_a_mean(self):
        chance = random.Random(1)
        tables = [{"wall": (1, [chance.gauss(1, .01)] * 3)} for _ in range(400)]
        self.assertAlmostEqual(scene_bakes.standard_error(tables), .01 / 20, delta=1e-4)

    def test_options_of_the_mesh(self):
        self.assertEqual(scene_bakes.mesh_options(["--method", "hemicube", "--patches", "100", "--repair"]), ["--patches", "100"])
        self.assertIn("--sky", scene_bakes.scene_options("bake", "window_room.gltf"))
        self.assertNotIn("--sky", scene_bakes.scene_options("formfactors", "window_room.gltf"))

    def test_scenes_but_the_conference_room(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("conference/conference.obj", "room/room.obj", "room/room.glb", "analytic/cube6.obj"):
                (Path(folder) / name).parent.mkdir(exist_ok=True)
                (Path(folder) / name).touch()
            with mock.patch.dict(os.environ, {"LAMBERT_SCENES": folder}):
                found = [path.name for path in scene_bakes.all_scenes()]
        self.assertEqual(found[-1], "room.glb")
        self.assertEqual(sum(name.startswith("cube6") for name in found), 1)
        self.assertNotIn("conference.obj", found)


@unittest.skipUnless(Path(PROGRAM).exists(), "needs the program")
class Figures(unittest.TestCase):
    def table(self, *words):
        out = io.StringIO()
        with mock.patch.object(sys, "argv", ["room_figures.py", "--program", PROGRAM, *map(str, words)]), contextlib.redirect_stdout(out):
            self.assertEqual(room_figures.main(), 0)
        return [[cell.strip() for cell in line.strip("| ").split(" | ")] for line in out.getvalue().splitlines()]

    def test_the_cube_is_right(self):
        with mock.patch.multiple(room_figures, FIRST_WALKS=1e5, WALKS=3), mock.patch.object(row_check, "POINTS", 200):
            header, _, row = self.table("--options=--patches 100", "--walk-error", .004, "--rows", 3, CUBE)
        cells = dict(zip(header, row))
        self.assertEqual(len(row), len(header), row)
        self.assertLess(float(cells["error %"]), 1)
        self.assertLess(float(cells["walks %"]), .5)
        self.assertLess(float(cells["by rays"].split()[0]), float(cells["rows state"]) + .01)  # four standard errors

    def test_a_scene_without_light_says_so(self):
        with tempfile.TemporaryDirectory() as folder:
            dark, earlier = Path(folder) / "dark.obj", Path(folder) / "earlier.md"
            dark.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", encoding="utf-8")
            *_, row = self.table(dark)
            self.assertEqual(row[0], "dark.obj")
            self.assertIn("light", row[-1])
            earlier.write_text(room_figures.line_of(row), encoding="utf-8")
            self.assertEqual(self.table("--done", earlier, dark), [])


if __name__ == "__main__":
    unittest.main()
