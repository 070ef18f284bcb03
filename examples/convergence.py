"""Convergence of the eight variants of the paper (Prikryl et al. 2000, Figure 5): error against rays.

    python3 examples/convergence.py

A variant combines three choices:
    ci, si  Combined iterations: rays carry power and importance. Separate iterations: each ray carries power or importance.
    hi      Elements keep their own importance. Otherwise all elements of a patch share its importance.
    dr      Deferred refinement: the mesh stays coarse during the warm-up.
"""

import argparse
from pathlib import Path
from typing import Any

import interflect as ifl
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd


SCENE, VIEW = Path(__file__).resolve().parents[1] / "scenes/maze.mgf", "room-0"
WIDTH, HEIGHT = 160, 90  # pixels
VARIANTS: dict[str, dict[str, Any]] = {
    name: {
        "separate_iterations": name.startswith("si"),
        "importance_at_patches": "hi" not in name,
        "defer_refinement": "dr" in name,
    }
    for name in ("si", "si+dr", "si+hi", "si+dr+hi", "ci", "ci+dr", "ci+hi", "ci+dr+hi")
}


def error(solution: ifl.Solution, reference: np.ndarray) -> float:
    """Relative root mean square error of a picture, averaged over blocks of 5 x 5 pixels.

    Blocks average the noise of the reference, which the difference would otherwise contain.
    """
    picture = ifl.render(solution, VIEW, shading="smooth", samples=16, width=WIDTH, height=HEIGHT)
    return next(d.relative_rmse for d in ifl.compare(picture, reference).blocks if d.block == 5)


def measure(scene: ifl.Scene, reference: np.ndarray, rays: list[int], seeds: int) -> pd.DataFrame:
    """One row per run."""
    rows = []
    for count in rays:
        for seed in range(1, seeds + 1):
            for name, settings in VARIANTS.items():
                solution = ifl.solve(scene, view=VIEW, rays=count, seed=seed, preset="paper", epsilon=1e-6, **settings)
                rows.append({"variant": name, "rays": count, "seed": seed, "error": error(solution, reference),
                             "leaves": len(solution)})
    return pd.DataFrame(rows)


def draw(table: pd.DataFrame) -> plt.Figure:
    """Draws the mean error over the seeds. `table` has one column per variant and one row per number of rays."""
    figure, axes = plt.subplots(figsize=(7, 4.5), layout="constrained")
    for name in table:
        axes.loglog(table.index, table[name], marker="os"[name.startswith("si")], markersize=4, label=name,
                    linestyle=("-", "--")[name.startswith("si")])
    slope = table.iloc[0].mean() * (table.index / table.index[0]) ** -0.5
    axes.loglog(table.index, slope, color="black", linewidth=0.8, linestyle=":", label="rays$^{-1/2}$")
    axes.set(xlabel="rays", ylabel="relative error of the picture", title="Eight variants, preset “paper”")
    axes.grid(which="both", alpha=0.3)
    axes.legend(loc="center left", bbox_to_anchor=(1, 0.5))
    return figure


def main(arguments: list[str] | None = None) -> pd.DataFrame:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rays", type=float, default=4e6, help="largest number of rays of a run")
    parser.add_argument("--seeds", type=int, default=2, help="runs per variant and number of rays")
    parser.add_argument("--samples", type=int, default=1024, help="paths per pixel of the reference")
    parser.add_argument("--output", type=Path, default=Path("out/examples"), help="folder of the plot and the table")
    options = parser.parse_args(arguments)
    options.output.mkdir(parents=True, exist_ok=True)

    scene = ifl.load(SCENE)
    # The path tracer shares no estimate with the solver.
    reference = ifl.render(scene, VIEW, shading="path", samples=options.samples, width=WIDTH, height=HEIGHT)
    rays = [round(options.rays / 4**step) for step in (3, 2, 1, 0)]
    runs = measure(scene, reference, rays, options.seeds)
    runs.to_csv(options.output / "convergence.csv", index=False)
    table = runs.pivot_table(index="rays", columns="variant", values="error", sort=False)
    draw(table).savefig(options.output / "convergence.png", dpi=120)
    print(f"Relative error of the picture of {VIEW} in {SCENE.stem}, mean of {options.seeds} seeds")
    print(table.to_string(float_format="{:.3f}".format))
    return table


if __name__ == "__main__":
    main()
