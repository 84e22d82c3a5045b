#!/usr/bin/env python3
"""Checks of startup.py, and that the program still loads little: python3 scripts/test_startup.py"""
import os
import subprocess
import unittest

import startup


class Startup(unittest.TestCase):
    def test_costs_are_of_the_command_alone(self):
        seconds, size = startup.cost("/bin/true", ())
        self.assertLess(seconds, 1)
        self.assertGreater(size, 1e5)

    def test_a_command_that_fails_is_named(self):
        with self.assertRaisesRegex(SystemExit, "exit code 1"):
            startup.cost("/bin/false", ("--version",))

    @unittest.skipUnless("LAMBERT" in os.environ, "LAMBERT names no program")
    def test_the_program_loads_no_image_library(self):
        libraries = subprocess.run(["ldd", os.environ["LAMBERT"]], capture_output=True, text=True).stdout
        self.assertNotIn("OpenImageIO", libraries)
        self.assertLess(len(libraries.splitlines()), 40)


if __name__ == "__main__":
    unittest.main()
