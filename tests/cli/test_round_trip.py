#!/usr/bin/env python3
"""A scene bakes to the same light whichever format it is read from."""
import sys
import unittest
from typing import Callable, NamedTuple

from lambert_cli import DATA, MISSED, OK, ProgramTest, materials, read_json, run

sys.path.insert(0, str(DATA))
import generate
from polygon_files import write_ply, write_stl
from scene_files import Material, write_gltf, write_obj


class Format(NamedTuple):
    extension: str
    write: Callable             # (scene, folder)
    has_materials: bool = False  # else all is of the one material `default`
    has_quads: bool = False      # else triangles only


FORMATS = {
    "glTF": Format("gltf", write_gltf, has_materials=True),
    "OBJ": Format("obj", write_obj, has_materials=True, has_quads=True),
    "PLY, text": Format("ply", write_ply, has_quads=True),
    "PLY, little-endian": Format("ply", lambda scene, folder: write_ply(scene, folder, "<"), has_quads=True),
    "PLY, big-endian": Format("ply", lambda scene, folder: write_ply(scene, folder, ">"), has_quads=True),
    "STL, text": Format("stl", write_stl),
    "STL, binary": Format("stl", lambda scene, folder: write_stl(scene, folder, binary=True)),
}

EMITTED, REFLECTANCE = "0.3,0.2,0.1", "0.5,0.6,0.7"
SAME_RAYS = ("--rotation", "fixed", "--resolution", "64")
# Most bakes are the same to the last bit; glTF places objects in single precision, which may move a hemicube's pixel, and change
# how many points a patch takes to know the light of emitters to 0.3 %.
ROUNDING = 4e-3
# Formats without quads come as pairs of triangles, in another order: other random rotations, so other errors.
DEFAULTS = 0.005


def with_faces(scene, change):
    """The scene with `change(face)`, a list of faces, in place of each face."""
    return scene._replace(meshes={name: [[new for face in part for new in change(face)] for part in parts]
                                  for name, parts in scene.meshes.items()})


def triangulated(scene):
    return with_faces(scene, lambda face: [(face[0], [face[1][0], a, b]) for a, b in zip(face[1][1:], face[1][2:])])


def of_one_material(scene):
    return with_faces(scene, lambda face: [("default", face[1])])._replace(materials={"default": Material((.5, .5, .5))})


class RoundTrip(ProgramTest):
    def bake(self, scene, *arguments):
        """The report; one view for a whole wall may well miss the balance of energy."""
        report = self.folder / "report.json"
        done = run("bake", scene, "--json", report, "--quiet", *arguments)
        self.assertIn(done.returncode, (OK, MISSED), done.stderr)
        return read_json(report)

    def check(self, scene, names, tolerance, *options):
        """Bakes the scene from each format and compares it with the first one."""
        first = None
        for name in names:
            folder = self.folder / name.replace(", ", "_")
            folder.mkdir(exist_ok=True)
            FORMATS[name].write(scene, folder)
            report = self.bake(folder / f"{scene.name}.{FORMATS[name].extension}", *options)
            first = first or report
            self.assertEqual(set(materials(report)), set(materials(first)), name)
            worst = 0
            for material, expected in materials(first).items():
                found = materials(report)[material]
                self.assert_close(found["area"], expected["area"], 1e-5, (name, material))
                brightest = max(expected["mean_irradiance"])
                for f, e in zip(found["mean_irradiance"], expected["mean_irradiance"]):
                    worst = max(worst, abs(f - e) / brightest if f != e else 0)  # a lamp may face nothing
            print(f"{scene.name:<12} {name:<20} {report['patches']:>6} patches   irradiance differs by {worst:.1e}")
            self.assertLess(worst, tolerance, (scene.name, name, options))

    def check_one_material(self, scene, names, tolerance, *options):
        self.check(of_one_material(scene), names, tolerance, "--emit", f"default={EMITTED}", "--reflectance",
                   f"default={REFLECTANCE}", *options)

    WITH_MATERIALS = [name for name, entry in FORMATS.items() if entry.has_materials]
    WITH_QUADS = [name for name, entry in FORMATS.items() if entry.has_quads]

    def test_triangles_of_all_formats_are_the_same_patches(self):
        for scene in (generate.cornell_box(), generate.table_room(), generate.furnace_box()):
            self.check_one_material(triangulated(scene), FORMATS, ROUNDING, "--patches", "0", *SAME_RAYS)

    def test_quads_of_all_formats_that_have_them_are_the_same_patches(self):
        self.check_one_material(generate.cornell_box(), self.WITH_QUADS, ROUNDING, "--patches", "0", *SAME_RAYS)

    def test_materials_are_the_same(self):
        self.check(triangulated(generate.cornell_box()), self.WITH_MATERIALS, ROUNDING, "--patches", "0", *SAME_RAYS)
        self.check(triangulated(generate.table_room()), self.WITH_MATERIALS, ROUNDING, "--patches", "0", *SAME_RAYS)

    def test_colours_of_a_ply_are_the_reflectances_of_materials(self):
        scene = triangulated(generate.cornell_box())
        mean = {}
        for extension, write in (("gltf", write_gltf), ("ply", write_ply)):
            write(scene, self.folder)
            report = self.bake(self.folder / f"{scene.name}.{extension}", "--emit", f"*={EMITTED}", "--patches", "0",
                               "-o", self.folder / "baked.glb", *SAME_RAYS)
            area = sum(material["area"] for material in report["materials"])
            mean[extension] = [sum(material["area"] * material["mean_irradiance"][channel]
                                   for material in report["materials"]) / area for channel in range(3)]
        for f, e in zip(mean["ply"], mean["gltf"]):
            self.assert_close(f, e, ROUNDING, "mean irradiance of all materials")

    def test_refined_meshes_are_the_same(self):
        options = ("--patch-length", "0.1", *SAME_RAYS)
        self.check(triangulated(generate.cornell_box()), self.WITH_MATERIALS, ROUNDING, *options)
        self.check_one_material(triangulated(generate.cornell_box()), FORMATS, ROUNDING, *options)

    def test_default_options_give_the_same_light(self):
        self.check(generate.cornell_box(), self.WITH_MATERIALS, DEFAULTS)
        # Small, because it is done once for each format.
        self.check_one_material(generate.cornell_box(), FORMATS, DEFAULTS, "--patches", "500", "--resolution", "64")


if __name__ == "__main__":
    unittest.main()
