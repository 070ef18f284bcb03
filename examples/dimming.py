"""Dimming of light groups for uniform light and little energy, with SciPy's linear programming.

    python3 examples/dimming.py

A classroom has a window on one side and 12 lamps, each in a light group of its own. Light is additive: the illuminance
at point i is the sum over the groups g of E_ig f_g. E_ig is the illuminance by group g alone at full power, f_g the
dimming factor. So the cheapest factors solve

    minimise    sum of f_g                  (the power: equal lamps, dimmed linearly)
    subject to  mean of E f >= 500 lx
                each point   >= 0.6 of the mean    (U0)
                0 <= f_g <= 1, and f = 1 for the window
"""

import argparse
from pathlib import Path

import interflect as ifl
import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import linprog


LENGTH, WIDTH, HEIGHT = 9.0, 6.0, 3.0  # of the room [m]
LAMP_SIZE, LAMP_EXITANCE, LAMP_POWER = 0.6, 11_000, 36  # side [m], [lm/m^2], [W] at full light
WINDOW_EXITANCE = 1_500  # a dull day, as seen through the panes [lm/m^2]
NEEDED_MEAN, NEEDED_UNIFORMITY = 500, 0.6  # EN 12464-1: mean [lx] and U0 = minimum / mean
MARGIN = 1.02  # the optimum lies on the limits of the targets: 2% more covers the noise of measurement and solution


def rectangle(corner: tuple, a: tuple, b: tuple) -> np.ndarray:
    """Corners of a rectangle with the edges a and b [m]; its normal is a x b."""
    return corner + np.array([(0, 0, 0), a, np.add(a, b), b])


def make_scene() -> ifl.Scene:
    x, y, z = (LENGTH, 0, 0), (0, WIDTH, 0), (0, 0, HEIGHT)
    surfaces = [  # name, material, corners
        ("floor", 0, rectangle((0, 0, 0), x, y)),
        ("ceiling", 1, rectangle((0, 0, HEIGHT), y, x)),
        ("south", 2, rectangle((0, 0, 0), z, x)),
        ("north", 2, rectangle((0, WIDTH, 0), x, z)),
        ("west", 2, rectangle((0, 0, 0), y, z)),
        ("east", 2, rectangle((LENGTH, 0, 0), z, y)),
        ("window", 3, rectangle((0.5, 0.01, 1), (0, 0, 1.5), (LENGTH - 1, 0, 0))),
    ]
    for row, lamp_y in enumerate((1, 3, 5)):
        for column, lamp_x in enumerate((1.2, 3.4, 5.6, 7.8)):
            corner = (lamp_x - LAMP_SIZE / 2, lamp_y - LAMP_SIZE / 2, HEIGHT - 0.01)
            lamp = rectangle(corner, (0, LAMP_SIZE, 0), (LAMP_SIZE, 0, 0))
            surfaces.append((f"lamp-{row + 1}-{column + 1}", 4, lamp))
    names, materials, corners = zip(*surfaces)
    scene = ifl.Scene(
        np.concatenate(corners),
        np.arange(4 * len(corners)).reshape(-1, 4),
        [
            ifl.Material("floor", 0.2),
            ifl.Material("ceiling", 0.7),
            ifl.Material("wall", 0.5),
            ifl.Material("window", 0.1, exitance=WINDOW_EXITANCE),
            ifl.Material("lamp", 0.7, exitance=LAMP_EXITANCE),
        ],
        face_materials=materials,
        objects=names,
        face_objects=range(len(names)),
    )
    return scene.replace(light_groups=ifl.groups_by_name(scene))  # one group per object that emits


def working_plane(scene: ifl.Scene) -> ifl.MeasuringGrid:
    return ifl.area_grid(scene, ifl.find_top(scene, "floor"), boundary=0.5, height=0.75)


def illuminance_of_groups(solution: ifl.Solution, grid: ifl.MeasuringGrid, samples: int) -> np.ndarray:
    """Illuminance of each group alone at full power: (points, groups) [lx]."""
    columns = []
    for name in solution.group_names:
        others_off = {other: 0 for other in solution.group_names if other != name}
        columns.append(ifl.probe(solution.dim(others_off), grid, samples=samples).illuminance)
    return np.column_stack(columns)


def cheapest_factors(illuminance: np.ndarray, is_lamp: np.ndarray) -> np.ndarray:
    """Factors of all groups with the least power that meet both targets.

    Raises:
        RuntimeError: if full power does not meet them.
    """
    mean = illuminance.mean(axis=0)
    limits = np.vstack([-mean, MARGIN * NEEDED_UNIFORMITY * mean - illuminance])
    bounds = [(0, 1) if lamp else (1, 1) for lamp in is_lamp]
    right = np.concatenate([[-MARGIN * NEEDED_MEAN], np.zeros(len(illuminance))])
    result = linprog(is_lamp.astype(float), A_ub=limits, b_ub=right, bounds=bounds)
    if not result.success:
        raise RuntimeError(f"no dimming meets the targets: {result.message}")
    return result.x


def report(title: str, illuminance: np.ndarray, lamps: np.ndarray) -> None:
    mean, uniformity = illuminance.mean(), illuminance.min() / illuminance.mean()
    print(f"{title:24} {LAMP_POWER * lamps.sum():4.0f} W   mean {mean:4.0f} lx   U0 {uniformity:.2f}")


def draw(grid: ifl.MeasuringGrid, plans: dict[str, np.ndarray]) -> plt.Figure:
    figure, panels = plt.subplots(1, len(plans), figsize=(13, 3.6), layout="constrained")
    x = grid.corner[0] + (np.arange(grid.columns) + 0.5) * grid.column_spacing
    y = grid.corner[1] + (np.arange(grid.rows) + 0.5) * grid.row_spacing
    largest = max(values.max() for values in plans.values())
    for axes, (title, values) in zip(panels, plans.items()):
        plan = np.full(grid.rows * grid.columns, np.nan)
        plan[grid.cells] = values
        plan = plan.reshape(grid.rows, grid.columns)
        colours = axes.pcolormesh(x, y, plan, cmap="inferno", vmin=0, vmax=largest, shading="nearest")
        lines = axes.contour(x, y, plan, levels=range(100, 3000, 100), colors="white", linewidths=0.8)
        axes.clabel(lines, fmt="%d lx", fontsize=7)
        axes.set(title=title, xlabel="x [m], window at y = 0", ylabel="y [m]", aspect="equal")
    figure.colorbar(colours, ax=panels, label="illuminance [lx]")
    return figure


def main(arguments: list[str] | None = None) -> dict[str, np.ndarray]:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rays", type=float, default=5e6, help="rays of the solver")
    parser.add_argument("--samples", type=int, default=4096, help="directions per measuring point")
    parser.add_argument("--output", type=Path, default=Path("out/examples"), help="folder of the picture")
    options = parser.parse_args(arguments)
    options.output.mkdir(parents=True, exist_ok=True)

    with ifl.Solver(make_scene(), rays=options.rays) as solver:
        solver.advance()
        solution = solver.solution
        grid = working_plane(solution.scene)
        groups = illuminance_of_groups(solution, grid, options.samples)
        is_lamp = np.array([name.startswith("lamp") for name in solution.group_names])
        factors = cheapest_factors(groups, is_lamp)

        # For comparison: the lowest factor common to all lamps that meets both targets.
        daylight, lamps = groups[:, ~is_lamp].sum(axis=1), groups[:, is_lamp].sum(axis=1)
        common = cheapest_factors(np.column_stack([daylight, lamps]), np.array([False, True]))[1]
        report("all lamps at full power", daylight + lamps, is_lamp.astype(float))
        report(f"all lamps at {100 * common:.0f}%", daylight + common * lamps, common * is_lamp)
        report("optimised", groups @ factors, factors[is_lamp])

        # Check: first the scaled solution, then a solution of the dimmed scene, which doubles the number of rays.
        dimming = dict(zip(solution.group_names, factors))
        scaled = ifl.probe(solution.dim(dimming), grid, samples=options.samples).illuminance
        report("  check, scaled", scaled, factors[is_lamp])
        for name, factor in dimming.items():
            solver.set_dimming(name, factor)
        solver.advance(rays=options.rays)
        solved = ifl.probe(solver.solution, grid, samples=options.samples, seed=2).illuminance
        report("  check, solved again", solved, factors[is_lamp])
    print(f"energy saved by optimisation: {100 * (1 - factors[is_lamp].sum() / (common * is_lamp.sum())):.0f}%")
    for row in range(3):
        print("  dimming of row", row + 1, " ".join(f"{100 * f:4.0f}%" for f in factors[is_lamp].reshape(3, 4)[row]))
    plans = {
        "full power": daylight + lamps,
        f"all lamps at {100 * common:.0f}%": daylight + common * lamps,
        "optimised": groups @ factors,
    }
    draw(grid, plans).savefig(options.output / "dimming.png", dpi=120)
    predicted = groups @ factors
    return {"points": grid.points, "factors": factors, "predicted": predicted, "scaled": scaled, "solved": solved}


if __name__ == "__main__":
    main()
