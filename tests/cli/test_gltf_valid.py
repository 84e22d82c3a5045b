#!/usr/bin/env python3
"""What `lambert bake` writes as glTF passes the Khronos validator (tests/gltf/validate.sh)."""
import subprocess
import sys
import tempfile
from pathlib import Path

from lambert_cli import DATA, OK, REPOSITORY, SMALL, run

SCENES = ("cornell_box.gltf", "table_room.gltf", "furnace_box.obj")


def bake_all(folder):
    for scene in SCENES:
        for quantity in ("radiosity", "irradiance"):
            targets = [folder / f"{Path(scene).stem}_{quantity}.{kind}" for kind in ("glb", "gltf")]
            outputs = [word for target in targets for word in ("-o", target)]
            solution = folder / f"{Path(scene).stem}_{quantity}_solution.glb"
            done = run("bake", DATA / scene, *SMALL, "--quiet", "--quantity", quantity, *outputs,
                       "--keep-bounces", "--solution", solution)
            if done.returncode != OK:
                sys.exit(f"{scene}: {done.stderr}")
            yield from (*targets, solution)


def main():
    with tempfile.TemporaryDirectory() as name:
        files = list(bake_all(Path(name)))
        return subprocess.run([REPOSITORY / "tests" / "gltf" / "validate.sh", *files]).returncode


if __name__ == "__main__":
    sys.exit(main())
