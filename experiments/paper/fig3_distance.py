"""Figure 3: distance from the reference against time, with and without importance."""

from pathlib import Path

import numpy as np
from lab import results
from lab.analysis import drawing
from lab.results import Row
from lab.analysis.statistics import ratio_at
from lab.tasks import Entry, ladder, reference_of

DISTANCES = ["perceptual_distance_smooth", "relative_mse_flat", "relative_mse_smooth"]
TIMES = 6  # rows of the table


def entries(config: dict) -> list[Entry]:
    return ladder(config, config["methods"], reference_of(config))


def draw(config: dict, rows: list[Row], folder: Path) -> None:
    series = results.grouped(rows, "series")
    figure, axes = drawing.panels(len(DISTANCES))
    for ax, distance in zip(axes, DISTANCES):
        for number, (name, runs) in enumerate(series.items()):
            drawing.draw_curve(ax, results.curve(runs, "seconds", distance), str(name), number)
        drawing.logarithmic(ax, "seconds", distance)
    drawing.shared_legend(figure, axes[0], 2)
    caption = f"""Distance from the reference (path-traced, {config['reference']['paths']} paths a pixel) against the
        solver's time; lower is better, and the gap between the lines at a time is what importance gains. Each point is
        the mean of separate runs of that many rays ({min(config['seeds'])} to {max(config['seeds'])} seeds); bands are 95%
        confidence intervals. {', '.join(f'{b / 1e6:g}' for b in config['budgets'])} million rays."""
    drawing.save(figure, folder, "fig3-distance", caption)
    write_ratios(config, series, folder)
    results.write_summary(folder / "fig3-distance.md", rows)


def write_ratios(config: dict, series: dict[str | float, list[Row]], folder: Path) -> None:
    """Writes the ratio of the error with importance to that without, at times that both have reached."""
    importance, none = (series[method["name"]] for method in config["methods"])
    curves = {d: [results.curve(runs, "seconds", d) for runs in (importance, none)] for d in DISTANCES}
    a, b = curves[DISTANCES[0]]
    times = np.geomspace(max(a.x[0], b.x[0]), min(a.x[-1], b.x[-1]), TIMES)
    lines = []
    for time in times:
        ratios = [ratio_at(*curves[d], time) for d in DISTANCES]
        lines.append([f"{time:.2g}", *map(str, ratios)])
    header = ["seconds", *(f"ratio of {drawing.LABELS[d]}" for d in DISTANCES)]
    results.write_table(folder / "fig3-distance-ratios.md", header, lines)
