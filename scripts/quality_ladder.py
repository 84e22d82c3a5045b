#!/usr/bin/env python3
"""Prints how far the light of each --quality is from a much finer solution: a better one must not be worse.

    scripts/quality_ladder.py [--program FILE] [--finer N] [--json FILE] [SCENE...] [-- OPTION...]

The error of a preset is the area-weighted RMS, over materials and channels, of the difference of their mean irradiance from the reference's,
relative to the RMS of the reference. The reference is the mean of four solutions by random walks (seeds 1 to 4) on N times the patches of
`high` [4]; its own error is their standard error, without that of its mesh, which stands in the errors of all presets alike. Without scenes: those
of data/, each in one of its formats. Options after -- go to every bake, for example -- --sky overcast. Exit status 1 if a preset is worse than a
lower one by more than three times the reference's error. All of data/ takes long: minutes to hours of processor time.
"""
import argparse
import json
import os
import sys
from pathlib import Path

from scene_bakes import Bakes, INPUT, NoReport, ROOT, materials_of, mean_of, relative_error, scenes_of, standard_error

PRESETS = ("preview", "normal", "high")
SEEDS = (1, 2, 3, 4)  # of the reference; an error from two, of one material, may well be ten times too small


def worse_presets(errors, own):
    """Those whose error is above that of a lower one by more than the reference can tell."""
    return [PRESETS[k] for k in range(1, len(errors)) if errors[k] > min(errors[:k]) + 3 * own]


def ladder(bakes, scene, finer):
    """Errors and CPU seconds of the presets, and the reference's own error."""
    reports = [bakes.report(scene, "--quality", preset) for preset in PRESETS]
    patches = str(round(finer * reports[-1]["patches"]))
    tables = [materials_of(bakes.report(scene, "--quality", "high", "--solver", "random-walk", "--patches", patches,
                                        "--seed", str(seed))) for seed in SEEDS]
    reference, own = mean_of(tables), standard_error(tables)
    errors = [relative_error(materials_of(report), reference) for report in reports]
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
        try:
            row = ladder(bakes, scene, arguments.finer)
        except NoReport as error:
            if error.code != INPUT:  # of which no light is the most likely
                sys.exit(f"{scene}: {error}")
            print(f"{scene.name:<28} left out: {error}", flush=True)
            continue
        rows.append(row)
        print(row_text(row), flush=True)
    if arguments.json:
        arguments.json.write_text(json.dumps(rows, indent=2) + "\n", encoding="utf-8")
    return 1 if any(row["worse"] for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
