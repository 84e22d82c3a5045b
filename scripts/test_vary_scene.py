#!/usr/bin/env python3
"""Checks of vary_scene.py: python3 scripts/test_vary_scene.py"""
import contextlib
import io
import math
import tempfile
import unittest
from pathlib import Path

import vary_scene

BOX = Path(__file__).parent.parent / "data" / "cornell_box.obj"


def read(path):
    polygons, libraries = vary_scene.read_obj(path)
    return polygons, vary_scene.read_mtl(libraries)


def areas(polygons):
    """Per material; by the fan's triangles, as the left wall is not planar."""
    sums = {}
    for material, points in polygons:
        fan = sum(vary_scene.area([points[0], a, b]) for a, b in zip(points[1:], points[2:]))
        sums[material] = sums.get(material, 0) + fan
    return sums


def corners(polygons, name):
    return [p for material, points in polygons if material == name for p in points]


class VaryScene(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.polygons, self.materials = read(BOX)

    def vary(self, *options):
        out = self.folder / "varied.obj"
        self.assertEqual(vary_scene.main([str(BOX), str(out), *options]), 0)
        return read(out)

    def assert_same_areas(self, polygons):
        expected, found = areas(self.polygons), areas(polygons)
        self.assertEqual(expected.keys(), found.keys())
        for material, size in expected.items():
            self.assertAlmostEqual(found[material], size, delta=1e-13, msg=material)  # double precision, sizes < 1

    def test_without_options_nothing_changes(self):
        polygons, materials = self.vary()
        self.assertEqual(polygons, self.polygons)
        self.assertEqual(materials, self.materials)

    def test_rotation_keeps_areas_and_distances(self):
        polygons, _ = self.vary("--rotate=-.3,1,.2,37.7")
        self.assert_same_areas(polygons)
        before = [p for _, points in self.polygons for p in points]
        after = [p for _, points in polygons for p in points]
        self.assertTrue(all(p != q for p, q in zip(before, after)))
        for p, q in zip(before[1:], after[1:]):
            self.assertAlmostEqual(math.dist(p, before[0]), math.dist(q, after[0]), 13)
        handed = [vary_scene.dot(vary_scene.area_vector(points), vary_scene.sub(points[0], far[0]))
                  for group in (self.polygons, polygons) for (_, points), (_, far) in zip(group, group[1:])]
        for a, b in zip(handed, handed[len(handed) // 2:]):
            self.assertAlmostEqual(a, b, 13)  # a mirror image would change the sign

    def test_quarter_turn_has_the_right_sense(self):
        (_, points), = vary_scene.rotate([("m", [(1, 1, 0), (-1, 1, 0), (-1, -1, 0), (1, -1, 0)])], (0, 0, 2), 90)
        for found, expected in zip(points[0], (-1, 1, 0)):
            self.assertAlmostEqual(found, expected, 15)

    def test_move_shifts_one_material_only(self):
        polygons, _ = self.vary("--move", "tall=.01,0,-.02")
        for name in self.materials:
            shift = (.01, 0, -.02) if name == "tall" else (0, 0, 0)
            for p, q in zip(corners(self.polygons, name), corners(polygons, name)):
                for a, b, d in zip(p, q, shift):
                    self.assertAlmostEqual(a + d, b, 15)

    def test_subdivision_tiles_the_wall_exactly(self):
        for name in ("back", "left", "ceiling"):
            for seed in range(20):
                polygons, _ = self.vary("--subdivide", f"{name}={seed}")
                self.assert_same_areas(polygons)
                pieces = [points for material, points in polygons if material == name]
                self.assertGreaterEqual(len(pieces), vary_scene.PIECES)
                for points in pieces:
                    self.assertIn(len(points), (3, 4))
                    normal = vary_scene.area_vector(points)
                    n = len(points)
                    for i in range(n):  # convex, and no corner is straight
                        a, b, c = points[i - 1], points[i], points[(i + 1) % n]
                        turn = vary_scene.cross(vary_scene.sub(b, a), vary_scene.sub(c, b))
                        self.assertGreater(vary_scene.dot(turn, normal), 0, (name, seed))

    def test_subdivision_depends_on_the_seed_only(self):
        self.assertEqual(self.vary("--subdivide", "back=7"), self.vary("--subdivide", "back=7"))
        self.assertNotEqual(self.vary("--subdivide", "back=7"), self.vary("--subdivide", "back=8"))

    def test_permutation_exchanges_albedos_and_leaves_the_emitter(self):
        for seed in range(20):
            _, materials = self.vary("--permute-albedos", str(seed))
            kd = {name: vary_scene.colour(lines, "Kd") for name, lines in materials.items()}
            old = {name: vary_scene.colour(lines, "Kd") for name, lines in self.materials.items()}
            self.assertEqual(sorted(kd.values()), sorted(old.values()))
            self.assertNotEqual(kd, old)
            self.assertEqual(materials["light"], self.materials["light"])

    def test_errors_name_what_was_found(self):
        broken = self.folder / "broken.obj"
        broken.write_text("v 0 0 0\nv 1 0 0\nf 1 2 3\n")
        cases = [([BOX, self.folder / "o.obj", "--move", "nobody=1,2,3"], "materials floor, ceiling"),
                 ([BOX, self.folder / "o.obj", "--move", "tall=1,2"], "3 numbers"),
                 ([BOX, self.folder / "o.obj", "--rotate", "0,0,0,3"], "no length"),
                 ([BOX, BOX], "overwrite"),
                 ([self.folder / "none.obj", self.folder / "o.obj"], "No such file"),
                 ([broken, self.folder / "o.obj"], "broken.obj:3")]
        for arguments, message in cases:
            with contextlib.redirect_stderr(io.StringIO()) as stderr:
                self.assertEqual(vary_scene.main([str(a) for a in arguments]), 2)
            self.assertIn(message, stderr.getvalue())


if __name__ == "__main__":
    unittest.main()
