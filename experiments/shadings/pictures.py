"""Pictures of the audit and their comparison with path-traced ones."""

import math
import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from measured.audit import widened
from lab import program
from lab.analysis import blocks
from lab.analysis.blocks import Interval, Layout
from lab.analysis.picture import read_exr, read_layer
from lab.reference import box_mean

from .runs import Run


@dataclass(frozen=True)
class Picture:
    """Channel means of the pixels, in a row. Layers without a value are 0."""

    light: np.ndarray
    emitted: np.ndarray
    error: np.ndarray  # stated standard error
    indirect_share: np.ndarray  # of the stated variance
    printed: float  # relative error that the command prints
    seconds: float

    def block_errors(self, layout: Layout, shares_records: bool) -> np.ndarray:
        variance = self.error**2
        shared = variance * self.indirect_share if shares_records else np.zeros_like(variance)
        return blocks.block_standard_error(variance - shared, shared, layout)


def read_picture(path: Path, finished: program.Finished, layers: bool) -> Picture:
    light = read_exr(path).mean(axis=2).ravel()
    none = np.zeros_like(light)
    said = re.findall(r"estimated relative error ([\d.]+)% a pixel", finished.messages)
    printed = float(said[-1]) / 100 if said else math.nan
    if not layers:
        return Picture(light, none, none, none, printed, finished.seconds)
    direct, indirect = (read_layer(path, f"{name}_variance", "V")[:, :, 0].ravel() for name in ("direct", "indirect"))
    share = indirect / np.maximum(direct + indirect, 1e-30)
    emitted, error = (read_exr(path, name).mean(axis=2).ravel() for name in ("emitted", "standard_error"))
    return Picture(light, emitted, error, share, printed, finished.seconds)


@dataclass(frozen=True)
class Truth:
    """Reference pictures of a scene, and comparisons with them."""

    size: tuple[int, int]
    references: list[np.ndarray]
    errors: list[np.ndarray]  # stated standard errors of the references
    emitted: np.ndarray
    second: np.ndarray  # by the second method
    depth: np.ndarray  # height x width [m]

    @cached_property
    def layout(self) -> Layout:
        width, height = self.size
        shines = (self.emitted > 0).reshape(height, width)
        return blocks.pixel_layout(~widened(widened(shines)), tile_side=height // 4)

    @cached_property
    def whole(self) -> Layout:
        """All pixels, for the error that the command prints."""
        return blocks.pixel_layout(np.ones(self.size[::-1], bool), tile_side=self.size[1] // 4)

    @cached_property
    def dark(self) -> Layout:
        return blocks.darkest(self.second, self.layout)

    @cached_property
    def scale(self) -> np.ndarray:
        """The larger of the light of a pixel and the mean reflected light, as in the command's error of a pixel. The
        second method's light has noise of its own, which products of differences need."""
        width, height = self.size
        around = box_mean(self.second.reshape(height, width), radius=1).ravel()
        return np.maximum(around, float((np.mean(self.references, axis=0) - self.emitted).mean()))

    def measures(self, pictures: list[Picture], run: Run) -> dict[str, Interval]:
        light = [p.light for p in pictures]
        found = {}
        for prefix, layout in (("", self.layout), ("dark_", self.dark)):
            if not len(layout.tile):
                continue
            found[f"{prefix}mean"] = blocks.mean_ratio(light, self.references, layout)
            found[f"{prefix}blocks"] = blocks.block_error(light, self.references, layout)
            found[f"{prefix}bias"] = blocks.block_bias(light, self.references, layout)
            if run.stated:
                found |= self._stated(prefix, pictures, layout, run.shares_records)
        printed = [p.printed for p in pictures if not math.isnan(p.printed)]
        if run.stated and printed:
            true = blocks.relative_error(light, self.references, self.scale, self.whole)
            found["printed"] = true.mapped(lambda error: float(np.mean(printed)) / error if error > 0 else math.inf)
        return found

    def _stated(
        self, prefix: str, pictures: list[Picture], layout: Layout, shares_records: bool
    ) -> dict[str, Interval]:
        light, stated = [p.light for p in pictures], [p.error for p in pictures]
        of_blocks = [p.block_errors(layout, shares_records) for p in pictures]
        of_references = [blocks.block_standard_error(e**2, np.zeros_like(e), layout) for e in self.errors]
        return {
            f"{prefix}stated": blocks.stated_over_true(stated, light, self.references, self.scale, layout),
            f"{prefix}stated_blocks": blocks.block_stated_over_true(of_blocks, light, self.references, layout),
            f"{prefix}coverage": blocks.coverage(of_blocks, light, self.references, of_references, layout),
        }

    def block_noise(self) -> float:
        """Returns the noise of the blocks of the mean reference, over their mean."""
        a, b = (self.layout.means(r) for r in self.references)
        return float(np.sqrt(np.mean((a - b) ** 2)) / (a + b).mean())
