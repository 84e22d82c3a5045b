#!/usr/bin/env python3
"""A scene far from the origin of its file has the light of the same scene at the origin, and all that is read and written has its
place in the file."""
import base64
import json
import math
import struct
import unittest

from lambert_cli import Gltf, Ply, ProgramTest, materials, read_json, read_table

SMALL = ("--patches", "300", "--resolution", "64")
AT_ORIGIN = (0.0, 0.0, 0.0)
# Coordinates that are round in no system, so that nothing is exact by luck.
FAR_AWAY = [tuple(distance * axis for axis in (.6180339, .0123457, -.7861513)) for distance in (1e3, 1e5, 5e6)]
# What is read is the same to 1e-7 of the room; a hemicube's pixel on an edge may still fall to the other side.
SAME_LIGHT = 1e-3

# A closed room with a lamp below its ceiling, which is not in the middle of anything.
CORNERS = [(x, y, z) for y in (0, 3) for x, z in ((0, 0), (4, 0), (4, 2), (0, 2))]
LAMP = [(2, 2.9, .5), (3, 2.9, .5), (3, 2.9, 1.5), (2, 2.9, 1.5)]
WALLS = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (2, 3, 7, 6), (0, 4, 7, 3), (1, 2, 6, 5)]


def moved(points, offset=AT_ORIGIN, scale=1.0):
    return [tuple(scale * (x + d) for x, d in zip(point, offset)) for point in points]


def write_obj(path, offset=AT_ORIGIN, scale=1.0, extra=""):
    path.with_suffix(".mtl").write_text("newmtl wall\nKd .6 .6 .6\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n")
    lines = [f"mtllib {path.stem}.mtl", *("v " + " ".join(map(repr, p)) for p in moved(CORNERS + LAMP, offset, scale)),
             "o room", "usemtl wall", *("f " + " ".join(str(k + 1) for k in face) for face in WALLS),
             "o lamp", "usemtl lamp", "f 9 10 11 12", extra]
    path.write_text("\n".join(lines) + "\n")
    return path


def write_gltf(path, offset=AT_ORIGIN, scale=1.0, in_vertices=False, more_nodes=()):
    """Each object in a node that is moved; or, with `in_vertices`, in single precision where it lies."""
    buffer, document = b"", {"asset": {"version": "2.0"}, "accessors": [], "bufferViews": [], "meshes": [], "scene": 0}

    def accessor(data, count, kind, component):
        nonlocal buffer
        document["bufferViews"].append({"buffer": 0, "byteOffset": len(buffer), "byteLength": len(data)})
        document["accessors"].append({"bufferView": len(document["bufferViews"]) - 1, "componentType": component,
                                      "count": count, "type": kind})
        buffer += data
        return len(document["accessors"]) - 1

    document["nodes"] = []
    for name, points, faces in (("room", CORNERS, WALLS), ("lamp", LAMP, [(0, 1, 2, 3)])):
        places = moved(points, offset, scale) if in_vertices else moved(points, scale=scale)
        triangles = [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]
        positions = accessor(b"".join(struct.pack("<3f", *p) for p in places), len(places), "VEC3", 5126)
        document["accessors"][positions].update(
            min=[min(struct.unpack("<f", struct.pack("<f", x))[0] for x in axis) for axis in zip(*places)],
            max=[max(struct.unpack("<f", struct.pack("<f", x))[0] for x in axis) for axis in zip(*places)])
        indices = accessor(b"".join(struct.pack("<3I", *t) for t in triangles), 3 * len(triangles), "SCALAR", 5125)
        document["meshes"].append({"primitives": [{"attributes": {"POSITION": positions}, "indices": indices,
                                                   "material": len(document["meshes"])}]})
        node = {"name": name, "mesh": len(document["meshes"]) - 1}
        if not in_vertices and offset != AT_ORIGIN:
            node["translation"] = [scale * d for d in offset]
        document["nodes"].append(node)
    document["materials"] = [
        {"name": "wall", "pbrMetallicRoughness": {"baseColorFactor": [.6, .6, .6, 1], "metallicFactor": 0}},
        {"name": "lamp", "emissiveFactor": [1, 1, 1],
         "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0}}]
    document["nodes"] += more_nodes
    document["scenes"] = [{"nodes": list(range(len(document["nodes"])))}]
    document["buffers"] = [{"byteLength": len(buffer),
                            "uri": "data:application/octet-stream;base64," + base64.b64encode(buffer).decode()}]
    if any("camera" in node for node in more_nodes):
        document["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1.0, "znear": .1}}]
    if any("extensions" in node for node in more_nodes):
        document["extensionsUsed"] = ["KHR_lights_punctual"]
        document["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point", "name": "bulb", "intensity": 1}]}}
    path.write_text(json.dumps(document))
    return path


def write_ply(path, offset=AT_ORIGIN, scale=1.0, number="double"):
    """All of one material, which --emit lets shine."""
    places = moved(CORNERS + LAMP, offset, scale)
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(places)}",
              *(f"property {number} {axis}" for axis in "xyz"), f"element face {len(WALLS) + 1}",
              "property list uchar int vertex_indices", "end_header"]
    body = b"".join(struct.pack("<3" + {"double": "d", "float": "f"}[number], *p) for p in places)
    body += b"".join(struct.pack("<B4i", 4, *face) for face in [*WALLS, (8, 9, 10, 11)])
    path.write_bytes("\n".join(header).encode() + b"\n" + body)
    return path


WRITERS = {".obj": write_obj, ".gltf": write_gltf, ".ply": write_ply}
PLY_LIGHT = ("--emit", "default=.3,.2,.1")


class FarAway(ProgramTest):
    def irradiance(self, scene, *options):
        if scene.suffix == ".ply":
            options += PLY_LIGHT
        report = self.bake(scene, *SMALL, *options)
        self.assertEqual([text for text in report["warnings"] if "rounded" in text], [], scene)
        return {name: material["mean_irradiance"] for name, material in materials(report).items()}

    def assert_same_light(self, found, expected, what):
        self.assertEqual(found.keys(), expected.keys(), what)
        for name, light in expected.items():
            for a, b in zip(found[name], light):
                self.assert_close(a, b, SAME_LIGHT, f"{what}, {name}")

    def test_the_light_is_that_of_the_origin(self):
        for extension, write in WRITERS.items():
            expected = self.irradiance(write(self.folder / f"origin{extension}"))
            for offset in FAR_AWAY:
                far = write(self.folder / f"far{extension}", offset)
                self.assert_same_light(self.irradiance(far), expected, f"{extension} at {offset}")

    def test_of_any_size(self):
        for extension, write in WRITERS.items():
            for scale in (1e-3, 1e3):
                expected = self.irradiance(write(self.folder / f"origin{extension}", scale=scale))
                far = write(self.folder / f"far{extension}", FAR_AWAY[-1], scale)
                self.assert_same_light(self.irradiance(far), expected, f"{extension}, {scale} times as large")

    def test_in_units_of_the_file(self):
        expected = self.irradiance(write_obj(self.folder / "origin.obj", scale=1e3), "--unit", ".001")
        far = self.irradiance(write_obj(self.folder / "far.obj", FAR_AWAY[-1], 1e3), "--unit", ".001")
        self.assert_same_light(far, expected, "millimetres")

    def test_of_what_is_left_when_a_node_is_excluded(self):
        stray = "v 0 0 0\nv 1 0 0\nv 0 1 0\no stray\nusemtl wall\nf 13 14 15"
        expected = self.irradiance(write_obj(self.folder / "origin.obj"))
        far = write_obj(self.folder / "far.obj", FAR_AWAY[-1], extra=stray)
        self.assert_same_light(self.irradiance(far, "--exclude", "stray"), expected, "with a stray triangle")

    def test_lights_and_cameras_come_along(self):
        def scene(name, offset):
            place = [a + d for a, d in zip((1, 2, 1), offset)]
            return write_gltf(self.folder / name, offset, more_nodes=[
                {"name": "eye", "camera": 0, "translation": place},
                {"name": "bulb", "translation": place, "extensions": {"KHR_lights_punctual": {"light": 0}}}])
        near, far = scene("near.gltf", AT_ORIGIN), scene("far.gltf", FAR_AWAY[-1])
        self.assert_same_light(self.irradiance(far), self.irradiance(near), "lit by a bulb")
        report = self.folder / "info.json"
        self.run_well("info", far, "--json", report, "--quiet")
        info = read_json(report)
        for found in (info["lights"][0]["position"], info["cameras"][0]["eye"]):
            for a, b, d in zip(found, (1, 2, 1), FAR_AWAY[-1]):
                self.assertAlmostEqual(a, b + d, delta=1e-6)  # single precision near the room

    def bounds(self, scene):
        report = self.folder / "info.json"
        self.run_well("info", scene, "--json", report, "--quiet")
        return read_json(report)["bounds"]

    def test_what_is_written_lies_where_the_scene_lies(self):
        offset = FAR_AWAY[-1]
        far = write_obj(self.folder / "far.obj", offset)
        outputs = [self.folder / f"baked{extension}" for extension in (".obj", ".ply", ".glb")]
        solution = self.folder / "solution.glb"
        self.run_well("bake", far, *SMALL, "--quiet", "--solution", solution, *(x for o in outputs for x in ("-o", o)))
        low, high = moved([(0, 0, 0), (4, 3, 2)], offset)
        for file in [far, *outputs, solution]:
            bounds = self.bounds(file)
            for found, expected in ((bounds["lower"], low), (bounds["upper"], high)):
                for a, b in zip(found, expected):
                    self.assertAlmostEqual(a, b, delta=1e-6, msg=file.name)  # 4 m in single precision
        self.assertEqual([line for line in Ply(outputs[1]).header if line.startswith("property double")],
                         [f"property double {axis}" for axis in "xyz"])
        for glb in (Gltf(outputs[2]), Gltf(solution)):
            self.assertLess(max(abs(x) for p in glb.attribute("POSITION") for x in p), 16)
            self.assertEqual(len(glb.json["nodes"][0]["translation"]), 3)

    def test_a_near_scene_is_written_as_ever(self):
        near, glb, ply = write_obj(self.folder / "near.obj"), self.folder / "near.glb", self.folder / "near.ply"
        self.run_well("bake", near, *SMALL, "--quiet", "-o", glb, "-o", ply)
        self.assertNotIn("translation", Gltf(glb).json["nodes"][0])
        self.assertIn("property float x", Ply(ply).header)

    def test_pictures_and_points_are_where_they_are_typed(self):
        near, far = write_obj(self.folder / "near.obj"), write_obj(self.folder / "far.obj", FAR_AWAY[-1])
        points, pictures = [(1, 0, 1), (2.5, 1.25, .75)], []
        readings = []
        for scene, offset in ((near, AT_ORIGIN), (far, FAR_AWAY[-1])):
            csv, picture = self.folder / "points.csv", self.folder / f"{scene.stem}.exr"
            csv.write_text("".join(",".join(map(repr, p)) + ",0,1,0\n" for p in moved(points, offset)))
            out = self.folder / f"{scene.stem}.csv"
            self.run_well("probe", scene, csv, "-o", out, *SMALL, "--quiet")
            readings.append(read_table(out))
            for row, place in zip(readings[-1], moved(points, offset)):
                self.assertEqual(tuple(row[:3]), place)
            eye, look_at = (",".join(map(repr, p)) for p in moved([(.5, 2, .5), (3, .5, 1.5)], offset))
            report = self.bake(scene, *SMALL, "--image", picture, "--size", "16x16", "--eye", eye, "--look-at", look_at)
            for a, b in zip(report["camera"]["eye"], moved([(.5, 2, .5)], offset)[0]):
                self.assertAlmostEqual(a, b, delta=1e-6)
            pictures.append(report["camera"])
        for a, b in zip(*readings):
            for x, y in zip(a[6:9], b[6:9]):
                self.assert_close(y, x, 5e-3, "a point")  # a pixel of its hemicube, or of its patch's
        for a, b in zip(pictures[0]["direction"], pictures[1]["direction"]):
            self.assertAlmostEqual(a, b, delta=1e-6)

    def test_solutions_are_compared_and_taken_up(self):
        far = write_obj(self.folder / "far.obj", FAR_AWAY[-1])
        first, second, report = self.folder / "a.glb", self.folder / "b.glb", self.folder / "compared.json"
        self.run_well("bake", far, *SMALL, "--quiet", "--solution", first)
        self.run_well("bake", far, *SMALL, "--quiet", "--solution", second, "--warm-start", first)
        self.run_well("compare", "bakes", first, second, "--json", report)
        self.assertEqual(read_json(report)["unmatched_area"], 0)
        self.run_well("bake", far, "--patches", "500", "--resolution", "64", "--quiet", "--solution", second)
        self.run_well("compare", "bakes", first, second, "--json", report)
        self.assertLess(read_json(report)["unmatched_area"], .01)

    def test_coordinates_that_the_file_has_rounded_are_warned_of(self):
        single = write_ply(self.folder / "single.ply", FAR_AWAY[-1], number="float")
        inside = write_gltf(self.folder / "inside.gltf", FAR_AWAY[-1], in_vertices=True)
        for scene, options in ((single, PLY_LIGHT), (inside, ())):
            for command in (("info", scene), ("bake", scene, *SMALL, "-o", self.folder / "baked.glb", *options)):
                self.assertIn("coordinates are rounded to 0.25 m", self.run_well(*command).stderr)
        exact = self.run_well("info", write_ply(self.folder / "double.ply", FAR_AWAY[-1]))
        self.assertNotIn("rounded", exact.stderr)


if __name__ == "__main__":
    unittest.main()
