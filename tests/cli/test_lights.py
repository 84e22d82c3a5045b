#!/usr/bin/env python3
"""Lights without area in `bake` and `probe`: those of glTF files, --sky, --sun and --per-light."""
import math
import unittest

from lambert_cli import DATA, INPUT, OK, USAGE, Gltf, ProgramTest, materials, read_json, run

ROOM = DATA / "window_room.gltf"
SMALL = ("--patches", "1500", "--resolution", "32")
GROUND = "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nf 1 2 3 4\n"  # its front up, 4 m²


def rectangle_angle(x0, x1, y0, y1, distance):
    """Solid angle of a rectangle in a plane at this distance, its corners counted from the foot of the perpendicular."""
    def corner(x, y):
        return math.atan2(x * y, distance * math.sqrt(x * x + y * y + distance * distance))
    return corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0)


def hdr_picture(width, height, texels):
    """A Radiance picture; `texels` are (mantissas r, g, b and exponent + 128)."""
    return b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width) + b"".join(map(bytes, texels))


class LightsOfAFile(ProgramTest):
    def test_send_what_their_cones_hold(self):
        report = self.bake(ROOM, *SMALL, "--per-light", "--seed", "3")
        lights = {light["name"]: light for light in report["lights"]}
        self.assertEqual([(light["name"], light["kind"]) for light in report["lights"]],
                         [("panel", "material"), ("bulb", "lights"), ("spot", "lights")])
        # What the bulb sends through the far end of the window is lost; nothing stands before it.
        sphere = 4 * math.pi - rectangle_angle(-.1, 2.3, -.5, 1.0, 4.5)
        for found, colour in zip(lights["bulb"]["energy"]["received"], (1, .85, .6)):
            self.assert_close(found, 60 * colour * sphere, 2e-3)
        inner, outer = math.cos(.35), math.cos(.6)
        cone = 2 * math.pi * ((1 - inner) + (inner - outer) / 3)
        for found, colour in zip(lights["spot"]["energy"]["received"], (1, .95, .9)):
            self.assert_close(found, 2 * 400 * colour * cone, 2e-3)
        self.assertEqual(report["warnings"], [])
        self.assertLess(abs(report["energy"]["imbalance"]), 5e-3)  # rows as they come from hemicubes

    def test_can_be_all_light_there_is(self):
        report = self.bake(ROOM, *SMALL, "--emit", "panel=0,0,0")
        self.assertEqual(report["energy"]["emitted"], [0, 0, 0])
        self.assertGreater(report["energy"]["received"][0], 500)

    def test_are_the_same_on_any_number_of_threads(self):
        options = (*SMALL, "--sky", "clear", "--sun", "135,35")
        one, three = (self.bake(ROOM, *options, "--threads", n) for n in (1, 3))
        self.assertEqual(one["materials"], three["materials"])
        self.assertEqual(one["energy"], three["energy"])


class PerLight(ProgramTest):
    def test_files_add_up_to_the_whole(self):
        out = self.folder / "room.glb"
        report = self.bake(ROOM, *SMALL, "--per-light", "--sky", "overcast", "--sun", "180,40,20000", "--tolerance", "1e-9",
                           "-o", out, "-o", self.folder / "room.ply")
        self.assertEqual([light["name"] for light in report["lights"]], ["panel", "bulb", "spot", "sun", "sky"])
        whole = Gltf(out).attribute("_RADIOSITY")
        brightest = max(map(max, whole))
        sums = [[0.0] * 3 for _ in whole]
        places = Gltf(out).attribute("POSITION")
        for light in report["lights"]:
            self.assertEqual(Gltf(light["files"][0]).attribute("POSITION"), places)
            self.assertEqual([str(self.folder / f"room.light-{light['name']}.{end}") for end in ("glb", "ply")],
                             light["files"])
            for total, value in zip(sums, Gltf(light["files"][0]).attribute("_RADIOSITY")):
                for c in range(3):
                    total[c] += value[c]
        # What the solver leaves is far below the rounding of six sums in single precision.
        for total, expected in zip(sums, whole):
            for a, b in zip(total, expected):
                self.assertLessEqual(abs(a - b), 2e-6 * brightest)
        for key in ("emitted", "received", "absorbed", "escaped"):
            for c in range(3):
                parts = sum(light["energy"][key][c] for light in report["lights"])
                self.assert_close(parts, report["energy"][key][c], 1e-5, key)

    def test_names_become_file_names_and_inputs_are_safe(self):
        scene = self.write("lamps.obj", "mtllib lamps.mtl\nusemtl lamp/1\n" + GROUND
                           + "usemtl lamp 1\nv 0 1 0\nv 1 1 0\nv 0 1 1\nf 5 6 7\n")
        self.write("lamps.mtl", "newmtl lamp/1\nKe 1 1 1\nnewmtl lamp 1\nKe 2 1 1\n")
        report = self.bake(scene, "--patches", "0", "--per-light", "-o", self.folder / "out.glb")
        self.assertEqual([light["files"] for light in report["lights"]],
                         [[str(self.folder / "out.light-lamp_1.glb")], [str(self.folder / "out.light-lamp_1_2.glb")]])
        other = self.write("out.light-lamp_1.obj", scene.read_text())
        done = run("bake", other, "--per-light", "--patches", "0", "-o", self.folder / "out.obj")
        self.assertEqual(done.returncode, USAGE, done.stderr)
        self.assertEqual(other.read_text(), scene.read_text())

    def test_is_refused_where_it_is_not_known_what_is_written(self):
        done = run("bake", ROOM, "--per-light", "--skip-existing", "-o", self.folder / "a.glb")
        self.assertEqual(done.returncode, USAGE)
        self.assertIn("--per-light", done.stderr)


class Sky(ProgramTest):
    def ground(self, *options):
        """RGB irradiance of open ground."""
        scene = self.write("ground.obj", GROUND)
        return materials(self.bake(scene, "--patches", "50", "--resolution", "16", *options))["default"]["mean_irradiance"]

    def test_uniform_gives_pi(self):
        for found, radiance in zip(self.ground("--sky", "1,2,0.5"), (1, 2, .5)):
            self.assert_close(found, math.pi * radiance, 1e-6)

    def test_overcast_gives_ten_thousand_lux_or_what_the_suns_place_tells(self):
        self.assert_close(self.ground("--sky", "overcast")[1], 10000, 2e-3)
        self.assert_close(self.ground("--sky", "overcast", "--sun", "77,30")[1], 300 + 21000 / 2, 2e-3)

    def test_clear_gives_its_illuminance_and_that_of_the_sun(self):
        sky = 800 + 15500 * math.sqrt(.5)
        air_mass = 1 / (.5 + .50572 * 36.07995 ** -1.6364)
        sun = 127500 * math.exp(-.21 * air_mass) * .5
        self.assert_close(self.ground("--sky", "clear", "--sun", "135,30")[1], sky + sun, 2e-3)
        self.assert_close(self.ground("--sky", "clear", "--sun", "135,30,0")[1], sky, 2e-3)
        self.assert_close(self.ground("--sun", "135,30")[1], sun, 1e-5)
        red, green, blue = self.ground("--sun=-45,30,20,10,0")
        self.assert_close(red, 10, 1e-5)
        self.assert_close(green, 5, 1e-5)
        self.assertEqual(blue, 0)

    def test_picture_has_north_in_its_middle(self):
        # One bright texel of 8 x 4: azimuths 45° to 90°, elevations 0° to 45°.
        texels = [(0, 0, 0, 0)] * 32
        texels[8 + 5] = (128, 64, 0, 129 + 6)  # 64, 32, 0
        picture = self.write("sky.hdr", hdr_picture(8, 4, texels))
        level = 64 * math.pi / 4 * .25  # azimuth × sin² / 2
        red, green, blue = self.ground("--sky", picture)
        self.assert_close(red, level, 2e-3)
        self.assert_close(green, level / 2, 2e-3)
        self.assertEqual(blue, 0)
        # A wall that faces east has ∫ cos² elevation × ∫ sin azimuth of it, one that faces west nothing.
        wall = self.write("wall.obj", "usemtl east\nv 0 0 1\nv 0 0 -1\nv 0 1 -1\nv 0 1 1\nf 1 2 3 4\n"
                          "usemtl west\nv -1 0 -1\nv -1 0 1\nv -1 1 1\nv -1 1 -1\nf 5 6 7 8\n")
        walls = materials(self.bake(wall, "--patches", "20", "--resolution", "16", "--sky", picture))
        self.assert_close(walls["east"]["mean_irradiance"][0],
                          64 * (math.pi / 8 + .25) * math.sqrt(.5), 2e-3)
        self.assertEqual(walls["west"]["mean_irradiance"], [0, 0, 0])

    def test_reaches_points_in_space(self):
        scene = self.write("ground.obj", GROUND)
        points = self.write("points.csv", "0,1,0,0,1,0\n0,0,0,0,1,0\n0,1,0,0,-1,0\n")
        out = self.folder / "out.csv"
        self.run_well("probe", scene, points, "-o", out, "--sky", "2,2,2", "--patches", "50", "--resolution", "16")
        up, on_ground, down = (float(line.split(",")[6]) for line in out.read_text().splitlines()[1:])
        self.assert_close(up, 2 * math.pi, 1e-6)
        self.assert_close(on_ground, 2 * math.pi, 1e-6)
        # Of the half below, the ground takes 4 / √2 atan(1 / √2) π^-1 and gives it back ρ = 1/2 times.
        factor = 4 / (math.pi * math.sqrt(2)) * math.atan(1 / math.sqrt(2))
        self.assert_close(down, 2 * math.pi * (1 - factor + .5 * factor), 2e-3)

    def test_is_in_the_picture_and_in_the_report(self):
        picture = self.folder / "room.png"
        report = self.bake(ROOM, *SMALL, "--sky", "clear", "--sun", "135,35", "--sky-rays", "64", "--light-points", "16",
                           "--image", picture, "--size", "64x48")
        self.assertTrue(picture.exists())
        options = report["options"]
        self.assertEqual((options["sky"], options["sun"], options["sky_rays"], options["light_points"]),
                         ("clear", "135,35", 64, 16))
        self.assertGreater(report["energy"]["received"][0], 1e4)
        self.assertIn("direct_light", report["seconds"])


class Errors(ProgramTest):
    def expect(self, code, text, *options):
        scene = self.write("ground.obj", GROUND)
        done = run("bake", scene, "--json", self.folder / "r.json", *options)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertIn(text, done.stderr)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1 if code == USAGE else len(done.stderr.splitlines()))
        self.assertFalse((self.folder / "r.json").exists())

    def test_of_use(self):
        self.expect(USAGE, "--sun", "--sky", "clear")
        for sun in ("1", "1,2,3,4", "1,91", "1,-1", "a,b", "400,20", "10,20,-1", "1,2,nan"):
            self.expect(USAGE, "--sun", f"--sun={sun}")
        for sky in ("1,2", "1,2,-3", "7", "1e31,0,0"):
            self.expect(USAGE, "--sky", f"--sky={sky}")
        self.expect(USAGE, "--sky-rays", "--sky", "1,1,1", "--sky-rays", "1")
        self.expect(USAGE, "--light-points", "--sun", "1,1", "--light-points", "0")

    def test_of_pictures(self):
        self.expect(INPUT, "no such file", "--sky", self.folder / "missing.exr")
        self.expect(INPUT, "not a picture", "--sky", self.write("broken.exr", "words"))
        whole = hdr_picture(4, 2, [(1, 1, 1, 128)] * 8)
        self.expect(INPUT, "cut.hdr", "--sky", self.write("cut.hdr", whole[:-9]))
        self.expect(INPUT, "2^26", "--sky", self.write("wide.hdr", hdr_picture(1 << 15, 1 << 12, [])))

    def test_a_picture_of_the_sky_is_not_overwritten(self):
        picture = self.write("sky.hdr", hdr_picture(4, 2, [(128, 128, 128, 128)] * 8))
        before = picture.read_bytes()
        done = run("bake", self.write("ground.obj", GROUND), "--sky", picture, "--json", picture)
        self.assertEqual(done.returncode, USAGE, done.stderr)
        self.assertEqual(picture.read_bytes(), before)

    def test_without_any_light_names_the_options(self):
        for options in ((), ("--sky", "0,0,0"), ("--sun", "90,40,0")):
            self.expect(INPUT, "--emit", *options)


class Info(ProgramTest):
    def test_finds_nothing_wrong_with_lights_without_area(self):
        report = self.folder / "info.json"
        self.run_well("info", ROOM, "--json", report)
        self.assertEqual(len(read_json(report)["lights"]), 3)
        self.assertNotIn("light", " ".join(item["problem"] for item in read_json(report)["worth_a_look"]))


if __name__ == "__main__":
    unittest.main()
