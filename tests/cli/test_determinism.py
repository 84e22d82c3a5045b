#!/usr/bin/env python3
"""The same input, options and seed give the same bytes, whatever the number of threads."""
import unittest

from lambert_cli import DATA, ProgramTest

NAMES = ("box.glb", "box.gltf", "box.ply", "box.obj", "box.mtl", "box.png", "box.exr")


class Determinism(ProgramTest):
    def bake_files(self, *options, scene=DATA / "cornell_box.gltf"):
        """The bytes of all outputs, and the report without what may differ."""
        outputs = [word for name in NAMES[:4] for word in ("-o", self.folder / name)]
        common = ("--patches", "800", "--resolution", "32", "--size", "96x96", "--samples", "2")
        report = self.bake(scene, *common, *options, *outputs, "--image", self.folder / "box.png")
        self.bake(scene, *common, *options, "--image", self.folder / "box.exr")
        for key in ("seconds", "peak_memory_bytes"):
            del report[key]
        for step in report["history"]:
            del step["seconds"]
        del report["options"]["threads"]
        return {name: (self.folder / name).read_bytes() for name in NAMES}, report

    def assert_same(self, first, second):
        for name in NAMES:
            self.assertTrue(first[0][name] == second[0][name], f"{name} differs")
        self.assertEqual(first[1], second[1])

    def test_number_of_threads_changes_nothing(self):
        one = self.bake_files("--threads", "1")
        for threads in (2, 3):
            self.assert_same(one, self.bake_files("--threads", threads))

    def test_number_of_threads_changes_nothing_where_surfaces_have_two_sides(self):
        one = self.bake_files("--threads", "1", "--two-sided", scene=DATA / "table_room.obj")
        self.assert_same(one, self.bake_files("--threads", "3", "--two-sided", scene=DATA / "table_room.obj"))

    def test_second_run_is_the_same(self):
        self.assert_same(self.bake_files(), self.bake_files())

    def test_another_seed_is_another_result(self):
        one, two = self.bake_files("--seed", "1"), self.bake_files("--seed", "2")
        for name in ("box.glb", "box.ply", "box.exr"):
            self.assertNotEqual(one[0][name], two[0][name])
        self.assertEqual(one[1]["patches"], two[1]["patches"])

    def test_probe_is_the_same_on_any_number_of_threads(self):
        points = self.write("points.csv", "".join(f"0.{k},0,0.{k},0,1,0\n0.{k},0.3,0.2,0,0,1\n" for k in range(10, 50)))
        tables = []
        for threads in (1, 2, 3):
            table = self.folder / f"{threads}.csv"
            self.run_well("probe", DATA / "cornell_box.obj", points, "-o", table, "--patches", "500", "--resolution", "32",
                          "--threads", threads, "--quiet")
            tables.append(table.read_bytes())
        self.assertEqual(tables[0], tables[1])
        self.assertEqual(tables[0], tables[2])


if __name__ == "__main__":
    unittest.main()
