#!/usr/bin/env python3
"""Keeps of a fuzzer's corpus the inputs that together reach most code: trim_corpus.py PROGRAM FOLDER [--most N].

Inputs that somebody named stay; libFuzzer's own have a hash for a name.
"""
import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path


def reached(program, folder):
    """For each input the features of the code that it reaches, as libFuzzer's merging numbers them."""
    with tempfile.TemporaryDirectory() as temporary:
        control, chosen = Path(temporary) / "control", Path(temporary) / "chosen"
        chosen.mkdir()
        subprocess.run([program, "-set_cover_merge=1", "-max_len=1048576", f"-merge_control_file={control}", chosen, folder],
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
        lines = control.read_text().splitlines()
    count = int(lines[0])   # then how many of them belong to `chosen`, the names, and what each reached
    names = [Path(name) for name in lines[2:2 + count]]
    features = {name: set() for name in names}
    for kind, index, *numbers in map(str.split, lines[2 + count:]):
        if kind == "FT":
            features[names[int(index)]] = set(numbers)
    return features


def most_telling(features, most):
    """Each time the input that adds most; of equals the smallest, then the first by name."""
    left, kept, known = dict(features), [], set()
    for name in features:
        if not re.fullmatch("[0-9a-f]{40}", name.name):
            known |= left.pop(name)
            kept.append(name)
    while left and len(kept) < most:
        best = min(left, key=lambda name: (-len(left[name] - known), name.stat().st_size, name))
        if not left[best] - known:
            break
        known |= left.pop(best)
        kept.append(best)
    return kept, known


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--most", type=int, default=40, help="inputs that are kept [40]")
    arguments = parser.parse_args()
    features = reached(arguments.program, arguments.folder)
    kept, known = most_telling(features, arguments.most)
    for path in set(arguments.folder.iterdir()) - set(kept):
        path.unlink()
    everything = set().union(*features.values())
    print(f"{arguments.folder}: kept {len(kept)} of {len(features)} inputs, which reach {len(known)} of {len(everything)} features")
    return 0


if __name__ == "__main__":
    sys.exit(main())
