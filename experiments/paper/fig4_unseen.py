"""Figure 4: importance, and hierarchical and flat importance-driven solutions in rooms outside the view."""

from pathlib import Path

from lab import results
from lab.analysis import drawing
from lab.results import Row
from lab.tasks import Entry, Measure, Picture, Solve, reference_of


def entries(config: dict) -> list[Entry]:
    solves = {
        method["name"]: Solve(config["scene"], config["view"], method["options"], config["rays"], config["seed"])
        for method in config["methods"] + config["also"]
    }
    first = next(iter(solves.values()))
    shown = reference_of(config, "shown")
    above, look = config["overview_picture"], config["picture"]
    found = [
        Entry("importance: overview", Picture(first, config["overview"], f"{above} --show importance")),
        Entry("reference: unseen", Picture(shown, config["unseen"], f"{look} --shading flat")),
    ]
    for method in config["methods"]:
        for place, options in (("overview", above), ("unseen", look)):
            picture = Picture(solves[method["name"]], config[place], f"{options} --shading flat")
            found.append(Entry(f"{method['name']}: {place}", picture))
    for name, solve in solves.items():
        for place, view in (("seen", config["view"]), ("unseen", config["unseen"])):
            found.append(Entry(f"{name}: error {place}", Measure(solve, view, reference_of(config | {"view": view}))))
    return found


def draw(config: dict, rows: list[Row], folder: Path) -> None:
    by_name = {row["series"]: row for row in rows}
    names = [method["name"] for method in config["methods"]]

    def error(name: str, place: str) -> float:
        return by_name[f"{name}: error {place}"]["relative_mse_flat"]

    figure, axes = drawing.panels(3, 2, size=(3.4, 2.5))
    drawing.show_picture(axes[0], by_name["importance: overview"]["picture"], "importance")
    drawing.show_picture(axes[3], by_name["reference: unseen"]["picture"], "unseen room: reference")
    for ax, below, name in zip(axes[1:3], axes[4:6], names):
        elements = by_name[f"{name}: overview"]["elements"]
        drawing.show_picture(ax, by_name[f"{name}: overview"]["picture"], f"{name}: {elements:,.0f} elements")
        title = f"unseen room, {name}: relative MSE {error(name, 'unseen'):.3g}"
        drawing.show_picture(below, by_name[f"{name}: unseen"]["picture"], title)
    caption = f"""The maze without furniture from above: the importance of the view from one room, the hierarchical
        solution that it drives, and that on fixed elements, {config['rays'] / 1e6:g} million rays each, all of which follow
        importance. Below, a room that the view does not see: with a hierarchy its error is coarseness, on fixed elements
        it is noise. The rooms on the right have no importance at all and are dim or dark, which is why by default a share of the
        rays follows power alone."""
    drawing.save(figure, folder, "fig4-unseen", caption)

    lines = []
    for name in names + [method["name"] for method in config["also"]]:
        row = by_name[f"{name}: error seen"]
        cells = [f"{row['elements']:,.0f}", f"{row['seconds']:.1f}"]
        lines.append([name, *cells, *(f"{error(name, place):.3g}" for place in ("seen", "unseen"))])
    header = ["method", "elements", "seconds", "relative MSE, seen room", "relative MSE, unseen room"]
    results.write_table(folder / "fig4-unseen.md", header, lines)
