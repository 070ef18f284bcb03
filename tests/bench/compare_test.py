"""Conclusions of bench/compare; noise must stay inconclusive."""

import importlib.machinery
import importlib.util
import random
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "bench" / "compare"
loader = importlib.machinery.SourceFileLoader("compare", str(SCRIPT))
compare = importlib.util.module_from_spec(importlib.util.spec_from_loader("compare", loader))
loader.exec_module(compare)


class MedianInterval(unittest.TestCase):
    def test_of_tables(self):
        # Ranks of the 99% interval of a median, as printed in tables of the sign test.
        self.assertEqual(compare.median_interval(range(1, 9), 0.99), (1, 8))
        self.assertEqual(compare.median_interval(range(1, 16), 0.99), (3, 13))
        self.assertEqual(compare.median_interval(range(1, 21), 0.95), (6, 15))

    def test_of_too_few(self):
        for n in range(8):
            self.assertIsNone(compare.median_interval(range(n), 0.99))

    def test_covers_as_often_as_it_says(self):
        draw = random.Random(1)
        missed = 0
        for _ in range(2000):  # median 1 of a skewed distribution
            low, high = compare.median_interval([draw.lognormvariate(0, 1) for _ in range(15)], 0.99)
            missed += not low <= 1 <= high
        self.assertLess(missed, 35)  # 15 expected (0.74%); false alarm 1e-5


class Verdict(unittest.TestCase):
    def ratios(self, centre, pairs=15):
        draw = random.Random(2)
        return [centre * draw.gauss(1, 0.03) for _ in range(pairs)]

    def test_is_none_in_noise(self):
        sentence, code = compare.verdict(self.ratios(1.005))
        self.assertEqual(code, 2)
        self.assertIn("no conclusion", sentence)

    def test_is_none_from_too_few_pairs(self):
        self.assertEqual(compare.verdict([0.5] * 7)[1], 2)

    def test_sees_what_is_plain(self):
        self.assertEqual(compare.verdict(self.ratios(0.9))[1], 1)
        self.assertEqual(compare.verdict(self.ratios(1.1))[1], 0)
        self.assertTrue(compare.verdict(self.ratios(0.9))[0].startswith("slower"))


if __name__ == "__main__":
    unittest.main()
