"""Runs tasks and caches their results by command and build of the program."""

import contextlib
import hashlib
import json
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from .analysis.picture import noise_floor
from .program import ROOT, Finished, Program, prepared, read_stats, run
from .tasks import SHADINGS, Measure, Picture, Reference, Solve, Task, probe

METRICS = ("relative_mse", "perceptual_distance", "flip", "ratio_of_means")  # keys of `compare --json`
COLUMNS = (
    ["series", "scene", "view", "budget", "rays", "seed", "seconds", "processor_seconds", "elements", "peak_mib"]
    + [f"{metric}_{shading}" for metric in METRICS for shading in SHADINGS]
    + ["picture", "version", "command", "reference", "reference_noise", "machine", "threads"]
)


@dataclass(frozen=True)
class Solution:
    """A solution file, and the values of COLUMNS that describe its run."""

    path: Path
    row: dict


class Store:
    """A folder with KEY.json for every finished task, and its picture if the task is a Picture."""

    def __init__(self, program: Program, folder: Path):
        self._program = program
        self._folder = folder.resolve()
        self._folder.mkdir(parents=True, exist_ok=True)

    def has(self, task: Task) -> bool:
        return self._path(task, "json").exists()

    def row(self, task: Task) -> dict:
        """Returns the values of COLUMNS for a finished task, except `series`."""
        return json.loads(self._path(task, "json").read_text())

    @contextlib.contextmanager
    def solution(self, solve: Solve) -> Iterator[Solution]:
        """Solves. The solution file, often tens of megabytes, is deleted at the end of the `with` statement."""
        path, stats = self._path(solve, "h5"), self._path(solve, "stats")
        try:
            finished = self.run(solve.arguments(str(path), str(stats)))
            header, last = read_stats(stats)
            yield Solution(path, self._row(solve, finished, header, last))
        finally:
            path.unlink(missing_ok=True)
            stats.unlink(missing_ok=True)

    def trace(self, reference: Reference) -> None:
        """Renders a path-traced reference, and stores the relative MSE due to its noise."""
        picture, error = self._path(reference, "exr"), self._path(reference, "error.exr")
        self.run(reference.arguments(str(picture), str(error)))
        self._path(reference, "json").write_text(json.dumps({"noise": noise_floor(picture, error)}))
        error.unlink()

    def do(self, task: Picture | Measure, solution: Solution) -> None:
        """Runs a task on the solution. The reference of a Measure must be finished."""
        found = self._draw(task, solution) if isinstance(task, Picture) else self._compare(task, solution)
        path = self._path(task, "json")
        unfinished = path.with_suffix(".part")
        unfinished.write_text(json.dumps({**solution.row, "view": task.view, **found}, indent=1))
        unfinished.replace(path)

    def run(self, arguments: list[str]) -> Finished:
        return run(self._program, arguments)

    def _row(self, solve: Solve, finished: Finished, header: dict, last: dict) -> dict:
        command = ["interflect", *solve.arguments("solution.h5", "stats.json")]
        return {
            "scene": solve.scene,
            "budget": solve.rays,
            "rays": last["rays"],
            "seed": solve.seed,
            "seconds": last["seconds"],
            "processor_seconds": round(finished.processor_seconds, 3),
            "elements": last["elements"],
            "peak_mib": round(finished.peak_mib, 1),
            "version": self._program.version,
            "command": " ".join(command),
            "machine": self._program.machine,
            "threads": header["threads"],
        }

    def _draw(self, picture: Picture, solution: Solution) -> dict:
        path = self._path(picture, picture.suffix)
        self.run(picture.arguments(str(solution.path), str(path)))
        return {"picture": os.path.relpath(path, ROOT)}

    def _compare(self, measure: Measure, solution: Solution) -> dict:
        """Returns the relative MSE without the reference's noise. Below a tenth of that noise it is unknown."""
        reference, noise = measure.reference, 0.0
        if isinstance(reference, Reference):
            found = {"reference": reference.options}
            noise = json.loads(self._path(reference, "json").read_text())["noise"]
        else:
            found = {"reference": f"{reference.options} --rays {reference.rays} --seed {reference.seed}"}
        found["reference_noise"] = noise
        for shading in SHADINGS:
            traced = isinstance(reference, Reference)
            wanted = self._path(reference if traced else probe(reference, measure.view, shading), "exr")
            seen = solution.path.with_suffix(".exr")
            self.run(probe(measure.solve, measure.view, shading).arguments(str(solution.path), str(seen)))
            difference = json.loads(self.run(["compare", str(seen), str(wanted), "--json"]).output)
            found |= {f"{metric}_{shading}": difference[metric] for metric in METRICS}
            found[f"relative_mse_{shading}"] = max(difference["relative_mse"] - noise, noise / 10)
            seen.unlink()
        return found

    def _path(self, value: Solve | Task, suffix: str) -> Path:
        """Returns the path of the results of `value`. Depends on the build and on the content of the scene file."""
        scene = Path(prepared(self._program, (value if isinstance(value, Solve | Reference) else value.solve).scene))
        content = hashlib.sha256(scene.read_bytes()).hexdigest() if scene.is_file() else ""
        key = hashlib.sha256(f"{self._program.fingerprint}{content}{value}".encode()).hexdigest()[:20]
        return self._folder / f"{key}.{suffix}"
