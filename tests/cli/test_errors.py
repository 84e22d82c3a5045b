#!/usr/bin/env python3
"""Wrong use ends with the right exit code and one line that says what is wrong, and leaves nothing behind."""
import json
import os
import resource
import struct
import subprocess
import unittest

from lambert_cli import DATA, INPUT, OK, PROGRAM, SYSTEM, USAGE, ProgramTest, run

BOX = DATA / "cornell_box.obj"
GLTF = DATA / "cornell_box.gltf"
TINY = ("--patches", "0", "--resolution", "16", "--quiet")
TRIANGLE = "v 0 0 0\nv 1 0 0\nv 1 1 0\n"


class ErrorTest(ProgramTest):
    def assert_fails(self, code, *arguments, says="", **more):
        """Exit code, one line on stderr beside warnings, empty stdout, and an unchanged folder."""
        before = self.listing()
        done = run(*arguments, cwd=self.folder, **more)
        what = " ".join(map(str, arguments))
        lines = [line for line in done.stderr.splitlines() if not line.startswith("warning: ")]
        self.assertEqual(done.returncode, code, f"{what}: {done.stderr}")
        self.assertEqual(len(lines), 1, f"{what}: {done.stderr}")
        self.assertTrue(lines[0].startswith("lambert: "), lines[0])
        self.assertIn(says, lines[0], what)
        self.assertEqual(done.stdout, "", what)
        self.assertEqual(self.listing(), before, what)

    def listing(self):
        return {path.name: path.read_bytes() if path.is_file() else None for path in self.folder.iterdir()}


class WrongOptions(ErrorTest):
    def assert_refused(self, *options, says="", scene=BOX):
        self.assert_fails(USAGE, "bake", scene, "-o", "x.glb", "--quiet", *options, says=says)

    def test_command_line_that_is_not_understood(self):
        for arguments in ((), ("frobnicate",), ("bake",), ("bake", BOX, "-o"), ("bake", BOX, "--nonsense", "-o", "x.glb"),
                          ("bake", BOX, BOX, "-o", "x.glb"), ("probe", BOX), ("info",), ("verify", "extra")):
            self.assert_fails(USAGE, *arguments)

    def test_bake_without_a_target(self):
        self.assert_fails(USAGE, "bake", BOX, says="-o FILE")

    def test_values_out_of_range(self):
        for option, values in {
                "--resolution": ("15", "2", "17", "4098", "-16", "abc", "1e2", ""),
                "--patches": ("-1", "1.5", "abc", "99999999999999999999", "300000000"),
                "--patch-length": ("0", "nan", "-1", "1e-9", "abc"),
                "--bounces": ("-1", "abc"), "--threads": ("-1", "abc"), "--seed": ("-1", "abc"),
                "--tolerance": ("-1", "nan", "2"), "--crease-angle": ("-1", "nan", "181"),
                "--memory-limit": ("0", "nan"), "--unit": ("0", "-1", "nan", "inf"),
                "--exposure": ("abc", "nan", "101", "1e999"), "--method": ("magic",), "--quantity": ("happiness",),
                "--format": ("doc",)}.items():
            for value in values:
                self.assert_refused(option, value, says=option.strip("-").replace("-", " ").split()[0])

    def test_an_option_is_no_file(self):
        for option in ("--json", "-o", "--image", "--solution"):
            self.assert_refused(option, "--quiet", says="--quiet")

    def test_options_that_exclude_each_other(self):
        self.assert_refused("--patches", "10", "--patch-length", "0.1", says="--patch")

    def test_pictures_that_cannot_be(self):
        for options in (("--size", "0x10"), ("--size", "10"), ("--size", "axb"), ("--size", "100000x10"),
                        ("--eye", "0,0", "--look-at", "0,0,1"), ("--eye", "0,0,0"), ("--look-at", "0,0,1"),
                        ("--eye", "0,0,0", "--look-at", "0,0,0"), ("--eye", "nan,0,0", "--look-at", "0,0,1"),
                        ("--eye", "0,0,0", "--look-at", "0,0,1", "--fov", "0"),
                        ("--eye", "0,0,0", "--look-at", "0,0,1", "--fov", "180"),
                        ("--eye", "0,0,0", "--look-at", "0,1,0", "--up", "0,1,0"), ("--fov", "45"), ("--samples", "0"),
                        ("--camera", "nobody"), ("--camera", "camera", "--eye", "0,0,0", "--look-at", "0,0,1")):
            self.assert_refused("--image", "x.png", *options, scene=GLTF)
        self.assert_fails(USAGE, "bake", GLTF, "--image", "x.jpg", *TINY, says=".png")

    def test_materials_that_are_not_there_or_badly_written(self):
        for option in ("--emit", "--reflectance"):
            self.assert_refused(option, "nothing=.5,.5,.5", says='"nothing"')
            for value in ("light", "light=", "light=1,1", "light=1,1,1,1", "light=a,b,c", "light=1,1,-1", "light=nan,0,0"):
                self.assert_refused(option, value, says=option)
        self.assert_refused("--reflectance", "light=1,1,1", says="0.99")

    def test_unit_with_gltf(self):
        self.assert_refused("--unit", "0.001", scene=GLTF, says="--unit")


class WrongScenes(ErrorTest):
    def assert_unusable(self, name, says=""):
        self.assert_fails(INPUT, "bake", name, "-o", "x.glb", *TINY, says=says or name)
        self.assert_fails(INPUT, "info", name, says=name)

    def test_missing_or_not_a_scene(self):
        self.write("notes.txt", "hello")
        for name in ("missing.obj", "missing.glb", "missing.gltf", "notes.txt"):
            self.assert_unusable(name)

    def test_folder(self):
        for name in ("folder.obj", "folder.glb"):
            (self.folder / name).mkdir()
            self.assert_unusable(name, "folder")

    def test_empty_files(self):
        for name in ("empty.obj", "empty.glb", "empty.gltf"):
            self.write(name, "")
            self.assert_unusable(name, "empty")

    def test_random_bytes(self):
        noise = bytes((k * k * 31 + k * 17 + 5) % 251 for k in range(2000))
        for name in ("noise.glb", "noise.gltf", "noise.obj"):
            self.write(name, noise)
            self.assert_unusable(name)

    def test_glb_that_was_cut_off(self):
        self.write("cut.glb", b"glTF\x02\0\0\0\xff\xff\0\0\x10\0\0\0JSON{")
        self.assert_unusable("cut.glb")

    def test_obj_with_an_index_that_does_not_exist_names_the_line(self):
        self.write("bad.obj", TRIANGLE + "f 1 2 9\n")
        self.assert_unusable("bad.obj", "bad.obj:4")

    def test_gltf_that_is_not_json(self):
        self.write("bad.gltf", '{"asset": {"version": "2.0"}, ')
        self.assert_unusable("bad.gltf")

    def test_scene_without_light_names_emit(self):
        self.write("dark.obj", TRIANGLE + "f 1 2 3\n")
        self.assert_fails(INPUT, "bake", "dark.obj", "-o", "x.glb", *TINY, says="--emit")


class WrongTargets(ErrorTest):
    def assert_target_refused(self, code, *options, scene=BOX, says=""):
        self.assert_fails(code, "bake", scene, *options, *TINY, says=says)

    def test_folder_missing_is_a_folder_or_not_writable(self):
        (self.folder / "folder.glb").mkdir()
        self.write("file", "")
        places = ["missing/x.glb", "folder.glb", "file/x.glb", "/proc/lambert/x.glb"]
        if os.geteuid() != 0:  # permissions do not bind root
            (self.folder / "locked").mkdir(mode=0o500)
            places.append("locked/x.glb")
        for place in places:
            self.assert_target_refused(SYSTEM, "-o", place, says=place)
        for option in ("--json", "--image"):
            self.assert_target_refused(SYSTEM, "-o", "x.glb", option, "missing/x.png", says="missing/x.png")

    def test_device_is_not_replaced(self):
        os.mkfifo(self.folder / "pipe.glb")
        self.assert_target_refused(SYSTEM, "-o", "pipe.glb", says="pipe.glb")

    def test_unknown_extension(self):
        for name in ("x.abc", "x", ".glb"):
            self.assert_target_refused(USAGE, "-o", name)

    def test_scene_is_not_overwritten(self):
        box = self.copy_box()
        for name in ("box.obj", "./box.obj", str(box), f"../{self.folder.name}/box.obj"):
            self.assert_target_refused(USAGE, "-o", name, scene="box.obj", says="overwrite")
            self.assert_target_refused(USAGE, "-o", "x.glb", "--json", name, scene="box.obj", says="overwrite")
        (self.folder / "link.obj").symlink_to("box.obj")
        self.assert_target_refused(USAGE, "-o", "link.obj", scene="box.obj", says="overwrite")
        self.assert_fails(USAGE, "info", "box.obj", "--json", "box.obj", says="overwrite")

    def test_material_library_of_the_scene_is_not_overwritten(self):
        self.copy_box(library="light.mtl")
        self.assert_target_refused(USAGE, "-o", "light.obj", scene="box.obj", says="light.mtl")
        self.assert_target_refused(USAGE, "-o", "x.glb", "--json", "light.mtl", scene="box.obj", says="light.mtl")

    def test_image_of_the_scene_is_not_overwritten(self):
        self.copy_box(library="Light.mtl")
        with open(self.folder / "Light.mtl", "a") as library:
            library.write("newmtl picture\nmap_Kd -s 2 2 maps\\Wall.png\n")
        self.write("box.obj", (self.folder / "box.obj").read_text().replace("Light.mtl", "LIGHT.MTL"))
        (self.folder / "maps").mkdir()
        self.write("maps/wall.png", "")
        self.assert_target_refused(USAGE, "-o", "x.glb", "--image", "maps/wall.png", scene="box.obj", says="wall.png")

    def test_images_of_a_ply_and_of_a_glb_are_not_overwritten(self):
        (self.folder / "image.glb").write_bytes(b"image")
        ply = self.folder / "scene.ply"
        ply.write_bytes(b"ply\nformat ascii 1.0\ncomment TextureFile image.glb\nelement vertex 0\nend_header\n")
        document = json.dumps({"asset": {"version": "2.0"}, "images": [{"uri": "image.glb"}]}).encode()
        document += b" " * (-len(document) % 4)
        glb = self.folder / "scene.glb"
        glb.write_bytes(struct.pack("<4sIIII", b"glTF", 2, 20 + len(document), len(document), 0x4E4F534A) + document)
        for scene in ply, glb:
            self.assert_target_refused(USAGE, "-o", "image.glb", scene=scene, says="overwrite")

    def test_target_named_twice(self):
        here = f"../{self.folder.name}/x.glb"
        for names in (("x.glb", "x.glb"), ("x.glb", "./x.glb"), ("x.glb", here)):
            self.assert_target_refused(USAGE, "-o", names[0], "-o", names[1], says="twice")
        self.assert_target_refused(USAGE, "-o", "x.obj", "--json", "x.mtl", says="twice")

    def test_probe_overwrites_neither_scene_nor_points(self):
        self.copy_box()
        self.write("p.csv", "0.1,0.1,0.1,0,1,0\n")
        for target in ("box.obj", "box.mtl", "p.csv"):
            self.assert_fails(USAGE, "probe", "box.obj", "p.csv", "-o", target, *TINY, says="overwrite")

    def test_write_that_fails_keeps_the_old_file_and_leaves_no_temporary(self):
        # No file may grow past 1,000 bytes: the disk is as good as full.
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
        self.write("x.glb", "old")
        for target in ("x.glb", "x.ply"):
            self.assert_fails(SYSTEM, "bake", BOX, "-o", target, *TINY, says="cannot write", preexec_fn=limit)

    def test_name_may_be_as_long_as_names_can_be(self):
        self.assertEqual(run("bake", BOX, "-o", "x" * 251 + ".glb", *TINY, cwd=self.folder).returncode, OK)

    def copy_box(self, library="box.mtl"):
        self.write(library, (DATA / "cornell_box.mtl").read_bytes())
        return self.write("box.obj", BOX.read_text().replace("cornell_box.mtl", library))


class WrongStreams(ErrorTest):
    COMMANDS = (("info", BOX), ("--help",), ("--version",), ("bake", "--help"),
                ("bake", BOX, "-o", "x.glb", "--patches", "0", "--resolution", "16"))

    def assert_stdout_matters(self, redirection):
        for arguments in self.COMMANDS:
            done = subprocess.run(["sh", "-c", f'exec "$@" {redirection}', "sh", PROGRAM, *map(str, arguments)],
                                  cwd=self.folder, stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            self.assertEqual(done.returncode, SYSTEM, f"{arguments}: {done.stderr}")
            self.assertEqual([line for line in done.stderr.splitlines() if line.startswith("lambert: ")],
                             ["lambert: standard output cannot be written"])

    def test_closed_stdout_is_an_error(self):
        self.assert_stdout_matters(">&-")

    def test_full_stdout_is_an_error(self):
        self.assert_stdout_matters(">/dev/full")

    def test_closed_stderr_gets_into_no_file(self):
        options = ("--patches", "0", "--resolution", "16")
        self.run_well("bake", BOX, "-o", self.folder / "one.glb", *options)
        subprocess.run(["sh", "-c", 'exec "$@" 2>&-', "sh", PROGRAM, "bake", str(BOX), "-o", "two.glb", *options],
                       cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, check=True)
        self.assertEqual((self.folder / "one.glb").read_bytes(), (self.folder / "two.glb").read_bytes())


class WrongPoints(ErrorTest):
    def assert_points_refused(self, content, says):
        self.write("p.csv", content)
        self.assert_fails(INPUT, "probe", BOX, "p.csv", *TINY, says=says)

    def test_malformed_lines_are_named(self):
        good = "0.1,0.1,0.1,0,1,0\n"
        for bad in ("0.1,0.1,abc,0,1,0", "0.1,0.1,0.1,0,1", "1 2 3 4 5 6", "0.1;0.1;0.1;0;1;0", "x,y,z,nx,ny,nz",
                    "0.1,,0.1,0,1,0", "0.1m,0.1,0.1,0,1,0", "nan,0.1,0.1,0,1,0", "0.1,0.1,0.1,0,0,0", "inf,0,0,0,0,1"):
            self.assert_points_refused("# points\n" + good + bad + "\n", "p.csv:3")

    def test_no_points(self):
        for content in ("", "# nothing\n", "x,y,z,nx,ny,nz\n"):
            self.assert_points_refused(content, "p.csv")

    def test_file_missing_or_a_folder(self):
        for name in ("missing.csv", "."):
            self.assert_fails(INPUT, "probe", BOX, name, *TINY)


class Help(ProgramTest):
    def test_help_and_version_end_well_on_stdout(self):
        for arguments in (("--help",), ("bake", "--help"), ("probe", "--help"), ("info", "--help"), ("verify", "--help"),
                          ("--version",)):
            done = run(*arguments)
            self.assertEqual((done.returncode, done.stderr), (OK, ""), arguments)
            self.assertNotEqual(done.stdout, "")

    def test_version_is_a_number(self):
        self.assertRegex(run("--version").stdout, r"^\d+\.\d+\.\d+\n$")


if __name__ == "__main__":
    unittest.main()
