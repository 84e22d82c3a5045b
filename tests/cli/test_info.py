#!/usr/bin/env python3
"""lambert info tells before a bake what is in a scene and what is wrong with it."""
import unittest

from lambert_cli import DATA, OK, ProgramTest, materials, read_json, run

CUBE = ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (4, 5, 7, 6), (0, 2, 3, 1))  # fronts outside


def cube(lower, upper, first, inward=False):
    """Vertices and faces of an OBJ."""
    ends = (lower, upper)
    lines = [f"v {ends[k & 1]} {ends[k >> 1 & 1]} {ends[k >> 2]}" for k in range(8)]
    for face in CUBE:
        lines.append("f " + " ".join(str(first + k) for k in (reversed(face) if inward else face)))
    return "\n".join(lines) + "\n"


class InfoTest(ProgramTest):
    def info(self, scene, *options):
        """The JSON report, and what was printed."""
        report = self.folder / "info.json"
        done = self.run_well("info", scene, "--json", report, *options)
        return read_json(report), done.stdout

    def room(self, box_inward=False, materials_text="newmtl wall\nKd .5 .5 .5\nKe 1 1 1\nnewmtl box\nKd .5 .5 .5\n"):
        self.write("room.mtl", materials_text)
        return self.write("room.obj", "mtllib room.mtl\ng Room\nusemtl wall\n" + cube(0, 4, 1, inward=True) +
                          "g Box\nusemtl box\n" + cube(1, 2, 9, inward=box_inward))

    def problems(self, report):
        return [finding["problem"] for finding in report["worth_a_look"]]


class Surfaces(InfoTest):
    def test_nothing_is_wrong_with_a_box_in_a_room(self):
        report, printed = self.info(self.room())
        surfaces = report["surfaces"]
        self.assertEqual((surfaces["shells"], surfaces["closed_shells"], surfaces["open_edges"]), (2, 2, 0))
        self.assertEqual([shell["node"] for shell in surfaces["largest"]], ["Room", "Box"])
        self.assertAlmostEqual(surfaces["largest"][0]["volume"], -64, places=3)
        self.assertAlmostEqual(surfaces["largest"][1]["volume"], 1, places=5)
        self.assertEqual(report["back_faces"]["fraction"], 0)
        self.assertEqual(report["worth_a_look"], [])
        self.assertNotIn("worth a look", printed)

    def test_box_inside_out_is_told_with_its_name(self):
        report, printed = self.info(self.room(box_inward=True))
        self.assertEqual(report["surfaces"]["inside_out_shells"], 1)
        self.assertIn('1 closed object with the fronts inside: "Box"', self.problems(report))
        self.assertGreater(report["back_faces_from_lights"]["materials"]["box"], 0.02)
        self.assertTrue(any("--two-sided" in finding["remedy"] for finding in report["worth_a_look"]))
        self.assertIn("worth a look", printed)
        self.assertEqual(self.info(self.room(box_inward=True), "--two-sided")[0]["worth_a_look"], [])

    def test_backs_are_as_many_as_a_bake_meets(self):
        scene = self.room(box_inward=True)
        told = self.info(scene)[0]["back_faces"]["fraction"]
        met = self.bake(scene, "--patches", "600", "--resolution", "64")["form_factors"]["back_face_fraction"]
        self.assert_close(told, met, 0.1)  # 65,536 rays: the standard error is 2 % of this fraction, and hemicubes have their own

    def test_same_report_whatever_the_number_of_runs(self):
        scene = DATA / "table_room.obj"
        self.assertEqual(self.info(scene), self.info(scene))


class Findings(InfoTest):
    def test_unit_is_guessed_until_it_is_given(self):
        scene = self.write("room.obj", cube(0, 5000, 1, inward=True))
        report, printed = self.info(scene)
        self.assertEqual(report["unit_guesses"], [0.001])
        self.assertIn("--unit 0.001 if these are millimetres", printed)
        self.assertNotIn("unlikely", self.info(scene, "--unit", "0.001")[1])
        self.write("room.lambert.json", '{"unit": 0.001}')
        report, printed = self.info(scene)
        self.assertEqual((report["unit"], report["bounds"]["upper"]), (0.001, [5, 5, 5]))
        self.assertNotIn("unlikely", printed)

    def test_missing_light_is_told(self):
        report, _ = self.info(self.room(materials_text="newmtl wall\nKd .5 .5 .5\n"))
        self.assertIn("there is no light", self.problems(report))

    def test_mirrors_and_glass_are_treated_by_their_diffuse_part(self):
        report, printed = self.info(self.room(materials_text="newmtl wall\nKd .5 .5 .5\nKe 1 1 1\nKs .2 .2 .2\n"
                                                             "newmtl box\nKd .1 .1 .1\nKs .9 .9 .9\nillum 5\n"))
        self.assertTrue(materials(report)["box"]["diffuse_part_only"])
        self.assertFalse(materials(report)["wall"]["diffuse_part_only"])
        self.assertIn("treated by its diffuse part", printed)

    def test_occluder_is_told(self):
        report, printed = self.info(self.room(), "--occlude-only", "Box")
        black = [material for material in report["materials"] if material["occluder"]]
        self.assertEqual([material["name"] for material in black], ["box"])
        self.assertIn("only blocks light", printed)

    def test_many_warnings_of_a_kind_are_one_line(self):
        names = [f"m{k}" for k in range(40)]
        self.write("room.mtl", "".join(f"newmtl {name}\nKd 2 2 2\nKe 1 1 1\n" for name in names))
        scene = self.write("room.obj", "mtllib room.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\n" +
                           "".join(f"usemtl {name}\nf 1 2 3\n" for name in names))
        done = run("info", scene)
        self.assertEqual(done.returncode, OK)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn('"m0"', done.stderr)
        self.assertIn("39 more", done.stderr)

    def test_nodes_are_listed_by_area(self):
        report, printed = self.info(self.room())
        self.assertEqual([(node["name"], node["polygons"]) for node in report["nodes"]], [("Room", 6), ("Box", 6)])
        self.assertIn("Room", printed)

    def test_strictness_reaches_the_reader_and_the_report(self):
        report = self.bake(self.room(), "--patches", "100", "--resolution", "16", "--strict", "--allow-outside-files")
        self.assertTrue(report["options"]["strict"])
        self.assertTrue(report["options"]["allow_outside_files"])


if __name__ == "__main__":
    unittest.main()
