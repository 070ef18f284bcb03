"""Compares noisy estimates of light with two independent noisy references, in blocks of samples.

A sample is a pixel or a measuring point. Blocks are small groups of samples, tiles are groups of blocks that are large
enough for their noise to count as independent. `estimates` are runs of one method with different seeds. Expected values
of products of differences from both references contain no noise of the references.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

CONFIDENCE = 0.95
NORMAL_95 = 1.959964  # half the width of such an interval in standard deviations of the normal distribution


@dataclass(frozen=True)
class Interval:
    """A value and its bounds, two standard errors away."""

    value: float
    low: float
    high: float

    @staticmethod
    def around(value: float, error: float) -> "Interval":
        return Interval(value, value - 2 * error, value + 2 * error)

    def overlaps(self, low: float, high: float) -> bool:
        return self.low <= high and self.high >= low

    def mapped(self, function: Callable[[float], float]) -> "Interval":
        """Applies a monotonic function; the order of the bounds is restored."""
        low, high = sorted((function(self.low), function(self.high)))
        return Interval(function(self.value), low, high)


@dataclass(frozen=True)
class Layout:
    block: np.ndarray  # of each sample; -1: not compared
    tile: np.ndarray  # of each block

    def means(self, values: np.ndarray) -> np.ndarray:
        """Returns the mean of each block."""
        return self.sums(values) / self.counts()

    def sums(self, values: np.ndarray) -> np.ndarray:
        inside = self.block >= 0
        return np.bincount(self.block[inside], values[inside], len(self.tile))

    def counts(self) -> np.ndarray:
        return np.bincount(self.block[self.block >= 0], minlength=len(self.tile))

    def only(self, wanted: np.ndarray) -> "Layout":
        """Returns the layout of the blocks for which `wanted` holds."""
        number = np.where(wanted, np.cumsum(wanted) - 1, -1)
        block = np.where(self.block >= 0, number[self.block], -1)
        return Layout(block, self.tile[wanted])


def pixel_layout(compared: np.ndarray, *, tile_side: int, block_side: int = 9) -> Layout:
    """Divides a picture into squares. Blocks need half of their pixels, and incomplete ones at the right and at the
    bottom are left out.
    @param compared  height x width; whether a pixel is compared."""
    height, width = compared.shape
    rows, columns = height // block_side, width // block_side
    y, x = np.indices(compared.shape)
    complete = (y < rows * block_side) & (x < columns * block_side)
    block = np.where(complete & compared, y // block_side * columns + x // block_side, -1).ravel()
    row, column = np.divmod(np.arange(rows * columns), columns)
    blocks_per_tile = max(1, tile_side // block_side)
    layout = Layout(block, row // blocks_per_tile * columns + column // blocks_per_tile)
    return layout.only(2 * layout.counts() >= block_side**2)


def ratio_of_sums(numerators: np.ndarray, denominators: np.ndarray, tile: np.ndarray) -> Interval:
    """Returns sum over sum, with the standard error from the spread of the tiles (ratio estimator, Cochran 1977).
    @param numerators, denominators  Sums of each block. @param tile  Of each block."""
    tops, bottoms = np.bincount(tile, numerators), np.bincount(tile, denominators)
    used = np.bincount(tile) > 0
    tops, bottoms = tops[used], bottoms[used]
    total = bottoms.sum()
    if not total > 0:
        return Interval(math.nan, math.nan, math.nan)
    ratio = tops.sum() / total
    count = len(tops)
    variance = ((tops - ratio * bottoms) ** 2).sum() * count / (count - 1) if count > 1 else math.inf
    return Interval.around(float(ratio), math.sqrt(variance) / total)


def error_of_mean(estimates: Sequence[np.ndarray], layout: Layout) -> float:
    """Returns the standard error of the mean of all estimates over the samples, at least two estimates.

    It is the larger of two: from the spread of the tiles, which has many degrees of freedom, and from the spread of the
    whole means, which contains noise that all tiles share.
    """
    seeds = len(estimates)
    sums = np.array([np.bincount(layout.tile, layout.sums(e)) for e in estimates])
    deviations = sums - sums.mean(axis=0)
    samples = layout.counts().sum()
    of_tiles = math.sqrt((deviations**2).sum() / (seeds - 1) / seeds) / samples
    of_means = float(np.std(sums.sum(axis=1), ddof=1)) / math.sqrt(seeds) / samples
    return max(of_tiles, of_means)


def mean_ratio(estimates: Sequence[np.ndarray], references: Sequence[np.ndarray], layout: Layout) -> Interval:
    """Returns the mean of the estimates over the mean of the references.

    With several seeds, the bounds contain the noise of both sides. A single estimate has the spread of the ratio from
    tile to tile, which also contains its bias there, so its bounds are wider.
    """
    wanted, found = (sum(layout.sums(v) for v in values) / len(values) for values in (references, estimates))
    if len(estimates) < 2:
        return ratio_of_sums(found, wanted, layout.tile)
    mean = wanted.sum() / layout.counts().sum()
    ratio = float(found.sum() / wanted.sum())
    error = math.hypot(error_of_mean(estimates, layout), ratio * error_of_mean(references, layout)) / mean
    return Interval.around(ratio, error)


def _block_products(estimates, references, layout: Layout) -> np.ndarray:
    """Returns the expected squared error of each block, without the noise of the references."""
    a, b = (layout.means(r) for r in references)
    return np.mean([(m - a) * (m - b) for m in map(layout.means, estimates)], axis=0)


def _relative_root(squares: np.ndarray, references, layout: Layout) -> Interval:
    mean = sum(layout.means(r).mean() for r in references) / len(references)
    found = ratio_of_sums(squares, np.ones(len(squares)), layout.tile)
    return found.mapped(lambda square: math.sqrt(max(0.0, square)) / mean)


def block_error(estimates: Sequence[np.ndarray], references: Sequence[np.ndarray], layout: Layout) -> Interval:
    """Returns the root mean square error of the blocks of one estimate, over the mean of the references."""
    return _relative_root(_block_products(estimates, references, layout), references, layout)


def block_bias(estimates: Sequence[np.ndarray], references: Sequence[np.ndarray], layout: Layout) -> Interval:
    """Returns the part of block_error() that all seeds share; at least two estimates."""
    a, b = (layout.means(r) for r in references)
    means = [layout.means(e) for e in estimates]
    pairs = [(x, y) for i, x in enumerate(means) for j, y in enumerate(means) if i != j]
    return _relative_root(np.mean([(x - a) * (y - b) for x, y in pairs], axis=0), references, layout)


def stated_over_true(
    stated: Sequence[np.ndarray],
    estimates: Sequence[np.ndarray],
    references: Sequence[np.ndarray],
    scale: np.ndarray,
    layout: Layout,
) -> Interval:
    """Returns the stated over the true error, both as root mean squares over the samples relative to `scale`.
    @param stated  Standard error of each sample of each estimate.
    @param scale  Of each sample; its noise is independent of all other arguments."""
    a, b = references
    true = np.mean([(e - a) * (e - b) for e in estimates], axis=0) / scale**2
    claimed = np.mean([s**2 for s in stated], axis=0) / scale**2
    found = ratio_of_sums(layout.sums(true), layout.sums(claimed), layout.tile)
    return found.mapped(lambda square: 1 / math.sqrt(square) if square > 0 else math.inf)


def relative_error(
    estimates: Sequence[np.ndarray], references: Sequence[np.ndarray], scale: np.ndarray, layout: Layout
) -> Interval:
    """Returns the true error of stated_over_true()."""
    a, b = references
    true = np.mean([(e - a) * (e - b) for e in estimates], axis=0) / scale**2
    found = ratio_of_sums(layout.sums(true), layout.counts().astype(float), layout.tile)
    return found.mapped(lambda square: math.sqrt(max(0.0, square)))


def block_standard_error(independent: np.ndarray, shared: np.ndarray, layout: Layout) -> np.ndarray:
    """Returns the stated standard error of the mean of each block.
    @param independent  Variance of each sample whose errors are independent.
    @param shared  Variance of each sample whose errors are the same in the whole block."""
    return np.sqrt(layout.sums(independent) / layout.counts() ** 2 + layout.means(np.sqrt(shared)) ** 2)


def block_stated_over_true(
    stated: Sequence[np.ndarray], estimates: Sequence[np.ndarray], references: Sequence[np.ndarray], layout: Layout
) -> Interval:
    """As stated_over_true(), for the means of blocks. @param stated  Standard error of each block of each estimate."""
    claimed = np.mean([s**2 for s in stated], axis=0)
    found = ratio_of_sums(_block_products(estimates, references, layout), claimed, layout.tile)
    return found.mapped(lambda square: 1 / math.sqrt(square) if square > 0 else math.inf)


def coverage(
    stated: Sequence[np.ndarray],
    estimates: Sequence[np.ndarray],
    references: Sequence[np.ndarray],
    reference_errors: Sequence[np.ndarray],
    layout: Layout,
) -> Interval:
    """Returns the share of blocks whose 95% interval contains the reference. The interval includes the noise of the
    references. @param stated, reference_errors  Standard error of each block."""
    wanted = sum(layout.means(r) for r in references) / len(references)
    noise = sum(e**2 for e in reference_errors) / len(reference_errors) ** 2
    pairs = zip(estimates, stated, strict=True)
    within = [np.abs(layout.means(e) - wanted) <= NORMAL_95 * np.sqrt(s**2 + noise) for e, s in pairs]
    found = ratio_of_sums(np.mean(within, axis=0), np.ones(len(layout.tile)), layout.tile)
    # The spread of few tiles may be 0 by chance. The spread of independent blocks is its lower limit.
    binomial = math.sqrt(CONFIDENCE * (1 - CONFIDENCE) / len(layout.tile))
    return Interval.around(found.value, max(binomial, (found.high - found.value) / 2))


def darkest(values: np.ndarray, layout: Layout, share: float = 0.2) -> Layout:
    """Returns the layout of this share of the blocks with the least light.
    @param values  Independent of the compared values, because a choice by noisy values prefers low ones."""
    means = layout.means(values)
    return layout.only(means <= np.quantile(means, share))
