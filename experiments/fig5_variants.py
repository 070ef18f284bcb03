"""Figures 5 and 6: the eight variants of the method."""

from pathlib import Path

from lab import drawing, results
from lab.results import Row
from lab.tasks import Entry, ladder, reference_of

DISTANCE = "perceptual_distance_smooth"


def entries(config: dict) -> list[Entry]:
    variants = [
        {
            "name": variant["name"],
            "options": f"{config['schedule']} {variant['options']}",
            "iterations": config["iterations"],
        }
        for variant in config["variants"]
    ]
    return ladder(config, variants + config["methods"], reference_of(config))


def draw(config: dict, rows: list[Row], folder: Path) -> None:
    series = results.grouped(rows, "series")
    names = [variant["name"] for variant in config["variants"]]
    chosen = {
        "separate steps (si)": [name for name in names if name.startswith("si")],
        "combined steps (ci)": [name for name in names if name.startswith("ci")],
        "the paper's best, and the program's schedule": config["best"] + [m["name"] for m in config["methods"]],
    }
    for x, name in (("seconds", "fig5-variants"), ("rays", "fig5-variants-rays")):
        figure, axes = drawing.panels(len(chosen), share_y=True)
        for ax, (title, shown) in zip(axes, chosen.items()):
            for number, series_name in enumerate(shown):
                drawing.draw_curve(ax, results.curve(series[series_name], x, DISTANCE), series_name, number)
            ax.set_title(title)
            ax.legend(fontsize=8)
        for ax in axes:
            drawing.logarithmic(ax, x, DISTANCE)
            ax.label_outer()
        caption = f"""The eight variants: importance and power in separate (si) or combined steps (ci), no refinement in
            the warm-up (dr), importance kept by elements (hi). {config['iterations']} equal iterations, as in the paper.
            Lines that lie within each other's bands (95% confidence) cannot be told apart. Means of
            {min(config['seeds'])} to {max(config['seeds'])} seeds at
            {', '.join(f'{budget / 1e6:g}' for budget in config['budgets'])} million rays."""
        drawing.save(figure, folder, name, caption)
    results.write_summary(folder / "fig5-variants.md", rows)
