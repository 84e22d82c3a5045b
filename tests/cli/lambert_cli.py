"""What the end-to-end tests share: running the program, and reading what it writes.

The program stands in the environment variable LAMBERT, the repository's scenes in LAMBERT_DATA; scenes from outside the
repository, where there are any, in LAMBERT_SCENES.
"""
import base64
import json
import math
import os
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

PROGRAM = os.environ.get("LAMBERT", "lambert")
DATA = Path(os.environ.get("LAMBERT_DATA", Path(__file__).parents[2] / "data"))
SCENES = Path(os.environ["LAMBERT_SCENES"]) if os.environ.get("LAMBERT_SCENES") else None
REPOSITORY = Path(__file__).parents[2]
SKIPPED = 77

OK, MISSED, USAGE, INPUT, SYSTEM, INTERRUPTED = 0, 1, 2, 3, 4, 130

# A bake of a fraction of a second, for tests in which the light itself does not matter.
SMALL = ("--patches", "300", "--resolution", "32")


def run(*arguments, **more):
    """Runs the program to its end; stdout and stderr are text."""
    return subprocess.run([PROGRAM, *map(str, arguments)], stdin=subprocess.DEVNULL, timeout=600, text=True,
                          errors="replace", **{"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **more})


class ProgramTest(unittest.TestCase):
    """A test with an empty folder of its own."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def run_well(self, *arguments):
        """Runs the program and requires that it ends with 0."""
        done = run(*arguments)
        self.assertEqual(done.returncode, OK, done.stderr)
        return done

    def bake(self, scene, *arguments):
        """Bakes and returns the JSON report."""
        report = self.folder / "report.json"
        self.run_well("bake", scene, "--json", report, "--quiet", *arguments)
        return read_json(report)

    def killed(self, seconds, *arguments):
        """Starts the program and kills it after so long; whether it was still running."""
        with subprocess.Popen([PROGRAM, *map(str, arguments)], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as process:
            time.sleep(seconds)
            process.send_signal(signal.SIGKILL)
            return process.wait() == -signal.SIGKILL

    def write(self, name, content):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def assert_close(self, found, expected, relative, what=""):
        self.assertLessEqual(abs(found - expected), relative * abs(expected), f"{what}: {found}, expected {expected}")


# ---- Reading what was written

def read_json(path):
    def refuse(word):
        raise ValueError(f"{path}: {word} is not JSON")
    return json.loads(Path(path).read_text(encoding="utf-8"), parse_constant=refuse)


def materials(report):
    return {material["name"]: material for material in report["materials"]}


class Gltf:
    """A baked .glb or .gltf whose buffer is inside."""
    FORMATS = {5121: "B", 5123: "H", 5125: "I", 5126: "f"}
    WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}

    def __init__(self, path):
        content = Path(path).read_bytes()
        if content[:4] == b"glTF":
            self.json, self.buffer = self.split_glb(content)
        else:
            self.json = json.loads(content)
            self.buffer = base64.b64decode(self.json["buffers"][0]["uri"].partition("base64,")[2])

    @staticmethod
    def split_glb(content):
        version, size = struct.unpack_from("<II", content, 4)
        if version != 2 or size != len(content):
            raise ValueError(f"glTF version {version}, {size} of {len(content)} bytes")
        chunks, at = {}, 12
        while at < size:
            length, kind = struct.unpack_from("<I4s", content, at)
            chunks[kind] = content[at + 8:at + 8 + length]
            at += 8 + length
        return json.loads(chunks[b"JSON"]), chunks[b"BIN\0"]

    def primitives(self):
        return [primitive for mesh in self.json["meshes"] for primitive in mesh["primitives"]]

    def accessor(self, index):
        """Its values: numbers, or tuples of numbers."""
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        width = self.WIDTHS[accessor["type"]]
        layout = struct.Struct(f"<{width}{self.FORMATS[accessor['componentType']]}")
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        stride = view.get("byteStride", layout.size)
        values = [layout.unpack_from(self.buffer, start + k * stride) for k in range(accessor["count"])]
        return [value[0] for value in values] if width == 1 else values

    def attribute(self, name):
        """Its values over all primitives."""
        return [value for primitive in self.primitives() for value in self.accessor(primitive["attributes"][name])]

    def extras(self):
        return self.json["asset"].get("extras") or self.json["meshes"][0].get("extras") or {}


class Ply:
    """A baked .ply: its header, its vertices as dictionaries, its faces as tuples of indices."""
    TYPES = {"float": "f", "double": "d", "uchar": "B", "uint": "I"}

    def __init__(self, path):
        content = Path(path).read_bytes()
        header, _, body = content.partition(b"end_header\n")
        self.header = header.decode().splitlines()
        words = [line.split() for line in self.header]
        count = {line[1]: int(line[2]) for line in words if line[0] == "element"}
        properties = [(line[2], self.TYPES[line[1]]) for line in words if line[0] == "property" and line[1] != "list"]
        layout = struct.Struct("<" + "".join(kind for _, kind in properties))
        names = [name for name, _ in properties]
        self.vertices = [dict(zip(names, layout.unpack_from(body, k * layout.size))) for k in range(count["vertex"])]
        at, self.faces = count["vertex"] * layout.size, []
        for _ in range(count["face"]):
            self.faces.append(struct.unpack_from(f"<{body[at]}I", body, at + 1))
            at += 1 + 4 * body[at]
        if at != len(body):
            raise ValueError(f"{path}: {len(body) - at} bytes after the last face")

    def corners(self, face):
        return [tuple(self.vertices[k][axis] for axis in "xyz") for k in self.faces[face]]


def png_size(path):
    content = Path(path).read_bytes()
    if content[:8] != b"\x89PNG\r\n\x1a\n" or content[12:16] != b"IHDR":
        raise ValueError(f"{path}: not a PNG")
    return struct.unpack(">II", content[16:24])


def read_table(path):
    """The rows of a CSV with # comments, as lists of numbers."""
    lines = Path(path).read_text().splitlines()
    return [[float(value) for value in line.split(",")] for line in lines if line and not line.startswith("#")]


def relative_rms(found, expected, weights=None):
    """The RMS of the difference over the mean of what is expected."""
    weights = weights or [1.0] * len(expected)
    total = sum(weights)
    square = sum(w * (f - e) ** 2 for w, f, e in zip(weights, found, expected)) / total
    return math.sqrt(square) / (sum(w * e for w, e in zip(weights, expected)) / total)


def skip_all(reason):
    """Ends the script so that CTest counts it as skipped."""
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)
