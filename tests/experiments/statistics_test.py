"""The statistics of the experiments, against known values."""

import math
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "experiments"))

from paper import fig5_variants
from lab.analysis import statistics


class StudentT(unittest.TestCase):
    def test_tables(self):
        # Two-sided, as in printed tables of Student's distribution.
        for degrees, confidence, t in (
            (1, 0.95, 12.706),
            (2, 0.95, 4.303),
            (3, 0.95, 3.182),
            (4, 0.95, 2.776),
            (7, 0.95, 2.365),
            (30, 0.95, 2.042),
            (5, 0.90, 2.015),
            (4, 0.99, 4.604),
        ):
            self.assertAlmostEqual(statistics.student_t(degrees, confidence), t, delta=6e-4, msg=f"{degrees} degrees")

    def test_many_degrees_are_normal(self):
        self.assertAlmostEqual(statistics.student_t(100_000), 1.95997, delta=1e-4)


class Mean(unittest.TestCase):
    def test_interval(self):
        # Mean 5, sample standard deviation sqrt(5/2), t(4) = 2.776: half-width 2.776 sqrt(5/2 / 5).
        found = statistics.mean(np.array([3.0, 4.0, 5.0, 6.0, 7.0]))
        self.assertEqual(found.value, 5)
        self.assertAlmostEqual(found.half_width, 1.9633, delta=1e-3)
        self.assertEqual(str(found), "5 ± 2")

    def test_one_value_has_no_interval(self):
        found = statistics.mean(np.array([0.0123]))
        self.assertTrue(math.isnan(found.half_width))
        self.assertEqual(str(found), "0.0123")

    def test_covers_as_often_as_it_says(self):
        # 4,000 intervals of 5 normal samples: 95% cover the mean, within 4 standard deviations of the binomial (1.4%).
        samples = np.random.default_rng(1).normal(10, 3, (4000, 5))
        intervals = [statistics.mean(row) for row in samples]
        covering = np.mean([abs(m.value - 10) < m.half_width for m in intervals])
        self.assertAlmostEqual(covering, 0.95, delta=0.014)


class PowerLaw(unittest.TestCase):
    def test_exact(self):
        x = np.array([1e5, 1e6, 1e7])
        law = statistics.fit_power_law(x, 7 * x**-0.5)
        self.assertAlmostEqual(law.slope, -0.5)
        self.assertAlmostEqual(law.factor, 7, places=6)
        self.assertLess(law.half_width, 1e-9)
        self.assertAlmostEqual(law(4e6), 7 / 2e3)

    def test_textbook_interval(self):
        # log x = 1, 2, 3, 4, 5 and log y = 2, 4, 5, 4, 5: slope 0.6, residual sum of squares 2.4, so the slope's
        # standard error is sqrt(2.4 / 3 / 10) = 0.2828; t(3) = 3.182.
        law = statistics.fit_power_law(np.exp([1, 2, 3, 4, 5]), np.exp([2, 4, 5, 4, 5]))
        self.assertAlmostEqual(law.slope, 0.6)
        self.assertAlmostEqual(law.half_width, 0.9001, delta=1e-3)


class Curve(unittest.TestCase):
    def test_pooled_band(self):
        # Logarithms 0 and 2 at the first budget, 5 at the second: pooled variance 2 with one degree of freedom.
        found = statistics.curve([(np.array([1.0, 4.0]), np.exp([0.0, 2.0])), (np.array([9.0]), np.exp([5.0]))])
        np.testing.assert_allclose(found.x, [2, 9])
        np.testing.assert_allclose(np.log(found.y), [1, 5])
        np.testing.assert_allclose(found.spread, [1, math.sqrt(2)])
        np.testing.assert_allclose(np.log(found.band), [12.706, 12.706 * math.sqrt(2)], rtol=1e-4)

    def test_one_seed_has_no_band(self):
        found = statistics.curve([(np.array([1.0]), np.array([2.0]))])
        self.assertTrue(np.isnan(found.band).all())

    def test_ratio(self):
        x = np.array([1.0, 100.0])
        above = statistics.Curve(x, np.array([8.0, 2.0]), np.array([0.03, 0.03]), 4)
        below = statistics.Curve(x, np.array([2.0, 2.0]), np.array([0.04, 0.04]), 9)
        ratio = statistics.ratio_at(above, below, 10)  # midpoint in logarithms: 4 over 2
        self.assertAlmostEqual(ratio.value, 2)
        self.assertAlmostEqual(math.log(ratio.high / ratio.value), 2.776 * 0.05, delta=1e-4)
        self.assertAlmostEqual(ratio.high / ratio.value, ratio.value / ratio.low)

    def test_mean_ratio(self):
        # Logarithms 1, 2, 3: mean 2, standard error 1 / sqrt(3); t(2) = 4.303.
        ratio = statistics.mean_ratio(np.exp([1.0, 2.0, 3.0]))
        self.assertAlmostEqual(math.log(ratio.value), 2)
        self.assertAlmostEqual(math.log(ratio.high), 2 + 4.303 / math.sqrt(3), delta=1e-3)
        self.assertAlmostEqual(math.log(ratio.low), 2 - 4.303 / math.sqrt(3), delta=1e-3)
        self.assertEqual(str(statistics.mean_ratio(np.array([0.5]))), "0.50")


class Effects(unittest.TestCase):
    def test_of_each_choice(self):
        factors = {"si": 3, "ci": 2, "hi": 5, "dr": 0.5}
        names = ["si", "si+dr", "si+hi", "si+dr+hi", "ci", "ci+dr", "ci+hi", "ci+dr+hi"]
        rows = [
            {
                "series": name,
                "budget": 1e6,
                "seed": seed,
                fig5_variants.DISTANCE: math.prod(factors[f] for f in name.split("+")),
            }
            for name in names
            for seed in (1, 2)
        ]
        with tempfile.TemporaryDirectory() as folder:
            fig5_variants.write_effects(names, rows, Path(folder))
            lines = (Path(folder) / "fig5-variants-effects.md").read_text().splitlines()[2:]
        cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
        self.assertEqual([c[2] for c in cells], ["1.50 (1.50 to 1.50)", "5.00 (5.00 to 5.00)", "0.50 (0.50 to 0.50)"])
        self.assertEqual([c[3].count("1.50") for c in cells], [4, 0, 0])


class Crossing(unittest.TestCase):
    def test_between_points(self):
        x, y = np.array([1e6, 4e6, 16e6]), np.array([0.08, 0.02, 0.005])  # y = 0.08e6 / x
        found, extrapolated = statistics.crossing(x, y, 0.01)
        self.assertAlmostEqual(found / 8e6, 1)
        self.assertFalse(extrapolated)

    def test_beyond_them(self):
        x, y = np.array([1e6, 4e6, 16e6]), np.array([0.08, 0.02, 0.005])
        for target, rays in ((0.001, 80e6), (0.16, 0.5e6)):
            found, extrapolated = statistics.crossing(x, y, target)
            self.assertAlmostEqual(found / rays, 1)
            self.assertTrue(extrapolated)


if __name__ == "__main__":
    unittest.main()
