"""Averaging of iterations: the program's schedule against the paper's, at equal rays."""

from pathlib import Path

from lab import results
from lab.analysis import drawing
from lab.results import Row
from lab.tasks import Entry, ladder, reference_of

METRICS = ["relative_mse_flat", "relative_mse_smooth"]


def entries(config: dict) -> list[Entry]:
    return ladder(config, config["methods"], reference_of(config))


def draw(config: dict, rows: list[Row], folder: Path) -> None:
    figure, axes = drawing.panels(len(METRICS), size=(4.0, 3.0))
    for ax, metric in zip(axes, METRICS):
        for number, (name, runs) in enumerate(results.grouped(rows, "series").items()):
            drawing.draw_curve(ax, results.curve(runs, "rays", metric), str(name), number)
        drawing.logarithmic(ax, "rays", metric)
    drawing.shared_legend(figure, axes[0], 2)
    iterations = next(method["iterations"] for method in config["methods"] if "iterations" in method)
    caption = f"""Importance-driven runs with the program's schedule, whose iterations follow the light bounce by bounce and grow, and with the paper's: {iterations} equal iterations from darkness. Trust is how much its
        parent's past counts for a new element. Bands are 95% confidence intervals."""
    drawing.save(figure, folder, "averaging", caption)
    results.write_summary(folder / "averaging.md", rows)
