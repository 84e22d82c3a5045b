#!/usr/bin/env python3
"""Mean irradiance of the Cornell box's surfaces, and of its variants', against an independent particle tracer."""
import math
import subprocess
import sys
import unittest

from lambert_cli import DATA, REPOSITORY, SCENES, ProgramTest, materials, relative_rms

BOX = DATA / "cornell_box.obj"
REFERENCE = DATA / "reference" / "cornell_surfaces.csv"
ONE_SURFACE = 0.015  # relative, any channel
ALL_SURFACES = 0.01  # area-weighted RMS over mean, any channel
FLUX = 0.01


def reference_surfaces():
    lines = [line for line in REFERENCE.read_text().splitlines() if not line.startswith("#")]
    return {name: tuple(map(float, values)) for name, *values in (line.split(",") for line in lines)}


def reference_flux(word):
    """The RGB fluxes of a comment, in Ke units × sr × m²."""
    line = next(line for line in REFERENCE.read_text().splitlines() if line.startswith(f"# {word} "))
    numbers = [float(text) for text in line.replace(",", " ").split() if text[0].isdigit()]
    return [1e-6 * number for number in numbers[:3]]


class Cornell(ProgramTest):
    def check(self, name, scene, *options):
        report = self.bake(scene, *options)
        found, expected = materials(report), reference_surfaces()
        self.assertEqual(set(found), set(expected))
        errors = {(surface, channel): found[surface]["mean_irradiance"][channel] / expected[surface][channel] - 1
                  for surface in expected for channel in range(3)}
        worst = max(errors, key=lambda key: abs(errors[key]))
        areas = [found[surface]["area"] for surface in expected]
        rms = max(relative_rms([found[surface]["mean_irradiance"][channel] for surface in expected],
                               [expected[surface][channel] for surface in expected], areas) for channel in range(3))
        print(f"{name:<24} {report['patches']:>6} patches   worst {100 * errors[worst]:+.2f} % ({worst[0]}, "
              f"{'rgb'[worst[1]]})   RMS {100 * rms:.2f} %   imbalance {100 * report['energy']['imbalance']:+.2f} %")
        self.assertLess(abs(errors[worst]), ONE_SURFACE)
        self.assertLess(rms, ALL_SURFACES)
        return report

    def variant(self, *options):
        """The box, changed by scripts/vary_scene.py."""
        path = self.folder / "variant.obj"
        subprocess.run([sys.executable, REPOSITORY / "scripts" / "vary_scene.py", BOX, path, *options], check=True)
        return path

    def test_box_has_the_reference_surfaces_and_fluxes(self):
        energy = self.check("box", BOX)["energy"]
        for word in ("emitted", "escaped"):
            for value, expected in zip(energy[word], reference_flux(word)):
                self.assert_close(value, expected, FLUX, word)

    def test_rotated_box(self):
        self.check("rotated by 37 degrees", self.variant("--rotate=1,2,3,37"))

    def test_box_with_a_wall_in_irregular_pieces(self):
        for seed in (1, 2):
            self.check(f"back in pieces, seed {seed}", self.variant("--subdivide", f"back={seed}"))

    @unittest.skipUnless(SCENES, "LAMBERT_SCENES is not set")
    def test_box_in_millimetres(self):
        self.check("millimetres", SCENES / "cornell_pcg_split" / "cornell_pcg_split.obj", "--unit", "0.001")


class TheReference(unittest.TestCase):
    def test_is_read_as_written(self):
        self.assertEqual(len(reference_surfaces()), 8)
        for found, radiance in zip(reference_flux("emitted"), (17, 12, 4)):
            self.assertTrue(math.isclose(found, math.pi * radiance * 0.13 * 0.105, rel_tol=1e-6))


if __name__ == "__main__":
    unittest.main()
