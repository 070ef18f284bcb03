"""Error against rays for each method, with fitted slopes."""

import dataclasses
from pathlib import Path

import numpy as np
from lab import results
from lab.analysis import drawing
from lab.results import Row
from lab.analysis.statistics import Curve, fit_power_law
from lab.tasks import Entry, Measure, Solve, ladder, reference_of


def entries(config: dict) -> list[Entry]:
    small = config["small"]
    found = ladder(config, config["flat"], reference_of(config, "reference-flat"))
    found += ladder(config, config["hierarchical"], reference_of(config, "reference-hierarchical"))
    found += ladder(config | small, small["methods"], reference_of(small))
    for method in small["links"]:
        for epsilon in small["epsilons"]:
            solve = Solve(small["scene"], small["view"], f"{method['options']} --epsilon {epsilon:g}", small["rays"], 1)
            found.append(Entry(method["name"], Measure(solve, small["view"], reference_of(small))))
    return found


def draw(config: dict, rows: list[Row], folder: Path) -> None:
    small = config["small"]
    panels = [
        ("one mesh for all", config["scene"], config["flat"]),
        ("meshes that are refined", config["scene"], config["hierarchical"]),
        (f"{small['scene']}, beside deterministic links", small["scene"], small["methods"] + small["links"]),
    ]
    figure, axes = drawing.panels(len(panels), size=(3.4, 4.3))
    lines = []
    for ax, (title, scene, methods) in zip(axes, panels):
        for number, method in enumerate(methods):
            runs = [row for row in rows if row["series"] == method["name"] and row["scene"] == scene]
            error = relative_rmse(runs)
            slope = "" if method in small["links"] else slope_of(runs)
            drawing.draw_curve(ax, error, f"{method['name']}  {slope}".strip(), number)
            lines.append([scene, method["name"], f"{error.x[-1] / 1e6:.3g} M", f"{100 * error.y[-1]:.2g}%", slope])
        drawing.logarithmic(ax, "rays", "relative RMSE, flat shading")
        drawing.guide(ax, config["budgets"], ax.get_ylim()[1], -0.5, "slope -1/2")
        ax.set_title(title)
        ax.legend(fontsize=7.5, loc="upper center", bbox_to_anchor=(0.5, -0.2))
    caption = f"""Relative root mean square error of the picture against rays. The number beside a method is the slope of the
        line fitted to all its runs, with its 95% confidence interval: -0.5 is that of independent samples, steeper is
        better. {config['seeds'][0]} seeds a point; bands are 95% confidence intervals. Left, all methods have the same
        fixed mesh and err by noise alone; in the middle, a line that levels off has reached what its mesh smooths away.
        Right, hr has no noise: its points are thresholds, and its rays only ask what is in sight."""
    drawing.save(figure, folder, "convergence", caption)
    results.write_table(folder / "convergence.md", ["scene", "method", "rays", "relative RMSE, flat", "slope"], lines)


def relative_rmse(runs: list[Row]) -> Curve:
    """Returns error against rays. Link methods have a run per threshold, all in one budget, sorted by rays.
    """
    if len({row["seed"] for row in runs}) == 1:
        x, y = np.array(sorted((row["rays"], row["relative_mse_flat"]) for row in runs)).T
        return Curve(x, np.sqrt(y), np.full(len(x), np.nan), 0)
    squared = results.curve(runs, "rays", "relative_mse_flat")
    return dataclasses.replace(squared, y=np.sqrt(squared.y), spread=squared.spread / 2)


def slope_of(runs: list[Row]) -> str:
    law = fit_power_law(results.values(runs, "rays"), np.sqrt(results.values(runs, "relative_mse_flat")))
    return f"{law.slope:.2f} ± {law.half_width:.2f}"
