#!/usr/bin/env python3
"""`lambert compare formfactors`: the page, its figures, and what happens when something is wrong."""
import csv
import os
import re
import signal
import subprocess
import time
import unittest
import xml.etree.ElementTree

from html_page import Page
from lambert_cli import DATA, INPUT, INTERRUPTED, PROGRAM, SYSTEM, USAGE, ProgramTest, png_size, read_json, run

METHODS = ("auto", "hemicube", "hemisphere", "local-lines", "global-lines", "closed-form")
EFFORTS = ("--efforts", "auto=0.2,0.05", "--efforts", "hemicube=16,32", "--efforts", "hemisphere=16,32", "--efforts", "local-lines=64,256",
           "--efforts", "global-lines=4096,16384", "--efforts", "closed-form=0.1,0.01")
QUICK = ("--patches", "60", "--seeds", "2", "--size", "64x64", *EFFORTS)
COSTS = {"cpu_seconds", "wall_seconds"}


class CompareTest(ProgramTest):
    def compare(self, scene, *more, name="out"):
        """Runs the comparison and returns its folder."""
        folder = self.folder / name
        self.run_well("compare", "formfactors", scene, "-o", folder, "--quiet", *QUICK, *more)
        return folder

    def rows(self, folder):
        with open(folder / "results.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))


class ThePage(CompareTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.keep = ProgramTest()
        cls.keep.setUp()
        cls.addClassCleanup(cls.keep.doCleanups)
        # A name that would be markup if it were not escaped.
        folder = cls.keep.folder / "<b>&\"scene'"
        folder.mkdir()
        cls.scene = folder / "<i>&\"box'.obj"
        cls.scene.write_bytes((DATA / "cornell_box.obj").read_bytes())
        (folder / "cornell_box.mtl").write_bytes((DATA / "cornell_box.mtl").read_bytes())
        cls.out = cls.keep.folder / "out"
        cls.done = run("compare", "formfactors", cls.scene, "-o", cls.out, *QUICK, "--reference", "local-lines:4096",
                       "--json", cls.keep.folder / "report.json")

    def setUp(self):
        super().setUp()
        self.assertEqual(self.done.returncode, 0, self.done.stderr)
        self.html = (self.out / "index.html").read_text(encoding="utf-8")

    def test_is_whole_html_and_names_all(self):
        page = Page(self.html)
        for method in METHODS:
            self.assertIn(method, page.text)
        self.assertIn(self.scene.name, page.text)
        self.assertNotIn("<i>", self.html)
        self.assertGreaterEqual(page.tags.count("svg"), 7)
        self.assertEqual(page.tags.count("img"), 1 + 2 * len(METHODS))
        self.assertEqual(page.tags.count("script"), 0)

    def test_needs_nothing_from_outside(self):
        page = Page(self.html)
        for url in page.urls:
            self.assertTrue(url.startswith(("data:image/png;base64,", "#")), url[:80])
        namespaces = r'xmlns(:xlink)?="http://www.w3.org/[^"]*"'
        self.assertNotRegex(re.sub(namespaces, "", self.html), r"https?://|url\((?!#)|@import")

    def test_ids_are_unique_and_references_are_met(self):
        page = Page(self.html)
        self.assertEqual(len(page.ids), len(set(page.ids)))
        for target in re.findall(r"""(?:href=["']#|url\(#)([^"')]*)""", self.html):
            self.assertIn(target, page.ids)

    def test_plots_are_xml_and_pictures_png(self):
        svgs = sorted(self.out.glob("*.svg"))
        self.assertGreaterEqual(len(svgs), 7)
        for svg in svgs:
            root = xml.etree.ElementTree.fromstring(svg.read_text(encoding="utf-8"))
            self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
        self.assertEqual(png_size(self.out / "scene.png"), (64, 64))
        for method in METHODS:
            self.assertEqual(png_size(self.out / f"misdirected_{method}.png")[0], 64)

    def test_json_csv_and_table_say_the_same(self):
        report = read_json(self.out / "results.json")
        self.assertEqual(report, read_json(self.keep.folder / "report.json"))
        self.assertEqual([method["name"] for method in report["methods"]], list(METHODS))
        self.assertGreater(report["reference"]["own_error"], 0)
        rows = self.rows(self.out)
        self.assertEqual(len(rows), 5 * 2 * 2 + 2)  # two seeds but of closed forms
        for method in report["methods"]:
            for effort in method["efforts"]:
                same = [float(row["relative_rms"]) for row in rows
                        if row["method"] == method["name"] and float(row["effort"]) == effort["effort"]]
                self.assert_close(effort["relative_rms"]["mean"], sum(same) / len(same), 1e-6)
            coarse, fine = (effort["relative_rms"]["mean"] for effort in method["efforts"])
            # What closed forms show is the error of the reference, to which their own adds next to nothing.
            self.assertLess(fine, coarse * (1.01 if method["name"] == "closed-form" else 1), method["name"])
            self.assertIn(method["name"], self.done.stdout)


class TheRuns(CompareTest):
    def test_results_depend_on_the_seed_and_not_on_the_threads(self):
        def figures(folder):
            return [{key: value for key, value in row.items() if key not in COSTS} for row in self.rows(folder)]
        one = figures(self.compare(DATA / "cube6.obj", "--threads", "1", name="one"))
        self.assertEqual(one, figures(self.compare(DATA / "cube6.obj", "--threads", "4", name="four")))
        self.assertNotEqual(one, figures(self.compare(DATA / "cube6.obj", "--seed", "5", name="other")))

    def test_a_convex_scene_is_compared_with_closed_forms(self):
        report = read_json(self.compare(DATA / "cube6.obj") / "results.json")
        self.assertEqual(report["reference"]["own_error"], 0)
        self.assertIn("exact", report["reference"]["name"])

    def test_a_scene_without_light_is_compared(self):
        scene = self.write("dark.obj", "".join(
            f"v {x} {y} {z}\n" for x in (0, 1) for y in (0, 1) for z in (0, 1)) + "f 1 3 4 2\nf 5 6 8 7\n")
        folder = self.compare(scene)
        self.assertFalse(read_json(folder / "results.json")["lit"])
        self.assertIn("no light", (folder / "index.html").read_text(encoding="utf-8"))

    def test_one_method_one_effort_one_seed(self):
        folder = self.folder / "least"
        self.run_well("compare", "formfactors", DATA / "cube6.obj", "-o", folder, "--patches", "60", "--size", "64x64",
                      "--methods", "hemicube", "--efforts", "hemicube=16", "--seeds", "1")
        Page((folder / "index.html").read_text(encoding="utf-8"))

    def test_a_second_run_replaces_the_first(self):
        first = self.compare(DATA / "cube6.obj")
        (first / "index.html").write_text("old")
        self.assertIn("cube6", (self.compare(DATA / "cube6.obj") / "index.html").read_text(encoding="utf-8"))


class WhatIsWrong(CompareTest):
    def refuse(self, code, pattern, *arguments, **more):
        done = run("compare", "formfactors", *arguments, **more)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertRegex(done.stderr, pattern)
        self.assertEqual(done.stdout, "")
        self.assertFalse((self.folder / "out").exists())

    def test_usage(self):
        out = ("-o", self.folder / "out")
        box = DATA / "cornell_box.obj"
        self.refuse(USAGE, "output.*required", box)
        self.refuse(USAGE, "no method \"cube\": there are auto, hemicube", box, *out, "--methods", "hemicube,cube")
        self.refuse(USAGE, "named twice", box, *out, "--methods", "hemicube,hemicube")
        self.refuse(USAGE, "METHOD=EFFORT", box, *out, "--efforts", "16")
        self.refuse(USAGE, "found \"17\", allowed is 4 to 4096 in steps of 2", box, *out, "--efforts", "hemicube=17")
        self.refuse(USAGE, "not among", box, *out, "--methods", "hemicube", "--efforts", "local-lines=16")
        self.refuse(USAGE, "not convex", box, *out, "--patches", "60", "--reference", "exact")
        self.refuse(USAGE, "METHOD:EFFORT", box, *out, "--reference", "best")
        self.refuse(USAGE, "seeds", box, *out, "--seeds", "0")
        self.assertEqual(run("compare").returncode, USAGE)

    def test_a_reference_of_another_mesh(self):
        matrix = self.write("two.csv", "0,1\n1,0\n")
        self.refuse(INPUT, "found a matrix of 2 patches, the scene has", DATA / "cube6.obj", "-o", self.folder / "out", "--patches", "60",
                    "--reference", matrix)

    def test_without_gnuplot_nothing_is_begun(self):
        path = os.environ | {"PATH": "/nonexistent"}
        begun = time.monotonic()
        self.refuse(SYSTEM, "gnuplot-nox", DATA / "cornell_box.obj", "-o", self.folder / "out", env=path)
        self.assertLess(time.monotonic() - begun, 30)  # the comparison itself takes minutes

    def test_a_folder_that_cannot_be(self):
        file = self.write("file", "old")
        done = run("compare", "formfactors", DATA / "cube6.obj", "-o", file / "sub")
        self.assertEqual(done.returncode, SYSTEM, done.stderr)
        done = run("compare", "formfactors", DATA / "cube6.obj", "-o", file)
        self.assertEqual(done.returncode, SYSTEM, done.stderr)
        self.assertEqual(file.read_text(), "old")

    def test_an_interrupt_leaves_nothing(self):
        arguments = [PROGRAM, "compare", "formfactors", str(DATA / "cornell_box.obj"), "-o", str(self.folder / "out")]
        with subprocess.Popen(arguments, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True) as process:
            line = process.stderr.readline()  # the scene is read and meshed: the work has begun
            self.assertIn("patches", line)
            process.send_signal(signal.SIGINT)
            output, errors = process.communicate(timeout=300)
        self.assertEqual(process.returncode, INTERRUPTED, errors)
        self.assertEqual(output, "")
        self.assertEqual(list(self.folder.iterdir()), [])


if __name__ == "__main__":
    unittest.main()
