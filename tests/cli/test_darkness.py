#!/usr/bin/env python3
"""A result without light is never silent: what is black, by which fault of the scene, and the way out. Rays that slip between
polygons are no light."""
import json
import math
import base64
import struct
import unittest

from lambert_cli import ProgramTest, materials, read_json

SMALL = ("--patches", "300", "--resolution", "32")
FEW_RAYS = ("--patches", "1000", "--resolution", "32", "--sky-rays", "1024")

CORNERS = [(x, y, z) for y in (0, 3) for x, z in ((0, 0), (4, 0), (4, 2), (0, 2))]
INWARD = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (2, 3, 7, 6), (0, 4, 7, 3), (1, 2, 6, 5)]
OUTWARD = [face[::-1] for face in INWARD]
LAMP = [(2, 2.9, .5), (3, 2.9, .5), (3, 2.9, 1.5), (2, 2.9, 1.5)]  # shines down
LAMP_ABOVE = [(x, y + 1, z) for x, y, z in LAMP]


def turned(points, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return [(c * x + s * z + .137, y, c * z - s * x) for x, y, z in points]


class Darkness(ProgramTest):
    def room(self, faces=INWARD, lamp=LAMP, radiance=1.0, reflectance=.6, degrees=0.0):
        """A room of node `box` and material `wall`, and a lamp."""
        self.write("m.mtl", f"newmtl wall\nKd {reflectance} {reflectance} {reflectance}\n"
                            f"newmtl lamp\nKd 0 0 0\nKe {radiance} {radiance} {radiance}\n")
        lines = ["mtllib m.mtl", *("v " + " ".join(map(repr, p)) for p in turned(CORNERS + (lamp or []), degrees)),
                 "o box", "usemtl wall", *("f " + " ".join(str(k + 1) for k in face) for face in faces)]
        if lamp:
            lines += ["o light", "usemtl lamp", "f 9 10 11 12"]
        return self.write("room.obj", "\n".join(lines) + "\n")

    def box_with_bulb(self, place, degrees):
        """The same room, fronts inside, as glTF with a point light."""
        triangles = [t for a, b, c, d in INWARD for t in ((a, b, c), (a, c, d))]
        data = b"".join(struct.pack("<3f", *p) for p in turned(CORNERS, degrees))
        size = len(data)
        data += b"".join(struct.pack("<3I", *t) for t in triangles)
        document = {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
            "nodes": [{"mesh": 0, "name": "box"}, {"name": "bulb", "translation": place, "extensions": {
                "KHR_lights_punctual": {"light": 0}}}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
            "materials": [{"name": "wall", "pbrMetallicRoughness": {"baseColorFactor": [.7, .7, .7, 1],
                                                                    "metallicFactor": 0}}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3"},
                          {"bufferView": 1, "componentType": 5125, "count": 36, "type": "SCALAR"}],
            "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": size},
                            {"buffer": 0, "byteOffset": size, "byteLength": len(data) - size}],
            "buffers": [{"byteLength": len(data),
                         "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
            "extensionsUsed": ["KHR_lights_punctual"],
            "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "name": "bulb", "intensity": 1000}]}}}
        return self.write("box.gltf", json.dumps(document))

    def assert_black(self, scene, *options, says):
        """Bakes to black, and says all of `says` on stderr and in the report."""
        report = self.folder / "report.json"
        done = self.run_well("bake", scene, "--json", report, *options)
        result = read_json(report)
        warning = next((text for text in result["warnings"] if text.startswith("the result is black")), "")
        for word in says:
            self.assertIn(word, warning)
            self.assertIn(word, done.stderr)
        for name, material in materials(result).items():
            if name != "lamp":
                self.assertEqual(material["mean_irradiance"], [0, 0, 0])
        self.assertEqual(result["exposure_ev"], 0)
        return result

    def findings(self, scene):
        report = self.folder / "info.json"
        self.run_well("info", scene, "--json", report, "--quiet")
        return [entry["problem"] + ": " + entry["remedy"] for entry in read_json(report)["worth_a_look"]]

    def assert_finding(self, scene, *words):
        self.assertTrue([text for text in self.findings(scene) if all(word in text for word in words)],
                        self.findings(scene))

    def test_a_room_whose_fronts_face_outward(self):
        scene = self.room(OUTWARD)
        words = ('"lamp"', '"box"', '"wall"', "backs", "--two-sided")
        self.assert_black(scene, *SMALL, says=words)
        self.assert_finding(scene, "no light from", *words)
        light = materials(self.bake(scene, *SMALL, "--two-sided"))["wall"]["mean_irradiance"]
        self.assertGreater(min(light), .1)  # the way out is one

    def test_a_closed_box_with_its_light_outside(self):
        for degrees in (0, 11, 37.3):
            scene = self.box_with_bulb([-3, 4, -2], degrees)
            for options in ((), ("--sky", "1,1,1", "--sun", "200,30,100")):
                self.assert_black(scene, *FEW_RAYS, *options, says=('"bulb"', '"box"', "open it"))
        self.assert_finding(scene, '"bulb"', '"box"', '"wall"')
        self.assertEqual([text for text in self.findings(self.box_with_bulb([1, 2, 1], 0)) if "no light" in text], [])

    def test_a_closed_box_with_an_emitter_outside(self):
        for degrees in (0, 11):
            scene = self.room(lamp=LAMP_ABOVE, degrees=degrees)
            self.assert_black(scene, *SMALL, says=('"lamp"', '"box"'))
            self.assert_finding(scene, '"lamp"', '"box"')

    def test_an_emitter_that_shines_away(self):
        scene = self.room(OUTWARD, lamp=LAMP_ABOVE[::-1])
        self.assert_black(scene, *SMALL, says=('"lamp"', "leaves the scene", "turn or move"))

    def test_dim_light_is_light(self):
        """However bright it is outside, and however dim the lamp is inside."""
        expected = materials(self.bake(self.room(), *SMALL))["wall"]["mean_irradiance"]
        report = self.bake(self.room(radiance=1e-9), *FEW_RAYS, "--sky", "1,1,1", "--sun", "200,30,1e5")
        dim = materials(report)["wall"]["mean_irradiance"]
        for found, bright in zip(dim, expected):
            self.assert_close(found, 1e-9 * bright, .02, "dim room")  # other patches
        self.assertGreater(report["exposure_ev"], 25)  # 2^30 for 1e-9

    def test_a_small_window_is_open(self):
        """The sky through a hole of 4 cm in the ceiling: a few hundred rays."""
        a, b, c, d = (CORNERS[k] for k in INWARD[1])
        hole = [(1.0, 3, 1.0), (1.04, 3, 1.0), (1.04, 3, 1.04), (1.0, 3, 1.04)]
        ring = [(4, 5, 9, 8), (5, 6, 10, 9), (6, 7, 11, 10), (7, 4, 8, 11)]
        scene = self.room([face for k, face in enumerate(INWARD) if k != 1] + ring, lamp=hole)
        text = scene.read_text().replace("o light\nusemtl lamp\nf 9 10 11 12\n", "")
        scene.write_text(text)
        self.assertEqual((a[1], b[1], c[1], d[1]), (3, 3, 3, 3))
        light = materials(self.bake(scene, *FEW_RAYS, "--sky", "1,1,1"))["wall"]["mean_irradiance"]
        # All that enters, pi L A, spread over 52 m2 of reflectance .6 less the hole.
        expected = math.pi * .04 ** 2 / 52 / (1 - .6)
        self.assert_close(light[0], expected, .35, "by the hole")  # a standard error of a tenth or so, threefold

    def test_surfaces_that_reflect_nothing(self):
        done = self.run_well("bake", self.room(reflectance=0), *SMALL, "-o", self.folder / "black.glb")
        self.assertIn("the result is black: no surface on which light falls reflects any", done.stderr)
        self.assertIn("--reflectance", done.stderr)

    def test_a_picture_of_nothing(self):
        done = self.run_well("bake", self.room(), *SMALL, "--image", self.folder / "black.png", "--size", "16x16",
                             "--eye", "2,1.5,9", "--look-at", "2,1.5,20")
        self.assertIn("the picture is black", done.stderr)
        done = self.run_well("bake", self.room(), *SMALL, "--image", self.folder / "lit.png", "--size", "16x16",
                             "--eye", "1,1.5,1", "--look-at", "3,1,1")
        self.assertNotIn("the picture is black", done.stderr)

    def test_a_lit_room_is_not_warned_of(self):
        warnings = self.bake(self.room(), *SMALL)["warnings"]
        self.assertEqual([text for text in warnings if "the result is black" in text], [])
        self.assertEqual([text for text in self.findings(self.room()) if "no light" in text], [])


if __name__ == "__main__":
    unittest.main()
