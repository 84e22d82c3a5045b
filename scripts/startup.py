#!/usr/bin/env python3
"""Prints what a start of the program costs: scripts/startup.py [--program FILE] [--runs 21]

CPU seconds (median) and memory (largest) of commands that do next to nothing. Exits with 1 above 50 ms or 30 MB.
"""
import argparse
import os
import statistics
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
COMMANDS = (("--version",), ("--help",), ("info", "data/cube6.obj"), ("bake", "--help"))
MOST_SECONDS, MOST_BYTES = .050, 30e6


def cost(program, words):
    """CPU seconds and bytes of one run."""
    with open(os.devnull, "w") as nowhere:
        process = subprocess.Popen([program, *words], cwd=ROOT, stdout=nowhere, stderr=nowhere)
        _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        sys.exit(f"startup: {' '.join(words)}: exit code {process.returncode}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", 1)[0])
    parser.add_argument("--program", default=str(ROOT / "build/cli/lambert"))
    parser.add_argument("--runs", type=int, default=21)
    arguments = parser.parse_args()
    program = str(Path(arguments.program).resolve())
    libraries = len(subprocess.run(["ldd", program], capture_output=True, text=True).stdout.splitlines())
    print(f"{libraries} shared libraries\n\n| command | CPU ms | MB |\n|---|---|---|")
    missed = False
    for words in COMMANDS:
        runs = [cost(program, words) for _ in range(arguments.runs)]
        seconds, size = statistics.median(run[0] for run in runs), max(run[1] for run in runs)
        missed |= seconds > MOST_SECONDS or size > MOST_BYTES
        print(f"| `lambert {' '.join(words)}` | {1e3 * seconds:.0f} | {size / 1e6:.1f} |")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
