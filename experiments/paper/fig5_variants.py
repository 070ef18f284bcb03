"""Figures 5 and 6: the eight variants of the method."""

from pathlib import Path

import numpy as np
from lab import results
from lab.analysis import drawing
from lab.results import Row
from lab.analysis.statistics import mean_ratio
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
        figure, axes = drawing.panels(len(chosen), size=(3.1, 3.9), share_y=True)
        for ax, (title, shown) in zip(axes, chosen.items()):
            for number, series_name in enumerate(shown):
                drawing.draw_curve(ax, results.curve(series[series_name], x, DISTANCE), series_name, number)
            ax.set_title(title)
            ax.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.2))
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
    write_effects(names, rows, folder)


# Parts of a variant's name: the part that marks the choice, and its replacement.
EFFECTS = {
    "separate over combined": ("si", "ci"),
    "with hi over without": ("+hi", ""),
    "with dr over without": ("+dr", ""),
}


def write_effects(names: list[str], rows: list[Row], folder: Path) -> None:
    """Writes the effect of each choice on the distance, with the others fixed: for each pair, and the mean over all
    seeds."""
    lines = []
    for effect, (has, instead) in EFFECTS.items():
        pairs = [(name, name.replace(has, instead)) for name in names if has in name]
        for budget, runs in results.grouped(rows, "budget").items():
            distance = {(row["series"], row["seed"]): row[DISTANCE] for row in runs}
            seeds = sorted({seed for _, seed in distance})
            ratios = np.array([[distance[a, seed] / distance[b, seed] for a, b in pairs] for seed in seeds])
            each = [f"{a} / {b}: {mean_ratio(column).value:.2f}" for (a, b), column in zip(pairs, ratios.T)]
            of_seeds = np.exp(np.log(ratios).mean(axis=1))
            lines.append([effect, f"{budget / 1e6:g} M", str(mean_ratio(of_seeds)), ", ".join(each)])
    header = ["choice", "rays", f"ratio of {drawing.LABELS[DISTANCE]}", "of each two variants"]
    results.write_table(folder / "fig5-variants-effects.md", header, lines)
