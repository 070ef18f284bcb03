"""View factors of three pairs of surfaces against their closed forms.

    python3 examples/view_factors.py

The view factor F12 is the fraction of the diffuse radiation that leaves surface 1 and reaches surface 2 directly. The
closed forms are C-11, C-14 and C-41 of J. R. Howell, A Catalog of Radiation Heat Transfer Configuration Factors.
"""

import argparse
from pathlib import Path

import interflect as ifl
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

SQUARE = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], float)
SIDES = 256  # of the polygons that stand for discs


def surfaces(first: np.ndarray, second: np.ndarray) -> ifl.Scene:
    """Two polygons of the same number of vertices, as objects "1" and "2", which see each other.

    `first` is counter-clockwise seen from `second`, and the reverse. Faces are triangles that share a vertex.
    """
    n = len(first)
    fan = np.array([(0, k, k + 1) for k in range(1, n - 1)])
    return ifl.Scene(
        np.concatenate([first, second]),
        np.concatenate([fan, n + fan]),
        ifl.Material("black"),
        objects=["1", "2"],
        face_objects=np.repeat([0, 1], len(fan)),
    )


def parallel_squares(distance: float) -> tuple[ifl.Scene, float]:
    """Facing unit squares, C-11."""
    x = 1 / distance
    root = np.sqrt(1 + x * x)
    exact = 2 / (np.pi * x * x) * (np.log(root**2 / np.sqrt(1 + 2 * x * x)) + 2 * x * root * np.arctan(x / root))
    exact -= 4 / (np.pi * x) * np.arctan(x)
    return surfaces(SQUARE, SQUARE[::-1] + (0, 0, distance)), exact


def perpendicular_squares(height: float) -> tuple[ifl.Scene, float]:
    """A unit square and a rectangle of this height that share an edge, C-14."""
    h, w = height, 1.0
    a, b, c = 1 + w * w, 1 + h * h, 1 + w * w + h * h
    d = w * w + h * h
    logarithm = np.log(a * b / c * (w * w * c / (a * d)) ** (w * w) * (h * h * c / (b * d)) ** (h * h)) / 4
    angles = w * np.arctan(1 / w) + h * np.arctan(1 / h) - np.sqrt(d) * np.arctan(1 / np.sqrt(d))
    wall = np.array([(0, 0, 0), (0, 1, 0), (0, 1, height), (0, 0, height)])
    return surfaces(SQUARE, wall), (angles + logarithm) / (np.pi * w)


def coaxial_discs(distance: float) -> tuple[ifl.Scene, float]:
    """Facing discs of radius 1, C-41."""
    angle = 2 * np.pi * np.arange(SIDES) / SIDES
    radius = np.sqrt(2 * np.pi / SIDES / np.sin(2 * np.pi / SIDES))  # the polygon has the area of the disc
    disc = radius * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    s = 2 + distance**2
    return surfaces(disc, disc[::-1] + (0, 0, distance)), (s - np.sqrt(s * s - 4)) / 2


SHAPES = {
    "parallel squares": parallel_squares,
    "perpendicular squares": perpendicular_squares,
    "coaxial discs": coaxial_discs,
}
SIZES = (0.25, 0.5, 1, 2, 4)  # distance, or height of the perpendicular rectangle


def compare(rays: float) -> pd.DataFrame:
    rows: list[dict] = []
    for name, shape in SHAPES.items():
        for size in SIZES:
            scene, exact = shape(size)
            factors = ifl.view_factors(scene, rays=rays, seed=len(rows) + 1)
            first, second = factors.names.index("1"), factors.names.index("2")
            estimate, error = factors.dense()[first, second], factors.dense_errors()[first, second]
            rows.append({"surfaces": name, "size": size, "exact": exact, "estimate": estimate, "standard error": error})
    table = pd.DataFrame(rows)
    table["deviation"] = (table["estimate"] - table["exact"]) / table["standard error"]
    return table


def draw(table: pd.DataFrame) -> plt.Figure:
    figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
    sizes = np.geomspace(min(SIZES), max(SIZES), 100)
    for (name, shape), colour in zip(SHAPES.items(), ("tab:blue", "tab:orange", "tab:green")):
        axes.loglog(sizes, [shape(size)[1] for size in sizes], color=colour, label=name)
        rows = table[table["surfaces"] == name]
        axes.loglog(rows["size"], rows["estimate"], "o", color=colour)
    axes.set(xlabel="distance or height, in sides or radii", ylabel="view factor $F_{12}$")
    axes.set_title("Estimates (dots) and closed forms (lines)")
    axes.grid(which="both", alpha=0.3)
    axes.legend()
    return figure


def main(arguments: list[str] | None = None) -> pd.DataFrame:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rays", type=float, default=4e6, help="rays of each pair of surfaces")
    parser.add_argument("--output", type=Path, default=Path("out/examples"), help="folder of the plot")
    options = parser.parse_args(arguments)
    options.output.mkdir(parents=True, exist_ok=True)

    table = compare(options.rays)
    draw(table).savefig(options.output / "view-factors.png", dpi=120)
    print("View factors [1]; deviation from the closed form in standard errors")
    print(table.to_string(index=False, float_format="{:.5f}".format))
    return table


if __name__ == "__main__":
    main()
