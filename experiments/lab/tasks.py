"""Tasks as plain values, identified by their commands, so that equal tasks run once."""

import shlex
from dataclasses import dataclass


@dataclass(frozen=True)
class Solve:
    """One run of `interflect solve`. Options are written as on the command line."""

    scene: str  # environment variables in it are expanded at run time
    view: str  # for example "--view room-4"
    options: str  # the method and its options
    rays: int
    seed: int

    def arguments(self, output: str, stats: str) -> list[str]:
        options = shlex.split(self.view) + shlex.split(self.options)
        limits = ["--rays", str(self.rays), "--seed", str(self.seed)]
        return ["solve", self.scene, "-o", output, *options, *limits, "--stats", stats]


@dataclass(frozen=True)
class Picture:
    solve: Solve
    view: str
    options: str
    suffix: str = "png"

    def arguments(self, solution: str, output: str) -> list[str]:
        return ["render", solution, "-o", output, *shlex.split(self.view), *shlex.split(self.options)]


SHADINGS = ("flat", "smooth")  # constant elements; the default shading
PROBE_SIZE = "320x180"


def probe(solve: Solve, view: str, shading: str) -> Picture:
    """Returns the picture in which errors are measured."""
    return Picture(solve, view, f"--size {PROBE_SIZE} --samples 64 --shading {shading}", "exr")


@dataclass(frozen=True)
class Reference:
    """A path-traced probe, with neither the mesh nor the estimator of the solutions under test."""

    scene: str
    view: str
    paths: int  # per pixel
    seed: int

    @property
    def options(self) -> str:
        return f"--shading path --no-mirrors --samples {self.paths} --seed {self.seed}"

    def arguments(self, output: str, error: str) -> list[str]:
        view, options = shlex.split(self.view), shlex.split(self.options)
        return ["render", self.scene, "-o", output, "--error-image", error, *view, "--size", PROBE_SIZE, *options]


@dataclass(frozen=True)
class Measure:
    """Error of a solution's probes against a reference: path-traced, or a long run on the same fixed mesh."""

    solve: Solve
    view: str
    reference: Reference | Solve


Task = Picture | Measure | Reference


@dataclass(frozen=True)
class Entry:
    """A task of a figure with the name of its series and its budget of rays."""

    series: str
    task: Task


def with_iterations(options: str, rays: int, iterations: int | None) -> str:
    """Sets the rays per iteration so that `iterations` of them use up the rays; None leaves `options` unchanged."""
    return options if iterations is None else f"{options} --rays-per-iteration {rays // iterations}"


def ladder(config: dict, methods: list[dict], reference: Reference | Solve) -> list[Entry]:
    """Measures each method at each of the `budgets` with the number of seeds in `seeds`, each in a separate run."""
    entries = []
    for method in methods:
        for rays, count in zip(config["budgets"], config["seeds"], strict=True):
            options = with_iterations(method["options"], rays, method.get("iterations"))
            for seed in range(1, count + 1):
                solve = Solve(config["scene"], config["view"], options, rays, seed)
                entries.append(Entry(method["name"], Measure(solve, config["view"], reference)))
    return entries


def reference_of(config: dict, table: str = "reference") -> Reference | Solve:
    """Returns the reference: same scene and view, with a separate seed. Path-traced if it has `paths`."""
    reference = config[table]
    if "paths" in reference:
        return Reference(config["scene"], config["view"], reference["paths"], reference["seed"])
    return Solve(config["scene"], config["view"], reference["options"], reference["rays"], reference["seed"])
