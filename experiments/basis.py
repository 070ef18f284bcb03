"""Constant and linear elements from the same rays, on the best mesh of each: `experiments/run basis`.

`bench/linear_basis.cpp` stores the light of several runs on small cells and computes every basis and mesh from them, with
four independent references. So differences between bases contain neither different rays nor the program's choice of a
mesh. docs/results.md (Linear basis functions) explains the result.
"""

import math
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from audit_scenes import Scene
from constants import attic, gallery
from lab import drawing, program, results
from lab.results import Row
from lab.statistics import Ratio, mean, mean_ratio

WORK = program.ROOT / "out/experiments/cache/basis"
TABLE = program.ROOT / "experiments/results/basis.csv"
FIGURES = program.ROOT / "docs/figures"
SEEDS, REFERENCE_RAYS = 6, 24_000_000
BUDGETS = (500_000, 2_000_000, 8_000_000)
DRAWN = 2_000_000  # rays of the figure


@dataclass(frozen=True)
class Subject:
    name: str
    edge: float  # of the cells [m]
    file: str = ""  # with a named view; else made from `scene`
    view: str = ""
    scene: Scene | None = None

    def prepare(self, command: program.Program) -> Path:
        """Returns a solution file with the scene as the solver divides it, its light sources and its view."""
        solved = WORK / f"{self.name}.h5"
        file, options = self.file, f"--view {self.view}"
        if self.file.startswith("make-scene "):
            file = str(WORK / f"{self.name}.mgf")
            program.run(command, [*self.file.split(), "-o", file, "--force"])
        if self.scene:
            file, options = str(self.scene.write(WORK, self.name, self.scene.text)), f"{self.scene.view()} {self.scene.options}"
        program.run(command, ["solve", file, *options.split(), "--rays", "10k", "-o", str(solved)])
        return solved


SUBJECTS = [
    Subject("two-rooms", 0.035, "make-scene two-rooms", "lit"),
    Subject("office", 0.03, "scenes/office.mgf", "desk"),
    Subject("attic", 0.03, scene=attic()),
    Subject("gallery", 0.05, scene=gallery()),
]
TITLES = {
    "two-rooms": "two-rooms: soft gradients",
    "office": "office: furniture",
    "attic": "attic: sunlight",
    "gallery": "gallery: indirect light",
}
# A group of candidates counts with its best member.
CONSTANT = ("constant smooth", "constant smooth reduced")
GROUPS = {
    "constant, flat": ("constant flat", "constant flat reduced"),
    "constant, smooth": CONSTANT,
    "linear": ("linear", "linear reduced"),
    "linear, joined": ("linear joined", "linear joined reduced"),
    "either": ("either", "either reduced"),
    "either, joined": ("either joined", "either joined reduced"),
}
CHOSEN = ("uniform", "patches", "quadtree")  # meshes that are chosen with knowledge of the references


def measure(command: program.Program, subject: Subject) -> list[dict]:
    bench = command.path.with_name("linear_basis")
    if not bench.is_file():
        raise program.ExperimentError(f"{bench} is not there: build the target interflect_linear_basis")
    raw = WORK / f"{subject.name}.csv"
    arguments = [bench, subject.prepare(command), subject.edge, SEEDS, REFERENCE_RAYS, *BUDGETS]
    with raw.open("w") as file:
        subprocess.run([str(a) for a in arguments], stdout=file, check=True)
    return summarised(subject.name, results.read_csv(raw, {"basis", "mesh"}))


def summarised(scene: str, rows: Iterable[Row]) -> list[dict]:
    """Joins the seeds of a mesh in one row. @return `errors` in the order of the seeds."""
    keys = ("rays", "basis", "mesh", "parameter")
    found: dict = {}
    for row in rows:
        found.setdefault(tuple(row[key] for key in keys), []).append(row)
    joined = []
    for key, seeds in found.items():
        seeds.sort(key=lambda row: row["seed"])
        means = {name: f"{results.values(seeds, name).mean():.4g}" for name in ("elements", "coefficients", "relative_error")}
        errors = " ".join(f"{row['error']:.4g}" for row in seeds)
        joined.append({"scene": scene} | dict(zip(keys, key)) | means | {"errors": errors})
    return joined


def read() -> list[Row]:
    rows = results.read_csv(TABLE, {"scene", "basis", "mesh", "errors"})
    for row in rows:
        row["errors"] = np.array([float(e) for e in row["errors"].split()])
    return rows


def best(rows: Iterable[Row], members: Iterable[str], meshes: Iterable[str] = CHOSEN) -> Row:
    """Returns the row of least mean error."""
    return min((row for row in rows if row["basis"] in members and row["mesh"] in meshes), key=lambda row: row["errors"].mean())


def over(row: Row, base: Row) -> Ratio:
    return mean_ratio(row["errors"] / base["errors"])


def slope(rows: list[Row], members: Iterable[str]) -> float:
    """Returns the exponent of the error in the rays."""
    errors = [math.log(best([row for row in rows if row["rays"] == rays], members)["errors"].mean()) for rays in BUDGETS]
    return float(np.polyfit(np.log(BUDGETS), errors, 1)[0])


def rays_for_equal_error(ratio: Ratio, exponent: float) -> Ratio:
    return Ratio(*(value ** (-1 / exponent) for value in (ratio.value, ratio.low, ratio.high)))


def write_tables(rows: list[Row]) -> None:
    lines, on_program, sources = [], [], []
    for subject in SUBJECTS:
        of_scene = [row for row in rows if row["scene"] == subject.name]
        for rays in BUDGETS:
            runs = [row for row in of_scene if row["rays"] == rays]
            base = best(runs, CONSTANT)
            for group, members in GROUPS.items():
                row = best(runs, members)
                ratio = over(row, base)
                gain = "1" if row is base else str(rays_for_equal_error(ratio, slope(of_scene, members)))
                lines.append(
                    [
                        subject.name, f"{rays / 1e6:g} M", group, row["mesh"], f"{row['elements']:,.0f}", f"{row['coefficients']:,.0f}",
                        str(mean(row["errors"])), "1" if row is base else str(ratio), gain,
                    ]
                )  # fmt: skip
            now = best(runs, CONSTANT, ["refined"])
            cells = [subject.name, f"{rays / 1e6:g} M", f"{now['elements']:,.0f}", str(mean(now["errors"])), str(over(base, now))]
            same = best([row for row in runs if row["parameter"] == 0], ["constant smooth reduced"], ["program"])
            for coarser in range(3):
                meshes = [row for row in runs if row["mesh"] == "program" and row["parameter"] == coarser]
                cells += [str(over(best(meshes, GROUPS[group], ["program"]), same)) for group in ("constant, smooth", "linear, joined")]
            on_program.append(cells)
        for row in of_scene:
            if row["mesh"].startswith("sources"):
                sources.append(
                    [subject.name, row["mesh"].removeprefix("sources "), f"{subject.edge * 2 ** row['parameter']:.2f} m" if row["mesh"].endswith("uniform") else "",
                     "uniform" if row["basis"] == "isrr" else "hit points", f"{row['elements']:,.0f}", str(mean(row["errors"]))]
                )  # fmt: skip
    header = ["scene", "rays", "basis", "mesh", "elements", "coefficients", "squared error", "over smooth constants", "rays for equal error"]
    results.write_table(FIGURES / "basis.md", header, lines)
    levels = [f"{group}, {coarser} coarser" for coarser in range(3) for group in ("constant", "linear")]
    results.write_table(FIGURES / "basis-program.md", ["scene", "rays", "elements", "squared error", "best mesh over it", *levels], on_program)
    results.write_table(FIGURES / "basis-sources.md", ["scene", "mesh", "edge", "origins", "elements", "squared error"], sources)


def draw(rows: list[Row]) -> None:
    figure, axes = drawing.panels(len(SUBJECTS), size=(2.9, 3.0))
    for ax, subject in zip(axes, SUBJECTS):
        runs = [row for row in rows if row["scene"] == subject.name and row["rays"] == DRAWN]
        for number, (group, members) in enumerate(list(GROUPS.items())[:4]):
            for name, style in zip(members, ("-", ":")):
                curve = sorted((row["coefficients"], row["errors"].mean()) for row in runs if row["basis"] == name and row["mesh"] == "uniform")
                label = group + (", reduced" if style == ":" else "")
                ax.plot(*zip(*curve), style, marker=drawing.MARKERS[number], color=drawing.COLOURS[number], label=label)
        now = best(runs, CONSTANT, ["refined"])
        ax.plot(now["coefficients"], now["errors"].mean(), "*", color="black", markersize=10, label="the program, smooth")
        ax.set_xscale("log")
        ax.set_yscale("log")
        ax.set_xlabel("coefficients on visible surfaces")
        ax.set_title(TITLES[subject.name])
    axes[0].set_ylabel("squared error of the picture")
    drawing.shared_legend(figure, axes[0], 5)
    caption = f"""Uniform meshes of all sizes from the same {DRAWN / 1e6:g} million rays: squared error over the square of the
        picture's mean against the number of coefficients. Dotted: after reduction of differences that are mostly noise. Mean of
        {SEEDS} seeds."""
    drawing.save(figure, FIGURES, "basis", caption)


def main(only_draw: bool) -> None:
    if not only_draw:
        command = program.find_program()
        WORK.mkdir(parents=True, exist_ok=True)
        rows = []
        for subject in SUBJECTS:
            print(f"{subject.name}: {SEEDS} seeds", file=sys.stderr, flush=True)
            rows += measure(command, subject)
        results.write_csv(TABLE, rows, list(rows[0]))
    rows = read()
    write_tables(rows)
    draw(rows)
    print((FIGURES / "basis.md").read_text(), end="")
