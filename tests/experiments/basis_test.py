"""Rows and choices of the experiment with linear elements."""

import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "experiments"))

import basis


def row(seed: int, error: float, **others) -> dict:
    defaults = {"rays": 1000.0, "basis": "linear", "mesh": "uniform", "parameter": 1.0, "elements": 10.0, "coefficients": 40.0}
    return defaults | {"seed": seed, "error": error, "relative_error": 2 * error} | others


class Rows(unittest.TestCase):
    def test_seeds_of_a_mesh_are_joined_in_their_order(self):
        joined = basis.summarised("room", [row(2, 0.2), row(1, 0.1), row(1, 0.5, mesh="patches")])
        self.assertEqual([one["errors"] for one in joined], ["0.1 0.2", "0.5"])
        self.assertEqual(joined[0]["relative_errors"], "0.2 0.4")

    def test_the_best_row_is_of_the_requested_bases_and_meshes(self):
        rows = [
            {"basis": name, "mesh": mesh, "errors": basis.np.array(errors)}
            for name, mesh, errors in (("linear", "uniform", [3, 1]), ("linear", "patches", [1, 1.5]), ("linear", "program", [0, 0]),
                                       ("constant flat", "uniform", [0, 0]))
        ]  # fmt: skip
        self.assertEqual(basis.best(rows, ["linear"], basis.CHOSEN["errors"])["mesh"], "patches")


class Moments(unittest.TestCase):
    def test_linear_elements_from_cells_are_nearly_as_good_as_from_hits(self):
        """Fixed seed. Cells have 1 / (1 - 1/n^2) of the variance of a slope: 1.07, and its square for the bilinear part."""
        ratios = [float(line.split()[-6]) for line in basis.check_moments()]
        self.assertAlmostEqual(ratios[0], 1.08, delta=0.03)
        self.assertAlmostEqual(ratios[-1], 1, delta=0.02)


if __name__ == "__main__":
    unittest.main()
