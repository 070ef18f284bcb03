"""Compares every shading and bake with path tracing: `experiments/run audit --only shadings`.

The scenes are those of shading_scenes.py. Each shading draws a picture with each of two seeds; bakes are compared at
points on surfaces with `probe --shading path`. The references are two independent path-traced pictures, kept for all
builds, and instant radiosity is the second method: it is compared like any other. Every measured run is a row of
results/audit-shadings.csv. Rows of the same build are not measured again.

Limits, each widened by two standard errors, for the whole picture and for its darkest fifth: mean within 0.5%; blocks
of 9 x 9 pixels within 3% (root mean square, of their mean); stated over true error 0.8 to 1.25; 95% intervals of blocks
cover 93 to 97%. Pixels with a lamp and their neighbours are left out, except from the error that the command prints.
"""

import hashlib
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from audit import widened
from audit_scenes import Scene
from lab import blocks, program, results
from lab.baked import Baked, read_baked
from lab.blocks import Interval, Layout
from lab.picture import read_exr, read_layer
from lab.reference import box_mean
from shading_scenes import KINDS, drawn_scenes, make_scene

WORK = program.ROOT / "out/experiments/cache/audit-shadings"
TABLE = program.ROOT / "experiments/results/audit-shadings.csv"
SEEDS = (1, 2)
REFERENCE_SEEDS = (98, 99)
LIMITS = {"mean": (0.995, 1.005), "blocks": (0, 0.03), "stated": (0.8, 1.25), "printed": (0.8, 1.25), "coverage": (0.93, 0.97)}
TIME_TOLERANCE = 1.1  # of --time

RESOLVED = 0.01  # two standard errors of a mean above this decide nothing about its limit
MITSUBA = "MITSUBA_PYTHON"  # environment variable: a Python that has Mitsuba

# Bakes are compared at visible points within this distance of the point that the view looks at [m], in cells of 9 texels
# at 20 a metre.
POINT_REACH, CELL, POINTS_PER_CELL = 4.0, 0.45, 5
SAME_DEPTH = 0.03  # relative difference between the distance of a point and of the surface that its pixel shows


@dataclass(frozen=True)
class Scale:
    """Size and effort of the measurements; QUICK is for trials."""

    size: tuple[int, int] = (320, 180)
    reference_samples: int = 128  # per pixel and reference picture
    second_samples: int = 32
    mitsuba_samples: int = 64
    solving: str = ""  # options of `solve`; "": its defaults
    until_rays: str = "40M"  # limit of --until
    seconds: int = 10  # for --time
    points: int = 4000  # for bakes
    point_samples: int = 128  # paths per point and seed


QUICK = Scale((96, 54), 64, 16, 32, "--rays 1M", "1M", 3, 600, 64)


@dataclass(frozen=True)
class Run:
    """A way to make pictures or bakes: options of `render` or `export`."""

    name: str
    options: str
    source: str = "solution"  # what is read: the "scene", its "solution", or its export to "mitsuba"
    stated: bool = True  # the command states errors
    shares_records: bool = False  # pixels of a block have the same error of indirect light
    mirrors: bool = True  # what mirrors reflect is drawn


def picture_runs(scale: Scale) -> list[Run]:
    # Without limits of rays and samples, --until would not end where too little light arrives.
    until = f"--until 5% --rays {scale.until_rays} --max-samples 256"
    hybrid = {"shares_records": True}
    return [
        Run("instant", f"--shading instant --samples {scale.second_samples}", "scene"),
        Run("path", "--shading path", "scene"),
        Run("mitsuba", f"{scale.mitsuba_samples}", "mitsuba", stated=False),
        Run("flat", "--shading flat", stated=False, mirrors=False),
        Run("smooth", "--shading smooth", stated=False, mirrors=False),
        Run("gather", "--shading gather"),
        Run("hybrid", "--shading hybrid", **hybrid),
        Run(f"hybrid --time {scale.seconds}", f"--shading hybrid --time {scale.seconds}", "scene", **hybrid),
        Run("hybrid --until 5%", f"--shading hybrid {until}", "scene", **hybrid),
    ]


BAKES = [
    Run("lightmap", "--lightmap", stated=False),
    Run("lightmap gather", "--lightmap --shading gather", stated=False),
    Run("vertices", "", stated=False),
    Run("vertices smooth", "--shading smooth", stated=False),
]


@dataclass(frozen=True)
class Picture:
    """Channel means of the pixels, in a row. Layers without a value are 0."""

    light: np.ndarray
    emitted: np.ndarray
    error: np.ndarray  # stated standard error
    indirect_share: np.ndarray  # of the stated variance
    printed: float  # relative error that the command prints
    seconds: float

    def block_errors(self, layout: Layout, shares_records: bool) -> np.ndarray:
        variance = self.error**2
        shared = variance * self.indirect_share if shares_records else np.zeros_like(variance)
        return blocks.block_standard_error(variance - shared, shared, layout)


def read_picture(path: Path, finished: program.Finished, layers: bool) -> Picture:
    light = read_exr(path).mean(axis=2).ravel()
    none = np.zeros_like(light)
    said = re.findall(r"estimated relative error ([\d.]+)% a pixel", finished.messages)
    printed = float(said[-1]) / 100 if said else math.nan
    if not layers:
        return Picture(light, none, none, none, printed, finished.seconds)
    direct, indirect = (read_layer(path, f"{name}_variance", "V")[:, :, 0].ravel() for name in ("direct", "indirect"))
    share = indirect / np.maximum(direct + indirect, 1e-30)
    emitted, error = (read_exr(path, name).mean(axis=2).ravel() for name in ("emitted", "standard_error"))
    return Picture(light, emitted, error, share, printed, finished.seconds)


@dataclass(frozen=True)
class Truth:
    """Reference pictures of a scene, and what is compared with them."""

    size: tuple[int, int]
    references: list[np.ndarray]
    errors: list[np.ndarray]  # stated standard errors of the references
    emitted: np.ndarray
    second: np.ndarray  # by the second method
    depth: np.ndarray  # height x width [m]

    @cached_property
    def layout(self) -> Layout:
        width, height = self.size
        shines = (self.emitted > 0).reshape(height, width)
        return blocks.pixel_layout(~widened(widened(shines)), tile_side=height // 4)

    @cached_property
    def whole(self) -> Layout:
        """All pixels, for the error that the command prints."""
        return blocks.pixel_layout(np.ones(self.size[::-1], bool), tile_side=self.size[1] // 4)

    @cached_property
    def dark(self) -> Layout:
        return blocks.darkest(self.second, self.layout)

    @cached_property
    def scale(self) -> np.ndarray:
        """The larger of the light of a pixel and the mean reflected light, as in the command's error of a pixel. The
        second method's light has noise of its own, which products of differences need."""
        width, height = self.size
        around = box_mean(self.second.reshape(height, width), radius=1).ravel()
        return np.maximum(around, float((np.mean(self.references, axis=0) - self.emitted).mean()))

    def measures(self, pictures: list[Picture], run: Run) -> dict[str, Interval]:
        light = [p.light for p in pictures]
        found = {}
        for prefix, layout in (("", self.layout), ("dark_", self.dark)):
            if not len(layout.tile):
                continue
            found[f"{prefix}mean"] = blocks.mean_ratio(light, self.references, layout)
            found[f"{prefix}blocks"] = blocks.block_error(light, self.references, layout)
            found[f"{prefix}bias"] = blocks.block_bias(light, self.references, layout)
            if run.stated:
                found |= self._stated(prefix, pictures, layout, run.shares_records)
        printed = [p.printed for p in pictures if not math.isnan(p.printed)]
        if run.stated and printed:
            true = blocks.relative_error(light, self.references, self.scale, self.whole)
            found["printed"] = true.mapped(lambda error: float(np.mean(printed)) / error if error > 0 else math.inf)
        return found

    def _stated(self, prefix: str, pictures: list[Picture], layout: Layout, shares_records: bool) -> dict[str, Interval]:
        light, stated = [p.light for p in pictures], [p.error for p in pictures]
        of_blocks = [p.block_errors(layout, shares_records) for p in pictures]
        of_references = [blocks.block_standard_error(e**2, np.zeros_like(e), layout) for e in self.errors]
        return {
            f"{prefix}stated": blocks.stated_over_true(stated, light, self.references, self.scale, layout),
            f"{prefix}stated_blocks": blocks.block_stated_over_true(of_blocks, light, self.references, layout),
            f"{prefix}coverage": blocks.coverage(of_blocks, light, self.references, of_references, layout),
        }

    def block_noise(self) -> float:
        """Returns the noise of the blocks of the mean reference, over their mean."""
        a, b = (self.layout.means(r) for r in self.references)
        return float(np.sqrt(np.mean((a - b) ** 2)) / (a + b).mean())


@dataclass(frozen=True)
class PointTruth:
    """Path-traced illuminance at points on surfaces that face up or sideways."""

    points: np.ndarray
    normals: np.ndarray
    cell: np.ndarray  # of each point
    references: list[np.ndarray]

    def measures(self, baked: Baked) -> dict[str, Interval]:
        light = [baked.at(self.points, self.normals)]
        single = Layout(np.arange(len(self.cell)), self.cell)  # the mean of all points, also of sparse cells
        full = Layout(self.cell, np.arange(self.cell.max() + 1)).only(np.bincount(self.cell) >= POINTS_PER_CELL)
        found = {"mean": blocks.mean_ratio(light, self.references, single)}
        if len(full.tile) > 1:
            dark = blocks.darkest(sum(self.references), full)
            found |= {"blocks": blocks.block_error(light, self.references, full)}
            found |= {"dark_mean": blocks.mean_ratio(light, self.references, dark)}
            found |= {"dark_blocks": blocks.block_error(light, self.references, dark)}
        return found


def visible(points: np.ndarray, scene: Scene, depth: np.ndarray) -> np.ndarray:
    """Returns whether the scene's view shows each point. @param depth  Distance that each pixel shows [m]."""
    eye, target, up = (np.array(v, float) for v in (scene.eye, scene.look_at, scene.up))
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, up)
    right /= np.linalg.norm(right)
    height, width = depth.shape
    pixels_per_tangent = height / 2 / math.tan(math.radians(scene.fov) / 2)
    along = np.maximum((points - eye) @ forward, 1e-9)
    column = (width / 2 + pixels_per_tangent * ((points - eye) @ right) / along).astype(int)
    row = (height / 2 - pixels_per_tangent * ((points - eye) @ np.cross(right, forward)) / along).astype(int)
    inside = (along > 1e-6) & (column >= 0) & (column < width) & (row >= 0) & (row < height)
    shown = depth[np.clip(row, 0, height - 1), np.clip(column, 0, width - 1)]
    distance = np.linalg.norm(points - eye, axis=1)
    return inside & (np.abs(shown - distance) < SAME_DEPTH * distance)


def draw_points(baked: Baked, scene: Scene, depth: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Draws visible points uniformly from the area that faces up, or to one of the four horizontal directions with the
    most area, within POINT_REACH of the view's target. `probe` measures no others. Returns points and normals."""
    random = np.random.default_rng(1)
    normals, areas = baked.normals.round(6), baked.areas()
    vertical = np.abs(normals[:, 2]) < 1e-6
    directions, member = np.unique(normals[vertical], axis=0, return_inverse=True)
    largest = np.argsort(-np.bincount(member.ravel(), areas[vertical]))[:4] if len(directions) else []
    allowed = normals[:, 2] > 0.999999
    for direction in directions[largest]:
        allowed |= (normals == direction).all(axis=1)
    weights = np.where(allowed, areas, 0)
    if not weights.sum() > 0:
        return np.empty((0, 3)), np.empty((0, 3))
    tries = 200 * count  # the surfaces of a hall are some hundred times those that are within reach
    triangle = random.choice(len(areas), tries, p=weights / weights.sum())
    u, v = np.sqrt(random.random(tries)), random.random(tries)
    corners = np.stack([1 - u, u * (1 - v), u * v], axis=1)
    points = (baked.corners[triangle] * corners[:, :, None]).sum(axis=1)
    near = np.linalg.norm(points - np.array(scene.look_at), axis=1) < POINT_REACH
    chosen = np.flatnonzero(near & visible(points, scene, depth))[:count]
    return points[chosen], normals[triangle[chosen]]


def cells_of(points: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Returns the index of the square of side CELL around each point, on its plane."""
    is_up = normals[:, 2] > 0.5
    sideways = np.where(is_up, points[:, 0], points[:, 1] * normals[:, 0] - points[:, 0] * normals[:, 1])
    upwards = np.where(is_up, points[:, 1], points[:, 2])
    plane = (points * normals).sum(axis=1).round(3)
    key = np.column_stack([normals, plane, np.floor(sideways / CELL), np.floor(upwards / CELL)])
    return np.unique(key, axis=0, return_inverse=True)[1].ravel()


class Bench:
    """Measures scenes with a build of the program, and keeps references and rows."""

    def __init__(self, command: program.Program, scale: Scale, folder: Path, table: Path):
        self.command, self.scale, self.folder, self.table = command, scale, folder, table
        self.build = command.fingerprint[:12]

    def measure(self, name: str) -> None:
        """Measures the runs of a scene that the table does not have yet."""
        rows = [row for row in read_rows(self.table) if row["scene"] != name or self._is_current(row) and not row["failure"]]
        known = {row["run"] for row in rows if row["scene"] == name}
        missing = [run for run in [*picture_runs(self.scale), *BAKES] if run.name not in known]
        if not missing:
            return
        with tempfile.TemporaryDirectory() as temporary:
            work = SceneWork(self, name, Path(temporary))
            for run in missing:
                print(f"{name}: {run.name}", file=sys.stderr, flush=True)
                row = {"scene": name, "run": run.name, "size": self._size(), "build": self.build}
                try:
                    row |= work.row(run)
                except program.ExperimentError as error:
                    row["failure"] = " ".join(str(error).split())[-300:]
                rows.append(row | {"version": self.command.version})
                results.write_csv(self.table, rows, COLUMNS)

    def _size(self) -> str:
        return "x".join(map(str, self.scale.size))

    def _is_current(self, row: dict) -> bool:
        return row["build"] == self.build and row["size"] == self._size()

    def kept(self, key: str, name: str, make: Callable[[], dict[str, np.ndarray]]) -> dict[str, np.ndarray]:
        """Returns arrays from the cache, or makes and keeps them."""
        file = self.folder / f"{name}-{hashlib.sha256(key.encode()).hexdigest()[:16]}.npz"
        if not file.is_file():
            file.parent.mkdir(parents=True, exist_ok=True)
            partial = file.with_name(f"partial-{file.name}")
            np.savez_compressed(partial, **make())
            partial.rename(file)
        with np.load(file) as arrays:
            return dict(arrays)


class SceneWork:
    """The pictures, solutions and references of one scene, in a temporary folder."""

    def __init__(self, bench: Bench, name: str, folder: Path):
        self.bench, self.name, self.folder = bench, name, folder
        self.scene: Scene = make_scene(name)
        self.path = self.scene.write(folder, name.replace("@", "-"), self.scene.text)
        images = "".join(hashlib.sha256(i.tobytes()).hexdigest() for i in self.scene.images.values())
        self.key = self.scene.text + images + "".join(self.scene.files.values()) + self.scene.view()
        self._solutions: dict[str, Path] = {}
        self._truths: dict[bool, Truth] = {}

    def row(self, run: Run) -> dict:
        if run in BAKES:
            measures, cost = self._baked(run)
        else:
            truth = self.truth(run.mirrors or not self.scene.mirrors)
            pictures = [self.picture(run, seed) for seed in SEEDS]
            measures = truth.measures(pictures, run)
            cost = {"seconds": np.mean([p.seconds for p in pictures]), "reference_blocks": truth.block_noise()}
            cost |= {"printed_error": np.mean([p.printed for p in pictures])}
        row = {key: f"{value:.5g}" for key, value in cost.items()}
        for key, interval in measures.items():
            ends = (interval.value, interval.low, interval.high)
            row |= {f"{key}{end}": f"{v:.6g}" for end, v in zip(("", "_low", "_high"), ends)}
        return row

    def picture(self, run: Run, seed: int) -> Picture:
        """`seed` is also that of the solution."""
        if run.source == "mitsuba":
            return self._draw_by_mitsuba(int(run.options), seed)
        source = self.path if run.source == "scene" else self.solution(self.scene.view(), seed)
        seeded = f"--seed {seed}" if run.stated else ""  # other pictures have the seed of the solution
        return self._draw(source, f"{run.options} {seeded}", run.stated)

    def _draw(self, source: Path, options: str, layers: bool) -> Picture:
        picture = self.folder / "picture.exr"
        size = "x".join(map(str, self.bench.scale.size))
        drawing = f"{self.scene.view()} --size {size} {options} {'--layers' if layers else ''} -o {picture}"
        finished = program.run(self.bench.command, ["render", str(source), *drawing.split()])
        return read_picture(picture, finished, layers)

    def _draw_by_mitsuba(self, samples: int, seed: int) -> Picture:
        python = os.environ.get(MITSUBA)
        if not python:
            raise program.ExperimentError(f"not measured: {MITSUBA} names no Python with Mitsuba")
        if self.scene.mirrors:
            raise program.ExperimentError("not measured: light that mirrors reflect to surfaces is lost here, but not in Mitsuba")
        script, exported, output = Path(__file__).parent / "lab/mitsuba_render.py", self.folder / "scene.xml", self.folder / "picture.npy"
        view = {"name": "audit", "eye": [*self.scene.eye], "look_at": [*self.scene.look_at], "up": [*self.scene.up], "fov": self.scene.fov}
        self.path.with_suffix(".views.json").write_text(json.dumps({"views": [view]}))
        size = "x".join(map(str, self.bench.scale.size))
        program.run(self.bench.command, ["export", str(self.path), "--size", size, "-o", str(exported)])
        begin = time.monotonic()
        drawn = subprocess.run([python, script, exported, output, str(samples), str(seed)], capture_output=True, text=True)
        if drawn.returncode != 0:
            raise program.ExperimentError(f"Mitsuba failed: {drawn.stderr[-250:]}")
        light = np.load(output).mean(axis=2).ravel().astype(float)
        none = np.zeros_like(light)
        return Picture(light, none, none, none, math.nan, time.monotonic() - begin)

    def solution(self, view: str, seed: int) -> Path:
        key = f"{'view' if view else 'whole'}-{seed}"
        if key not in self._solutions:
            path = self.folder / f"{key}.h5"
            options = f"{view} {self.bench.scale.solving} --seed {seed} -o {path}"
            program.run(self.bench.command, ["solve", str(self.path), *options.split()])
            self._solutions[key] = path
        return self._solutions[key]

    def truth(self, mirrors: bool) -> Truth:
        if mirrors not in self._truths:
            scale = self.bench.scale
            key = f"{self.key} {scale.size} {scale.reference_samples} {scale.second_samples} {mirrors}"
            arrays = self.bench.kept(key, self.name, lambda: self._trace_references(mirrors))
            references, errors = ([arrays[f"{what}{seed}"] for seed in REFERENCE_SEEDS] for what in ("light", "error"))
            self._truths[mirrors] = Truth(scale.size, references, errors, arrays["emitted"], arrays["second"], arrays["depth"])
        return self._truths[mirrors]

    def _trace_references(self, mirrors: bool) -> dict[str, np.ndarray]:
        print(f"{self.name}: reference", file=sys.stderr, flush=True)
        scale, arrays = self.bench.scale, {"emitted": 0}
        seen = "" if mirrors else "--no-mirrors"
        for seed in REFERENCE_SEEDS:
            traced = self._draw(self.path, f"--shading path --samples {scale.reference_samples} --seed {seed} {seen}", True)
            arrays |= {f"light{seed}": traced.light, f"error{seed}": traced.error}
            arrays["emitted"] = arrays["emitted"] + traced.emitted / len(REFERENCE_SEEDS)
        arrays["depth"] = read_layer(self.folder / "picture.exr", "depth", "Z")[:, :, 0]
        second = f"--shading instant --samples {scale.second_samples} --seed {REFERENCE_SEEDS[0]} {seen}"
        return arrays | {"second": self._draw(self.path, second, True).light}

    def _baked(self, run: Run) -> tuple[dict[str, Interval], dict[str, float]]:
        baked, finished = self._bake(run)
        truth = self._point_truth()
        if not len(truth.points):
            return {}, {"seconds": finished.seconds}
        return truth.measures(baked), {"seconds": finished.seconds}

    def _bake(self, run: Run) -> tuple[Baked, program.Finished]:
        output = self.folder / "baked.glb"
        finished = program.run(self.bench.command, ["export", str(self.solution("", SEEDS[0])), *run.options.split(), "-o", str(output)])
        return read_baked(output), finished

    def _point_truth(self) -> PointTruth:
        scale = self.bench.scale
        key = f"{self.key} points {scale.points} {scale.point_samples}"
        arrays = self.bench.kept(key, self.name, self._trace_points)
        return PointTruth(arrays["points"], arrays["normals"], arrays["cell"], [arrays[f"light{s}"] for s in REFERENCE_SEEDS])

    def _trace_points(self) -> dict[str, np.ndarray]:
        print(f"{self.name}: points", file=sys.stderr, flush=True)
        faces, _ = self._bake(BAKES[0])  # its mesh has the scene's own faces
        points, normals = draw_points(faces, self.scene, self.truth(True).depth, self.bench.scale.points)
        arrays = {"points": points, "normals": normals, "cell": cells_of(points, normals)}
        for seed in REFERENCE_SEEDS:
            light = np.zeros(len(points))
            for direction in np.unique(normals, axis=0):
                chosen = (normals == direction).all(axis=1)
                light[chosen] = self._probe(points[chosen], direction, seed)
            arrays[f"light{seed}"] = light
        return arrays

    def _probe(self, points: np.ndarray, direction: np.ndarray, seed: int) -> np.ndarray:
        """Returns path-traced illuminance of surfaces that face this direction, up or horizontal [lx]."""
        table = self.folder / "points.csv"
        is_up = direction[2] > 0.5
        facing = ["--quantity", "horizontal"] if is_up else ["--quantity", "vertical", "--direction", ",".join(f"{x:.9g}" for x in direction)]
        places = [word for p in points for word in ("--point", ",".join(f"{x:.9g}" for x in p))]
        tracing = f"--shading path --samples {self.bench.scale.point_samples} --seed {seed} -o {table}"
        program.run(self.bench.command, ["probe", str(self.path), *tracing.split(), *facing, *places])
        return np.genfromtxt(table, delimiter=",", skip_header=1, usecols=3, ndmin=1)


MEASURES = [f"{part}{name}" for name in ("mean", "blocks", "bias", "stated", "stated_blocks", "coverage") for part in ("", "dark_")]
COLUMNS = ["scene", "run"]
COLUMNS += [f"{name}{end}" for name in [*MEASURES, "printed"] for end in ("", "_low", "_high")]
COLUMNS += ["printed_error", "reference_blocks", "seconds", "failure", "size", "build", "version"]
TEXTS = {"scene", "run", "failure", "size", "build", "version"}


def read_rows(table: Path) -> list[dict]:
    return results.read_csv(table, TEXTS) if table.is_file() else []


def misses(row: dict) -> list[str]:
    """Returns the names of the limits that a row misses."""
    if row["failure"]:
        return ["failure"]
    missed = []
    for part in ("", "dark_"):
        for name, limits in LIMITS.items():
            value = row.get(f"{part}{name}", math.nan)
            interval = Interval(value, row.get(f"{part}{name}_low"), row.get(f"{part}{name}_high"))
            if not math.isnan(value) and not interval.overlaps(*limits):
                missed.append(f"{part}{name}")
    limit = re.search(r"--time (\d+)", row["run"])
    if limit and row["seconds"] > TIME_TOLERANCE * float(limit[1]):
        missed.append("time")
    return missed


# Known reasons for missed limits, by kind of scene and start of the run's name; "" stands for all.
REASONS: dict[tuple[str, str], str] = {}


def reason(row: dict, missed: list[str]) -> str:
    if row["failure"]:
        return row["failure"]
    parts = []
    for (kind, run), text in REASONS.items():
        if kind in ("", row["scene"].partition("@")[0]) and row["run"].startswith(run):
            parts.append(text)
    if "blocks" in missed and row["bias"] <= LIMITS["blocks"][1]:
        parts.append(f"blocks: noise, which differs from seed to seed; without it {row['bias']:.1%}")
    if row["reference_blocks"] > row["blocks"]:
        parts.append("the reference has more noise than the picture")
    return "; ".join(parts) or "not known"


def write_page(table: Path, page: Path) -> None:
    """Writes a line for each run. Cells contain the value of the whole picture, then that of its darkest fifth."""
    lines = []
    for row in sorted(read_rows(table), key=lambda row: order_of(row["scene"])):
        missed = misses(row)
        doubt = (row["mean_high"] - row["mean_low"]) / 2
        verdict = ", ".join(m.replace("dark_", "dark ") for m in missed) or ("pass" if doubt <= RESOLVED else "not resolved")

        def cell(name: str, text: Callable[[float], str]) -> str:
            shown = [(n, row.get(n, math.nan)) for n in (name, f"dark_{name}")]
            return "; ".join(f"**{text(v)}**" if n in missed else text(v) for n, v in shown if not math.isnan(v))

        lines.append(
            [
                row["scene"],
                row["run"],
                cell("mean", lambda v: f"{v - 1:+.2%}") + f" (± {doubt:.2%})",
                cell("blocks", lambda v: f"{v:.1%}"),
                cell("stated", lambda v: f"{v:.2f}"),
                cell("printed", lambda v: f"{v:.2f}"),
                cell("stated_blocks", lambda v: f"{v:.2f}"),
                cell("coverage", lambda v: f"{v:.1%}"),
                f"{row['seconds']:.1f}",
                verdict,
                reason(row, missed) if verdict != "pass" else "",
            ]
        )
    header = "scene;run;mean;blocks of 9;stated over true;printed over true;blocks, stated over true;coverage;seconds;missed;reason"
    results.write_table(page, header.split(";"), lines)


def order_of(name: str) -> tuple[bool, int]:
    """Scenes with a name of their own come before drawn ones."""
    kind, _, seed = name.partition("@")
    return bool(seed), list(KINDS).index(kind)


def seed_of_commit() -> str:
    git = subprocess.run(["git", "rev-parse", "--short=12", "HEAD"], cwd=program.ROOT, capture_output=True, text=True)
    if git.returncode != 0:
        raise program.ExperimentError(f"--from-commit: {git.stderr.strip()}")
    return git.stdout.strip()


def main(names: list[str], seed: str | None, command: program.Program, quick: bool, only_draw: bool, out: Path | None) -> None:
    """@param names  Scenes or kinds; with a seed, the ten scenes that it draws replace an empty list."""
    if seed and not names:
        names = drawn_scenes(seed)
    out = out or (program.ROOT / "out/experiments/quick" if quick else None)
    table = out / "results/audit-shadings.csv" if out else TABLE
    if not only_draw:
        bench = Bench(command, QUICK if quick else Scale(), out / "cache/audit-shadings" if out else WORK, table)
        for name in names or KINDS:
            bench.measure(name)
    page = (out / "figures" if out else program.ROOT / "docs/figures") / "audit-shadings.md"
    write_page(table, page)
    print(page.read_text(), end="")
