"""The real scenes: all are readable, and the brightness of the office matches another renderer."""

import os
import unittest
from pathlib import Path

from command import CommandTest

SCENES = Path(os.environ["INTERFLECT_SCENES"])
NAMES = ("office-graz", "office2", "cube", "corridor", "floor_gloss", "examp1")


class RealScenes(CommandTest):
    def test_are_all_read(self):
        for name in NAMES:
            with self.subTest(name=name):
                report = self.json("info", SCENES / f"{name}.mgf")
                self.assertGreater(report["patches"], 60)
                self.assertGreater(min(report["emitted_power"]), 0)


class OfficeGraz(CommandTest):
    def test_is_as_bright_as_a_path_tracer_finds_it(self):
        """reference/: Cycles, 4,096 samples a pixel. Its values are radiance M / (179 pi), ours luminance M / pi."""
        luminous_efficacy, tolerance = 179, 0.05
        view = ("--eye", "3.7037,0.0788,2.2690", "--look-at", "1.0023,8.9229,-1.1130")
        picture = ("--size", "240x135", "--rays", "5M", "--samples", "64", "--denoise", "--no-mirrors")
        self.interflect("render", SCENES / "office-graz.mgf", "-o", "out.hdr", *view, *picture, timeout=500)
        reference = SCENES / "reference" / "office-graz.cycles4096.240x135.hdr"
        difference = self.json("compare", "out.hdr", reference)
        self.assertEqual(difference["non_finite_pixels"], 0)
        self.assertAlmostEqual(difference["ratio_of_means"] / luminous_efficacy, 1, delta=tolerance)
        # The distribution of the light matches, not only its total.
        scaled = self.json("compare", "out.hdr", reference, "--scale")
        self.assertLess(scaled["blocks"][1]["trimmed_relative_rmse"], 0.05)  # measured: 0.035


if __name__ == "__main__":
    unittest.main()
