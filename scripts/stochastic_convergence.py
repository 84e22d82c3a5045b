#!/usr/bin/env python3
"""Prints how the error of stochastic relaxation falls with its rays on the grey Cornell box: as it is, turned, and with its blocks moved.

    scripts/stochastic_convergence.py [--program FILE] [--scene FILE] [OPTION...]

The error at the 572 points of data/reference/cornell_grey_irradiance.csv is the RMS of the difference of rho E over the mean of rho E.
Where the blocks are moved, E at the points is that of a finer mesh. Further options go to the program
(build/benchmarks/stochastic_convergence), for example --lines chords. The scene is LAMBERT_SCENES/cornell_grey.
"""
import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import vary_scene

ROOT = Path(__file__).resolve().parent.parent
POINTS = ROOT / "data/reference/cornell_grey_irradiance.csv"
AXIS, DEGREES = (1.0, 2.0, 3.0), 40.0
OFFSET = (0.35, 0.0, -0.3)  # metres; the blocks stay on the floor and inside


def name_blocks(polygons, materials):
    """Gives what follows the lamp, the two blocks, a material of their own."""
    lamp = max(i for i, (material, _) in enumerate(polygons) if material == "light")
    materials["block"] = materials["white"]
    return [("block" if i > lamp else material, points) for i, (material, points) in enumerate(polygons)]


def rotated_points(polygons, path):
    """The points turned as vary_scene turns the scene, in a new file."""
    turned, turned_direction = vary_scene.rotation(polygons, AXIS, DEGREES)
    lines = []
    for line in POINTS.read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            values = line.split(",")
            numbers = [float(v) for v in values[:6]]
            place, normal = turned(tuple(numbers[:3])), turned_direction(tuple(numbers[3:]))
            line = ",".join([*map(repr, place + normal), *values[6:]])
        lines.append(line)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", type=Path, default=ROOT / "build/benchmarks/stochastic_convergence")
    parser.add_argument("--scene", type=Path,
                        default=Path(os.environ.get("LAMBERT_SCENES", ".")) / "cornell_grey/cornell_grey.obj")
    arguments, options = parser.parse_known_args()
    polygons, libraries = vary_scene.read_obj(arguments.scene)
    materials = vary_scene.read_mtl(libraries)

    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        moved = name_blocks(polygons, materials)
        variants = {"as it is": (polygons, POINTS, []),
                    "turned": (vary_scene.rotate(polygons, AXIS, DEGREES), rotated_points(polygons, folder / "p.csv"), []),
                    "blocks moved": (vary_scene.move(moved, "block", OFFSET), POINTS, ["--fine", "40000"])}
        for name, (variant, points, extra) in variants.items():
            scene = folder / (name.replace(" ", "_") + ".obj")
            vary_scene.write_scene(scene, variant, materials)
            print(f"# {name}", flush=True)
            result = subprocess.run([arguments.program, scene, "--points", points, *extra, *options], check=False)
            if result.returncode != 0:
                return result.returncode
    return 0


if __name__ == "__main__":
    sys.exit(main())
