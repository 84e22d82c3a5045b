#!/usr/bin/env python3
"""Checks of sensor_figures.py: python3 scripts/test_sensor_figures.py"""
import unittest

import sensor_figures as figures


class SensorFigures(unittest.TestCase):
    def test_error_is_relative_to_the_mean(self):
        expected = [[0] * 6 + [1, 1, 1, 0, 0, 0], [0] * 6 + [3, 3, 3, 0, 0, 0]]
        found = [[0] * 6 + [1.2] * 3 + [.1] * 3, [0] * 6 + [3] * 3 + [.1] * 3]
        error, stated, within = figures.statistics(found, expected)
        self.assertAlmostEqual(error, .2 / 2 ** .5 / 2, 12)
        self.assertAlmostEqual(stated, .05, 12)
        self.assertEqual(within, 1)

    def test_errors_beyond_two_stated_ones_are_counted(self):
        expected = [[0] * 6 + [1, 1, 1, .01, .01, .01]] * 4
        found = [[0] * 6 + [1 + d] * 3 + [.01] * 3 for d in (0, .02, .03, -.03)]
        self.assertEqual(figures.statistics(found, expected)[2], .5)

    def test_points_turn_with_the_scene(self):
        square = [("a", [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)])]
        (row,) = figures.turned([[1, 1, 0, 0, 0, 1]], square)
        for value, centre in zip(row[:3], (1, 1, 0)):
            self.assertAlmostEqual(value, centre, 12)
        self.assertAlmostEqual(sum(n * n for n in row[3:]), 1, 12)
        self.assertLess(row[5], .99)


if __name__ == "__main__":
    unittest.main()
