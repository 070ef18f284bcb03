"""How far gathered pictures are from path-traced ones, against the time that they take: `experiments/run gathering`.

Pictures of office-graz at 960 x 540 pixels: by final gathering with and without the filter, as the elements are (smooth) and by path
tracing. What is there in results/gathering.csv already is not measured again. Two path-traced pictures are the reference, so that
their noise does not count. Time is that of all processors, with reading and solving the scene, over two of them: other work on the
machine does not count.
"""

import resource
import sys
import tempfile
from pathlib import Path

import numpy as np
from lab import drawing, program, results
from lab.picture import luminance, read_exr

WORK = program.ROOT / "out/experiments/cache/gathering"
TABLE = program.ROOT / "experiments/results/gathering.csv"
SCENE = f"{program.SCENES}/office-graz.mgf"
VIEW = "--eye 3.7037,0.0788,2.2690 --look-at 1.0023,8.9229,-1.1130 --size 960x540"
REFERENCE_PATHS = 96
PROCESSORS = 2
WORKS = {  # series: rays to solve with (path tracing needs none), and samples
    "gathered": [(1_000_000, 4), (2_000_000, 8), (4_000_000, 16), (8_000_000, 32)],
    "gathered and filtered": [(1_000_000, 4), (2_000_000, 8), (4_000_000, 16), (8_000_000, 32)],
    "smooth": [(2_000_000, 16), (5_000_000, 16), (10_000_000, 16), (20_000_000, 16), (40_000_000, 16)],
    "path": [(0, 4), (0, 8), (0, 16), (0, 32)],
}
OPTIONS = {
    "gathered": "--shading gather --no-mirrors",
    "gathered and filtered": "--shading gather --no-mirrors --denoise",
    "smooth": "--shading smooth",
    "path": "--shading path --no-mirrors",
}
TARGET, TARGET_SECONDS = 0.05, 20


class Reference:
    """Two path-traced pictures. Pixels where a lamp is seen, and those next to them, do not count."""

    def __init__(self, command: program.Program):
        WORK.mkdir(parents=True, exist_ok=True)
        files = [self._picture(command, seed) for seed in (98, 99)]
        self.pictures = [luminance(read_exr(file)) for file in files]
        mean_picture = sum(self.pictures) / 2
        lamps = np.pad(sum(luminance(read_exr(file, "emitted")) for file in files) > 0, 1)
        height, width = mean_picture.shape
        self.counts = ~np.any([lamps[y : y + height, x : x + width] for y in range(3) for x in range(3)], axis=0)
        self.mean = mean_picture[self.counts].mean()
        self.scale = np.maximum(mean_picture, self.mean)  # dark pixels need not be exact

    @staticmethod
    def _picture(command: program.Program, seed: int) -> Path:
        path = WORK / f"{REFERENCE_PATHS}-{seed}.exr"
        if not path.is_file():
            options = f"--shading path --no-mirrors --samples {REFERENCE_PATHS} --seed {seed} --layers"
            program.run(command, f"render {SCENE} {VIEW} {options} -o {path}".split())
        return path

    def relative_rmse(self, picture: np.ndarray) -> float:
        """Relative to a pixel's luminance, but at least to the picture's mean. The product of the differences from two independent
        pictures has the expected value of the square without their noise."""
        first, second = ((picture - p) / self.scale for p in self.pictures)
        return float(np.sqrt(max(0.0, (first * second)[self.counts].mean())))

    def ratio_of_means(self, picture: np.ndarray) -> float:
        return float(picture[self.counts].mean() / self.mean)


def processor_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def measure() -> None:
    command = program.find_program()
    rows = results.read_csv(TABLE) if TABLE.is_file() else []
    done = {(row["series"], row["samples"], row["rays"]) for row in rows}
    reference = None
    for series, works in WORKS.items():
        for rays, samples in works:
            if (series, samples, rays) in done:
                continue
            reference = reference or Reference(command)
            print(f"{series}: {samples} samples, {rays} rays", file=sys.stderr, flush=True)
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder) / "picture.exr"
                solving = f"--rays {rays}" if rays else ""
                arguments = f"render {SCENE} {VIEW} {OPTIONS[series]} --samples {samples} {solving} -o {path}"
                before = processor_seconds()
                program.run(command, arguments.split())
                seconds = (processor_seconds() - before) / PROCESSORS
                picture = luminance(read_exr(path))
            rows.append(
                {
                    "series": series,
                    "samples": samples,
                    "rays": rays,
                    "seconds": round(seconds, 2),
                    "relative_rmse": round(reference.relative_rmse(picture), 5),
                    "ratio_of_means": round(reference.ratio_of_means(picture), 5),
                    "version": command.version,
                }
            )
            results.write_csv(TABLE, rows, rows[-1])


def draw() -> None:
    rows = results.read_csv(TABLE)
    figure, (axes,) = drawing.panels(1, size=(5.2, 3.6))
    lines = []
    for number, series in enumerate(WORKS):
        runs = sorted((row for row in rows if row["series"] == series), key=lambda row: row["seconds"])
        axes.plot(
            [row["seconds"] for row in runs],
            [row["relative_rmse"] for row in runs],
            label=series,
            **drawing.style_of(number),
        )
        for row in runs:
            mean = f"{row['ratio_of_means'] - 1:+.2%}"
            error = f"{row['relative_rmse']:.1%}"
            lines.append([series, f"{row['rays'] / 1e6:g} M", f"{row['samples']:g}", f"{row['seconds']:.1f}", error, mean])
    drawing.logarithmic(axes, "seconds on two cores, with the solve", "relative RMSE a pixel")
    axes.axhline(TARGET, color="#999999", linewidth=0.8, linestyle="--")
    axes.axvline(TARGET_SECONDS, color="#999999", linewidth=0.8, linestyle="--")
    axes.legend()
    caption = f"""office-graz at 960 x 540: relative root mean square error of pixels of reflected light against the time that the picture
        takes, processor time over two. Reference: twice {REFERENCE_PATHS} paths a pixel, whose noise does not count. Dashed: what is asked for,
        5% in 20 seconds."""
    folder = program.ROOT / "docs/figures"
    drawing.save(figure, folder, "gathering", caption)
    header = ["picture", "rays to solve", "samples", "seconds", "relative RMSE", "mean"]
    results.write_table(folder / "gathering.md", header, lines)


def main(only_draw: bool) -> None:
    if not only_draw:
        measure()
    draw()
