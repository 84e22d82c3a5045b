"""What the scripts that make malformed scenes share."""
import argparse
from pathlib import Path
from typing import NamedTuple

SOUND_NAME = "sound"    # begins the names of scenes that must be baked: of one that is not, all mutations would be refused alike


class Case(NamedTuple):
    name: str               # of the scene's file, unique in its set
    content: bytes
    library: bytes = b""    # of an OBJ


def library_of(name):
    """The name of an OBJ's material library."""
    return name.rpartition(".")[0] + ".mtl"


def flipped(random_, content):
    """With up to eight bytes changed, removed, repeated or exchanged for a telling one."""
    content = bytearray(content)
    for _ in range(random_.randint(1, 8)):
        at = random_.randrange(len(content))
        kind = random_.randrange(4)
        if kind == 0:
            content[at] ^= 1 << random_.randrange(8)
        elif kind == 1:
            content[at] = random_.choice(b"\0\1\x7f\x80\xff09-.{}[]\",:")
        elif kind == 2:
            del content[at:at + random_.randint(1, 16)]
        else:
            content[at:at] = content[at:at + random_.randint(1, 16)]
        if not content:
            break
    return bytes(content)


def write(case, folder):
    """Writes a case and returns the path of its scene."""
    path = folder / case.name
    path.write_bytes(case.content)
    if case.library:
        (folder / library_of(case.name)).write_bytes(case.library)
    return path


def main(description, count, cases):
    """The program: writes what cases(count, seed) makes into a folder."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--count", type=int, default=count, help=f"of each kind [{count}]")
    parser.add_argument("--seed", type=int, default=1, help="[1]")
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    for case in cases(arguments.count, arguments.seed):
        write(case, arguments.folder)
    return 0
