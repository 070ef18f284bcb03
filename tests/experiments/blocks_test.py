"""The statistics of the audit of shadings, against known values. Seeds are fixed. Tolerances of random numbers are four
standard errors, which correct code exceeds with other seeds once in 16,000 comparisons, unless stated otherwise."""

import math
import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "experiments"))

from measured.audit_scenes import Scene
from lab.analysis import baked, blocks
from shadings import page
from shadings.points import cells_of, draw_points, visible

SIZE = (90, 180)  # height and width: 10 x 20 blocks, in tiles of 2 x 2
LAYOUT = blocks.pixel_layout(np.ones(SIZE, bool), tile_side=18)
PIXELS = SIZE[0] * SIZE[1]


def noise(random: np.random.Generator, deviation: float, count: int) -> list[np.ndarray]:
    return list(random.normal(0, deviation, (count, PIXELS)))


def noise_of_blocks(random: np.random.Generator, deviation: float) -> np.ndarray:
    return random.normal(0, deviation, len(LAYOUT.tile))[LAYOUT.block]


class Layout(unittest.TestCase):
    def test_squares(self):
        self.assertEqual(len(LAYOUT.tile), 200)
        self.assertTrue((LAYOUT.counts() == 81).all())
        self.assertEqual(sorted(np.bincount(LAYOUT.tile)[np.unique(LAYOUT.tile)]), [4] * 50)
        y, x = np.indices(SIZE)
        np.testing.assert_allclose(LAYOUT.means(y.ravel().astype(float))[:2], 4)
        np.testing.assert_allclose(LAYOUT.means(x.ravel().astype(float))[:2], [4, 13])

    def test_blocks_need_half_of_their_pixels(self):
        compared = np.ones((20, 20), bool)  # the last two rows and columns complete no block
        compared[:5, :9] = False  # 36 of 81 are left
        compared[9:12, 9:] = False  # 54 are left
        layout = blocks.pixel_layout(compared, tile_side=9)
        np.testing.assert_array_equal(layout.counts(), [81, 81, 54])

    def test_darkest_fifth(self):
        values = np.arange(200.0)[LAYOUT.block]
        dark = blocks.darkest(values, LAYOUT)
        np.testing.assert_array_equal(np.unique(values[dark.block >= 0]), np.arange(40.0))


class Ratio(unittest.TestCase):
    def test_error_by_hand(self):
        # Tiles (1, 2) and (3, 2), each of two blocks: ratio 4 / 4; residuals -1 and 1; variance 2 * 2 / 1 / 4^2.
        found = blocks.ratio_of_sums(np.array([0.5, 0.5, 2, 1]), np.ones(4), np.array([0, 0, 1, 1]))
        self.assertEqual(found.value, 1)
        self.assertAlmostEqual(found.high - found.value, 2 * 0.5)

    def test_bounds_of_decreasing_functions(self):
        found = blocks.Interval(4, 1, 9).mapped(lambda x: 1 / math.sqrt(x))
        self.assertEqual((found.value, found.low, found.high), (1 / 2, 1 / 3, 1))


class Mean(unittest.TestCase):
    def test_two_standard_errors_cover_the_ratio(self):
        # 400 trials of 95.4%: fewer than 91% or all of them with probability below 1e-4. Blocks share noise of the
        # estimates; standard errors of independent pixels would be too small.
        random, within = np.random.default_rng(1), 0
        for _ in range(400):
            references = [10 + n for n in noise(random, 2, 2)]
            estimates = [10.2 + n + noise_of_blocks(random, 0.3) for n in noise(random, 2, 2)]
            within += blocks.mean_ratio(estimates, references, LAYOUT).overlaps(1.02, 1.02)
        self.assertGreater(within / 400, 0.91)
        self.assertLess(within / 400, 1)

    def test_noise_that_a_whole_picture_shares(self):
        # Means of 9 and 11 have the standard error 1, although no pixel of one differs from another.
        estimates = [np.full(PIXELS, 9.0), np.full(PIXELS, 11.0)]
        self.assertAlmostEqual(blocks.error_of_mean(estimates, LAYOUT), 1)

    def test_a_single_estimate_has_the_spread_of_tiles(self):
        references = [np.full(PIXELS, 10.0)] * 2
        estimate = 10 + np.where(LAYOUT.tile % 2 == 0, 1.0, -1.0)[LAYOUT.block]
        found = blocks.mean_ratio([estimate], references, LAYOUT)
        self.assertAlmostEqual(found.high - found.value, 2 * 0.1 / math.sqrt(50), delta=0.001)


class Blocks(unittest.TestCase):
    def test_error_without_the_noise_of_the_references(self):
        # Blocks are 6% too bright or too dark; the noise of the references alone is 4%. The relative standard error of
        # the products is below 7%, and that of their root is half of it.
        random = np.random.default_rng(2)
        references = [10 + n + noise_of_blocks(random, 0.4) for n in noise(random, 1, 2)]
        estimates = [10 + np.where(np.arange(200) % 3 == 0, 0.6, -0.6)[LAYOUT.block]] * 2
        self.assertAlmostEqual(blocks.block_error(estimates, references, LAYOUT).value, 0.06, delta=0.06 * 0.14)

    def test_bias_without_the_noise_of_the_estimates(self):
        # Noise of 5% in blocks over a bias of 3% in half of them: error sqrt(0.05^2 + 0.03^2 / 2), bias 0.0212.
        random = np.random.default_rng(3)
        references = [np.full(PIXELS, 10.0)] * 2
        bias = np.where(np.arange(200) % 2 == 0, 0.3, 0.0)[LAYOUT.block]
        estimates = [10 + bias + noise_of_blocks(random, 0.5) for _ in range(2)]
        self.assertAlmostEqual(blocks.block_error(estimates, references, LAYOUT).value, 0.0543, delta=0.0543 * 0.2)
        self.assertTrue(blocks.block_bias(estimates, references, LAYOUT).overlaps(0.0212, 0.0212))
        self.assertLess(blocks.block_bias(estimates, references, LAYOUT).value, 0.04)

    def test_stated_errors_of_blocks(self):
        # Independent pixels: 3 / 9. Shared by the block: 4. Both: their root of squares.
        nine, sixteen = np.full(PIXELS, 9.0), np.full(PIXELS, 16.0)
        np.testing.assert_allclose(blocks.block_standard_error(nine, 0 * nine, LAYOUT), 1 / 3)
        np.testing.assert_allclose(blocks.block_standard_error(0 * nine, sixteen, LAYOUT), 4)
        np.testing.assert_allclose(blocks.block_standard_error(nine, sixteen, LAYOUT), math.hypot(1 / 3, 4))


class Stated(unittest.TestCase):
    def setUp(self):
        random = np.random.default_rng(4)
        self.light = random.uniform(1, 20, PIXELS)
        self.deviation = 0.1 * self.light
        self.references = [self.light + 0.1 * self.light * n for n in noise(random, 1, 2)]
        self.estimates = [self.light + self.deviation * n for n in noise(random, 1, 2)]

    def test_over_true(self):
        # 16,200 pixels, two seeds: the true error has a relative standard error of 0.5%.
        for factor in (1, 0.5, 3):
            stated = [factor * self.deviation] * 2
            found = blocks.stated_over_true(stated, self.estimates, self.references, self.light, LAYOUT)
            self.assertAlmostEqual(found.value / factor, 1, delta=0.02)
            self.assertTrue(found.overlaps(0.98 * factor, 1.02 * factor))

    def test_true_error(self):
        found = blocks.relative_error(self.estimates, self.references, self.light, LAYOUT)
        self.assertAlmostEqual(found.value, 0.1, delta=0.002)

    def test_unknown_where_the_estimate_is_exact(self):
        exact = [self.light] * 2
        found = blocks.stated_over_true([self.deviation] * 2, exact, self.references, self.light, LAYOUT)
        self.assertEqual(found.high, math.inf)

    def test_coverage(self):
        # 200 blocks and two seeds: standard error below 1.6%. The noise of the references is two thirds of the
        # variance; intervals without it would cover 74%. Half the error covers 67.3%, with a standard error below 2.4%.
        of = lambda deviation: blocks.block_standard_error(deviation**2, np.zeros(PIXELS), LAYOUT)
        noisy = [self.light + 0.2 * self.light * n for n in noise(np.random.default_rng(5), 1, 2)]
        for factor, references, noise_of_them, share in (
            (1, noisy, 0.2 * self.light, 0.95),
            (1, [self.light] * 2, 0 * self.light, 0.95),
            (0.5, [self.light] * 2, 0 * self.light, 0.673),
        ):
            stated = [of(factor * self.deviation)] * 2
            found = blocks.coverage(stated, self.estimates, references, [of(noise_of_them)] * 2, LAYOUT)
            self.assertAlmostEqual(found.value, share, delta=0.064 if share > 0.9 else 0.095)


class Baked(unittest.TestCase):
    def test_bilinear(self):
        image = np.array([[0.0, 10.0], [20.0, 30.0]])
        for place, value in (((0.25, 0.25), 0), ((0.75, 0.25), 10), ((0.5, 0.5), 15), ((0, 0), 0), ((1, 1), 30)):
            self.assertAlmostEqual(baked.bilinear(image, np.array(place)), value)
        self.assertAlmostEqual(baked.bilinear(np.array([[1.0, 3.0]]), np.array([0.5, 0.5])), 2)

    def test_points_on_triangles(self):
        # A sheet at z = 1 with two sides; the light is x on its upper side and 100 + y on its lower one.
        upper = [[(0, 0, 1), (1, 0, 1), (1, 1, 1)], [(0, 0, 1), (1, 1, 1), (0, 1, 1)]]
        corners = np.array(upper + [triangle[::-1] for triangle in upper], float)
        values = np.where(np.arange(4)[:, None] < 2, corners[:, :, 0], 100 + corners[:, :, 1])
        sheet = baked.Baked(corners, lambda triangle, weights: (values[triangle] * weights).sum(axis=1))
        points = np.array([(0.3, 0.8, 1), (0.3, 0.8, 1), (0.9, 0.2, 1), (2, 0.5, 1), (0.3, 0.8, 1)])
        normals = np.array([(0, 0, 1), (0, 0, -1), (0, 0, 1), (0, 0, 1), (1, 0, 0)], float)
        np.testing.assert_allclose(sheet.at(points, normals), [0.3, 100.8, 0.9, 0, 0], atol=1e-9)

    def test_points_are_drawn_where_probes_measure(self):
        floor = [(0, 0, 0), (2, 0, 0), (0, 2, 0)]
        wall = [(0, 0, 0), (0, 2, 0), (0, 0, 2)]
        ceiling, roof = [(0, 0, 2), (0, 2, 2), (2, 0, 2)], [(0, 0, 2), (1, 0, 3), (0, 1, 3)]
        far = [(50, 0, 0), (52, 0, 0), (50, 2, 0)]
        room = baked.Baked(np.array([floor, wall, ceiling, roof, far], float), lambda triangle, weights: triangle)
        scene = Scene("", eye=(50, 50, 50), look_at=(0, 0, 0), fov=30)
        y, x = np.indices((90, 160)) + 0.5
        tangent = np.hypot(x - 80, y - 45) / 45 * math.tan(math.radians(15))
        depth = 75**0.5 * 10 * np.hypot(1, tangent)  # of the plane through the origin that faces the eye
        points, normals = draw_points(room, scene, depth, 1000)
        self.assertEqual(set(map(tuple, normals)), {(0, 0, 1), (1, 0, 0)})
        self.assertLess(np.abs(points).max(), 2)
        self.assertAlmostEqual((normals[:, 2] == 1).mean(), 0.5, delta=0.064)  # 4 standard deviations

    def test_visible_points(self):
        # The camera at z = 10 looks down with y up in the picture; one half of it shows the floor, the other a table.
        scene = Scene("", eye=(0, 0, 10), look_at=(0, 0, 0), fov=90, up=(0, 1, 0))
        y, x = np.indices((60, 80)) + 0.5
        distance = np.hypot(1, np.hypot(x - 40, y - 30) / 30)
        depth = np.where(x < 40, 10 * distance, 9 * distance)
        points = np.array([(-3, 2, 0), (-3, 2, 1), (3, 2, 0), (3, 2, 1), (3, 20, 1), (0, 0, 20)], float)
        np.testing.assert_array_equal(visible(points, scene, depth), [1, 0, 0, 1, 0, 0])

    def test_cells_are_squares_of_one_plane(self):
        points = np.array([(0.1, 0.1, 0), (0.4, 0.4, 0), (0.5, 0.1, 0), (0.1, 0.1, 1), (0, 0.1, 0.1), (0, 0.4, 0.4)])
        normals = np.array([(0, 0, 1)] * 4 + [(1, 0, 0)] * 2, float)
        cell = cells_of(points, normals)
        self.assertEqual(cell[0], cell[1])
        self.assertEqual(cell[4], cell[5])
        self.assertEqual(len(set(cell)), 4)


class Misses(unittest.TestCase):
    def row(self, run="hybrid", failure="", seconds=9.0, **intervals):
        row = dict.fromkeys(page.COLUMNS, math.nan)
        row |= {"scene": "crate", "run": run, "failure": failure, "seconds": seconds}
        for name, (value, low, high) in intervals.items():
            row |= {name: value, f"{name}_low": low, f"{name}_high": high}
        return row

    def test_limits_are_widened_by_two_standard_errors(self):
        self.assertEqual(page.misses(self.row(mean=(1.006, 1.004, 1.008), coverage=(0.98, 0.96, 1))), [])
        self.assertEqual(page.misses(self.row(mean=(1.007, 1.0055, 1.009))), ["mean"])
        self.assertEqual(page.misses(self.row(dark_stated=(0.7, 0.65, 0.75))), ["dark_stated"])

    def test_time(self):
        self.assertEqual(page.misses(self.row("hybrid --time 10", seconds=10.9)), [])
        self.assertEqual(page.misses(self.row("hybrid --time 10", seconds=11.1)), ["time"])

    def test_failures_are_misses(self):
        self.assertEqual(page.misses(self.row(failure="no light")), ["not measured"])


if __name__ == "__main__":
    unittest.main()
