"""Figures 5 and 6: the eight variants of the method."""

from pathlib import Path

from lab import drawing, results
from lab.results import Row
from lab.tasks import Entry, ladder, reference_of

DISTANCE = "perceptual_distance_smooth"


def entries(config: dict) -> list[Entry]:
    return ladder(config, config["methods"], reference_of(config))


def draw(config: dict, rows: list[Row], folder: Path) -> None:
    series = results.grouped(rows, "series")
    chosen = {
        "separate steps (si)": [name for name in series if str(name).startswith("si")],
        "combined steps (ci)": [name for name in series if str(name).startswith("ci")],
        "the paper's best": config["best"],
    }
    for x, name in (("seconds", "fig5-variants"), ("rays", "fig5-variants-rays")):
        figure, axes = drawing.panels(3)
        for ax, (title, names) in zip(axes, chosen.items()):
            for number, series_name in enumerate(names):
                drawing.draw_curve(ax, results.curve(series[series_name], x, DISTANCE), str(series_name), number)
            drawing.logarithmic(ax, x, DISTANCE)
            ax.set_title(title)
            ax.legend()
        for ax in axes[1:]:
            ax.sharey(axes[0])
        caption = f"""The eight variants: importance and power in separate (si) or combined steps (ci), no refinement before
            averaging begins (dr), importance kept by elements (hi). Lines that lie within each other's bands (95%
            confidence) cannot be told apart. {', '.join(f'{b / 1e6:g}' for b in config['budgets'])} million rays, means of
            {min(config['seeds'])} to {max(config['seeds'])} seeds."""
        drawing.save(figure, folder, name, caption)
    results.write_summary(folder / "fig5-variants.md", rows)
