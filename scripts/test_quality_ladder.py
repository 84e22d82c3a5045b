#!/usr/bin/env python3
"""Checks of quality_ladder.py: python3 scripts/test_quality_ladder.py"""
import math
import tempfile
import unittest
from pathlib import Path

import quality_ladder as ladder


def report(**light):
    """Of materials of 1 m^2, lit alike in all channels."""
    return {"materials": [{"name": name, "area": 1, "mean_irradiance": [e, e, e]} for name, e in light.items()]}


class FakeBakes:
    """Errors that fall, and a reference of seeds that are off by own, to either side."""

    def __init__(self, by_preset, own):
        self.by_preset, self.own, self.asked = by_preset, own, []

    def report(self, _, *options):
        self.asked.append(options)
        if "random-walk" in options:
            light = 1 + (self.own if int(options[-1]) % 2 else -self.own)
        else:
            light = 1 + self.by_preset[options[1]]
        return {**report(wall=light), "patches": 100, "cpu": 1.0, "energy": {"imbalance": 0}}


class QualityLadder(unittest.TestCase):
    def test_error_is_relative_and_weighted_by_area(self):
        expected = {"a": (1.0, [2.0] * 3), "b": (3.0, [1.0] * 3)}
        found = {"a": (1.0, [2.0] * 3), "b": (3.0, [1.1] * 3)}
        self.assertAlmostEqual(ladder.relative_error(found, expected), math.sqrt(3 * .01 / 7), 12)
        self.assertEqual(ladder.relative_error(expected, expected), 0)

    def test_materials_of_one_name_count_together(self):
        twice = {"materials": report(a=1)["materials"] + report(a=3)["materials"]}
        self.assertEqual(ladder.materials_of(twice), {"a": (2, [2.0] * 3)})

    def test_a_preset_is_worse_only_beyond_the_references_error(self):
        self.assertEqual(ladder.worse_presets([.03, .01, .002], .001), [])
        self.assertEqual(ladder.worse_presets([.03, .0311, .0329], .001), [])
        self.assertEqual(ladder.worse_presets([.01, .03, .02], .001), ["normal", "high"])

    def test_a_ladder_bakes_three_presets_and_four_references(self):
        bakes = FakeBakes({"preview": .04, "normal": .01, "high": .02}, .001)
        row = ladder.ladder(bakes, Path("room.obj"), 4)
        for found, error in zip(row["errors"], (.04, .01, .02)):
            self.assertAlmostEqual(found, error, 12)
        self.assertAlmostEqual(row["own_error"], .001 / math.sqrt(3), 5)
        self.assertEqual(len(bakes.asked), 7)
        self.assertEqual(row["worse"], ["high"])
        self.assertIn("400", bakes.asked[-1])
        self.assertIn("worse: high", ladder.row_text(row))

    def test_scenes_of_one_name_are_one(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("box.obj", "box.gltf", "box.mtl", "room.mgf", "generate.py"):
                (Path(folder) / name).touch()
            self.assertEqual([path.name for path in ladder.scenes_of(Path(folder))], ["box.gltf", "room.mgf"])


if __name__ == "__main__":
    unittest.main()
