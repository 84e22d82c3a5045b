#!/usr/bin/env python3
"""`lambert probe`: values against exact and independent ones, and the reading and writing of points."""
import math
import unittest

from lambert_cli import DATA, SMALL, ProgramTest, read_json, read_table, relative_rms

FURNACE = DATA / "furnace_box.obj"  # 2 x 1.5 x 1 m; B_e = 1, ρ = 0.5: E = B = 2 everywhere


class ProbeTest(ProgramTest):
    def probe(self, scene, points, *options):
        """The rows that `points` (text) give, after a check of the header."""
        table = self.folder / "out.csv"
        self.run_well("probe", scene, self.write("points.csv", points), "-o", table, "--quiet", *options)
        self.assertEqual(table.read_text().splitlines()[0], "# x,y,z,nx,ny,nz,E_r,E_g,E_b,stderr_r,stderr_g,stderr_b")
        return read_table(table)


class TheFurnace(ProbeTest):
    def assert_two(self, points):
        rows = self.probe(FURNACE, "\n".join(points), *SMALL)
        self.assertEqual(len(rows), len(points))
        for row in rows:
            for value in row[6:9]:
                self.assert_close(value, 2, 1e-4, row[:6])  # rows sum to 1: only the solver's tolerance is left

    def test_walls_receive_the_exact_irradiance(self):
        self.assert_two(["0.7,0,0.3,0,1,0", "2,0.4,0.6,-1,0,0", "0,0.1,0.9,1,0,0", "1.3,1.5,0.2,0,-1,0",
                         "1,1,0,0,0,1", "0.001,0.001,1,0,0,-1", "0,0,0,0,1,0"])

    def test_points_in_space_receive_the_exact_irradiance(self):
        self.assert_two(["1,0.7,0.5,0,1,0", "1,0.7,0.5,0,-1,0", "0.3,0.2,0.8,0.3,-0.5,0.7", "1.9,1.4,0.1,10,0,0"])

    def test_length_of_the_normal_does_not_matter(self):
        rows = self.probe(FURNACE, "1,0.7,0.5,0,1e-3,0\n1,0.7,0.5,0,1e3,0\n", *SMALL)
        self.assertEqual(rows[0][6:9], rows[1][6:9])


def turned(point):
    """By 0.9 about the z axis, then by 0.6 about the x axis."""
    x, y, z = point
    x, y = math.cos(.9) * x - math.sin(.9) * y, math.sin(.9) * x + math.cos(.9) * y
    return [x, math.cos(.6) * y - math.sin(.6) * z, math.sin(.6) * y + math.cos(.6) * z]


def same(point):
    return list(point)


class TheSmallLamp(ProbeTest):
    """A sphere of radiance 10 at 1 m above a floor of 2 x 2 m: E = L π r² cosθ / d²."""
    PLACES = [(0, 0, 0), (.5, 0, 0), (1, 0, 0), (0, 0, .9), (0, .5, 0)]  # the last one in the air

    def scene(self, radius, place):
        def vertex(name, *point):
            return "v {} =\n\tp {} {} {}\n".format(name, *place(point))
        text = ("m floor =\n\tc\n\trd 0.5\n\tsides 1\nm lamp =\n\tc\n\ted 31.4159265\n\tsides 1\n" +
                vertex("a", -1, 0, 1) + vertex("b", 1, 0, 1) + vertex("c1", 1, 0, -1) + vertex("d", -1, 0, -1) +
                "m floor\nf a b c1 d\n" + vertex("s", 0, 1, 0) + f"m lamp\nsph s {radius}\n")
        return self.write("lamp.mgf", text)

    def assert_found(self, radius, *options, place=same, unit=1.0):
        points = "".join(",".join(repr(v) for v in [unit * x for x in place(p)] + place((0, 1, 0))) + "\n"
                         for p in self.PLACES)
        rows = self.probe(self.scene(radius, place), points, "--patches", 200, *options)
        for row, (x, y, z) in zip(rows, self.PLACES):
            height = 1 - y
            distance = math.sqrt(x * x + height * height + z * z)
            expected = 10 * math.pi * radius ** 2 * height / distance ** 3
            for k in (6, 7, 8):
                # The polyhedron that stands for the sphere is a little smaller.
                self.assert_close(row[k], expected, 0.03, (radius, options, row[:6]))
                self.assertLess(row[k + 3], 0.02 * expected)

    def test_lamps_from_a_millimetre_on_are_found_on_the_floor_and_in_the_air(self):
        for radius in (0.0005, 0.001, 0.005, 0.015):
            self.assert_found(radius)

    def test_other_methods_find_them(self):
        for options in (["--method", "hemisphere"], ["--method", "local-lines"],
                        ["--storage", "none", "--solver", "southwell"]):
            self.assert_found(0.0005, *options)

    def test_turned_and_in_millimetres(self):
        self.assert_found(0.001, place=turned)
        self.assert_found(0.001, "--unit", "0.001", place=turned, unit=0.001)


class WhatCannotBeKnown(ProbeTest):
    # A room of 2 m with fronts inward and a lamp as its ceiling; in it a solid of 0.4 m, fronts outward.
    def test_points_inside_a_solid_and_on_a_hidden_face_are_nan(self):
        def box(low, high, inward, first):
            corners = [[(low, high)[i], (low, high)[j], (low, high)[k]] for i in (0, 1) for j in (0, 1) for k in (0, 1)]
            faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
            vertices = "".join("v {} {} {}\n".format(*c) for c in corners)
            order = (lambda f: f[::-1]) if inward else (lambda f: f)
            return vertices, ["f " + " ".join(str(first + v) for v in order(face)) + "\n" for face in faces]
        vertices, faces = box(0, 2, True, 1)
        inner, solid = box(0.8, 1.2, False, 9)
        self.write("room.mtl", "newmtl wall\nKd .5 .5 .5\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n")
        scene = self.write("room.obj", "mtllib room.mtl\n" + vertices + inner + "usemtl lamp\n" + faces[3] +
                           "usemtl wall\n" + "".join(faces[:3] + faces[4:] + solid))
        rows = self.probe(scene, "1,1,1,0,1,0\n1,0.4,1,0,1,0\n", "--patches", 300,
                          "--json", self.folder / "report.json")
        self.assertTrue(all(math.isnan(value) for value in rows[0][6:]))
        self.assertGreater(rows[1][6], 0)
        self.assertGreater(rows[1][9], 0)
        probes = read_json(self.folder / "report.json")["probes"]
        self.assertEqual(probes[0]["irradiance"], [None, None, None])
        self.assert_close(probes[1]["irradiance"][0], rows[1][6], 1e-8)
        self.assertEqual([probe["on_surface"] for probe in probes], [False, False])


class TheTable(ProbeTest):
    def test_comments_header_blank_lines_further_columns_and_crlf(self):
        points = ("# sensors\r\nx,y,z,nx,ny,nz,name\r\n0.25,0,0.5,0,1,0,first,7\r\n\r\n# between\r\n"
                  " 1.5 , 0 ,0.5,0, 1,0 \r\n+1,0.5,5e-1,0,1,0,third")
        rows = self.probe(FURNACE, points, *SMALL)
        self.assertEqual([row[:6] for row in rows],
                         [[0.25, 0, 0.5, 0, 1, 0], [1.5, 0, 0.5, 0, 1, 0], [1, 0.5, 0.5, 0, 1, 0]])
        self.assertEqual({len(row) for row in rows}, {12})

    def test_rows_keep_their_order(self):
        xs = [((k * 37) % 100) / 100 + 0.005 for k in range(100)]
        rows = self.probe(FURNACE, "".join(f"{x},0,0.5,0,1,0\n" for x in xs), *SMALL)
        self.assertEqual([round(row[0], 6) for row in rows], [round(x, 6) for x in xs])

    def test_own_output_can_be_read_again(self):
        first = self.probe(FURNACE, "0.3,0,0.5,0,1,0\n0.3,0.2,0.5,0,1,0\n", *SMALL)
        again = self.probe(FURNACE, (self.folder / "out.csv").read_text(), *SMALL)
        self.assertEqual(first, again)

    def test_without_output_the_table_goes_to_stdout(self):
        points = "0.3,0,0.5,0,1,0\n"
        self.probe(FURNACE, points, *SMALL)
        done = self.run_well("probe", FURNACE, self.folder / "points.csv", "--quiet", *SMALL)
        self.assertEqual(done.stdout, (self.folder / "out.csv").read_text())

    def test_json_is_the_report_of_the_bake(self):
        self.probe(FURNACE, "0.3,0,0.5,0,1,0\n", *SMALL, "--json", self.folder / "report.json")
        self.assertGreater(read_json(self.folder / "report.json")["patches"], 6)


class TheCornellBox(ProbeTest):
    def test_irradiance_agrees_with_path_tracing(self):
        reference = read_table(DATA / "reference" / "cornell_pcg_irradiance.csv")
        metres = [[0.001 * value for value in row[:3]] + row[3:6] for row in reference]
        rows = self.probe(DATA / "cornell_box.obj", "".join(",".join(map(repr, point)) + "\n" for point in metres))
        errors = [relative_rms([row[k] for row in rows], [row[k] for row in reference]) for k in (6, 7, 8)]
        print("RMS error at 408 points over mean, r g b:", " ".join(f"{100 * error:.2f} %" for error in errors))
        # Measured: 0.30, 0.25, 0.27 %, of which the reference's noise is 0.14 %. Stated are 0.3 %, which at 408 points scatter by a
        # thirtieth of themselves; a third more leaves room for what other processors round otherwise.
        for error in errors:
            self.assertLess(error, 0.004)
        within = [abs(sum(row[6:9]) - sum(right[6:9])) <= 2 * math.hypot(sum(row[9:12]), sum(right[9:12]))
                  for row, right in zip(rows, reference)]
        self.assertGreaterEqual(sum(within), 0.95 * len(within))


if __name__ == "__main__":
    unittest.main()
