#!/usr/bin/env python3
"""`lambert compare vpl`: the page, its figures, and what happens when something is wrong."""
import csv
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import unittest

from html_page import Page
from lambert_cli import (DATA, INPUT, INTERRUPTED, PROGRAM, REPOSITORY, SYSTEM, USAGE, ProgramTest, png_size, read_json,
                         run)

QUICK = ("--patches", "60", "--seeds", "4", "--size", "48x48", "--vpls", "64", "--ladder", "16")
PARTS = ["sampling", "visibility", "clamping", "bounces", "unexplained"]
TIMES = {"seconds", "cpu_seconds", "sampling_slope"}


def without_times(value):
    if isinstance(value, dict):
        return {key: without_times(v) for key, v in value.items() if key not in TIMES}
    return [without_times(v) for v in value] if isinstance(value, list) else value


class CompareVplTest(ProgramTest):
    def compare(self, scene, *more, name="out"):
        """Runs the comparison and returns its folder."""
        folder = self.folder / name
        self.run_well("compare", "vpl", scene, "-o", folder, "--quiet", *QUICK, *more)
        return folder


class ThePage(CompareVplTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.keep = ProgramTest()
        cls.keep.setUp()
        cls.addClassCleanup(cls.keep.doCleanups)
        # A name that would be markup if it were not escaped.
        cls.scene = cls.keep.folder / "<em>&\"box'.obj"
        cls.scene.write_bytes((DATA / "cornell_box.obj").read_bytes())
        (cls.keep.folder / "cornell_box.mtl").write_bytes((DATA / "cornell_box.mtl").read_bytes())
        cls.out = cls.keep.folder / "out"
        cls.done = run("compare", "vpl", cls.scene, "-o", cls.out, *QUICK, "--json", cls.keep.folder / "report.json")

    def setUp(self):
        super().setUp()
        self.assertEqual(self.done.returncode, 0, self.done.stderr)
        self.html = (self.out / "index.html").read_text(encoding="utf-8")

    def test_is_whole_html_with_one_slider(self):
        page = Page(self.html)
        self.assertIn("instant-radiosity", page.text)
        self.assertIn(self.scene.name, page.text)
        self.assertNotIn("<em>", self.html)
        self.assertEqual(page.tags.count("input"), 1)
        self.assertEqual(page.tags.count("script"), 1)
        self.assertEqual(page.tags.count("img"), 1 + 2 + 2 + len(PARTS))  # scene, slider, false colours, parts

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

    def test_pictures_are_there(self):
        self.assertEqual(png_size(self.out / "reference.png"), (48, 48))
        self.assertEqual(png_size(self.out / "instant-radiosity.png"), (48, 48))
        for name in ("error_instant-radiosity", "flip_instant-radiosity"):
            self.assertGreater(png_size(self.out / f"{name}.png")[1], 48)  # with its scale
        for name in ("reference", "instant-radiosity", "difference_instant-radiosity"):
            self.assertEqual((self.out / f"{name}.exr").read_bytes()[:4], b"\x76\x2f\x31\x01")

    def test_json_csv_and_table_say_the_same(self):
        report = read_json(self.out / "results.json")
        self.assertEqual(report, read_json(self.keep.folder / "report.json"))
        self.assertGreater(report["reference"]["own_error"], 0)
        method, = report["methods"]
        self.assertEqual(method["name"], "instant-radiosity")
        for key in ("seconds", "bias", "rms", "relative_rms", "energy_ratio", "maximum", "percentile_99"):
            self.assertIsInstance(method[key], float, key)
        self.assertEqual([part["part"] for part in method["anatomy"]], PARTS)
        self.assertAlmostEqual(sum(part["share"] for part in method["anatomy"]), 1, places=9)
        with open(self.out / "results.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 2 * 4)
        same = [float(row["relative_rms"]) for row in rows if float(row["vpls"]) == 64]
        self.assert_close(method["relative_rms"], sum(same) / len(same), 1e-6)
        self.assertIn("anatomy of instant-radiosity at 64 vpls", self.done.stdout)


class TheRuns(CompareVplTest):
    def test_results_depend_on_the_seed_and_not_on_the_threads(self):
        def report(*more, name):
            result = without_times(read_json(self.compare(DATA / "cube6.obj", *more, name=name) / "results.json"))
            del result["options"]
            return result
        one = report("--threads", "1", name="one")
        self.assertEqual(one, report("--threads", "4", name="four"))
        self.assertNotEqual(one["methods"], report("--seed", "5", name="other")["methods"])

    def test_a_second_run_replaces_the_first(self):
        first = self.compare(DATA / "cube6.obj")
        (first / "index.html").write_text("old")
        self.assertIn("cube6", (self.compare(DATA / "cube6.obj") / "index.html").read_text(encoding="utf-8"))

    def test_lights_without_area(self):
        report = read_json(self.compare(DATA / "window_room.gltf") / "results.json")
        self.assertLess(abs(report["methods"][0]["energy_ratio"] - 1), 0.2)


    def test_light_by_bounce(self):
        report = self.folder / "report.json"
        folder = self.compare(DATA / "cube6.obj", "--per-bounce", "2", "--clamp", "none", "--json", report)
        method, = read_json(report)["methods"]
        self.assertEqual([bounce["bounce"] for bounce in method["bounces"]], [0, 1, 2])
        self.assertIn("By bounce", Page((folder / "index.html").read_text(encoding="utf-8")).text)
        lights = [bounce["mean"] for bounce in method["bounces"]]
        self.assertGreater(lights[0], lights[1])
        self.assertGreater(lights[1], lights[2])
        for bounce in method["bounces"]:  # 64 lights and 4 seeds: a first look
            self.assertLess(abs(bounce["energy_ratio"] - 1), 0.3)
            self.assertGreaterEqual(bounce["own_error"], 0)

    def test_a_fixed_walk_lacks_the_bounces_after_its_last(self):
        method, = read_json(self.compare(DATA / "cube6.obj", "--per-bounce", "2", "--walk", "fixed", "--vpl-bounces", "1")
                            / "results.json")["methods"]
        self.assertGreater(method["bounces"][1]["energy_ratio"], 0.5)
        self.assertEqual(method["bounces"][2]["energy_ratio"], 0)


class Variants(CompareVplTest):
    """Scenes that nobody has seen, the options unchanged: parts must make the whole on them too."""

    def anatomy(self, *variation):
        scene = self.folder / "variant.obj"
        subprocess.run([sys.executable, REPOSITORY / "scripts/vary_scene.py", DATA / "cornell_box.obj", scene,
                        *variation], check=True)
        folder = self.folder / "out"
        self.run_well("compare", "vpl", scene, "-o", folder, "--quiet", "--patches", "300", "--seeds", "12",
                      "--ladder", "1024", "--size", "16x16")
        method, = read_json(folder / "results.json")["methods"]
        return {part["part"]: part for part in method["anatomy"]}

    def check(self, parts):
        self.assertAlmostEqual(sum(part["share"] for part in parts.values()), 1, places=9)
        left = parts["unexplained"]
        # Four standard errors, which 12 seeds know to a fifth; and they are small enough to say something.
        self.assertLess(abs(left["share"]), 4 * left["share_error"])
        self.assertLess(left["share_error"], 0.15)
        # 1024 lights and the default bound: noise and the bound share the error, the bound is all of the bias.
        self.assertGreater(parts["clamping"]["share"], 0.3)
        self.assertGreater(parts["sampling"]["share"], 0.15)
        for part in ("visibility", "bounces"):
            self.assertLess(abs(parts[part]["share"]), 0.03, part)

    def test_rotated(self):
        self.check(self.anatomy("--rotate=0.3,1,0.2,27"))

    def test_blocks_moved(self):
        self.check(self.anatomy("--move", "short=0.06,0,0.04", "--move", "tall=-0.03,0,-0.05"))

    def test_wall_subdivided(self):
        self.check(self.anatomy("--subdivide", "back=7"))

    def test_albedos_permuted(self):
        self.check(self.anatomy("--permute-albedos", "5"))


CHROMIUM = shutil.which("chromium")
MOVE_AND_TELL = """<script>
const range = document.querySelector('input[type=range]');
range.value = 20;
range.dispatchEvent(new Event('input'));
const views = document.querySelector('.views'), line = document.querySelector('.views i');
const cut = [...document.querySelectorAll('td, th, p, dd, figcaption, h3')].filter(e => e.scrollWidth > e.clientWidth + 1);
document.title = JSON.stringify({at: (line.offsetLeft + 1) / views.clientWidth, clip: getComputedStyle(
  document.querySelector('.views img + img')).clipPath, width: document.documentElement.scrollWidth, cut: cut.length,
  pictures: [...document.images].every(image => image.complete && image.naturalWidth > 0)});
</script></body>"""


@unittest.skipUnless(CHROMIUM, "no chromium")
class InABrowser(CompareVplTest):
    def test_the_slider_moves_and_nothing_is_cut_off_at_1280_pixels(self):
        folder = self.compare(DATA / "cornell_box.gltf", "--per-bounce", "1")
        page = (folder / "index.html").read_text(encoding="utf-8")
        self.assertEqual(page.count("</body>"), 1)
        driven = self.write("driven.html", page.replace("</body>", MOVE_AND_TELL))
        done = subprocess.run([CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--window-size=1280,900",
                               f"--user-data-dir={self.folder / 'browser'}", "--dump-dom", f"file://{driven}"],
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120, check=True)
        told = json.loads(re.search("<title>(.*?)</title>", done.stdout).group(1))
        self.assertAlmostEqual(told["at"], 0.2, places=2)
        self.assertIn("20%", told["clip"])
        self.assertLessEqual(told["width"], 1280)
        self.assertEqual(told["cut"], 0)
        self.assertTrue(told["pictures"])


class WhatIsWrong(CompareVplTest):
    def refuse(self, code, pattern, *arguments, **more):
        done = run("compare", "vpl", *arguments, **more)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertRegex(done.stderr, pattern)
        self.assertEqual(done.stdout, "")
        self.assertFalse((self.folder / "out").exists())

    def test_usage(self):
        out = ("-o", self.folder / "out")
        box = DATA / "cornell_box.obj"
        self.refuse(USAGE, "output.*required", box)
        self.refuse(USAGE, "no method \"cube\": there are instant-radiosity", box, *out, "--methods", "cube")
        self.refuse(USAGE, "named twice", box, *out, "--methods", "instant-radiosity,instant-radiosity")
        self.refuse(USAGE, "clamp: found \"0\"", box, *out, "--clamp", "0")
        self.refuse(USAGE, "clamp: found \"much\"", box, *out, "--clamp", "much")
        self.refuse(USAGE, "seeds", box, *out, "--seeds", "2")
        self.refuse(USAGE, "vpls", box, *out, "--vpls", "0")
        self.refuse(USAGE, "walk", box, *out, "--walk", "drunk")
        self.refuse(USAGE, "whole numbers", box, *out, "--vpls", "1.5")
        self.refuse(USAGE, "ladder: found 0.5, allowed are numbers from 1 to 16777216", box, *out, "--ladder", "0.5")
        self.refuse(USAGE, "vpl-bounces: is for --walk fixed", box, *out, "--vpl-bounces", "3")
        self.refuse(USAGE, "nothing to recover", box, *out, "--compensate", "--clamp", "none")
        self.refuse(USAGE, "known only in sum", box, *out, "--compensate", "--per-bounce", "3")
        self.refuse(USAGE, "per-bounce: found 17", box, *out, "--per-bounce", "17")

    def test_a_scene_without_light(self):
        scene = self.write("dark.obj", "".join(
            f"v {x} {y} {z}\n" for x in (0, 1) for y in (0, 1) for z in (0, 1)) + "f 1 3 4 2\nf 5 6 8 7\n")
        self.refuse(INPUT, "no light", scene, "-o", self.folder / "out")

    def test_without_gnuplot_nothing_is_begun(self):
        self.refuse(SYSTEM, "gnuplot-nox", DATA / "cornell_box.obj", "-o", self.folder / "out",
                    env=os.environ | {"PATH": "/nonexistent"})

    def test_an_interrupt_leaves_nothing(self):
        arguments = [PROGRAM, "compare", "vpl", str(DATA / "cornell_box.obj"), "-o", str(self.folder / "out")]
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
