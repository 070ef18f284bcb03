"""Measures scenes with a build of the program; keeps references and rows."""

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
from pathlib import Path

import numpy as np
from measured.audit_scenes import Scene
from lab import program, results
from lab.analysis.baked import Baked, read_baked
from lab.analysis.blocks import Interval
from lab.analysis.picture import read_layer

from .page import COLUMNS, read_rows
from .pictures import Picture, Truth, read_picture
from .points import PointTruth, cells_of, draw_points
from .runs import BAKES, REFERENCE_SEEDS, SEEDS, Run, Scale, picture_runs
from .scenes import make_scene

MITSUBA = "MITSUBA_PYTHON"  # environment variable: a Python that has Mitsuba
MITSUBA_SCRIPT = program.ROOT / "experiments/lab/mitsuba_render.py"


class Bench:
    """Measures scenes with a build of the program, and keeps references and rows."""

    def __init__(self, command: program.Program, scale: Scale, folder: Path, table: Path):
        self.command, self.scale, self.folder, self.table = command, scale, folder, table
        self.build = command.fingerprint[:12]

    def measure(self, name: str) -> None:
        """Measures the runs of a scene that the table does not have yet."""
        rows = [row for row in read_rows(self.table) if row["scene"] != name or self._is_valid(row)]
        known = {row["run"] for row in rows if row["scene"] == name}
        missing = [run for run in [*picture_runs(self.scale), *BAKES] if run.name not in known]
        if not missing:
            return
        with tempfile.TemporaryDirectory() as temporary:
            work = SceneWork(self, name, Path(temporary))
            for run in missing:
                print(f"{name}: {run.name}", file=sys.stderr, flush=True)
                row = {"scene": name, "run": run.name, "size": self.scale.picture_size, "build": self.build}
                try:
                    row |= work.row(run)
                except program.ExperimentError as error:
                    row["failure"] = " ".join(str(error).split())[-300:]
                rows.append(row | {"version": self.command.version})
                results.write_csv(self.table, rows, COLUMNS)

    def _is_valid(self, row: dict) -> bool:
        return row["build"] == self.build and row["size"] == self.scale.picture_size and not row["failure"]

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
        """@param seed  Of the solution and of the camera rays."""
        if run.source == "mitsuba":
            return self._draw_by_mitsuba(int(run.options), seed)
        source = self.path if run.source == "scene" else self.solution(self.scene.view(), seed)
        seeded = f"--seed {seed}" if run.stated else ""  # other pictures have the seed of the solution
        return self._draw(source, f"{run.options} {seeded}", run.stated)

    def _draw(self, source: Path, options: str, layers: bool) -> Picture:
        picture = self.folder / "picture.exr"
        size = f"--size {self.bench.scale.picture_size}"
        drawing = f"{self.scene.view()} {size} {options} {'--layers' if layers else ''} -o {picture}"
        finished = program.run(self.bench.command, ["render", str(source), *drawing.split()])
        return read_picture(picture, finished, layers)

    def _draw_by_mitsuba(self, samples: int, seed: int) -> Picture:
        python = os.environ.get(MITSUBA)
        if not python:
            raise program.ExperimentError(f"not measured: {MITSUBA} names no Python with Mitsuba")
        if self.scene.mirrors:
            raise program.ExperimentError("not measured: surfaces receive light from mirrors in Mitsuba only")
        exported, output = self.folder / "scene.xml", self.folder / "picture.npy"
        view = {name: list(getattr(self.scene, name)) for name in ("eye", "look_at", "up")}
        view |= {"name": "audit", "fov": self.scene.fov}
        self.path.with_suffix(".views.json").write_text(json.dumps({"views": [view]}))
        size = self.bench.scale.picture_size
        finished = program.run(self.bench.command, ["export", str(self.path), "--size", size, "-o", str(exported)])
        if left_out := re.findall(r"lights of the kind '\w+'", finished.messages):
            raise program.ExperimentError(f"not measured: exports for Mitsuba leave out {left_out[0]}")
        begin = time.monotonic()
        arguments = [python, MITSUBA_SCRIPT, exported, output, str(samples), str(seed)]
        drawn = subprocess.run(arguments, capture_output=True, text=True)
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
            others = (arrays[name] for name in ("emitted", "second", "depth"))
            self._truths[mirrors] = Truth(scale.size, references, errors, *others)
        return self._truths[mirrors]

    def _trace_references(self, mirrors: bool) -> dict[str, np.ndarray]:
        print(f"{self.name}: reference", file=sys.stderr, flush=True)
        scale, arrays = self.bench.scale, {"emitted": 0}
        seen = "" if mirrors else "--no-mirrors"
        for seed in REFERENCE_SEEDS:
            tracing = f"--shading path --samples {scale.reference_samples} --seed {seed} {seen}"
            traced = self._draw(self.path, tracing, True)
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
        solution = str(self.solution("", SEEDS[0]))
        finished = program.run(self.bench.command, ["export", solution, *run.options.split(), "-o", str(output)])
        return read_baked(output), finished

    def _point_truth(self) -> PointTruth:
        scale = self.bench.scale
        key = f"{self.key} points {scale.points} {scale.point_samples}"
        arrays = self.bench.kept(key, self.name, self._trace_points)
        references = [arrays[f"light{seed}"] for seed in REFERENCE_SEEDS]
        return PointTruth(arrays["points"], arrays["normals"], arrays["cell"], references)

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
        text = lambda values: ",".join(f"{x:.9g}" for x in values)
        facing = "--quantity horizontal" if direction[2] > 0.5 else f"--quantity vertical --direction {text(direction)}"
        places = [word for point in points for word in ("--point", text(point))]
        tracing = f"--shading path --samples {self.bench.scale.point_samples} --seed {seed} {facing} -o {table}"
        program.run(self.bench.command, ["probe", str(self.path), *tracing.split(), *places])
        return np.genfromtxt(table, delimiter=",", skip_header=1, usecols=3, ndmin=1)
