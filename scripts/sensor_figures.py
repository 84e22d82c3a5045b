#!/usr/bin/env python3
"""Prints how right `lambert probe` is at the sensors of the Cornell box and of its variants, and what it costs.

    scripts/sensor_figures.py [--program FILE] [--json FILE]

Of each scene and set of options: the RMS of the difference from the reference over the reference's mean (all channels), the RMS of the
stated standard errors over the same, the share of errors within two stated ones (the reference's own included), CPU seconds of the
whole process. The references: path tracing for the box as published (408 points) and for a grey box (572 points, with LAMBERT_SCENES);
for the box turned by an odd angle and with exchanged reflectances its own solution, converged, at the same points.
"""
import argparse
import json
import math
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

import vary_scene

ROOT = Path(__file__).resolve().parent.parent
OPTIONS = (("--patches", "1500", "--solver", "stochastic", "--target-error", ".05", "--gather-error", ".01"),
           ("--patches", "5000", "--solver", "stochastic", "--target-error", ".03", "--gather-error", ".0015"),
           ("--quality", "preview"), ())
CONVERGED = ("--patches", "20000", "--solver", "stochastic", "--target-error", ".01", "--gather-error", ".0015")
TURN = ("1,2,3", 37)


def table(path):
    return [[float(word) for word in line.split(",")] for line in Path(path).read_text().splitlines()
            if line and not line.startswith("#")]


def statistics(found, expected):
    """(error, stated, share within two) of rows x,y,z,nx,ny,nz,E,stderr."""
    mean = sum(sum(row[6:9]) for row in expected) / (3 * len(expected))
    squares = stated = 0.0
    within = 0
    for a, b in zip(found, expected, strict=True):
        squares += sum((p - q) ** 2 for p, q in zip(a[6:9], b[6:9]))
        stated += sum(p * p for p in a[9:12])
        within += abs(sum(a[6:9]) - sum(b[6:9])) <= 2 * math.hypot(sum(a[9:12]), sum(b[9:12]))
    n = 3 * len(expected)
    return math.sqrt(squares / n) / mean, math.sqrt(stated / n) / mean, within / len(expected)


class Sensors:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def probe(self, scene, points, options):
        """The rows, and CPU seconds."""
        file, out = self.folder / "points.csv", self.folder / "out.csv"
        file.write_text("".join(",".join(map(repr, row[:6])) + "\n" for row in points))
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([self.program, "probe", scene, file, "-o", out, "--quiet", *options], check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return table(out), after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def turned(rows, polygons):
    """The points of `rows` as vary_scene turns the scene."""
    place, direction = vary_scene.rotation(polygons, [float(x) for x in TURN[0].split(",")], TURN[1])
    return [[*place(tuple(row[:3])), *direction(tuple(row[3:6]))] for row in rows]


def cases(sensors):
    """Name, scene, reference."""
    box = ROOT / "data" / "cornell_box.obj"
    rows = [[.001 * x for x in row[:3]] + row[3:] for row in table(ROOT / "data/reference/cornell_pcg_irradiance.csv")]
    yield "Cornell box", box, rows
    for name, arguments in (("turned", [f"--rotate={TURN[0]},{TURN[1]}"]), ("albedos exchanged", ["--permute-albedos", "3"])):
        scene = sensors.folder / "variant.obj"
        vary_scene.main([str(box), str(scene), *arguments])
        points = turned(rows, vary_scene.read_obj(box)[0]) if name == "turned" else rows
        yield name, scene, sensors.probe(scene, points, CONVERGED)[0]
    grey = Path(os.environ.get("LAMBERT_SCENES", "")) / "cornell_grey" / "cornell_grey.obj"
    if grey.is_file():
        yield "grey box", grey, table(ROOT / "data/reference/cornell_grey_irradiance.csv")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", default=str(ROOT / "build/cli/lambert"))
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    results = []
    print("| scene | options | error | stated | within two | CPU s |\n|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        sensors = Sensors(arguments.program, Path(folder))
        for name, scene, reference in cases(sensors):
            for options in OPTIONS:
                rows, seconds = sensors.probe(scene, reference, options)
                error, stated, within = statistics(rows, reference)
                words = " ".join(options) or "none"
                print(f"| {name} | `{words}` | {100 * error:.2f} % | {100 * stated:.2f} % | {100 * within:.0f} % | {seconds:.2f} |",
                      flush=True)
                results.append({"scene": name, "options": words, "error": error, "stated": stated, "within": within,
                                "cpu_seconds": seconds})
    if arguments.json:
        arguments.json.write_text(json.dumps(results, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
