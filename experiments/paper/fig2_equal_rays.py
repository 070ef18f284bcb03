"""Figure 2: pictures at equal rays with and without importance, and their meshes."""

from pathlib import Path

from lab.analysis import drawing
from lab.results import Row
from lab.tasks import Entry, Picture, Solve

SHOWN = {"light": "--shading smooth", "mesh": "--show mesh --shading flat"}


def entries(config: dict) -> list[Entry]:
    found = []
    for method in config["methods"]:
        solve = Solve(config["scene"], config["view"], method["options"], config["rays"], config["seed"])
        for shown, options in SHOWN.items():
            picture = Picture(solve, config["view"], f"{config['picture']} {options}")
            found.append(Entry(f"{method['name']}: {shown}", picture))
    return found


def draw(config: dict, rows: list[Row], folder: Path) -> None:
    by_name = {row["series"]: row for row in rows}
    counts = [by_name[f"{method['name']}: light"]["elements"] for method in config["methods"]]
    captions = {
        "light": f"""The same room after {config['rays'] / 1e6:g} million rays each. With importance the rays go where the
            room gets its light from: look at how even the walls are, and at the shadows below the furniture.
            Elements: {counts[0]:,.0f} with, {counts[1]:,.0f} without, a ratio of {counts[0] / counts[1]:.3f} (the paper:
            48,702 of 324,606, 0.150).""",
        "mesh": """The elements of the two solutions in the room that is seen. What importance saves is where it is not: most of the
            elements without it are in the other eight rooms.""",
    }
    for shown, caption in captions.items():
        figure, axes = drawing.panels(2, size=(4.2, 2.6))
        for ax, method in zip(axes, config["methods"]):
            row = by_name[f"{method['name']}: {shown}"]
            title = f"{method['name']}: {row['elements']:,.0f} elements, {row['seconds']:.1f} s"
            drawing.show_picture(ax, row["picture"], title)
        name = "fig2-equal-rays" + ("" if shown == "light" else f"-{shown}")
        drawing.save(figure, folder, name, caption)
