#!/usr/bin/env python3
"""Checks of the scenes in this folder: python3 data/test_generate.py"""
import base64
import itertools
import json
import math
import struct
import tempfile
import unittest
from pathlib import Path

import generate
from scene_files import chromaticity, placed

FOLDER = Path(__file__).parent
SCENES = {scene.name: scene for scene, _ in generate.scenes()}
TOUCH = 1e-7  # metres; corners are rounded to 1e-8, and a separating axis mixes a few of them


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def vector_area(points):
    """Of length area, along the normal."""
    total = (0, 0, 0)
    for a, b in zip(points[1:], points[2:]):
        total = tuple(t + c / 2 for t, c in zip(total, cross(sub(a, points[0]), sub(b, points[0]))))
    return total


def length(a):
    return math.sqrt(dot(a, a))


def centre(points):
    return tuple(sum(axis) / len(points) for axis in zip(*points))


def volume(faces):
    """Positive if the faces look outwards."""
    return sum(dot(points[0], vector_area(points)) for _, points in faces) / 3


def unmatched_edges(faces):
    """Directed edges without exactly one partner in the opposite direction."""
    edges = [edge for _, points in faces for edge in zip(map(tuple, points), map(tuple, points[1:] + points[:1]))]
    return [edge for edge in edges if edges.count(edge) != 1 or edges.count(edge[::-1]) != 1]


def parts_of(scene):
    """(node's name, part) with the corners in the scene."""
    return [(node.name, [(material, [placed(node, p) for p in points]) for material, points in part])
            for node in scene.nodes for part in scene.meshes[node.mesh]]


def separation(a, b):
    """Of two convex parts: the widest gap along any separating-axis candidate; negative if they overlap."""
    axes = [vector_area(points) for part in (a, b) for _, points in part]
    edges = [{sub(q, p) for _, points in part for p, q in zip(points, points[1:])} for part in (a, b)]
    axes += [cross(e, f) for e, f in itertools.product(*edges)]
    corners = [{p for _, points in part for p in points} for part in (a, b)]
    widest = -math.inf
    for axis in axes:
        size = length(axis)
        if size < 1e-12:
            continue
        (a_low, a_high), (b_low, b_high) = ((min(values), max(values)) for values in
                                            ([dot(p, axis) / size for p in points] for points in corners))
        widest = max(widest, b_low - a_high, a_low - b_high)
        if widest > TOUCH:
            break
    return widest


def read_obj(path):
    vertices, faces, material = [], [], None
    for line in path.read_text().splitlines():
        key, *values = line.split() or [""]
        if key == "v":
            vertices.append(tuple(map(float, values)))
        elif key == "usemtl":
            material = values[0]
        elif key == "f":
            faces.append((material, [vertices[int(v.split("/")[0]) - 1] for v in values]))
    return faces


def turned(q, p):
    """Point p by the rotation quaternion q = x, y, z, w."""
    t = tuple(2 * c for c in cross(q[:3], p))
    return tuple(a + q[3] * b + c for a, b, c in zip(p, t, cross(q[:3], t)))


def read_gltf(path):
    gltf = json.loads(path.read_text())
    data = base64.b64decode(gltf["buffers"][0]["uri"].split(",")[1])

    def values(accessor, letter, width):
        entry = gltf["accessors"][accessor]
        offset = gltf["bufferViews"][entry["bufferView"]].get("byteOffset", 0) + entry["byteOffset"]
        return struct.unpack_from(f"<{entry['count'] * width}{letter}", data, offset)
    faces = []
    for node in (node for node in gltf["nodes"] if "mesh" in node):
        rotation, shift = node.get("rotation", (0, 0, 0, 1)), node.get("translation", (0, 0, 0))
        for primitive in gltf["meshes"][node["mesh"]]["primitives"]:
            flat = values(primitive["attributes"]["POSITION"], "f", 3)
            points = [tuple(a + b for a, b in zip(turned(rotation, flat[i:i + 3]), shift))
                      for i in range(0, len(flat), 3)]
            indices = values(primitive["indices"], "H", 1)
            faces += [(gltf["materials"][primitive["material"]]["name"], [points[k] for k in indices[i:i + 3]])
                      for i in range(0, len(indices), 3)]
    return faces


class Files(unittest.TestCase):
    def test_files_are_what_the_generator_writes(self):
        with tempfile.TemporaryDirectory() as folder:
            for scene, formats in generate.scenes():
                for name in formats:
                    generate.WRITERS[name](scene, Path(folder))
            for path in Path(folder).iterdir():
                self.assertEqual(path.read_bytes(), (FOLDER / path.name).read_bytes(), path.name)

    def test_gltf_and_obj_hold_the_same_surfaces(self):
        for scene, formats in generate.scenes():
            if not {"gltf", "obj"} <= set(formats):
                continue
            found = []
            for faces in (read_obj(FOLDER / f"{scene.name}.obj"), read_gltf(FOLDER / f"{scene.name}.gltf")):
                sums = {}
                for material, points in faces:  # the fans of both: the left wall of the Cornell box is not planar
                    for a, b in zip(points[1:], points[2:]):
                        area = vector_area([points[0], a, b])
                        moment = tuple(c * length(area) for c in centre([points[0], a, b]))
                        old = sums.get(material, (0,) * 7)
                        sums[material] = tuple(x + y for x, y in zip(old, (length(area), *area, *moment)))
                found.append(sums)
            self.assertEqual(found[0].keys(), scene.materials.keys())
            self.assertEqual(found[1].keys(), scene.materials.keys())
            for material in scene.materials:
                for a, b in zip(found[0][material], found[1][material]):
                    self.assertAlmostEqual(a, b, delta=1e-5, msg=f"{scene.name} {material}")  # glTF: single precision


class Lights(unittest.TestCase):
    def test_stand_where_the_scene_has_them_and_spots_look_along_their_direction(self):
        scene = SCENES["window_room"]
        gltf = json.loads((FOLDER / "window_room.gltf").read_text())
        definitions = gltf["extensions"]["KHR_lights_punctual"]["lights"]
        nodes = [node for node in gltf["nodes"] if "extensions" in node]
        self.assertEqual([light["name"] for light in definitions], ["bulb", "spot"])
        self.assertEqual(len(nodes), len(scene.lights))
        for light, node in zip(scene.lights, nodes):
            definition = definitions[node["extensions"]["KHR_lights_punctual"]["light"]]
            self.assertEqual((definition["name"], definition["type"], definition["intensity"]), light[:3])
            self.assertEqual(tuple(node["translation"]), light.position)
            if light.kind == "spot":
                looking = turned(node["rotation"], (0, 0, -1))
                for a, b in zip(looking, light.direction):
                    self.assertAlmostEqual(a, b / length(light.direction), delta=1e-7)


class MgfColours(unittest.TestCase):
    def test_grey_is_the_equal_energy_white(self):
        for value in chromaticity((.7, .7, .7)):
            self.assertAlmostEqual(value, 1 / 3, 12)

    def test_primaries_keep_their_hue_under_the_other_white(self):
        # The Bradford transform moves Rec. 709's primaries by less than 0.03, each towards more red light: E is warmer than D65.
        for rgb, (x, y) in zip(((1, 0, 0), (0, 1, 0), (0, 0, 1)), ((.64, .33), (.30, .60), (.15, .06))):
            found = chromaticity(rgb)
            self.assertLess(math.dist(found, (x, y)), .03)
            self.assertGreater(found[0], x)


class Orientation(unittest.TestCase):
    def test_faces_are_planar(self):
        for scene in SCENES.values():
            for material, points in (face for _, part in parts_of(scene) for face in part):
                if (scene.name, material) == ("cornell_box", "left"):
                    continue
                normal = vector_area(points)
                self.assertGreater(length(normal), 0)
                for p in points:
                    off = abs(dot(sub(p, points[0]), normal)) / length(normal)
                    self.assertLess(off, 2e-6 * max(length(sub(q, points[0])) for q in points), (scene.name, material))

    def test_analytic_rooms_are_closed_and_face_inwards(self):
        for name, expected in (("cube6", 1), ("room432", 30), ("furnace_box", 3), ("tetrahedron", 8 / 3)):
            faces = [face for _, part in parts_of(SCENES[name]) for face in part]
            self.assertEqual(unmatched_edges(faces), [], name)
            self.assertAlmostEqual(volume(faces), -expected, 12, name)

    def test_squares_face_each_other(self):
        for name in ("parallel_squares", "perpendicular_squares"):
            a, b = (points for _, part in parts_of(SCENES[name]) for _, points in part)
            for one, other in ((a, b), (b, a)):
                self.assertGreater(dot(vector_area(one), sub(centre(other), centre(one))), 0, name)

    def test_cornell_walls_face_inwards_and_blocks_outwards(self):
        inside = (.278, .274, .28)
        for name, part in parts_of(SCENES["cornell_box"]):
            block = name in ("short", "tall")
            middle = centre([p for _, points in part for p in points]) if block else inside
            for _, points in part:
                side = dot(vector_area(points), sub(centre(points), middle))
                self.assertGreater(side if block else -side, 0, name)

    def test_cornell_areas(self):
        areas = {}
        for _, part in parts_of(SCENES["cornell_box"]):
            for material, points in part:
                areas[material] = areas.get(material, 0) + length(vector_area(points))
        self.assertAlmostEqual(areas["light"], .130 * .105, 12)
        self.assertAlmostEqual(areas["ceiling"], .556 * .5592 - .130 * .105, 12)
        self.assertAlmostEqual(areas["right"], .5488 * .5592, 12)
        # Without a bottom, the vector areas of a block's faces add up to its footprint, upwards.
        for block in ("short", "tall"):
            faces = [points for name, part in parts_of(SCENES["cornell_box"]) if name == block for _, points in part]
            total = tuple(map(sum, zip(*map(vector_area, faces))))
            for found, expected in zip(total, vector_area(faces[0])):
                self.assertAlmostEqual(found, expected, 12, block)


class TableRoom(unittest.TestCase):
    scene = SCENES["table_room"]
    room = [part for name, part in parts_of(scene) if name == "room"][0]
    objects = [(name, part) for name, part in parts_of(scene) if name != "room"]

    def test_has_a_few_hundred_polygons(self):
        self.assertIn(sum(len(part) for _, part in parts_of(self.scene)), range(200, 601))

    def test_room_faces_inwards_without_a_gap(self):
        niche = 1.6 * 1.2 * .25
        self.assertAlmostEqual(volume(self.room), -(generate.WIDTH * generate.HEIGHT * generate.DEPTH + niche), 9)
        total = tuple(map(sum, zip(*(vector_area(points) for _, points in self.room))))
        self.assertLess(length(total), 1e-12)

    def test_objects_are_closed_and_face_outwards(self):
        for name, part in self.objects:
            self.assertEqual(unmatched_edges(part), [], name)
            self.assertGreater(volume(part), 0, name)

    def test_objects_stay_in_the_room(self):
        for name, part in self.objects:
            for point in (p for _, points in part for p in points):
                for x, size in zip(point, (generate.WIDTH, generate.HEIGHT, generate.DEPTH)):
                    self.assertTrue(0 <= x <= size, (name, point))

    def test_parts_touch_but_do_not_overlap_and_nothing_floats(self):
        resting = {name for name, part in self.objects for _, points in part for p in points
                   if p[1] in (0, generate.HEIGHT)}
        for (a, part_a), (b, part_b) in itertools.combinations(self.objects, 2):
            boxes = [[(min(axis), max(axis)) for axis in zip(*(p for _, points in part for p in points))]
                     for part in (part_a, part_b)]
            if any(low > other_high + TOUCH or other_low > high + TOUCH
                   for (low, high), (other_low, other_high) in zip(*boxes)):
                continue
            gap = separation(part_a, part_b)
            self.assertGreater(gap, -TOUCH, (a, b))
            if gap < TOUCH and a != b:
                resting |= {a, b}
        self.assertEqual(resting, {name for name, _ in self.objects})

    def test_lamps_shine_down_from_below_the_ceiling(self):
        lights = [(material, points) for _, part in self.objects for material, points in part
                  if any(self.scene.materials[material].ke)]
        self.assertEqual({material for material, _ in lights}, {"light_1", "light_2", "light_3", "light_4"})
        for material, points in lights:
            self.assertLess(vector_area(points)[1], 0, material)
            self.assertTrue(all(1.8 < p[1] < generate.HEIGHT - .2 for p in points), material)

    def test_camera_stands_free(self):
        eye = self.scene.camera.eye
        for name, part in self.objects:
            for axis, (low, high) in enumerate((min(v), max(v)) for v in zip(*(p for _, ps in part for p in ps))):
                if not low - .1 < eye[axis] < high + .1:
                    break
            else:
                self.fail(f"the camera stands in {name}")


if __name__ == "__main__":
    unittest.main()
