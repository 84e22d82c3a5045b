#!/usr/bin/env python3
"""Prints how the error of stochastic relaxation falls with its rays on the grey Cornell box: as it is, turned, and with its blocks moved.

    scripts/stochastic_convergence.py [--program FILE] [--scene FILE] [--plot FILE.svg] [OPTION...]

The error at the 572 points of data/reference/cornell_grey_irradiance.csv is the RMS of the difference of rho E over the mean of rho E.
Where the blocks are moved, E at the points is that of a finer mesh. Further options go to the program
(build/benchmarks/stochastic_convergence), for example --lines local,chords,bundles. The scene is LAMBERT_SCENES/cornell_grey;
without it our own data/cornell_box.obj, in colour and without the points. --plot draws the error to the converged solution (needs gnuplot).
"""
import argparse
import math
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
    """Gives the two blocks a material of their own: in our box they have one each, in the grey one they follow the lamp."""
    if "short" in materials:
        materials["block"] = materials["short"]
        return [("block" if material in ("short", "tall") else material, points) for material, points in polygons]
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


def scene_and_points(arguments):
    """The scene's file, and whether the points are on it."""
    if arguments.scene:
        return arguments.scene, True
    if os.environ.get("LAMBERT_SCENES"):
        return Path(os.environ["LAMBERT_SCENES"]) / "cornell_grey/cornell_grey.obj", True
    print("# LAMBERT_SCENES is not set: data/cornell_box.obj, without points", flush=True)
    return ROOT / "data/cornell_box.obj", False


def measured(command):
    """The rows that the program prints, as lists of kind, rays and errors; also printed as they come."""
    rows = []
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        for line in process.stdout:
            print(line, end="", flush=True)
            if not line.startswith("#"):
                kind, *numbers = line.strip().split(",")
                rows.append((kind, *map(float, numbers)))
    return rows if process.returncode == 0 else None


def slope(points):
    """Of log error over log rays, by least squares; nothing of one point."""
    x, y = ([math.log(value) for value in values] for values in zip(*points))
    centre = sum(x) / len(x)
    spread = sum((v - centre) ** 2 for v in x)
    return sum((v - centre) * w for v, w in zip(x, y)) / spread if spread > 0 else math.nan


COLOURS = {"local": "#0072b2", "chords": "#d55e00", "bundles": "#009e73"}
NAMES = {"local": "local lines", "chords": "chords", "bundles": "bundles"}


def panel(name, rows):
    """gnuplot's commands for one scene: a curve for each kind of line, its slope in the legend."""
    blocks, curves = [], []
    for number, kind in enumerate(dict.fromkeys(row[0] for row in rows)):
        points = [(row[1], row[4]) for row in rows if row[0] == kind]
        blocks.append(f"$curve{number} << EOD\n" + "\n".join(f"{x:.0f} {y:.5f}" for x, y in points) + "\nEOD\n")
        # gnuplot's minus sign in a title is a hyphen
        title = f"{NAMES[kind]}, slope {slope(points):.2f}".replace("-", "\N{MINUS SIGN}")
        curves.append(f"$curve{number} using 1:2 with linespoints lw 2 pt {5 + 2 * number} ps 0.6 "
                      f"lc rgb '{COLOURS[kind]}' title '{title}'")
    first = min((row for row in rows if row[0] == "local"), default=rows[0])
    curves.append(f"{first[4]} * (x / {first[1]})**-0.5 with lines dt 2 lc rgb '#808080' title '1 / √rays'")
    return "".join(blocks) + f"set title '{name}'\nplot " + ", ".join(curves) + "\n"


def draw(path, measurements):
    """One panel for each scene, as an SVG on white."""
    script = f"""set encoding utf8
set terminal svg size {300 * len(measurements)},340 font 'sans-serif,11' background '#ffffff'
set logscale xy
set xrange [1e5:2e7]
set yrange [0.005:0.5]
set xtics ('10⁵' 1e5, '10⁶' 1e6, '10⁷' 1e7)
set ytics ('0.5 %%' 0.005, '1 %%' 0.01, '2 %%' 0.02, '5 %%' 0.05, '10 %%' 0.1, '20 %%' 0.2, '50 %%' 0.5)
set grid lc rgb '#e0e0e0'
set xlabel 'rays'
set ylabel 'error to the converged solution'
set key top right samplen 1.5 spacing 1.1
set multiplot layout 1,{len(measurements)}
""" + "set ylabel ''\n".join(panel(name, rows) for name, rows in measurements.items()) + "unset multiplot\n"
    svg = subprocess.run(["gnuplot"], input=script, stdout=subprocess.PIPE, check=True, text=True, encoding="utf-8").stdout
    path.write_text(svg, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", type=Path, default=ROOT / "build/benchmarks/stochastic_convergence")
    parser.add_argument("--scene", type=Path)
    parser.add_argument("--plot", type=Path)
    arguments, options = parser.parse_known_args()
    scene_file, has_points = scene_and_points(arguments)
    polygons, libraries = vary_scene.read_obj(scene_file)
    materials = vary_scene.read_mtl(libraries)

    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        moved = name_blocks(polygons, materials)
        variants = {"as it is": (polygons, POINTS, []),
                    "turned": (vary_scene.rotate(polygons, AXIS, DEGREES), rotated_points(polygons, folder / "p.csv"), []),
                    "blocks moved": (vary_scene.move(moved, "block", OFFSET), POINTS, ["--fine", "40000"])}
        measurements = {}
        for name, (variant, points, extra) in variants.items():
            scene = folder / (name.replace(" ", "_") + ".obj")
            vary_scene.write_scene(scene, variant, materials)
            print(f"# {name}", flush=True)
            at_points = ["--points", points, *extra] if has_points else []
            measurements[name] = measured([arguments.program, scene, *at_points, *options])
            if measurements[name] is None:
                return 1
    if arguments.plot:
        draw(arguments.plot, measurements)
    return 0


if __name__ == "__main__":
    sys.exit(main())
