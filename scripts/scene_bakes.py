"""Bakes of scenes for scripts that measure them: which scenes, with which options, what they report and what they cost."""
import json
import math
import os
import resource
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FORMATS = (".gltf", ".glb", ".obj", ".mgf", ".ply")
MISSED, INPUT, SYSTEM = 1, 3, 4  # of the program's exit codes
UNITS = {"cornell_pcg.obj": ".001", "cornell_pcg_split.obj": ".001"}
SKIES = {"window_room.gltf": "1,1,1"}  # of scenes with no light of their own
MESH_OPTIONS = ("--patches", "--patch-length", "--quality")


def scene_options(command, scene):
    """Those that a scene needs in any case."""
    name = Path(scene).name
    options = ["--unit", UNITS[name]] if name in UNITS else []
    return options + (["--sky", SKIES[name]] if name in SKIES and command != "formfactors" else [])


def mesh_options(options):
    """Those, with their values, that say what the patches are."""
    return [word for k, word in enumerate(options) if word in MESH_OPTIONS or k and options[k - 1] in MESH_OPTIONS]


def scenes_of(folder):
    """One file per scene: those of one name are one scene."""
    found = {}
    for path in sorted(folder.iterdir(), key=lambda p: (p.stem, FORMATS.index(p.suffix) if p.suffix in FORMATS else 99)):
        if path.suffix in FORMATS:
            found.setdefault(path.stem, path)
    return list(found.values())


def all_scenes():
    """Those of data/, and of LAMBERT_SCENES those of other names, without the conference room, which has no light."""
    scenes = scenes_of(ROOT / "data")
    folder = os.environ.get("LAMBERT_SCENES")
    if folder:
        names = {path.stem for path in scenes}
        for inner in sorted(path for path in Path(folder).iterdir() if path.is_dir() and path.name != "conference"):
            scenes += [path for path in scenes_of(inner) if path.stem not in names]
    return scenes


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


def mean_of(tables):
    """Of tables of the same materials."""
    return {name: (area, [sum(table[name][1][c] for table in tables) / len(tables) for c in range(3)])
            for name, (area, _) in tables[0].items()}


def standard_error(tables):
    """Of the mean of independent tables, in the measure of relative_error()."""
    mean = mean_of(tables)
    squares = sum(relative_error(table, mean) ** 2 for table in tables)
    return math.sqrt(squares / (len(tables) - 1) / len(tables))


class NoReport(Exception):
    """What the program said instead."""

    def __init__(self, message, code):
        super().__init__(message)
        self.code = code


class Bakes:
    """Runs the program; `options` go to every run."""

    def __init__(self, program, options=()):
        self.program, self.options = program, list(options)

    def run(self, command, scene, *options):
        """The JSON report of the command, with `cpu` seconds; raises NoReport."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "report.json"
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            done = subprocess.run([str(self.program), command, str(scene), "--quiet", "--json", str(path),
                                   *scene_options(command, scene), *map(str, options), *self.options],
                                  stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace", check=False)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            if done.returncode not in (0, MISSED) or not path.exists():
                raise NoReport((done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1], done.returncode)
            report = json.loads(path.read_text(encoding="utf-8"))
        report["cpu"] = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        return report

    def report(self, scene, *options):
        """Of a bake."""
        return self.run("bake", scene, *options)
