"""Error against rays: scrambled Sobol' points against pseudo-random numbers."""

from pathlib import Path

from lab import results
from lab.analysis import drawing
from lab.results import Row
from lab.analysis.statistics import ratio_at
from lab.tasks import Entry, ladder, reference_of

METRIC = "relative_mse_flat"
PANELS = {"flat": "on a fixed mesh", "hierarchical": "on a mesh that is refined"}


def entries(config: dict) -> list[Entry]:
    return [
        entry for kind in PANELS for entry in ladder(config, config[kind], reference_of(config, f"reference-{kind}"))
    ]


def draw(config: dict, rows: list[Row], folder: Path) -> None:
    series = results.grouped(rows, "series")
    figure, axes = drawing.panels(len(PANELS), size=(3.6, 3.0))
    lines = []
    for ax, (kind, title) in zip(axes, PANELS.items()):
        sobol, random = (results.curve(series[method["name"]], "rays", METRIC) for method in config[kind])
        for number, (method, curve) in enumerate(zip(config[kind], (sobol, random))):
            drawing.draw_curve(ax, curve, method["name"], number)
        drawing.logarithmic(ax, "rays", METRIC)
        ax.set_title(title)
        ax.legend()
        for rays in config["budgets"]:
            lines.append([title, f"{rays / 1e6:g} M", str(ratio_at(sobol, random, rays))])
    caption = f"""Error against rays with scrambled Sobol' points and with pseudo-random numbers: the gap is what even
        spreading of starting points and directions gains. {config['seeds'][0]} seeds a point; bands are 95% confidence
        intervals."""
    drawing.save(figure, folder, "points", caption)
    results.write_table(folder / "points.md", ["mesh", "rays", "error with Sobol' over pseudo-random"], lines)
