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
from audit import Reference, Scale
from audit_scenes import Scene
from constants import attic, gallery
from lab import drawing, program, results
from lab.picture import luminance, read_exr
from lab.results import Row
from lab.statistics import Ratio, mean, mean_ratio

WORK = program.ROOT / "out/experiments/cache/basis"
TABLE = program.ROOT / "experiments/results/basis.csv"
FIGURES = program.ROOT / "docs/figures"
USUAL = (6, 24_000_000, (500_000, 2_000_000, 8_000_000))
CHECKED_RAYS = 300_000
DRAWN = 2_000_000  # rays of the figure


@dataclass(frozen=True)
class Subject:
    name: str
    edge: float  # of the cells [m]
    finer: int  # further divisions of cells where the program refines
    seeds: int
    reference_rays: int
    budgets: tuple[int, ...]
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
    Subject("two-rooms", 0.035, 0, *USUAL, "make-scene two-rooms", "lit"),
    Subject("office", 0.03, 0, *USUAL, "scenes/office.mgf", "desk"),
    Subject("attic", 0.06, 2, 4, 16_000_000, (2_000_000,), scene=attic()),
    Subject("gallery", 0.05, 0, *USUAL, scene=gallery()),
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
COUNTED = ("constant, smooth", "linear, joined")
# Meshes that are chosen with knowledge of the references, by measure.
CHOSEN = {
    "errors": ("uniform", "patches", "quadtree"),
    "relative_errors": ("uniform", "patches relative", "quadtree relative"),
}


def measure(command: program.Program, subject: Subject) -> list[dict]:
    bench = command.path.with_name("linear_basis")
    if not bench.is_file():
        raise program.ExperimentError(f"{bench} is not there: build the target interflect_linear_basis")
    raw = WORK / f"{subject.name}.csv"
    arguments = [bench, subject.prepare(command), subject.edge, subject.finer, subject.seeds, subject.reference_rays, *subject.budgets]
    with raw.open("w") as file:
        subprocess.run([str(a) for a in arguments], stdout=file, check=True)
    return summarised(subject.name, results.read_csv(raw, {"basis", "mesh"}))


def summarised(scene: str, rows: Iterable[Row]) -> list[dict]:
    """Joins the seeds of a mesh in one row; errors are in the order of the seeds."""
    keys = ("rays", "basis", "mesh", "parameter")
    found: dict = {}
    for row in rows:
        found.setdefault(tuple(row[key] for key in keys), []).append(row)
    joined = []
    for key, seeds in found.items():
        seeds.sort(key=lambda row: row["seed"])
        means = {name: f"{results.values(seeds, name).mean():.4g}" for name in ("elements", "coefficients")}
        errors = {f"{name}s": " ".join(f"{row[name]:.3g}" for row in seeds) for name in ("error", "relative_error")}
        joined.append({"scene": scene} | dict(zip(keys, key)) | means | errors)
    return joined


def read() -> list[Row]:
    rows = results.read_csv(TABLE, {"scene", "basis", "mesh", *CHOSEN})
    for row in rows:
        row |= {measure: np.array([float(e) for e in row[measure].split()]) for measure in CHOSEN}
    return rows


def best(rows: Iterable[Row], members: Iterable[str], meshes: Iterable[str], measure: str = "errors") -> Row:
    """Returns the row of least mean error."""
    return min((row for row in rows if row["basis"] in members and row["mesh"] in meshes), key=lambda row: row[measure].mean())


def over(row: Row, base: Row, measure: str = "errors") -> str:
    return "1" if row is base else str(mean_ratio(row[measure] / base[measure]))


def check_pictures(command: program.Program) -> None:
    """Compares errors computed from cells with errors of pictures of the same light, against path tracing."""
    subject = next(one for one in SUBJECTS if one.name == "gallery")
    solved = subject.prepare(command)
    scale = Scale(size=(320, 180), samples=256)
    reference = Reference(command, subject.name, subject.scene, scale, WORK)
    lines = []
    for level in (2, 3, 4):
        coarse, picture = WORK / f"level{level}.h5", WORK / "picture.exr"
        arguments = [command.path.with_name("linear_basis"), solved, subject.edge, subject.finer, CHECKED_RAYS, level, coarse]
        printed = subprocess.run([str(a) for a in arguments], capture_output=True, text=True, check=True).stdout
        for kind, line in zip(("flat", "smooth"), printed.splitlines()):
            options = f"--size 320x180 --samples 64 --shading {kind} -o {picture}"
            program.run(command, ["render", str(coarse), *subject.scene.view().split(), *options.split()])
            values = luminance(read_exr(picture))
            error = reference.pixel_error(values, values)[0] ** 2
            edge = f"{subject.edge * 2**level:.1f} m"
            lines.append([edge, kind, f"{float(line.split(',')[-2]):.3g}", f"{error:.3g}"])
    results.write_table(FIGURES / "basis-check.md", ["edge", "shading", "squared error of the cells", "of the picture"], lines)


def check_moments() -> list[str]:
    """Compares linear elements from cells with those from the hits themselves, for a smooth function with noise.

    @return  Lines with the squared errors of both, over the whole element.
    """
    generator = np.random.default_rng(1)
    light = lambda u, v: 1 + 0.4 * (u - 0.5) + 0.3 * (v - 0.5) ** 2 + 0.2 * u * v
    linear = lambda u, v: np.stack([np.ones_like(u), *(np.sqrt(3) * (2 * x - 1) for x in (u, v)), 3 * (2 * u - 1) * (2 * v - 1)])
    middles = lambda n: np.meshgrid(*2 * [(np.arange(n) + 0.5) / n], indexing="ij")
    hits, trials, points = 400, 1000, middles(64)
    lines = []
    for cells in (4, 8, 16):
        square = 1 - cells**-2  # of a linear function of the basis, over the middles of the cells
        errors = []
        for _ in range(trials):
            u, v = generator.random((2, hits))
            power = light(u, v)
            binned = np.zeros((cells, cells))
            np.add.at(binned, ((u * cells).astype(int), (v * cells).astype(int)), power / hits)
            from_cells = (linear(*middles(cells)) * binned).sum((1, 2)) / [1, square, square, square**2]
            from_hits = (linear(u, v) * power).mean(1)
            errors.append([np.mean((np.tensordot(c, linear(*points), 1) - light(*points)) ** 2) for c in (from_cells, from_hits)])
        of_cells, of_hits = np.mean(errors, axis=0)
        lines.append(f"{cells} x {cells} cells: squared error {of_cells / of_hits:.3f} of that from the hits")
    return lines


def fewest_coefficients(rows: Iterable[Row], members: Iterable[str], error: float) -> str:
    """Returns the least number of coefficients of a chosen mesh whose error is at most a tenth larger than `error`."""
    meshes = CHOSEN["errors"]
    within = [row["coefficients"] for row in rows if row["basis"] in members and row["mesh"] in meshes and row["errors"].mean() <= 1.1 * error]
    return f"{min(within):,.0f}" if within else "-"


def rays_for_equal_error(rows: list[Row], rays: int, members: Iterable[str]) -> str:
    """Returns the factor of the rays with which these bases have the error of smooth constants."""
    of_budget = {budget: [row for row in rows if row["rays"] == budget] for budget in sorted({row["rays"] for row in rows if row["mesh"] == "uniform"})}
    if len(of_budget) < 2:
        return "-"
    found = {budget: best(runs, members, CHOSEN["errors"]) for budget, runs in of_budget.items()}
    exponent = np.polyfit(np.log(list(found)), [math.log(row["errors"].mean()) for row in found.values()], 1)[0]
    ratio = mean_ratio(found[rays]["errors"] / best(of_budget[rays], CONSTANT, CHOSEN["errors"])["errors"])
    return str(Ratio(*(value ** (-1 / exponent) for value in (ratio.value, ratio.low, ratio.high))))


def write_tables(rows: list[Row]) -> None:
    costs = []
    for measure, file in zip(CHOSEN, ("basis.md", "basis-relative.md")):
        lines = []
        for subject in SUBJECTS:
            of_scene = [row for row in rows if row["scene"] == subject.name]
            for rays in subject.budgets:
                runs = [row for row in of_scene if row["rays"] == rays]
                start = [subject.name, f"{rays / 1e6:g} M"]
                if not any(row["mesh"] == CHOSEN[measure][-1] for row in runs):
                    continue  # rows of an older version
                base = best(runs, CONSTANT, CHOSEN[measure], measure)
                ratios = [over(best(runs, members, CHOSEN[measure], measure), base, measure) for members in GROUPS.values()]
                ratios[list(GROUPS.values()).index(CONSTANT)] = str(mean(base[measure]))
                lines.append([*start, *ratios])
                if measure == "errors":
                    counts = [fewest_coefficients(runs, GROUPS[group], base["errors"].mean()) for group in COUNTED]
                    needed = [rays_for_equal_error(of_scene, rays, GROUPS[group]) for group in ("linear", "linear, joined", "either, joined")]
                    costs.append([*start, *counts, *needed])
        results.write_table(FIGURES / file, ["scene", "rays", *GROUPS], lines)
    header = [*(f"coefficients: {group}" for group in COUNTED), "rays: linear", "linear, joined", "either, joined"]
    results.write_table(FIGURES / "basis-costs.md", ["scene", "rays", *header], costs)
    write_program_meshes(rows)
    write_sources(rows)


def write_program_meshes(rows: list[Row]) -> None:
    lines = []
    for subject in SUBJECTS:
        for rays in subject.budgets:
            runs = [row for row in rows if row["scene"] == subject.name and row["rays"] == rays]
            now = best(runs, CONSTANT, ["refined"])
            meshes = [row for row in runs if row["mesh"] == "program"]
            same = best([row for row in meshes if row["parameter"] == 0], CONSTANT[1:], ["program"])
            cells = [over(best(runs, CONSTANT, CHOSEN["errors"]), now)]
            for coarser in range(3):
                of_level = [row for row in meshes if row["parameter"] == coarser]
                cells += [over(best(of_level, GROUPS[group], ["program"]), same) for group in COUNTED]
            lines.append([subject.name, f"{rays / 1e6:g} M", f"{now['elements']:,.0f}", str(mean(now["errors"])), *cells])
    levels = [f"{group}, {name}" for name in ("its mesh", "1 coarser", "2 coarser") for group in ("constant", "linear")]
    results.write_table(FIGURES / "basis-program.md", ["scene", "rays", "elements", "squared error", "best mesh over it", *levels], lines)


def write_sources(rows: list[Row]) -> None:
    lines = []
    for subject in SUBJECTS:
        for row in rows:
            if row["scene"] != subject.name or not row["mesh"].startswith("sources"):
                continue
            is_uniform = row["mesh"].endswith("uniform")
            mesh = f"uniform, {subject.edge * 2 ** row['parameter']:.2g} m" if is_uniform else "the program's"
            origins = "uniform" if row["basis"] == "isrr" else "hit points"
            lines.append([subject.name, mesh, origins, f"{row['elements']:,.0f}", " and ".join(f"{e:.1e}" for e in row["errors"])])
    results.write_table(FIGURES / "basis-sources.md", ["scene", "mesh", "origins", "elements", "squared error"], lines)


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
        picture's mean against the number of coefficients. Dotted: after reduction of differences that are mostly noise. Means
        of 4 to 6 seeds."""
    drawing.save(figure, FIGURES, "basis", caption)


def main(only_draw: bool) -> None:
    if not only_draw:
        command = program.find_program()
        WORK.mkdir(parents=True, exist_ok=True)
        rows = []
        for subject in SUBJECTS:
            print(f"{subject.name}: {subject.seeds} seeds", file=sys.stderr, flush=True)
            rows += measure(command, subject)
        results.write_csv(TABLE, rows, list(rows[0]))
        check_pictures(command)
    rows = read()
    write_tables(rows)
    draw(rows)
    print((FIGURES / "basis.md").read_text(), *check_moments(), sep="\n")
