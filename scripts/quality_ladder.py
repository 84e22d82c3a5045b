#!/usr/bin/env python3
"""Prints how far the light of each --quality is from a much finer solution: a better one must not be worse.

    scripts/quality_ladder.py [--program FILE] [--finer N] [--json FILE] [SCENE...] [-- OPTION...]

The error of a preset is the area-weighted RMS, over materials and channels, of the difference of their mean irradiance from the reference's,
relative to the RMS of the reference. The reference is the mean of two stochastic solutions (seeds 1 and 2) on N times the patches of
`high` [4], its own error half their difference. Without scenes: those of data/, each in one of its formats. Options after -- go to every bake, for
example -- --sky overcast. Exit status 1 if a preset is worse than a lower one by more than twice the reference's error. All of data/ takes long:
minutes to hours of processor time.
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

ROOT = Path(__file__).resolve().parent.parent
PRESETS = ("preview", "normal", "high")
FORMATS = (".gltf", ".glb", ".obj", ".mgf", ".ply")
MISSED, INPUT = 1, 3  # of the program's exit codes


def scenes_of(folder):
    """One file per scene: those of one name are one scene."""
    found = {}
    for path in sorted(folder.iterdir(), key=lambda p: (p.stem, FORMATS.index(p.suffix) if p.suffix in FORMATS else 99)):
        if path.suffix in FORMATS:
            found.setdefault(path.stem, path)
    return list(found.values())


def materials_of(report):
    """Name -> (area, mean irradiance); materials of one name count together."""
    result = {}
    for material in report["materials"]:
        area, mean = result.get(material["name"], (0.0, [0.0, 0.0, 0.0]))
        whole = area + material["area"]
        light = [(area * a + material["area"] * b) / whole for a, b in zip(mean, material["mean_irradiance"])]
        result[material["name"]] = (whole, light)
    return result


def relative_error(found, expected):
    """Of two such tables: sqrt(sum A |E - R|^2) / sqrt(sum A |R|^2), with the areas of the second."""
    difference = light = 0.0
    for name, (area, reference) in expected.items():
        _, mean = found.get(name, (0.0, [0.0, 0.0, 0.0]))
        difference += area * sum((a - b) ** 2 for a, b in zip(mean, reference))
        light += area * sum(b * b for b in reference)
    return math.sqrt(difference / light) if light > 0 else 0.0


def mean_of(one, other):
    return {name: (area, [(a + b) / 2 for a, b in zip(light, other[name][1])]) for name, (area, light) in one.items()}


def worse_presets(errors, own):
    """Those whose error is above that of a lower one by more than the reference can tell."""
    return [PRESETS[k] for k in range(1, len(errors)) if errors[k] > min(errors[:k]) + 2 * own]


class Bakes:
    def __init__(self, program, options):
        self.program, self.options = program, options

    def report(self, scene, *options):
        """The JSON report, with `cpu` seconds; None if the scene cannot be baked (no light)."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "report.json"
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            done = subprocess.run([self.program, "bake", scene, "--quiet", "--json", path, *options, *self.options],
                                  stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            if done.returncode == INPUT:
                print(f"{Path(scene).name}: left out: {done.stderr.strip().splitlines()[-1]}", flush=True)
                return None
            if done.returncode not in (0, MISSED):
                sys.exit(f"{scene}: {done.stderr.strip()}")
            report = json.loads(path.read_text(encoding="utf-8"))
        report["cpu"] = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        return report


def ladder(bakes, scene, finer):
    """Errors and CPU seconds of the presets, and the reference's own error."""
    reports = []
    for preset in PRESETS:
        report = bakes.report(scene, "--quality", preset)
        if report is None:
            return None
        reports.append(report)
    patches = str(round(finer * reports[-1]["patches"]))
    halves = [materials_of(bakes.report(scene, "--quality", "high", "--solver", "stochastic", "--patches", patches,
                                        "--seed", str(seed))) for seed in (1, 2)]
    reference = mean_of(*halves)
    errors = [relative_error(materials_of(report), reference) for report in reports]
    own = relative_error(halves[0], halves[1]) / 2
    return {"scene": Path(scene).name, "errors": errors, "own_error": own, "worse": worse_presets(errors, own),
            "imbalance": [report["energy"]["imbalance"] for report in reports],
            "patches": [report["patches"] for report in reports], "cpu_seconds": [report["cpu"] for report in reports]}


def row_text(row):
    errors = "".join(f"{100 * error:11.3f} %" for error in row["errors"])
    seconds = "".join(f"{value:9.1f}" for value in row["cpu_seconds"])
    worse = "   worse: " + ", ".join(row["worse"]) if row["worse"] else ""
    return f"{row['scene']:<28}{errors}{100 * row['own_error']:11.3f} %{seconds}{worse}"


def main():
    own, passed_on = sys.argv[1:], []
    if "--" in own:
        passed_on = own[own.index("--") + 1:]
        own = own[:own.index("--")]
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*", type=Path)
    parser.add_argument("--program", default=os.environ.get("LAMBERT", ROOT / "build/cli/lambert"))
    parser.add_argument("--finer", type=float, default=4.0, help="patches of the reference over those of high")
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args(own)
    bakes = Bakes(arguments.program, passed_on)
    names = "".join(f"{preset:>13}" for preset in PRESETS)
    print(f"{'scene':<28}{names}{'reference':>13}{'CPU s of the three':>27}", flush=True)
    rows = []
    for scene in arguments.scenes or scenes_of(ROOT / "data"):
        row = ladder(bakes, scene, arguments.finer)
        if row:
            rows.append(row)
            print(row_text(row), flush=True)
    if arguments.json:
        arguments.json.write_text(json.dumps(rows, indent=2) + "\n", encoding="utf-8")
    return 1 if any(row["worse"] for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
