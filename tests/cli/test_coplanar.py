#!/usr/bin/env python3
"""Faces that overlap in one plane: one of them is seen, by every method, whatever their order, place and unit."""
import math
import unittest

from lambert_cli import ProgramTest, materials, read_json, run

MATERIALS = "newmtl wall\nKd .7 .7 .7\nnewmtl lamp\nKd 0 0 0\nKe 5 5 5\nnewmtl rug\nKd .1 .1 .1\n"

# A closed room of 4 × 3 × 4 m, its fronts inside; its floor and ceiling last.
ROOM = [((0, 0, 0), (0, 3, 0), (0, 3, 4), (0, 0, 4)), ((4, 0, 0), (4, 0, 4), (4, 3, 4), (4, 3, 0)),
        ((0, 0, 0), (4, 0, 0), (4, 3, 0), (0, 3, 0)), ((0, 0, 4), (0, 3, 4), (4, 3, 4), (4, 0, 4))]


def floor(x0, z0, x1, z1, y=0.0):
    return (x0, y, z0), (x0, y, z1), (x1, y, z1), (x1, y, z0)


def ceiling(x0, z0, x1, z1, y=3.0):
    return (x0, y, z0), (x1, y, z0), (x1, y, z1), (x0, y, z1)


def around(make, outer, inner):
    """A rectangle without a smaller one, as eight."""
    xs = (outer[0], inner[0], inner[2], outer[2])
    zs = (outer[1], inner[1], inner[3], outer[3])
    return [make(xs[i], zs[j], xs[i + 1], zs[j + 1]) for i in range(3) for j in range(3) if (i, j) != (1, 1)]


WHOLE = (0, 0, 4, 4)
LAMP = (1, 1, 2.2, 2.1)
LAMP_2 = (1.7, 1.5, 3, 3)
RUG = (1.3, 1.1, 3.1, 3.3)


def turned(point):
    """About two odd angles."""
    x, y, z = point
    a, b = 0.7, 0.3
    x, y = x * math.cos(a) - y * math.sin(a), x * math.sin(a) + y * math.cos(a)
    return x, y * math.cos(b) - z * math.sin(b), y * math.sin(b) + z * math.cos(b)


class CoplanarTest(ProgramTest):
    def scene(self, objects, triangles=False, turn=False, unit=1.0):
        """An OBJ of (node, material, quads)."""
        self.write("m.mtl", MATERIALS)
        lines, count = ["mtllib m.mtl"], 0
        for node, material, quads in objects:
            lines += [f"g {node}", f"usemtl {material}"]
            for quad in quads:
                for point in quad:
                    x, y, z = turned(point) if turn else point
                    lines.append(f"v {x / unit:.9g} {y / unit:.9g} {z / unit:.9g}")
                corners = [count + k for k in range(1, 5)]
                count += 4
                for face in [(0, 1, 2), (0, 2, 3)] if triangles else [(0, 1, 2, 3)]:
                    lines.append("f " + " ".join(str(corners[k]) for k in face))
        return self.write("scene.obj", "\n".join(lines) + "\n")

    def baked(self, objects, *options, **how):
        unit = how.get("unit", 1.0)
        patches = () if "--patches" in options else ("--patches", "1000")
        return self.bake(self.scene(objects, **how), "--unit", unit, *patches, *options)

    def wall(self, report):
        return materials(report)["wall"]["mean_irradiance"][0]

    def flux(self, report, name):
        """In watts: faces that are covered count in the mean, and receive nothing."""
        material = materials(report)[name]
        return material["area"] * material["mean_irradiance"][0]


ROOM_WALLS = ("room", "wall", ROOM + [floor(*WHOLE), ceiling(*WHOLE)])
CEILING_LAMP = ("lamp", "lamp", [ceiling(*LAMP)])


class ALampInTheCeiling(CoplanarTest):
    # All is absorbed: what the lamp leaves, on which E is .694 (1 % of that is .05 % here), by .3 of 80 m² of wall, of which 1.32 m²
    # lie above the lamp: (20.735 - 1.32 * .694) / 24. 1 %: 1000 patches and their one viewpoint.
    RIGHT, WITHIN = 0.8257, 0.01

    def check(self, *options, objects=(ROOM_WALLS, CEILING_LAMP), **how):
        report = self.baked(objects, *options, **how)
        self.assert_close(self.wall(report), self.RIGHT, self.WITHIN)
        self.assert_close(report["energy"]["emitted"][0], 1.32 * 5 * math.pi, 1e-5)
        return report

    def test_every_method_sees_it(self):
        for options in [("--method", "hemicube", "--resolution", "48"), ("--method", "hemisphere", "--resolution", "48"),
                        ("--method", "local-lines", "--lines", "2048"), ("--method", "global-lines", "--lines", "1000000"),
                        ("--method", "closed-form", "--patches", "100"), ("--solver", "stochastic"),
                        ("--method", "instant-radiosity", "--vpls", "1000", "--clamp", "none")]:
            with self.subTest(options):
                self.check(*options)

    def test_variants_of_the_scene(self):
        fast = ("--method", "local-lines", "--lines", "2048")
        self.check(*fast, objects=(CEILING_LAMP, ROOM_WALLS))
        self.check(*fast, turn=True, triangles=True, unit=0.001)
        hair = 5e-6  # within the tolerance, which is 2e-6 of the room's diagonal
        self.check(*fast, objects=(ROOM_WALLS, ("lamp", "lamp", [ceiling(*LAMP, y=3 + hair)])))
        self.check(*fast, objects=(ROOM_WALLS, ("lamp", "lamp", [ceiling(*LAMP, y=3 - hair)])))

    def test_the_log_and_info_name_the_pair(self):
        scene = self.scene((ROOM_WALLS, CEILING_LAMP))
        line = 'faces overlap in one plane: "lamp" covers 1.32 m² of "room"'
        done = self.run_well("bake", scene, "-o", self.folder / "x.glb", "--patches", "200", "--resolution", "32")
        self.assertEqual(done.stderr.count(line), 1)
        report = self.folder / "info.json"
        self.run_well("info", scene, "--json", report)
        info = read_json(report)
        self.assertIn(line, [finding["problem"] for finding in info["worth_a_look"]])
        overlap, = info["coplanar_overlaps"]
        self.assertEqual(overlap["upper"], {"node": "lamp", "material": "lamp"})
        self.assertEqual(overlap["lower"], {"node": "room", "material": "wall"})
        self.assert_close(overlap["area"], 1.32, 1e-5)
        self.assert_close(info["emitted"][0], 1.32 * 5 * math.pi, 1e-5)

    def test_where_polygons_are_the_patches_none_is_cut_and_a_warning_says_so(self):
        report = self.bake(self.scene((ROOM_WALLS, CEILING_LAMP)), "--patches", "0", "--resolution", "32")
        self.assertEqual(report["patches"], 7)
        self.assertTrue(any("none is cut" in warning for warning in report["warnings"]))


class OtherOverlaps(CoplanarTest):
    FAST = ("--method", "local-lines", "--lines", "2048")

    def same_light(self, objects, cut, **how):
        """The light of the scene is that of one whose faces were cut by hand. 1 %: the patches are others."""
        found, right = self.baked(objects, *self.FAST, **how), self.baked(cut, *self.FAST, **how)
        self.assert_close(found["energy"]["emitted"][0], right["energy"]["emitted"][0], 1e-5)
        for name in ("wall", "rug"):
            self.assert_close(self.flux(found, name), self.flux(right, name), 0.01, name)

    def test_a_rug_on_the_floor_in_any_order(self):
        rug = ("rug", "rug", [floor(*RUG)])
        cut = (("room", "wall", ROOM + around(floor, WHOLE, RUG) + around(ceiling, WHOLE, LAMP)), rug, CEILING_LAMP)
        self.same_light((rug, ROOM_WALLS, CEILING_LAMP), cut, turn=True, unit=0.001)
        # It lies across the tiles of a floor.
        tiles = [floor(x, z, x + 1, z + 1) for x in range(4) for z in range(4)]
        self.same_light((("room", "wall", ROOM + [ceiling(*WHOLE)] + tiles), CEILING_LAMP, rug), cut, triangles=True)

    def test_a_rug_with_a_hole(self):
        hole = (2, 2, 2.5, 2.4)
        rug = ("rug", "rug", around(floor, RUG, hole))
        cut = (("room", "wall", ROOM + around(floor, WHOLE, RUG) + [floor(*hole)] + around(ceiling, WHOLE, LAMP)), rug,
               CEILING_LAMP)
        self.same_light((ROOM_WALLS, CEILING_LAMP, rug), cut)

    def test_two_lamps_emit_once_where_they_overlap(self):
        objects = (ROOM_WALLS, CEILING_LAMP, ("lamp 2", "lamp", [ceiling(*LAMP_2)]))
        report = self.baked(objects, *self.FAST)
        self.assert_close(report["energy"]["emitted"][0], (1.32 + 1.95 - 0.3) * 5 * math.pi, 1e-5)
        # All is absorbed, to the noise of the lines.
        self.assertLess(abs(report["energy"]["imbalance"]), 0.01)

    def test_what_only_touches_is_no_overlap(self):
        lamps = ("lamp", "lamp", [ceiling(1, 1, 2, 2, 2.5), ceiling(2, 1, 3, 2, 2.5), ceiling(1, 2, 2.5, 3, 2.5)])
        report = self.baked((ROOM_WALLS, lamps), *self.FAST)
        self.assertEqual(report["input"]["coplanar_overlaps"], [])
        self.assertEqual(report["input"]["cut_by_coplanar"], 0)


class BackToBack(ProgramTest):
    def factors(self, faces):
        scene = self.write("sheets.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                           "v .4 0 0\nv .4 1 0\n" + faces)
        report = self.folder / "f.json"
        self.run_well("formfactors", scene, "--patches", "0", "--method", "local-lines", "--group-by", "node", "--json",
                      report)
        groups = read_json(report)["groups"]
        names = [group["name"] for group in groups]
        return lambda of, to: groups[names.index(of)]["factors"][names.index(to)]

    def test_each_shows_its_front_in_any_order_and_however_it_is_cut(self):
        up, down, top = "g up\nf 1 2 3 4\n", "g down\nf 4 3 2 1\n", "g top\nf 8 7 6 5\n"
        cut = "g down\nf 1 4 10 9\nf 9 10 3 2\n"
        smaller = "g down\nf 9 10 3 2\n"
        for faces in [(up, down, top), (down, up, top), (top, down, up), (up, cut, top), (cut, up, top),
                      (smaller, up, top)]:
            with self.subTest(faces):
                factor = self.factors("".join(faces))
                # Exact: .19982; .3 %: 32,768 stratified lines.
                self.assert_close(factor("top", "up"), 0.19982, 0.003)
                self.assertEqual(factor("top", "down"), 0)


if __name__ == "__main__":
    unittest.main()
