"""Conclusions of bench/compare, where noise must stay inconclusive, and its runs of two programs."""

import importlib.machinery
import importlib.util
import os
import random
import subprocess
import sys
import tempfile
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
        sentence, code = compare.verdict([0.5] * 6 + [0.25])
        self.assertEqual(code, 2)
        for words in ("7 pairs are too few", "median 0.500", "0.250 to 0.500"):
            self.assertIn(words, sentence)

    def test_sees_what_is_plain(self):
        self.assertEqual(compare.verdict(self.ratios(0.9))[1], 1)
        self.assertEqual(compare.verdict(self.ratios(1.1))[1], 0)
        self.assertTrue(compare.verdict(self.ratios(0.9))[0].startswith("slower"))


class Programs(unittest.TestCase):
    """Two programs that note how they were called."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def program(self, name, work):
        path = self.folder / name
        path.write_text(f"#!/bin/sh\necho {name} \"$@\" >> {self.folder}/calls\n{work}\n")
        os.chmod(path, 0o755)
        return path

    def compare(self, *arguments, exit_code):
        result = subprocess.run([sys.executable, "-B", SCRIPT, *arguments], capture_output=True, text=True, timeout=50)
        self.assertEqual(result.returncode, exit_code, result.stderr)
        return result

    def calls(self):
        return [line.split() for line in (self.folder / "calls").read_text().splitlines()]

    def test_of_whole_pictures(self):
        # The interval of 15 pairs excludes two outliers, so a false alarm needs three delays of 0.3 s of the fast program.
        slow, fast = self.program("slow", "sleep 0.3"), self.program("fast", "")
        said = self.compare(slow, fast, "--pairs", "15", "--picture", "--", "room.mgf", "--size", "8x8", exit_code=0).stdout
        self.assertIn("faster: median", said)
        calls = self.calls()
        self.assertEqual(len(calls), 30)
        for first, second in zip(calls[::2], calls[1::2]):
            self.assertEqual({first[0], second[0]}, {"slow", "fast"})
        for call in calls:
            self.assertEqual(call[1:6], ["render", "room.mgf", "--size", "8x8", "-o"])
            self.assertFalse(Path(call[6]).parent.exists())

    def test_of_the_solver(self):
        before = self.program("before", """echo '{"ratio": 0.5}'""")
        after = self.program("after", """echo '{"ratio": 0.4}'""")
        said = self.compare(before, after, "--pairs", "8", "--", "room.mgf", exit_code=1).stdout
        self.assertIn("slower: median 0.800", said)
        self.assertEqual(self.calls()[0][1:], ["bench", "room.mgf", "--rounds", "1", "--json"])

    def test_shows_why_a_program_failed(self):
        failing = self.program("failing", "echo no such scene >&2; exit 3")
        self.assertIn("no such scene", self.compare(failing, failing, "--picture", exit_code=3).stderr)


if __name__ == "__main__":
    unittest.main()
