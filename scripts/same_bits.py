#!/usr/bin/env python3
"""Whether two programs, as of two versions, write the same bytes: scripts/same_bits.py BEFORE AFTER [--keep FOLDER] [--only WORD]

Runs some thirty commands of each (bakes in all formats and by all methods, with lights apart, skies and textures; matrices, groups and
heat; probes; pages of comparisons; what `info` says) on scenes of data/, and compares all files that they write, the words that they
print, and their exit codes. Left out is what cannot be the same twice: seconds and memory in JSON and CSV, and in pages plots over
seconds and the text, whose numbers stand in their results.json. Prints one line per command; exits with 1 if anything differs.
"""
import argparse
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

DATA = Path(__file__).resolve().parent.parent / "data"
VARYING = ("second", "memory", "cpu", "wall", "cost", "version")  # of JSON and CSV names

BAKES = {
    "box": "cornell_box.gltf --patches 1500 -o {}/a.glb -o {}/a.gltf -o {}/a.ply -o {}/a.obj --image {}/a.png --solution {}/s.glb",
    "box picture": "cornell_box.obj --patches 800 --image {}/a.exr --size 64x48",
    "table": "table_room.gltf --quality preview -o {}/a.glb --image {}/a.png --per-light",
    "textures": "textured_room.gltf --patches 1500 -o {}/a.glb --per-light --solution {}/s.glb",
    "mgf": "classic_room.mgf --quality preview -o {}/a.ply",
    "ply": "furnace_box.ply --patches 300 --emit *=1,1,1 -o {}/a.obj",
    "stl": "furnace_box.stl --patches 300 --emit *=1,1,1 -o {}/a.glb",
    "polygons": "cornell_box.obj --patches 0 -o {}/a.glb",
    "hemicube": "corridor.gltf --patches 900 --method hemicube --repair -o {}/a.glb",
    "closed form": "cube6.obj --patches 200 --method closed-form --solver jacobi --keep-bounces -o {}/a.glb --solution {}/s.glb",
    "rows": "cornell_box.obj --patches 300 --storage none --solver southwell --method hemicube -o {}/a.glb",
    "global lines": "cornell_box.obj --patches 400 --method global-lines --lines 400000 --solver gauss-seidel -o {}/a.glb",
    "sky": "window_room.gltf --quality preview --sky clear --sun 135,35 -o {}/a.glb --image {}/a.png",
    "stochastic": "block_of_rooms.obj --quality preview --solver stochastic -o {}/a.glb --solution {}/s.glb",
    "global stochastic": "table_room.obj --patches 900 --solver stochastic --method global-lines --rays 1000000 -o {}/a.glb",
    "walks": "textured_room.obj --patches 900 --solver random-walk --rays 300000 --per-light -o {}/a.glb",
    "virtual lights": "cornell_box.gltf --patches 400 --method instant-radiosity --vpls 256 --compensate -o {}/a.glb",
    "black": "cornell_box.gltf --patches 300 --reflectance *=0,0,0 --emit light=0,0,0 --sky 1,1,1 -o {}/a.glb",
}
COMMANDS = {
    **{name: f"bake {DATA}/{words} --json {{}}/report.json" for name, words in BAKES.items()},
    "batch": f"bake {DATA}/cube6.obj {DATA}/tetrahedron.obj --quality preview --output-dir {{}} --json {{}}/report.json",
    "prediction": f"bake {DATA}/cornell_box.obj --dry-run -o {{}}/a.glb",
    "matrix": f"formfactors {DATA}/cornell_box.obj --patches 300 -o {{}}/m.mtx --json {{}}/report.json",
    "dense matrix": f"formfactors {DATA}/table_room.obj --patches 400 --method local-lines -o {{}}/m.npy --json {{}}/report.json",
    "csv": f"formfactors {DATA}/cube6.obj --patches 0 --method closed-form -o {{}}/m.csv",
    "view3d": f"formfactors {DATA}/cornell_box.obj --patches 200 --method hemisphere -o {{}}/m.txt",
    "groups": f"formfactors {DATA}/table_room.gltf --quality preview --group-by material -o {{}}/groups.csv --json {{}}/report.json",
    "heat": f"formfactors {DATA}/cube6.obj --patches 60 --group-by material --temperatures {{}}/temperatures.csv -o {{}}/groups.csv "
            "--json {}/report.json",
    "probe": f"probe {DATA}/cornell_box.obj {{}}/points.csv --quality preview -o {{}}/light.csv --json {{}}/report.json",
    "probe by lines": f"probe {DATA}/cornell_box.obj {{}}/points.csv --solver stochastic --quality preview -o {{}}/light.csv",
    "page of form factors": f"compare formfactors {DATA}/cube6.obj --patches 60 --seeds 2 -o {{}}/page --efforts hemicube=16,32 "
                            "--methods hemicube,local-lines --size 96x96",
    "page of virtual lights": f"compare vpl {DATA}/cornell_box.obj --patches 200 --seeds 3 --vpls 64 -o {{}}/page --size 64x64",
    "info": f"info {DATA}/textured_room.gltf --json {{}}/report.json",
    "verify": "verify",
    "mistake": f"bake {DATA}/cornell_box.gltf --quality best",
}
TEMPERATURES = "x0,300,0.8\nx1,400,0.5\ny0,adiabatic\ny1,300,1\nz0,350,0.9\nz1,290,0.3\n"
POINTS = "278,0,279.5,0,1,0\n100,300,200,0,0,1\n278,548,100,0,-1,0\n"


def without_varying(value):
    if isinstance(value, dict):
        return {key: without_varying(inner) for key, inner in value.items() if not any(word in key.lower() for word in VARYING)}
    return [without_varying(inner) for inner in value] if isinstance(value, list) else value


def without_varying_columns(text):
    rows = [row.split(",") for row in text.splitlines()]
    if not rows:
        return text
    kept = [k for k, name in enumerate(rows[0]) if not any(word in name.lower() for word in VARYING)]
    return "\n".join(",".join(row[k] for k in kept if k < len(row)) for row in rows)


def comparable(path, folder):
    """The file's content without what cannot be the same twice."""
    content = path.read_bytes()
    if path.suffix == ".json":
        text = json.dumps(without_varying(json.loads(content)))
        return text.replace(str(folder), "").encode()
    if path.name == "results.csv":
        return without_varying_columns(content.decode()).encode()
    if path.suffix == ".html":  # its words tell what was faster in this run; numbers are in results.json, pictures lie beside it
        return "".join(re.findall(r"<h[1-4].*?</h[1-4]>", content.decode(), flags=re.DOTALL)).encode()
    return content


def without_numbers(text):
    """Each number, with its unit of time or size, as one sign, and spaces as one."""
    return re.sub(r"\s+", " ", re.sub(r"[-+−]?\b[0-9][0-9.,e+−-]*( ?(ms|s|min|h|k|[kMG]i?B|[MG]))?\b", "#", text))


def run(program, words, folder):
    (folder / "points.csv").write_text(POINTS)
    (folder / "temperatures.csv").write_text(TEMPERATURES)
    done = subprocess.run([str(program)] + [word.replace("{}", str(folder)) for word in words.split()], capture_output=True, text=True)
    files = {str(path.relative_to(folder)): comparable(path, folder) for path in sorted(folder.rglob("*"))
             if path.is_file() and "seconds" not in path.name}
    return {"exit code": done.returncode, "prints": without_numbers(done.stdout.replace(str(folder), "")),
            "says": without_numbers(done.stderr.replace(str(folder), "")), **files}


def differences(before, after):
    return [name for name in sorted(before.keys() | after.keys()) if before.get(name) != after.get(name)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", 1)[0])
    parser.add_argument("before")
    parser.add_argument("after")
    parser.add_argument("--keep", help="folder in which the files stay")
    parser.add_argument("--only", default="", help="commands whose name has this in it")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        root = Path(arguments.keep or temporary)
        different = 0
        for name, words in COMMANDS.items():
            if arguments.only not in name:
                continue
            results = []
            for side, program in (("before", arguments.before), ("after", arguments.after)):
                folder = root / side / name.replace(" ", "_")
                folder.mkdir(parents=True, exist_ok=True)
                results.append(run(Path(program).resolve(), words, folder))
            found = differences(*results)
            different += bool(found)
            print(f"{name}: " + (f"differs in {', '.join(found)}" if found else
                                 f"same ({len(results[0]) - 3} files, exit code {results[0]['exit code']})"), flush=True)
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
