#!/usr/bin/env python3
"""Bakes every scene of many sets and checks that each ends well, see docs/robustness.md:

    scripts/campaign.py                       the whole campaign on build/cli/lambert
    scripts/campaign.py --sets gltf data      some sets
    scripts/campaign.py FILE...               these scenes only

A scene ends well if it is baked into a file that Lambert reads again, or refused with exit code 3 and one line on stderr,
within the limits of time and memory. Ends with 1 if one does not.
"""
import argparse
import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path
from typing import NamedTuple

import mutate_gltf
import mutate_scene
from mutation import SOUND_NAME, write

REPOSITORY = Path(__file__).resolve().parents[1]
EXTENSIONS = (".obj", ".gltf", ".glb", ".ply", ".stl", ".mgf")
# The whole path in as little time as it takes: the rule is about broken files, not about large sound ones.
CHEAP = ("--patches", "200", "--resolution", "4", "--curve-segments", "8", "--threads", "1", "--quiet")
NO_LIGHT = "--emit"     # names the option in the refusal of a scene without light
PATIENCE = 6            # a run is stopped after so many times its limit
OK, MISSED, INPUT = 0, 1, 3


class Limits(NamedTuple):
    seconds: float          # of processor time
    mebibytes: float        # resident
    sanitized: bool         # libraries may print and shadow memory does not count


class Run(NamedTuple):
    """How one run of the program ended."""
    code: int               # of exit, negative for a signal
    stderr: list            # lines
    seconds: float          # of processor time, the system's included: the machine may be busy with other things
    wall: float             # seconds
    mebibytes: float        # largest resident


class Outcome(NamedTuple):
    scene: str
    end: str                # baked, refused, crash or violation
    reason: str             # of anything but baked
    seconds: float          # of processor time, of the longest of its runs
    wall: float             # the same
    mebibytes: float


# ---- One scene

def run(program, arguments, limits):
    # Far above what is allowed: for the machine's sake, not for the measurement.
    def protect_machine():
        cpu = int(PATIENCE * limits.seconds)
        resource.setrlimit(resource.RLIMIT_CPU, (cpu, cpu))
        if not limits.sanitized:
            resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    with tempfile.TemporaryFile() as errors:
        start = time.monotonic()
        child = subprocess.Popen([program, *map(str, arguments)], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                 stderr=errors, preexec_fn=protect_machine)
        timer = threading.Timer(PATIENCE * limits.seconds, os.kill, (child.pid, signal.SIGKILL))
        timer.start()
        _, status, usage = os.wait4(child.pid, 0)
        timer.cancel()
        child.returncode = os.waitstatus_to_exitcode(status)
        wall = time.monotonic() - start
        errors.seek(0)
        lines = errors.read().decode(errors="replace").splitlines()
    return Run(child.returncode, lines, usage.ru_utime + usage.ru_stime, wall, usage.ru_maxrss / 1024)


def broken_rule(done, limits):
    """What is wrong with how a run ended: ("crash" or "violation", reason), or None."""
    report = [line for line in done.stderr if "ERROR: AddressSanitizer" in line or "runtime error: " in line or
              "LeakSanitizer" in line]
    if report:
        return "crash", report[0]
    if done.seconds > limits.seconds:
        return "violation", f"{done.seconds:.1f} s"
    if done.wall > PATIENCE * limits.seconds:
        return "violation", f"stopped after {done.wall:.1f} s, {done.seconds:.1f} s of them at work"
    if done.code < 0:
        return "crash", signal.Signals(-done.code).name
    last = done.stderr[-1] if done.stderr else "nothing on stderr"
    if done.code not in (OK, MISSED, INPUT):  # few pixels miss the balance of energy
        return "violation", f"exit code {done.code}: {last}"
    if done.mebibytes > limits.mebibytes and not limits.sanitized:
        return "violation", f"{done.mebibytes:.0f} MiB"
    lines = [line for line in done.stderr if not line.startswith("warning: ")]
    refusals = [line for line in lines if line.startswith("lambert: ")]
    others = len(lines) - len(refusals) if not limits.sanitized else 0
    if len(refusals) != (done.code == INPUT) or others:
        return "violation", f"{len(lines)} lines on stderr: {' | '.join(lines[:3])}"
    return None


def read_json(path):
    return json.loads(path.read_text(encoding="utf-8"))


def emission(report):
    """--emit for a scene that has no light of its own: on the material with the largest area."""
    largest = max(report["materials"], key=lambda material: material["area"])
    return "--emit", f"{largest['name']}=1,1,1"


def attempt(program, scene, folder, limits):
    """Bakes, if need be once more with a light, and reads the result again."""
    report, output = folder / "report.json", folder / "out.glb"
    for leftover in (report, output):
        leftover.unlink(missing_ok=True)
    runs = []

    def step(*arguments):
        """Runs the program; an Outcome if the scene's attempt ends here, badly or with a refusal."""
        runs.append(run(program, arguments, limits))
        if bad := broken_rule(runs[-1], limits):
            return outcome(bad[0], f"{arguments[0]}: {bad[1]}")
        return outcome("refused", runs[-1].stderr[-1]) if runs[-1].code == INPUT else None

    def outcome(end, reason=""):
        return Outcome(str(scene), end, reason, max(r.seconds for r in runs), max(r.wall for r in runs),
                       max(r.mebibytes for r in runs))

    bake = ("bake", scene, "-o", output, *CHEAP, "--json", report)
    end = step(*bake)
    if end and end.end == "refused" and NO_LIGHT in end.reason:
        end = step("info", scene, "--json", report, "--quiet") or step(*bake, *emission(read_json(report)))
    if end:
        return end
    read_json(report)
    end = step("info", output, "--quiet")
    return outcome("violation", "the result: " + end.reason) if end else outcome("baked")


# ---- Sets of scenes: functions that write what has to be written into a folder and return the scenes' paths

def scenes_below(folder):
    return sorted(path for path in Path(folder).rglob("*") if path.suffix.lower() in EXTENSIONS)


def assimp_models(_folder, _share, _seed):
    return scenes_below("/usr/share/assimp/models")


def own_scenes(_folder, _share, _seed):
    return [path for path in scenes_below(REPOSITORY / "data") if REPOSITORY / "data" / "fuzz" not in path.parents]


def corpus(folder, _share, _seed):
    """The inputs of tests/fuzz as files: what follows the mark is the file that the scene names."""
    companions = {"obj": "scene.mtl", "gltf": "scene.bin", "mgf": "scene.inc"}
    scenes = []
    for path in sorted((REPOSITORY / "data" / "fuzz").glob("*/*")):
        kind = path.parent.name
        if "." + kind not in EXTENSIONS:
            continue
        place = folder / kind / path.name
        place.mkdir(parents=True)
        content, mark, companion = path.read_bytes().partition(b"\n=====\n")
        if mark and kind in companions:
            (place / companions[kind]).write_bytes(companion)
        scenes.append(place / f"scene.{kind}")
        scenes[-1].write_bytes(content)
    return scenes


def malformed_gltf(folder, share, seed):
    return [write(case, folder) for case in mutate_gltf.cases(max(1, int(800 * share)), seed)]


def malformed(kind):
    def make(folder, share, seed):
        return [write(case, folder) for case in mutate_scene.cases(kind, max(1, int(200 * share)), seed)]
    return make


SETS = {"data": own_scenes, "assimp": assimp_models, "gltf": malformed_gltf,
        **{kind: malformed(kind) for kind in mutate_scene.FORMATS}, "corpus": corpus}


# ---- The campaign

def campaign(program, scenes, folder, limits, verbose):
    outcomes = []
    for scene in scenes:
        outcome = attempt(program, scene, folder, limits)
        if outcome.end == "refused" and scene.name.startswith(SOUND_NAME):
            outcome = outcome._replace(end="violation", reason="a sound scene: " + outcome.reason)
        outcomes.append(outcome)
        if verbose or outcome.end in ("crash", "violation"):
            print(f"{outcome.end:9} {outcome.seconds:5.2f} s {outcome.mebibytes:5.0f} MiB  {outcome.scene}  {outcome.reason}",
                  flush=True)
    return outcomes


def summary(outcomes):
    count = lambda end: sum(outcome.end == end for outcome in outcomes)
    return {"files": len(outcomes), "baked": count("baked"), "refused": count("refused"), "crashes": count("crash"),
            "violations": count("violation"), "seconds": max((o.seconds for o in outcomes), default=0.0),
            "wall": max((o.wall for o in outcomes), default=0.0),
            "mebibytes": max((o.mebibytes for o in outcomes), default=0.0)}


def print_table(summaries):
    print("| set | files | baked | refused | crashes | violations | longest | largest |\n|---|---|---|---|---|---|---|---|")
    for name, s in summaries.items():
        print(f"| {name} | {s['files']} | {s['baked']} | {s['refused']} | {s['crashes']} | {s['violations']} | "
              f"{s['seconds']:.1f} s | {s['mebibytes']:.0f} MiB |")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", type=Path, metavar="FILE")
    parser.add_argument("--program", default=os.environ.get("LAMBERT", REPOSITORY / "build" / "cli" / "lambert"))
    parser.add_argument("--sets", nargs="+", choices=SETS, default=list(SETS), metavar="SET", help=", ".join(SETS))
    parser.add_argument("--share", type=float, default=1.0, help="of the malformed files that are made, 0 to 1 [1]")
    parser.add_argument("--seed", type=int, default=1, help="of the malformed files [1]")
    parser.add_argument("--seconds", type=float, default=10.0, help="of processor time, limit for each run [10]")
    parser.add_argument("--mebibytes", type=float, default=1024.0, help="limit for each run [1024]")
    parser.add_argument("--sanitized", action="store_true", help="the program is a sanitizer build: ten times as long, any memory")
    parser.add_argument("--json", type=Path, help="writes all outcomes", metavar="FILE")
    parser.add_argument("--keep", type=Path, help="keeps the scenes that were made in this folder", metavar="FOLDER")
    parser.add_argument("--verbose", action="store_true", help="one line for each scene")
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    limits = Limits(arguments.seconds * (10 if arguments.sanitized else 1), arguments.mebibytes, arguments.sanitized)
    outcomes = {}
    with tempfile.TemporaryDirectory() as temporary:
        made = arguments.keep or Path(temporary) / "scenes"
        if arguments.scenes:
            outcomes["given"] = campaign(arguments.program, arguments.scenes, Path(temporary), limits, arguments.verbose)
        for name in () if arguments.scenes else arguments.sets:
            (made / name).mkdir(parents=True, exist_ok=True)
            scenes = SETS[name](made / name, arguments.share, arguments.seed)
            outcomes[name] = campaign(arguments.program, scenes, Path(temporary), limits, arguments.verbose)
    summaries = {name: summary(of_set) for name, of_set in outcomes.items()}
    summaries["all"] = summary([outcome for of_set in outcomes.values() for outcome in of_set])
    print_table(summaries)
    if arguments.json:
        arguments.json.write_text(json.dumps({
            "summary": summaries, "outcomes": {name: [o._asdict() for o in of_set] for name, of_set in outcomes.items()}}, indent=1))
    return 1 if summaries["all"]["crashes"] + summaries["all"]["violations"] else 0


if __name__ == "__main__":
    sys.exit(main())
