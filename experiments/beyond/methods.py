"""Error of every method against rays and time, on three scenes."""

from pathlib import Path

from measured.audit_scenes import SCENES as AUDIT_SCENES
from lab import program, results
from lab.analysis import drawing, statistics
from lab.results import Row
from lab.tasks import Entry, ladder, reference_of

WORK = program.ROOT / "out/experiments/cache/methods"
METRIC = "relative_mse_smooth"


def scenes(config: dict) -> list[dict]:
    """Returns the scenes with file and view."""
    found = []
    for one in config["scenes"]:
        if "made" in one:
            path = (WORK / f"{one['made']}.mgf").relative_to(program.ROOT)
            view = AUDIT_SCENES[one["made"]]().view()
            one = one | {"scene": str(path), "view": view, "has_luminaires": True}
        found.append(one)
    return found


def prepare(config: dict) -> None:
    """Writes the scenes that are made."""
    for one in config["scenes"]:
        if "made" in one:
            scene = AUDIT_SCENES[one["made"]]()
            scene.write(WORK, one["made"], scene.text)


def methods(config: dict, scene: dict) -> list[dict]:
    suitable = [m for m in config["methods"] if not (m.get("surfaces_only") and scene.get("has_luminaires"))]
    return [method | {"options": f"--method {method['name']}"} for method in suitable]


def entries(config: dict) -> list[Entry]:
    found = []
    for scene in scenes(config):
        found += ladder(config | scene, methods(config, scene), reference_of(scene))
    return found


def draw(config: dict, rows: list[Row], folder: Path) -> None:
    everywhere = scenes(config)
    figure, axes = drawing.panels(len(everywhere), 2, size=(3.3, 3.0))
    lines = []
    for column, scene in enumerate(everywhere):
        runs = [row for row in rows if row["scene"] == scene["scene"]]
        for row, cost in enumerate(("rays", "processor_seconds")):
            ax = axes[row * len(everywhere) + column]
            for number, method in enumerate(config["methods"]):
                of_method = [run for run in runs if run["series"] == method["name"]]
                if of_method:
                    drawing.draw_curve(ax, results.curve(of_method, cost, METRIC), method["name"], number)
            drawing.logarithmic(ax, cost, METRIC)
            ax.set_title(scene["name"])
        for (series, budget), seeds in sorted_runs(runs):
            error = statistics.mean(results.values(seeds, METRIC))
            mean = statistics.mean(results.values(seeds, "ratio_of_means_smooth"))
            elements, seconds = (results.values(seeds, name).mean() for name in ("elements", "processor_seconds"))
            cells = [str(error), str(mean), f"{seconds:.2g}", f"{elements:,.0f}"]
            lines.append([scene["name"], series, f"{budget / 1e6:g} M", *cells])
    drawing.shared_legend(figure, axes[0], 6)
    caption = f"""Relative mean square error of smooth pictures against rays (top) and processor time of `solve` (bottom).
        {config['seeds'][0]} seeds a point; bands are 95% confidence intervals."""
    drawing.save(figure, folder, "methods", caption)
    header = ["scene", "method", "rays", "relative MSE, smooth", "mean over path", "processor time [s]", "elements"]
    results.write_table(folder / "methods.md", header, lines)


def sorted_runs(runs: list[Row]):
    for series, of_series in results.grouped(runs, "series").items():
        for budget, seeds in results.grouped(of_series, "budget").items():
            yield (series, budget), seeds
