"""What is to be computed, as plain values: a task is known by its commands, so that equal ones are done once."""

import shlex
from dataclasses import dataclass


@dataclass(frozen=True)
class Solve:
    """One run of `interflect solve`. Options are written as on the command line."""

    scene: str  # environment variables in it are expanded when it is run
    view: str  # such as "--view room-4"
    options: str  # the method and what belongs to it
    rays: int
    seed: int

    def arguments(self, output: str, stats: str) -> list[str]:
        options = shlex.split(self.view) + shlex.split(self.options)
        limits = ["--rays", str(self.rays), "--seed", str(self.seed)]
        return ["solve", self.scene, "-o", output, *options, *limits, "--stats", stats]


@dataclass(frozen=True)
class Picture:
    """`interflect render` of a solution."""

    solve: Solve
    view: str
    options: str
    suffix: str = "png"

    def arguments(self, solution: str, output: str) -> list[str]:
        return ["render", solution, "-o", output, *shlex.split(self.view), *shlex.split(self.options)]


SHADINGS = ("flat", "smooth")  # the elements as they are; what people look at


def probe(solve: Solve, view: str, shading: str) -> Picture:
    """The picture that errors are measured in."""
    return Picture(solve, view, f"--size 320x180 --samples 4 --shading {shading}", "exr")


@dataclass(frozen=True)
class Measure:
    """How far the probes of a solution are from those of a reference."""

    solve: Solve
    view: str
    reference: Solve


Task = Picture | Measure


@dataclass(frozen=True)
class Entry:
    """A task as a figure knows it: what its rows are called, and which budget of rays they belong to."""

    series: str
    task: Task


def with_iterations(options: str, rays: int, iterations: int | None) -> str:
    """Adds the size of iterations, so that `iterations` of them use up the rays; None: as the options say."""
    return options if iterations is None else f"{options} --rays-per-iteration {rays // iterations}"


def ladder(config: dict, methods: list[dict], reference: Solve) -> list[Entry]:
    """Measures each method at each of the `budgets` with as many seeds as `seeds` says for it, in runs of their own."""
    entries = []
    for method in methods:
        for rays, count in zip(config["budgets"], config["seeds"], strict=True):
            options = with_iterations(method["options"], rays, method.get("iterations"))
            for seed in range(1, count + 1):
                solve = Solve(config["scene"], config["view"], options, rays, seed)
                entries.append(Entry(method["name"], Measure(solve, config["view"], reference)))
    return entries


def reference_of(config: dict, table: str = "reference") -> Solve:
    """The long run to compare with: same scene and view, and a seed that no measured run has."""
    reference = config[table]
    return Solve(config["scene"], config["view"], reference["options"], reference["rays"], reference["seed"])
