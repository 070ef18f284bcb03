"""Path-traced pictures, and the errors of other pictures against them."""

from pathlib import Path

import numpy as np

from . import program
from .analysis.picture import luminance, read_exr


class Reference:
    """Two path-traced pictures of a view, made once. Only reflected light is compared, so pixels with a lamp and their
    neighbours do not count."""

    SEEDS = (98, 99)

    def __init__(
        self, command: program.Program, folder: Path, name: str, scene_and_view: str, paths: int, shading: str = "path"
    ):
        """`paths` is per pixel and picture; `folder` keeps the pictures. `shading` may also be "gather", with its
        options, where path tracing finds too little of the light."""
        folder.mkdir(parents=True, exist_ok=True)
        self.files = [folder / f"{name}{paths}-{seed}.exr" for seed in self.SEEDS]
        for file, seed in zip(self.files, self.SEEDS):
            if not file.is_file():
                options = f"--shading {shading} --no-mirrors --samples {paths} --seed {seed} --layers"
                program.run(command, f"render {scene_and_view} {options} -o {file}".split())
        self.pictures = [luminance(read_exr(file)) for file in self.files]
        mean_picture = sum(self.pictures) / 2
        lamps = np.pad(sum(luminance(read_exr(file, "emitted")) for file in self.files) > 0, 1)
        height, width = mean_picture.shape
        self.counts = ~np.any([lamps[y : y + height, x : x + width] for y in range(3) for x in range(3)], axis=0)
        self.mean = mean_picture[self.counts].mean()
        # Dark pixels need not be exact. A scale from single pixels would follow their noise and favour low values.
        self.scale = np.maximum(box_mean(mean_picture, radius=4), self.mean)

    def relative_rmse(self, picture: np.ndarray) -> float:
        """Relative to the luminance around a pixel, but at least to the picture's mean. The expected product of the
        differences from two independent pictures is the squared error without their noise."""
        first, second = ((picture - p) / self.scale for p in self.pictures)
        return float(np.sqrt(max(0.0, (first * second)[self.counts].mean())))

    def ratio_of_means(self, picture: np.ndarray) -> float:
        return float(picture[self.counts].mean() / self.mean)

    def error_of_mean(self) -> float:
        """Returns the relative standard error of the reference's mean, from the difference of its two pictures."""
        differences = (self.pictures[0] - self.pictures[1])[self.counts]
        return float(np.sqrt((differences**2).sum()) / 2 / self.mean / differences.size)


def box_mean(values: np.ndarray, radius: int) -> np.ndarray:
    size = 2 * radius + 1
    sums = np.pad(np.pad(values, radius, mode="edge").cumsum(0).cumsum(1), ((1, 0), (1, 0)))
    return (sums[size:, size:] - sums[:-size, size:] - sums[size:, :-size] + sums[:-size, :-size]) / size**2
