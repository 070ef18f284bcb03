"""Tests have names as the rules demand, and the checker finds each violation.

INTERFLECT_TEST_PROGRAMS contains the test programs, separated as in PATH. Programs that are not built yet are left out.
"""

import os
import subprocess
import unittest
from pathlib import Path

from names import faults


class Programs(unittest.TestCase):
    maxDiff = None  # prints every fault

    def test_have_names_that_keep_the_rules(self):
        programs = [Path(program) for program in os.environ["INTERFLECT_TEST_PROGRAMS"].split(os.pathsep)]
        built = [program for program in programs if program.exists()]
        self.assertTrue(built, f"none of these is built: {programs}")
        for program in built:
            with self.subTest(program.name):
                listing = subprocess.run([program, "--gtest_list_tests"], check=True, capture_output=True, text=True)
                folder = program.name.removeprefix("test_").rpartition("_")[0]
                self.assertEqual("\n".join(faults(folder, listing.stdout)), "")


class Checker(unittest.TestCase):
    """Lists of tests, each with at most one fault."""

    def assert_only_fault(self, listing, words):
        found = faults("solver", listing)
        self.assertEqual(len(found), 1, found)
        self.assertIn(words, found[0])

    def test_sound_names_have_no_fault(self):
        listing = (
            "Solve.\n  IsEven\nRho/Furnace.  # TypeParam = float\n  IsEven/0_5  # GetParam() = 0.5\n"
            "Count/Terms.\n  AddUp/1000  # GetParam() = 1000\n"
        )
        self.assertEqual(faults("solver", listing), [])

    def test_long_name(self):
        self.assert_only_fault(f"Solve.\n  {'Is' * 50}\n", "expected at most 100")

    def test_bytes(self):
        listing = "A/B.\n  C/near  # GetParam() = (4-byte object <00-00 00-00>, 1)\n"
        self.assert_only_fault(listing, "solver.A/B.C/near: its parameter is printed as bytes")

    def test_address(self):
        listing = 'A/B.\n  C/near  # GetParam() = (0x55e367e0e71b pointing to "near", 1)\n'
        self.assert_only_fault(listing, "as an address")

    def test_index(self):
        self.assert_only_fault("A/B.\n  C/1  # GetParam() = 0.5\n", "ends with an index")


if __name__ == "__main__":
    unittest.main()
