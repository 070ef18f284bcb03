"""Figure 1: the reference picture."""

from pathlib import Path

from lab.analysis import drawing
from lab.results import Row
from lab.tasks import Entry, Picture, reference_of


def entries(config: dict) -> list[Entry]:
    return [Entry("reference", Picture(reference_of(config), config["view"], config["picture"]))]


def draw(config: dict, rows: list[Row], folder: Path) -> None:
    (row,) = rows
    figure, (axes,) = drawing.panels(1, size=(6.4, 3.8))
    drawing.show_picture(axes, row["picture"], f"{row['rays'] / 1e6:.0f} million rays, {row['elements']:,.0f} elements")
    caption = f"""The reference: {row['scene']} seen from one of its nine rooms, solved without importance, every ray kept
        ({config['reference']['options'].split()[1]}), in {row['seconds']:.0f} s. The paper's has 433 million rays and
        308,018 elements. Errors are measured against path-traced pictures."""
    drawing.save(figure, folder, "fig1-reference", caption)
