"""Cost of the view of one room against the size of the world around it."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from lab import results
from lab.analysis import drawing
from lab.results import Row
from lab.analysis.statistics import crossing, fit_power_law
from lab.tasks import Entry, Measure, Solve, reference_of


def entries(config: dict) -> list[Entry]:
    found = []
    for number, world in enumerate(config["worlds"]):
        reference = reference_of(config | world)
        for method in config["methods"]:
            budgets = method.get("rays") or [world["rooms"] * rays for rays in method["rays_per_room"]]
            for rays in budgets:
                for seed in range(1, method["seeds"][number] + 1):
                    solve = Solve(world["scene"], world["view"], method["options"], rays, seed)
                    found.append(Entry(method["name"], Measure(solve, world["view"], reference)))
    return found


@dataclass(frozen=True)
class Need:
    """Cost of a method in one world to reach the target error."""

    rooms: int
    rays: float
    seconds: float
    elements: float
    peak_mib: float
    measured: bool  # False: extrapolated


COSTS = ["rays", "seconds", "elements", "peak_mib"]


def needs_of(config: dict, runs: list[Row]) -> list[Need]:
    needs = []
    for world in config["worlds"]:
        here = [row for row in runs if row["scene"] == world["scene"]]
        error = results.curve(here, "rays", config["metric"])
        rays, extrapolated = crossing(error.x, error.y, config["target"])
        costs = {"rays": rays}
        for cost in COSTS[1:]:
            c = results.curve(here, "rays", cost)
            if cost == "seconds" and extrapolated:
                costs[cost] = float(fit_power_law(c.x, c.y)(rays))
            else:
                costs[cost] = float(np.exp(np.interp(np.log(rays), np.log(c.x), np.log(c.y))))
        needs.append(Need(rooms=world["rooms"], measured=not extrapolated, **costs))
    return needs


def draw(config: dict, rows: list[Row], folder: Path) -> None:
    needs = {name: needs_of(config, runs) for name, runs in results.grouped(rows, "series").items()}
    figure, axes = drawing.panels(2, 2, size=(4.0, 2.7))
    for ax, cost in zip(axes, COSTS):
        for number, (name, worlds) in enumerate(needs.items()):
            draw_needs(ax, worlds, cost, str(name), number)
        drawing.logarithmic(ax, "rooms of the world", cost)
        ax.set_xticks([world["rooms"] for world in config["worlds"]], [str(w["rooms"]) for w in config["worlds"]])
        ax.minorticks_off()
    drawing.shared_legend(figure, axes[0], len(needs))
    caption = f"""What it takes to draw one room with a {drawing.LABELS[config['metric']]} of {config['target']:g}, against the
        number of rooms around it: flat lines mean that the rest of the world costs nothing. Hollow marks are extrapolated
        from the runs there are. Reference: path-traced, {config['reference']['paths']} paths a pixel."""
    drawing.save(figure, folder, "world-size", caption)
    draw_errors(config, rows, folder)
    write_needs(needs, folder)


def draw_needs(axes, worlds: list[Need], cost: str, label: str, number: int) -> None:
    style = drawing.style_of(number)
    rooms, values = [need.rooms for need in worlds], [getattr(need, cost) for need in worlds]
    axes.plot(rooms, values, color=style["color"], label=label)
    for need, value in zip(worlds, values):
        axes.plot(need.rooms, value, **style, markerfacecolor=style["color"] if need.measured else "white")


def draw_errors(config: dict, rows: list[Row], folder: Path) -> None:
    figure, axes = drawing.panels(len(config["worlds"]), size=(2.2, 2.7), share_y=True)
    for ax, world in zip(axes, config["worlds"]):
        here = results.grouped((row for row in rows if row["scene"] == world["scene"]), "series")
        for number, (name, runs) in enumerate(here.items()):
            drawing.draw_curve(ax, results.curve(runs, "rays", config["metric"]), str(name), number)
        ax.axhline(config["target"], color="#999999", linestyle=":")
        ax.set_title(f"{world['rooms']} rooms" if world["rooms"] > 1 else "1 room")
    for ax in axes:
        drawing.logarithmic(ax, "rays", config["metric"])
        ax.label_outer()
    drawing.shared_legend(figure, axes[0], 3)
    caption = """Error of the view of one room against rays, by the size of the world around it; bands are 95% confidence
        intervals. Where a line crosses the dotted one, the rays of the other figure are read."""
    drawing.save(figure, folder, "world-size-errors", caption)


def write_needs(needs: dict, folder: Path) -> None:
    lines = []
    for name, worlds in needs.items():
        for need in worlds:
            mark = "" if need.measured else " (extrapolated)"
            rays = f"{need.rays / 1e6:.3g} M{mark}"
            lines.append(
                [str(need.rooms), name, rays, f"{need.seconds:.2g}", f"{need.elements:,.0f}", f"{need.peak_mib:,.0f}"]
            )
    results.write_table(folder / "world-size.md", ["rooms", "method", "rays", "seconds", "elements", "peak MiB"], lines)
