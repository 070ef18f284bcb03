"""Figure and tables of the comparison."""

import itertools
import math
from pathlib import Path

from lab import results
from lab.analysis import drawing

from .bench import DEFAULT, OURS, TEXTS, all_series, references_of
from .scenes import SCENES

SMALLEST = 1e-6  # of errors of blocks, which may be 0 by noise
PIXELS = ("pixels", "trimmed")  # errors that the noise of the references limits
COLUMNS = 3  # of panels
LARGEST = 300  # error in a panel [%]; a mesh that leaks light may have far more
CAPTION = """Pictures of {size} pixels: relative root mean square error of the luminance of pixels against the time of the
    whole process. The circle is Interflect with its default settings. References: path tracing by Interflect and by
    Mitsuba, whose noise does not count."""


def write(table: Path, folder: Path) -> None:
    rows = results.read_csv(table, TEXTS)
    small = min((row["size"] for row in rows), key=lambda size: int(size.partition("x")[0]))
    references = results.read_csv(references_of(table), TEXTS)
    found = smallest_errors(references)
    draw_curves([row for row in rows if row["size"] == small and row["scene"] in SCENES], folder, small, found)
    write_rows(rows, folder / "peers.md", small, found)
    write_times([row for row in rows if row["size"] == small], folder / "peers-times.md", found)
    write_agreement(references, folder / "peers-references.md")


Smallest = dict[tuple[str, str], float]  # error of pixels that stands out of the noise of the references: by scene and size


def smallest_errors(references: list[dict]) -> Smallest:
    return {(row["scene"], row["size"]): row["smallest"] for row in references}


def error_of(row: dict, kind: str, smallest: Smallest) -> float:
    """Returns the error, at least the smallest that is found."""
    return max(row[kind], smallest[row["scene"], row["size"]] if kind in PIXELS else SMALLEST)


def draw_curves(rows: list[dict], folder: Path, size: str, smallest: Smallest) -> None:
    """Draws a panel for each scene, held-out scenes excepted."""
    scenes = results.grouped(rows, "scene")
    if not scenes:
        return
    figure, panels = drawing.panels(min(COLUMNS, len(scenes)), -(-len(scenes) // COLUMNS), size=(3.3, 3.1))
    for axes in panels[len(scenes) :]:
        axes.axis("off")
    for (name, found), axes in zip(scenes.items(), panels):
        by_series = results.grouped(found, "series")
        for number, series in enumerate(all_series()):
            runs = sorted(by_series.get(series.name, []), key=lambda row: row["seconds"])
            if runs:
                curve = [row["seconds"] for row in runs], [100 * error_of(row, "pixels", smallest) for row in runs]
                axes.plot(*curve, label=series.name, **drawing.style_of(number))
        for row in (row for row in found if (row["series"], row["settings"]) == (OURS, DEFAULT)):
            style = {"markersize": 11, "markerfacecolor": "none", "markeredgecolor": "#333333", "linestyle": "none"}
            axes.plot([row["seconds"]], [100 * error_of(row, "pixels", smallest)], marker="o", **style)
        axes.set_yscale("log")
        axes.set_ylim(top=min(LARGEST, axes.get_ylim()[1]))
        drawing.logarithmic(axes, "time of the whole process [s]", "relative RMS error of pixels [%]")
        axes.set_title(name)
    most = max(range(len(scenes)), key=lambda k: len(panels[k].get_lines()))
    drawing.shared_legend(figure, panels[most], 5)
    drawing.save(figure, folder, "peers", CAPTION.format(size=size.replace("x", " x ")))


def write_rows(rows: list[dict], path: Path, small: str, smallest: Smallest) -> None:
    """Writes a line for each picture, sorted by scene, size, program and time."""
    order = [series.name for series in all_series()]
    lines = []
    for name, found in results.grouped(rows, "scene").items():
        for row in sorted(found, key=lambda row: (row["size"] != small, order.index(row["series"]), row["seconds"])):
            size = "" if row["size"] == small else f", {row['size'].replace('x', ' x ')}"
            errors = [shown_error(row, kind, smallest) for kind in (*PIXELS, "blocks_4", "blocks_9")]
            cost = [f"{row['seconds']:.1f}", f"{row['peak_mib']:,.0f}"]
            lines.append([name + size, row["series"], shown(row), *cost, *errors, f"{100 * (row['mean'] - 1):+.2f}%"])
    header = ["scene", "program", "settings", "seconds", "peak MiB"]
    header += ["pixels", "trimmed", "blocks of 4", "blocks of 9", "mean"]
    results.write_table(path, header, lines)


def shown(row: dict) -> str:
    """Returns the settings for a reader: samples, or the options that differ from the default."""
    if row["series"] == OURS:
        return row["settings"].removeprefix(DEFAULT).strip() or "default"
    first = row["settings"].split()[0]
    return f"{first} samples" if first.isdigit() else f"`{row['settings']}`"


def shown_error(row: dict, kind: str, smallest: Smallest) -> str:
    error = error_of(row, kind, smallest)
    return f"{'' if error == row[kind] else '< '}{100 * error:.3g}%"


def write_times(rows: list[dict], path: Path, smallest: Smallest) -> None:
    """Writes the time in which each program reaches the error of ours with its default settings, and the time in which
    ours reaches the smallest error that was measured of the other program."""
    lines = []
    for name, found in results.grouped(rows, "scene").items():
        by_series = results.grouped(found, "series")
        ours = by_series.get(OURS, [])
        default = next((row for row in ours if row["settings"] == DEFAULT), None)
        if default is None:
            continue
        of_ours = [f"{default['seconds']:.1f} ({shown_error(default, kind, smallest)})" for kind in ("pixels", "blocks_4")]
        lines.append([name, OURS, *of_ours, "", ""])
        for series in (series for series in all_series() if series.name != OURS and series.name in by_series):
            runs = by_series[series.name]
            kinds = ("pixels", "blocks_4")
            times = [seconds_to(error_of(default, kind, smallest), runs, kind, series.unbiased) for kind in kinds]
            best = min(runs, key=lambda row: row["pixels"])
            equal = seconds_to(error_of(best, "pixels", smallest), ours, "pixels", False)
            its_best = [f"{best['seconds']:.1f} ({shown_error(best, 'pixels', smallest)})"]
            its_best += [f"{equal} ({best['seconds'] / equal:.1f} times)"]
            lines.append([name, series.name, *[f"{time} {factor(time, default['seconds'])}" for time in times], *its_best])
    header = ["scene", "program", "seconds to the error of ours by default, pixels", "blocks of 4"]
    header += ["its smallest error", "seconds of ours to it"]
    results.write_table(path, header, lines)


class Time(float):
    """Seconds, with a word that limits them: "<", ">" or "about"."""

    def __new__(cls, word: str, seconds: float) -> "Time":
        time = super().__new__(cls, seconds)
        time.word = word
        return time

    def __str__(self) -> str:
        return f"{self.word} {float(self):,.{1 if self < 100 else 0}f}".strip()


def seconds_to(error: float, runs: list[dict], kind: str, unbiased: bool) -> Time:
    """Returns the time of a curve at this error, interpolated in logarithms. An unbiased curve is extrapolated with the
    root of time; others may not reach the error at any time."""
    points = sorted((row["seconds"], max(row[kind], SMALLEST)) for row in runs)
    if points[0][1] <= error:
        return Time("<", points[0][0])
    for (before, larger), (after, smaller) in itertools.pairwise(points):
        if smaller <= error:
            share = math.log(larger / error) / math.log(larger / smaller)
            return Time("", before * (after / before) ** share)
    last, reached = points[-1]
    return Time("about", last * (reached / error) ** 2) if unbiased else Time(">", last)


def factor(time: Time, ours: float) -> str:
    """Returns the time as a multiple of our time."""
    return f"({time.word} {float(time) / ours:.{1 if time < 10 * ours else 0}f} times)".replace("( ", "(")


def write_agreement(rows: list[dict], path: Path) -> None:
    lines = []
    for row in rows:
        mean = f"{100 * (row['ratio_of_means'] - 1):+.2f}% ± {100 * row['error_of_ratio']:.2f}%"
        others = [f"{100 * row[kind]:.3g}%" for kind in ("blocks_9", "noise_of_ours", "noise_of_theirs", "smallest")]
        lines.append([row["scene"], row["size"].replace("x", " x "), f"{2 * row['samples']:g}", mean, *others])
    header = ["scene", "pixels", "samples", "mean of Mitsuba's over ours", "difference of blocks of 9"]
    header += ["noise of ours", "of Mitsuba's", "smallest error that is found"]
    results.write_table(path, header, lines)
