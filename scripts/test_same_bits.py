#!/usr/bin/env python3
"""Checks of same_bits.py: python3 scripts/test_same_bits.py"""
import json
import os
import sys
import tempfile
import unittest
from pathlib import Path

import same_bits as bits

PROGRAM = """#!{python}
import sys, time
from pathlib import Path
out = Path(sys.argv[sys.argv.index("-o") + 1])
out.write_bytes(b"{content}")
out.with_name("report.json").write_text('{{"seconds": {{"total": %f}}, "light": {light}}}' % time.time())
print("baked in", time.time(), "s")
"""


class SameBits(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = Path(self.folder.name)

    def result(self, name, content="light", light=1):
        """Of a program that writes this."""
        program = self.root / name
        program.write_text(PROGRAM.format(python=sys.executable, content=content, light=light))
        program.chmod(0o755)
        (self.root / f"of_{name}").mkdir()
        return bits.run(program, "-o {}/a.glb", self.root / f"of_{name}")

    def test_times_are_left_out(self):
        self.assertEqual(bits.differences(self.result("a"), self.result("b")), [])

    def test_bytes_and_numbers_are_compared(self):
        self.assertEqual(bits.differences(self.result("a"), self.result("b", content="dark")), ["a.glb"])
        self.assertEqual(bits.differences(self.result("c"), self.result("d", light=2)), ["report.json"])

    def test_columns_of_seconds_are_left_out(self):
        self.assertEqual(bits.without_varying_columns("method,cpu_seconds,error\na,1.5,2\n"), "method,error\na,2")

    def test_numbers_become_one_sign(self):
        self.assertEqual(bits.without_numbers("5 patches,  1.2e-05 off, 0.3 s"), bits.without_numbers("17 patches, 3 off, 120 ms"))

    @unittest.skipUnless("LAMBERT" in os.environ, "LAMBERT names no program")
    def test_a_program_is_the_same_as_itself(self):
        for name in ("csv", "info", "mistake"):
            results = []
            for side in "ab":
                (self.root / name / side).mkdir(parents=True)
                results.append(bits.run(os.environ["LAMBERT"], bits.COMMANDS[name], self.root / name / side))
            self.assertEqual(bits.differences(*results), [], name)
            self.assertEqual(results[0]["exit code"], 2 if name == "mistake" else 0)
        json.loads(results[0].get("report.json", b"{}"))


if __name__ == "__main__":
    unittest.main()
