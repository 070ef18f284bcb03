"""Error of gathered pictures against their time: `experiments/run gathering`.

Pictures of office-graz at 960 x 540 pixels: final gathering with and without the filter, smooth elements, and path
tracing. Existing rows of results/gathering.csv are not measured again. The reference consists of two path-traced
pictures, whose noise cancels. Time is the processor time of reading, solving and drawing, divided by two processors, so
other work on the machine does not count.
"""

import resource
import sys
import tempfile
from pathlib import Path

from lab import drawing, program, results
from lab.picture import luminance, read_exr
from lab.reference import Reference

WORK = program.ROOT / "out/experiments/cache/gathering"
TABLE = program.ROOT / "experiments/results/gathering.csv"
SCENE = f"{program.SCENES}/office-graz.mgf"
VIEW = "--eye 3.7037,0.0788,2.2690 --look-at 1.0023,8.9229,-1.1130 --size 960x540"
REFERENCE_PATHS = 96
PROCESSORS = 2
WORKS = {  # series: rays to solve with (0 for path tracing), samples
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
            reference = reference or Reference(command, WORK, "", f"{SCENE} {VIEW}", REFERENCE_PATHS)
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
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1), ncols=2)
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
