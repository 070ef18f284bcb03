"""Errors of a picture against the pictures of two reference programs, without the noise of these.

The expected product of the differences from two independent references is the squared error. The worst pixels are
selected by one half of each reference and measured by the other half, so the selection does not prefer low noise.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

BLOCK_SIDES = (4, 9)  # [pixels]
TRIMMED = 0.01  # share of the pixels with the largest errors
DARKEST = 0.01  # of the mean: errors of darker pixels are relative to this


@dataclass(frozen=True)
class Errors:
    """Relative root mean square errors, and the ratio of means."""

    pixels: float
    trimmed: float  # of pixels, without the worst
    blocks_4: float
    blocks_9: float
    mean: float


@dataclass(frozen=True)
class Reference:
    """Luminance by two programs, each in two independent halves of its samples.
    @param counts  Pixels that are compared."""

    ours: tuple[np.ndarray, np.ndarray]
    theirs: tuple[np.ndarray, np.ndarray]
    counts: np.ndarray

    @cached_property
    def best(self) -> np.ndarray:
        return (sum(self.ours) + sum(self.theirs)) / 4

    def scale(self, half: int) -> np.ndarray:
        """Returns the luminance to which errors are relative, estimated by one half of the samples. The other half measures
        the errors, so their noise is independent of the scale."""
        luminance = (self.ours[half] + self.theirs[half]) / 2
        return luminance + DARKEST * luminance[self.counts].mean()

    def errors(self, picture: np.ndarray) -> Errors:
        blocks = [self._block_error(picture, side) for side in BLOCK_SIDES]
        mean = float(picture[self.counts].mean() / self.best[self.counts].mean())
        return Errors(self._pixel_error(picture), self._trimmed_error(picture), *blocks, mean)

    def _pixel_error(self, picture: np.ndarray) -> float:
        return root(np.mean([self._products(picture, half)[self.counts].mean() for half in range(2)]))

    def _trimmed_error(self, picture: np.ndarray) -> float:
        squares = []
        for half in range(2):
            guess = np.abs(picture - (self.ours[1 - half] + self.theirs[1 - half]) / 2) / self.scale(1 - half)
            kept = self.counts & (guess <= np.quantile(guess[self.counts], 1 - TRIMMED))
            squares.append(self._products(picture, half)[kept].mean())
        return root(np.mean(squares))

    def _products(self, picture: np.ndarray, half: int) -> np.ndarray:
        """Returns the squared relative error of each pixel, on average over the noise of one half."""
        scale = self.scale(1 - half)
        return (picture - self.ours[half]) * (picture - self.theirs[half]) / scale**2

    def _block_error(self, picture: np.ndarray, side: int) -> float:
        squares = []
        for half in range(2):
            scale = block_means(self.scale(1 - half), self.counts, side)
            pair = (self.ours[half], self.theirs[half])
            first, second = (block_means(picture - one, self.counts, side) / scale for one in pair)
            squares.append((first * second).mean())
        return root(np.mean(squares))

    def agreement(self) -> "Agreement":
        means = [half[self.counts].mean() for half in (*self.ours, *self.theirs)]
        ratio = (means[2] + means[3]) / (means[0] + means[1])
        everywhere = self.best + DARKEST * self.best[self.counts].mean()
        scale = block_means(everywhere, self.counts, BLOCK_SIDES[-1])
        pairs = zip(self.theirs, self.ours)
        differences = [block_means(b - a, self.counts, BLOCK_SIDES[-1]) / scale for a, b in pairs]
        noise = [root((((a - b) / everywhere)[self.counts] ** 2).mean()) / 2 for a, b in (self.ours, self.theirs)]
        error = np.hypot(means[0] - means[1], means[2] - means[3]) / (means[0] + means[1])
        smallest = (2 * (noise[0] * noise[1]) ** 2 / self.counts.sum()) ** 0.25
        return Agreement(float(ratio), float(error), root((differences[0] * differences[1]).mean()), *noise, float(smallest))


@dataclass(frozen=True)
class Agreement:
    """Differences of the two reference programs."""

    ratio_of_means: float  # theirs over ours
    error_of_ratio: float  # standard error, from the differences of halves: one degree of freedom for each program
    blocks_9: float  # relative root mean square difference of blocks, without noise
    noise_of_ours: float  # relative, of a pixel in both halves together
    noise_of_theirs: float
    # The root of the standard error of the squared error of a picture without error. A product of the noise of two halves
    # has the variance 4 a^2 b^2, the mean over both pairs of halves and n pixels 2 a^2 b^2 / n (a and b: noise_of_...).
    smallest: float


def root(mean_square: float) -> float:
    """Returns the root. Products of differences may be negative by noise, which counts as 0."""
    return float(np.sqrt(max(0.0, mean_square)))


def block_means(values: np.ndarray, counts: np.ndarray, side: int) -> np.ndarray:
    """Returns the means of the counting pixels in squares, in a row. Squares need half of their pixels, and incomplete
    ones at the right and at the bottom are left out."""
    rows, columns = (size // side for size in values.shape)

    def sums(grid: np.ndarray) -> np.ndarray:
        return grid[: rows * side, : columns * side].reshape(rows, side, columns, side).sum(axis=(1, 3))

    numbers = sums(counts.astype(float))
    used = 2 * numbers >= side**2
    return sums(np.where(counts, values, 0))[used] / numbers[used]


def without_lamps(emitted: np.ndarray) -> np.ndarray:
    """Returns the mask of the pixels without a light source in them or in their neighbours."""
    lamps = np.pad(emitted > 0, 1)
    height, width = emitted.shape
    return ~np.any([lamps[y : y + height, x : x + width] for y in range(3) for x in range(3)], axis=0)
