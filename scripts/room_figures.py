#!/usr/bin/env python3
"""Prints how right default bakes are, as a table: per-material irradiance against random walks on the same patches.

    scripts/room_figures.py [--program FILE] [--options "--method hemicube"] [--walk-error .002] SCENE...

Columns: the area-weighted RMS of the difference over the RMS of the irradiance, per material and channel, and the walks' own
standard error of it; what the mesh itself does, from walks on patches of a quarter of the area; the imbalance of the energy
before any repair; the mean error that rows of form factors state for themselves; CPU seconds of bake and walk.
A material's mean is over far more rays than a patch's, so that its standard error is well below --walk-error.
"""
import argparse
import json
import math
import os
import resource
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# Scenes without lights of their own, or in other units.
SCENE_OPTIONS = {
    "cornell_pcg.obj": ["--unit", ".001"],
    "cornell_pcg_split.obj": ["--unit", ".001"],
    "window_room.gltf": ["--sky", "1,1,1"],
}


def bake(program, scene, *options):
    """The JSON report and the CPU seconds of a bake; what went wrong instead of a report."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run([program, "bake", str(scene), "--json", str(report), "--quiet",
                               *SCENE_OPTIONS.get(Path(scene).name, []), *map(str, options)],
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace", check=False)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        if done.returncode not in (0, 1) or not report.exists():
            return (done.stderr.strip().splitlines() or ["no word"])[-1], seconds
        return json.loads(report.read_text(encoding="utf-8")), seconds


def material_rms(report, reference):
    """sqrt(Σ A |E − E'|² / Σ A |E'|²) over materials and channels."""
    other = {m["name"]: m for m in reference["materials"]}
    squares = norm = 0.0
    for material in report["materials"]:
        if material["name"] not in other:
            continue
        pairs = zip(material["mean_irradiance"], other[material["name"]]["mean_irradiance"])
        for e, right in pairs:
            squares += material["area"] * (e - right) ** 2
            norm += material["area"] * right ** 2
    return math.sqrt(squares / norm) if norm > 0 else math.nan


def row(program, scene, options, walk_error):
    """The cells of one scene."""
    report, seconds = bake(program, scene, *options)
    if isinstance(report, str):
        return [Path(scene).name, report]
    # Walks take so many patches again if they are asked for with the same words.
    mesh = [option for option in options if option.startswith("--patch")]
    walk = ["--solver", "random-walk", "--target-error", walk_error]
    walked, walk_seconds = bake(program, scene, *walk, *mesh)
    again, _ = bake(program, scene, *walk, *mesh, "--seed", 2)
    finer, _ = bake(program, scene, *walk, "--patches", 4 * report["patches"])
    cells = [Path(scene).name, str(report["patches"]), report["solver"], report["method"]]
    for other in (walked, again, finer):
        if isinstance(other, str):
            return cells + [other]
    if walked["patches"] != report["patches"]:
        return cells + [f"walks took {walked['patches']} patches"]
    factors = report["form_factors"]
    return cells + [f"{100 * material_rms(report, walked):.2f}",
                    f"{100 * material_rms(again, walked) / math.sqrt(2):.2f}",
                    f"{100 * material_rms(walked, finer):.2f}",
                    f"{100 * report['energy'].get('imbalance_before_repair', report['energy']['imbalance']):.3f}",
                    f"{factors.get('mean_row_error', 0):.4f}",
                    f"{seconds:.1f}", f"{walk_seconds:.1f}"]


def main():
    """The program."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=os.environ.get("LAMBERT", str(ROOT / "build/cli/lambert")))
    parser.add_argument("--options", default="", help="more options for the bake, not for the walks")
    parser.add_argument("--walk-error", type=float, default=0.02, help="of a patch, relative; of materials much less")
    parser.add_argument("scenes", nargs="+")
    arguments = parser.parse_args()
    header = ["scene", "patches", "solver", "method", "error %", "of the walks %", "of the mesh %", "imbalance %",
              "row error", "CPU s", "walks' CPU s"]
    print("| " + " | ".join(header) + " |\n" + "|---" * len(header) + "|", flush=True)
    for scene in arguments.scenes:
        cells = row(arguments.program, scene, shlex.split(arguments.options), arguments.walk_error)
        print("| " + " | ".join(cells) + " |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
