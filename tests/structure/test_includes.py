#!/usr/bin/env python3
"""The list of folders in CONTRIBUTING.md is the house as it is: each folder of product code stands in it once, includes itself and
folders above it only, and everything that is included is there."""
import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def listed_folders(text):
    """The folders of the first table, in its order."""
    table = text[text.index("## Where things are"):].split("\n\n")
    rows = next(block for block in table if block.startswith("| folder"))
    return [name for row in rows.splitlines()[2:] for name in re.findall(r"`([a-z/]+)/`", row.split("|")[1])]


def room_of(path, folders):
    """The innermost listed folder that holds the file; None if there is none."""
    parents = [str(parent) for parent in Path(path).parents]
    return next((parent for parent in parents if parent in folders), None)


def included(text):
    return re.findall(r'^\s*#\s*include\s+"([^"]+)"', text, re.MULTILINE)


def faults(files, folders):
    """What is wrong with `files` (path: content), one line each."""
    rank = {folder: k for k, folder in enumerate(folders)}
    found = []
    for path, text in sorted(files.items()):
        room = room_of(path, folders)
        if room is None:
            found.append(f"{path}: its folder is not in the list")
            continue
        for name in included(text):
            target = room_of(name, folders)
            if name not in files:
                found.append(f"{path}: includes {name}, which does not exist")
            elif rank[target] > rank[room]:
                found.append(f"{path}: includes {name}, but {room}/ stands above {target}/")
    return found


def product_files(folders):
    tops = {folder.split("/")[0] for folder in folders}
    return {str(file.relative_to(ROOT)): file.read_text() for top in sorted(tops) for file in (ROOT / top).rglob("*")
            if file.suffix in (".h", ".cpp")}


class House(unittest.TestCase):
    def setUp(self):
        self.folders = listed_folders((ROOT / "CONTRIBUTING.md").read_text())

    def test_is_as_listed(self):
        files = product_files(self.folders)
        self.assertGreater(len(files), 300)
        self.assertEqual(faults(files, self.folders), [])

    def test_has_no_folder_that_is_empty_or_listed_twice(self):
        self.assertEqual(len(set(self.folders)), len(self.folders))
        rooms = {room_of(path, self.folders) for path in product_files(self.folders)}
        self.assertEqual(sorted(set(self.folders) - rooms), [])

    def test_built_folders_are_listed(self):
        """Folders of the build, which are the first parts of those in the list, stand in the same order."""
        text = (ROOT / "CMakeLists.txt").read_text()
        built = re.search(r"foreach\(folder ([^)]*)\)", text).group(1).split()
        self.assertEqual(built, list(dict.fromkeys(folder.split("/")[0] for folder in self.folders)))


class Check(unittest.TestCase):
    def test_sees_an_upward_include_and_a_missing_file(self):
        files = {"a/x.h": '#include "b/y.h"\n', "b/y.h": '#include "a/x.h"\n#include "b/none.h"\n', "c/z.h": ""}
        self.assertEqual(faults(files, ["a", "b"]),
                         ["a/x.h: includes b/y.h, but a/ stands above b/", "b/y.h: includes b/none.h, which does not exist",
                          "c/z.h: its folder is not in the list"])

    def test_knows_inner_folders(self):
        files = {"a/x.h": "", "a/in/y.h": '#include "a/x.h"\n', "a/z.h": '#include "a/in/y.h"\n'}
        self.assertEqual(faults(files, ["a", "a/in"]), ["a/z.h: includes a/in/y.h, but a/ stands above a/in/"])


if __name__ == "__main__":
    sys.exit(unittest.main())
