"""Illuminance of an office on its working plane: a plan in false colours, and the numbers of EN 12464-1.

    python3 examples/office_plan.py
"""

import argparse
from pathlib import Path

import interflect as ifl
import matplotlib.pyplot as plt
import numpy as np


SCENE = Path(__file__).resolve().parents[1] / "scenes" / "office.mgf"
FURNITURE = ("office.desks", "office.north_wall", "office.lounge", "office.vase")
WORKING_PLANE = 0.75  # height above the floor [m]
BOUNDARY = 0.5  # strip along the walls without measuring points [m]
NEEDED_MEAN, NEEDED_UNIFORMITY = 500, 0.6  # EN 12464-1 for reading and writing: maintained mean [lx] and U0


def without(scene: ifl.Scene, objects: tuple[str, ...]) -> ifl.Scene:
    """The scene without these objects and the objects nested in them."""
    removed = np.array([(name + ".").startswith(tuple(f"{o}." for o in objects)) for name in scene.objects])
    # A two-sided face has two patches. Scene() makes the second one from the first.
    is_front = (scene.other_sides < 0) | (scene.other_sides > np.arange(len(scene.faces)))
    kept = is_front & ~removed[scene.face_objects]
    return ifl.Scene(
        scene.vertices + np.array(scene.origin),
        scene.faces[kept],
        scene.materials,
        face_materials=scene.face_materials[kept],
        face_objects=scene.face_objects[kept],
        objects=scene.objects,
        two_sided=scene.other_sides[kept] >= 0,
        luminaires=scene.luminaires,
        views=scene.views,
    )


def measure(scene: ifl.Scene, options: argparse.Namespace) -> tuple[ifl.MeasuringGrid, ifl.Measurement]:
    # Without a view the solver treats all surfaces alike, as a measurement needs.
    solution = ifl.solve(scene, rays=options.rays)
    floor = ifl.find_top(solution.scene, "office.floor")
    grid = ifl.area_grid(solution.scene, floor, options.spacing, BOUNDARY, WORKING_PLANE)
    return grid, ifl.probe(solution, grid, samples=options.samples)


def print_summary(title: str, grid: ifl.MeasuringGrid, measured: ifl.Measurement) -> None:
    summary = measured.summary()
    largest = ifl.grid_spacing(grid.columns * grid.column_spacing, grid.rows * grid.row_spacing)
    spacing = max(grid.column_spacing, grid.row_spacing)
    print(f"{title}: {summary.points} points, {spacing:.2f} m apart (EN 12464-1: at most {largest:.2f} m)")
    print(f"  mean {summary.mean:.0f} lx, standard error {summary.mean_error:.1g} lx (needed: {NEEDED_MEAN} lx)")
    print(f"  minimum {summary.min:.0f} lx, maximum {summary.max:.0f} lx")
    print(f"  U0 {summary.uniformity:.2f} (needed: {NEEDED_UNIFORMITY})")


def draw(axes: plt.Axes, title: str, grid: ifl.MeasuringGrid, illuminance: np.ndarray) -> plt.cm.ScalarMappable:
    """Draws a plan with contour lines; cells without a measuring point stay white."""
    plan = np.full(grid.rows * grid.columns, np.nan)
    plan[grid.cells] = illuminance
    plan = plan.reshape(grid.rows, grid.columns)
    x = grid.corner[0] + (np.arange(grid.columns) + 0.5) * grid.column_spacing
    y = grid.corner[1] + (np.arange(grid.rows) + 0.5) * grid.row_spacing
    colours = axes.pcolormesh(x, y, plan, cmap="inferno", vmin=0, vmax=1000, shading="nearest")
    lines = axes.contour(x, y, plan, levels=range(100, 1000, 100), colors="white", linewidths=0.8)
    axes.clabel(lines, fmt="%d lx", fontsize=8)
    axes.set(title=title, xlabel="x [m]", ylabel="y [m]", aspect="equal")
    return colours


def main(arguments: list[str] | None = None) -> dict[str, ifl.Measurement]:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rays", type=float, default=10e6, help="rays of the solver")
    parser.add_argument("--samples", type=int, default=1024, help="directions per measuring point")
    parser.add_argument("--spacing", type=float, default=0.2, help="largest distance between points [m]")
    parser.add_argument("--output", type=Path, default=Path("out/examples"), help="folder of the picture")
    options = parser.parse_args(arguments)
    options.output.mkdir(parents=True, exist_ok=True)

    office = ifl.load(SCENE)
    # Points inside furniture are dark, which spoils the minimum. So rooms are planned empty.
    plans = {"empty room": measure(without(office, FURNITURE), options), "with furniture": measure(office, options)}
    figure, axes = plt.subplots(1, len(plans), figsize=(12, 4.8), layout="constrained")
    for panel, (title, (grid, measured)) in zip(axes, plans.items()):
        print_summary(title, grid, measured)
        colours = draw(panel, title, grid, measured.illuminance)
    figure.colorbar(colours, ax=axes, label=f"illuminance {WORKING_PLANE} m above the floor [lx]", extend="max")
    figure.savefig(options.output / "office-plan.png", dpi=120)
    return {title: measured for title, (_, measured) in plans.items()}


if __name__ == "__main__":
    main()
