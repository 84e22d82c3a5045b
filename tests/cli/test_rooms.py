#!/usr/bin/env python3
"""Default bakes of small rooms in which light is easily lost or made, against right values: Monte Carlo without a mesh (standard
errors of about .02 %), conservation of energy, closed forms."""
import math
import unittest

from lambert_cli import SCENES, ProgramTest, materials, read_json

BOX = ("v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nv 0 0 10\nv 10 0 10\nv 10 10 10\nv 0 10 10\n")
WALLS = "usemtl wall\nf 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 4 3 7 8\nf 1 4 8 5\nf 2 6 7 3\n"


def turned(text, axis=(1.0, 2.0, 3.0), degrees=37.0, scale=1.0):
    """The vertices of an OBJ about an axis through the origin."""
    length = math.sqrt(sum(a * a for a in axis))
    u, c, s = [a / length for a in axis], math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    lines = []
    for line in text.splitlines():
        if line.startswith("v "):
            p = [float(x) for x in line.split()[1:]]
            dot = sum(a * b for a, b in zip(u, p))
            cross = [u[1] * p[2] - u[2] * p[1], u[2] * p[0] - u[0] * p[2], u[0] * p[1] - u[1] * p[0]]
            q = [scale * (p[k] * c + cross[k] * s + u[k] * dot * (1 - c)) for k in range(3)]
            line = "v " + " ".join(f"{x:.9g}" for x in q)
        lines.append(line)
    return "\n".join(lines) + "\n"


class RoomsTest(ProgramTest):
    def scene(self, text, mtl):
        (self.folder / "room.mtl").write_text(mtl, encoding="utf-8")
        path = self.folder / "room.obj"
        path.write_text("mtllib room.mtl\n" + text, encoding="utf-8")
        return path


class LampBelowACeiling(RoomsTest):
    """A lamp of 1 m² that shines on both sides, so far below the ceiling of a closed room of 10 m: 6283.2 are emitted."""

    # Distance from the ceiling: mean irradiance of the walls.
    RIGHT = {1e-4: 18.29, 1e-3: 18.324, 1e-2: 18.53, 1e-1: 20.32}
    MTL = "newmtl wall\nKd .6 .6 .6\nnewmtl lamp\nKd 0 0 0\nKe 1000 1000 1000\n"

    def room(self, gap):
        z = 10 - gap
        return (BOX + f"v 4.4 4.4 {z}\nv 5.4 4.4 {z}\nv 5.4 5.4 {z}\nv 4.4 5.4 {z}\n" + WALLS +
                "usemtl lamp\nf 9 10 11 12\nf 12 11 10 9\n")

    def check(self, text, right, *options, factor=1.0):
        report = self.bake(self.scene(text, self.MTL), *options)
        self.assert_close(materials(report)["wall"]["mean_irradiance"][0], right, 0.01)
        emitted, absorbed = report["energy"]["emitted"][0] / factor, report["energy"]["absorbed"][0] / factor
        self.assert_close(emitted, 6283.2, 1e-4)
        self.assert_close(absorbed, 6283.2, 0.01)
        self.assertEqual(report["warnings"], [])

    def test_at_any_distance(self):
        for gap, right in self.RIGHT.items():
            with self.subTest(gap):
                self.check(self.room(gap), right)

    def test_turned_by_an_odd_angle(self):
        self.check(turned(self.room(1e-2)), self.RIGHT[1e-2])

    def test_in_millimetres(self):
        self.check(turned(self.room(1e-2), scale=1000.0), self.RIGHT[1e-2], "--unit", ".001")


def ball(around, down, radius, middle):
    """Vertices and faces of a ball as OBJ; faces count from vertex 9."""
    def vertex(i, j):
        a, b = 2 * math.pi * i / around, math.pi * j / down
        p = (math.sin(b) * math.cos(a), math.sin(b) * math.sin(a), math.cos(b))
        return "v " + " ".join(f"{m + radius * x:.9g}" for m, x in zip(middle, p)) + "\n"

    def number(i, j):
        return 9 if j == 0 else 10 + around * (down - 1) if j == down else 10 + around * (j - 1) + i % around

    vertices = vertex(0, 0) + "".join(vertex(i, j) for j in range(1, down) for i in range(around)) + vertex(0, down)
    faces = ""
    for j in range(down):
        for i in range(around):
            corners = dict.fromkeys((number(i, j), number(i, j + 1), number(i + 1, j + 1), number(i + 1, j)))
            faces += "f " + " ".join(map(str, corners)) + "\n"
    return vertices, faces


class BallBelowACeiling(RoomsTest):
    """A black ball of 10 cm that shines, 2 cm below the ceiling of a closed room of 10 m."""

    RIGHT = {"floor": 0.0029583, "ceiling": 0.0071995, "wall": 0.0034709}  # mean irradiance per power, m⁻²

    def test_light_of_all_surfaces(self):
        mtl = "".join(f"newmtl {name}\nKd .6 .6 .6\n" for name in self.RIGHT) + "newmtl lamp\nKd 0 0 0\nKe 1000 1000 1000\n"
        room = ("usemtl floor\nf 1 2 3 4\nusemtl ceiling\nf 5 8 7 6\n"
                "usemtl wall\nf 1 5 6 2\nf 4 3 7 8\nf 1 4 8 5\nf 2 6 7 3\n")
        vertices, faces = ball(32, 16, 0.05, (4.9, 4.9, 9.93))
        for variant in (lambda text: text, turned):
            report = self.bake(self.scene(variant(BOX + vertices + room + "usemtl lamp\n" + faces), mtl))
            for name, right in self.RIGHT.items():
                with self.subTest(name):
                    found = materials(report)[name]["mean_irradiance"][0] / report["energy"]["emitted"][0]
                    self.assert_close(found, right, 0.01)


class FactorsOfRooms(RoomsTest):
    def test_between_floor_and_wall_of_a_flat_hall(self):
        # 50 x 30 x .3 m; Howell's catalogue C-14, to 1 %.
        text = ("v 0 0 0\nv 50 0 0\nv 50 30 0\nv 0 30 0\nv 0 0 .3\nv 50 0 .3\nv 50 30 .3\nv 0 30 .3\n"
                "o floor\nf 1 2 3 4\no ceil\nf 5 8 7 6\no y0\nf 1 5 6 2\no y1\nf 4 3 7 8\no x0\nf 1 4 8 5\no x1\nf 2 6 7 3\n")
        report = self.folder / "report.json"
        for variant in (text, turned(text)):
            self.run_well("formfactors", self.scene(variant, ""), "--group-by", "node", "--json", report, "--quiet")
            groups = {g["name"]: g for g in read_json(report)["groups"]}
            names = [g["name"] for g in read_json(report)["groups"]]
            self.assert_close(groups["floor"]["factors"][names.index("y0")], 0.004927, 0.01)

    def test_nothing_leaves_a_closed_oven_with_a_block_in_it(self):
        text = ("v -2 0 -2\nv 2 0 -2\nv 2 0 2\nv -2 0 2\nv -2 3 -2\nv 2 3 -2\nv 2 3 2\nv -2 3 2\n"
                "v -.5 0 -.5\nv .5 0 -.5\nv .5 0 .5\nv -.5 0 .5\nv -.5 1 -.5\nv .5 1 -.5\nv .5 1 .5\nv -.5 1 .5\n"
                "o floor\nf 4 3 2 1\no ceiling\nf 5 6 7 8\no walls\nf 1 2 6 5\nf 3 4 8 7\nf 4 1 5 8\nf 2 3 7 6\n"
                "o block\nf 9 10 11 12\nf 16 15 14 13\nf 13 14 10 9\nf 15 16 12 11\nf 16 13 9 12\nf 14 15 11 10\n")
        table = self.folder / "t.csv"
        table.write_text("group,kelvin,emissivity\nfloor,500,.8\nceiling,600,.8\nwalls,550,.8\nblock,300,.8\n"
                         "environment,0\n", encoding="utf-8")
        report = self.folder / "report.json"
        for variant in (text, turned(text)):
            self.run_well("formfactors", self.scene(variant, ""), "--group-by", "node", "--temperatures", table,
                          "--json", report, "--quiet", "--patches", "1500")
            heat = read_json(report)
            flows = [abs(g["watts"]) for g in heat["groups"]]
            self.assertLess(abs(heat["heat_flow"]["environment_watts"]), 1e-6 * max(flows))


@unittest.skipUnless(SCENES, "LAMBERT_SCENES is not set")
class ScenesFromElsewhere(ProgramTest):
    def test_l_shaped_room(self):
        report = self.bake(SCENES / "l_room/lroom.obj", "--image", self.folder / "room.png", "--size", "64x64")
        area = sum(m["area"] for m in report["materials"])
        mean = sum(m["area"] * sum(m["mean_irradiance"]) / 3 for m in report["materials"]) / area
        self.assert_close(mean, 0.9025, 0.01)
        x, _, z = report["camera"]["eye"]
        self.assertTrue(0 < x < 2 or 0 < z < 2)

    def test_furnished_flat(self):
        report = self.bake(SCENES / "flat/flat.glb")
        self.assertLess(abs(report["energy"]["imbalance_before_repair"]), 0.01)
        self.assert_close(materials(report)["Ceiling"]["mean_irradiance"][0], 0.0418, 0.01)


if __name__ == "__main__":
    unittest.main()
