"""View factors of arrays: closed forms, groups, the fit, and SciPy's matrices without copies."""

import tempfile
import unittest
from pathlib import Path

import numpy as np

import interflect as ifl

SQUARE = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], float)
GREY = ifl.Material("grey", 0.5)


def facing_squares(distance=1.0):
    """Two unit squares that face each other."""
    return ifl.Scene(np.vstack([SQUARE, SQUARE + (0, 0, distance)]), [(0, 1, 2, 3), (4, 7, 6, 5)], GREY,
                     objects=["", "floor", "ceiling"], face_objects=[1, 2])


def exact_facing(d):
    """F12 of unit squares at a distance d (Howell, catalogue of configuration factors, C-11)."""
    x = 1 / d
    s = np.sqrt(1 + x * x)
    return 2 / (np.pi * x * x) * (np.log(s * s / np.sqrt(1 + 2 * x * x)) + 2 * x * s * np.arctan(x / s) - 2 * x * np.arctan(x))


def cube():
    corners = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 2, 6, 4), (1, 5, 7, 3), (0, 4, 5, 1), (2, 3, 7, 6)]
    return ifl.Scene(corners, faces, GREY, objects=["", *"abcdef"], face_objects=[1, 2, 3, 4, 5, 6])


class Factors(unittest.TestCase):
    def test_of_facing_squares(self):
        """4 standard errors: two right factors of four distances fail once in 2,000 runs."""
        for distance in (0.3, 1, 2.5, 7):
            f = ifl.view_factors(facing_squares(distance), rays=1e6, seed=round(10 * distance))
            self.assertEqual(f.names, ["floor", "ceiling"])
            for i, j in ((0, 1), (1, 0)):
                error = f.dense_errors()[i, j]
                self.assertAlmostEqual(f.dense()[i, j], exact_facing(distance), delta=4 * error)
                self.assertLess(error, 0.02 * exact_facing(distance))  # a lost pi or cosine is far larger
            np.testing.assert_allclose(f.closure(), 1, atol=1e-6)

    def test_of_a_cube_and_its_fit(self):
        f = ifl.view_factors(cube(), "objects", rays=1e6)
        self.assertEqual(f.dense().diagonal().max(), 0)
        np.testing.assert_allclose(f.dense().sum(1), 1, atol=1e-6)
        fitted, report = f.reconciled()
        transfer = fitted.areas[:, None] * fitted.dense()
        np.testing.assert_allclose(transfer, transfer.T, atol=1e-6)
        np.testing.assert_allclose(fitted.closure(), 1, atol=1e-6)
        self.assertGreater(report.before.reciprocity.largest, report.after.reciprocity.largest)
        self.assertGreater(f.consistency().reciprocity.largest, 1e-6)  # a copy was fitted

    def test_groups(self):
        scene = facing_squares()
        expected = ifl.view_factors(scene, rays=1e5).dense()
        for groups in ("facets", {"floor": "floor", "ceiling": "ceil*"}, {"floor": [0], "ceiling": [1]},
                       {"floor": np.array([True, False]), "ceiling": np.array([False, True])}):
            np.testing.assert_array_equal(ifl.view_factors(scene, groups, rays=1e5).dense(), expected)
        only = ifl.view_factors(scene, {"floor": [0]}, rays=1e5)
        self.assertAlmostEqual(only.blocked[0], expected[0, 1], delta=0.01)
        self.assertAlmostEqual(only.sky[0] + only.blocked[0], 1, places=6)
        for groups in ({"a": [0], "b": [0]}, {"a": [2]}, {"a": [-1]}, {"a": [0.5]}, {"a": "nothing"}, "rooms", 7,
                       {"a": [True]}, {"a": [0], "b": "ceiling"}):
            with self.subTest(groups), self.assertRaises(ifl.InputError):
                ifl.view_factors(scene, groups)
        with self.assertRaises(ifl.InputError):
            ifl.view_factors(scene, rays=0)

    def test_of_scenes_without_objects_are_those_of_materials(self):
        scene = ifl.Scene(np.vstack([SQUARE, SQUARE + (0, 0, 1)]), [(0, 1, 2, 3), (4, 7, 6, 5)],
                          [GREY, ifl.Material("white", 0.8)], face_materials=[0, 1])
        self.assertEqual(ifl.view_factors(scene, rays=1e4).names, ["grey", "white"])

    def test_wrong_types_are_named(self):
        scene = facing_squares()
        for groups, expected in (({3: "floor"}, "names of groups that are str, found 3"), ("\ud800", "str"),
                                 ({"a": "\ud800"}, "pattern that is a str"),
                                 ({"a": np.array([2**64 - 1], np.uint64)}, "indices of faces, found 18446744073709551615")):
            with self.subTest(groups), self.assertRaisesRegex(TypeError, f"groups: expected .*{expected}"):
                ifl.view_factors(scene, groups)
        with self.assertRaisesRegex(TypeError, "rays: expected a whole number, found 'x'"):
            ifl.view_factors(scene, rays="x")

    def test_backs_block_or_let_through(self):
        """A one-sided square between the two, facing up: its back hides the ceiling from the floor."""
        between = np.vstack([SQUARE, SQUARE + (0, 0, 1), SQUARE + (0, 0, 0.5)])
        scene = ifl.Scene(between, [(0, 1, 2, 3), (4, 7, 6, 5), (8, 9, 10, 11)], GREY, objects=["", "floor", "ceiling"],
                          face_objects=[1, 2, 0])
        self.assertEqual(ifl.view_factors(scene, {"f": [0], "c": [1]}, rays=1e5).dense()[0, 1], 0)
        through = ifl.view_factors(scene, {"f": [0], "c": [1]}, rays=1e5, opaque_backs=False)
        self.assertAlmostEqual(through.dense()[0, 1], exact_facing(1), delta=0.01)

    def test_arrays_are_shared(self):
        f = ifl.view_factors(cube(), "facets", rays=1e5)
        for name in ("areas", "row_offsets", "columns", "values", "errors", "sky"):
            self.assertFalse(getattr(f, name).flags.writeable or getattr(f, name).flags.owndata, name)
        self.assertTrue(np.shares_memory(f.matrix.data, f.values))
        np.testing.assert_array_equal(f.matrix.toarray(), f.dense())
        values = f.values
        kept = values.copy()
        del f
        np.testing.assert_array_equal(values, kept)

    def test_are_saved(self):
        f = ifl.view_factors(cube(), rays=1e5)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "cube.npz"
            f.save(path)
            read = np.load(path)
            np.testing.assert_array_equal(read["values"], f.values)
            self.assertEqual(read["names"].tolist(), f.names)


if __name__ == "__main__":
    unittest.main()
