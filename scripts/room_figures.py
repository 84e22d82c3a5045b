#!/usr/bin/env python3
"""Prints how right default bakes are, as a table: the irradiance of materials against random walks on the same patches.

    scripts/room_figures.py [--program FILE] [--options "--quality high"] [--walk-error .002] [--walk-seconds 60] [--rows 40]
                            [--done FILE] [SCENE...]

Without scenes: those of data/ and of LAMBERT_SCENES but the conference room. Columns:

  error %     of materials' mean irradiance: area-weighted RMS over materials and channels of the difference from the walks', over
              the RMS of the walks'
  walks %     standard error of the walks in the same measure, from WALKS seeds; as many walks as bring it to --walk-error, in at
              most --walk-seconds of CPU time or so
  mesh %      the same difference of walks on four times the patches from those on the bake's; it holds the noise of both
  imbalance % of energy, by the form factors as they were computed, before any repair
  correction  the largest, as a share, by which --repair closes a row, and in brackets by how much it changes rows in the mean: a
              patch that sees next to nothing makes the first large, only poor factors the second; "large": no room for it
  rows state  the mean row error that the factors state for themselves
  by rays     between what that error lies by 1e5 independent rays on each of --rows random rows, their own noise taken off; in brackets the
              standard error of the lower bound (row_check.py says how)
  CPU s       of the bake; then error and CPU seconds of the same with --method hemicube, the former default; last those of the walks

A scene that cannot be baked has a row that says why. --done leaves out scenes that have a row in a file of earlier output.
"""
import argparse
import os
import shlex
import sys
from pathlib import Path

from row_check import RowCheck
from scene_bakes import Bakes, NoReport, ROOT, all_scenes, materials_of, mean_of, mesh_options, relative_error, standard_error

WALKS = 4  # independent sets of them
FIRST_WALKS, MOST_WALKS = 1e6, 4e9
MOST_ENTRIES = 2.5e8  # of a matrix, which is written to a temporary file
HEADER = ["scene", "patches", "method", "error %", "walks %", "mesh %", "imbalance %", "correction", "rows state", "by rays", "CPU s",
          "hemicube error %", "hemicube CPU s", "walks CPU s"]


class Walks:
    """The light of materials by random walks: `light`, its standard `error`, `walks` of each seed, `patches` and `cpu` seconds."""

    def __init__(self, bakes, scene, mesh, walks, first_seed=1):
        reports = [bakes.report(scene, "--solver", "random-walk", "--rays", int(walks), *mesh, "--seed", first_seed + k)
                   for k in range(WALKS)]
        tables = [materials_of(report) for report in reports]
        self.light, self.error, self.walks = mean_of(tables), standard_error(tables), walks
        self.patches, self.cpu = reports[0]["patches"], sum(report["cpu"] for report in reports)


def exact_walks(bakes, scene, mesh, target, seconds):
    """As many as the error wants, or the time allows."""
    walks = Walks(bakes, scene, mesh, FIRST_WALKS)
    wanted = 1.5 * (walks.error / target) ** 2  # the error of four seeds is itself only known to a third or so
    allowed = min(seconds / walks.cpu, MOST_WALKS / FIRST_WALKS)
    if walks.error <= target or allowed < 1.2:
        return walks
    return Walks(bakes, scene, mesh, FIRST_WALKS * min(wanted, allowed), 1 + WALKS)


def factor_cells(bakes, scene, options, rows, baked):
    """Correction, what the rows state, and what rays say; `baked` is the bake's report of its factors."""
    if not rows or not baked["entries"]:
        return ["", "", ""]
    if baked["entries"] > MOST_ENTRIES:
        return ["large", f"{baked['mean_row_error']:.4f}", "large"]
    check = RowCheck(bakes, scene, options, rows)
    repair, stated = baked["repair"] or check.repair, check.report["row_error"]
    correction = f"{repair['largest_correction']:.2g} ({repair['row_change']:.4f})" if repair else "large"
    cells = [correction, f"{stated['mean']:.4f}" if stated["mean"] is not None else ""]
    if not check.bounds:
        return cells + ["no rows"]
    least, spread, most = check.error()
    return cells + [f"{least:.4f} ({spread:.4f}) to {most:.3f}"]


def cells_of(bakes, scene, options, arguments):
    """The cells of a scene after its name; ends early, with the reason, if something cannot be had."""
    cells = []
    try:
        report = bakes.report(scene, *options)
        cells = [str(report["patches"]), report["method"]]
        mesh = mesh_options(options)
        walks = exact_walks(bakes, scene, mesh, arguments.walk_error, arguments.walk_seconds)
        if walks.patches != report["patches"]:
            return cells + [f"walks took {walks.patches} patches"]
        finer = Walks(bakes, scene, ["--patches", 4 * report["patches"]], walks.walks)
        imbalance = report["energy"]["imbalance_before_repair"]
        if imbalance is None:
            imbalance = report["energy"]["imbalance"]
        cells += [f"{100 * relative_error(materials_of(report), walks.light):.2f}", f"{100 * walks.error:.2f}",
                  f"{100 * relative_error(finer.light, walks.light):.2f}", f"{100 * imbalance:.3f}"]
        try:
            cells += factor_cells(bakes, scene, options, arguments.rows, report["form_factors"])
        except NoReport as error:
            cells += [f"{error}", "", ""]
        cells.append(f"{report['cpu']:.1f}")
        former = bakes.report(scene, *mesh, "--method", "hemicube")
        cells += [f"{100 * relative_error(materials_of(former), walks.light):.2f}", f"{former['cpu']:.1f}",
                  f"{walks.cpu:.0f}"]
    except NoReport as error:
        cells.append(f"{error}")
    return cells


def line_of(cells):
    """Of the table; no cell may end its row."""
    return "| " + " | ".join(cell.replace("|", "/") for cell in cells) + " |"


def main():
    """The program."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=os.environ.get("LAMBERT", str(ROOT / "build/cli/lambert")))
    parser.add_argument("--options", default="", help="more options, not for the walks but for those of the mesh")
    parser.add_argument("--walk-error", type=float, default=.002, help="relative, of materials' irradiance [.002]")
    parser.add_argument("--walk-seconds", type=float, default=60, help="CPU time they may take, and again on the finer mesh [60]")
    parser.add_argument("--rows", type=int, default=40, help="of form factors to check by rays; 0: none [40]")
    parser.add_argument("--done", type=Path, help="earlier output; scenes in it are left out")
    parser.add_argument("scenes", nargs="*", type=Path)
    arguments = parser.parse_args()
    bakes = Bakes(arguments.program)
    done = arguments.done.read_text(encoding="utf-8") if arguments.done and arguments.done.exists() else ""
    if not done:
        print(line_of(HEADER) + "\n" + "|---" * len(HEADER) + "|", flush=True)
    for scene in arguments.scenes or all_scenes():
        if f"| {scene.name} |" not in done:
            print(line_of([scene.name] + cells_of(bakes, scene, shlex.split(arguments.options), arguments)), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
