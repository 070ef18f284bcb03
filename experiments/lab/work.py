"""Order of the tasks, prediction of their time, and progress."""

import dataclasses
import sys
import time
from collections.abc import Iterable

from .store import Store
from .tasks import SHADINGS, Measure, Picture, Reference, Solve, Task, probe

CALIBRATION_RAYS = 4_000_000


def with_references(tasks: Iterable[Task]) -> list[Task]:
    """Returns all that `tasks` require, without duplicates; the references' pictures come first."""
    tasks = list(tasks)
    measures = [task for task in tasks if isinstance(task, Measure)]
    wanted = []
    for measure in measures:
        traced = isinstance(measure.reference, Reference)
        wanted += [measure.reference] if traced else [probe(measure.reference, measure.view, s) for s in SHADINGS]
    return list(dict.fromkeys([*wanted, *tasks]))


def by_solution(tasks: Iterable[Task]) -> dict[Solve, list[Task]]:
    """Groups tasks that share a solution, so that it is solved once; path-traced references have none."""
    groups: dict[Solve, list[Task]] = {}
    for task in (task for task in tasks if not isinstance(task, Reference)):
        groups.setdefault(task.solve, []).append(task)
    return groups


class Clock:
    """Predicts the time of tasks, from a short run on this machine and from the tasks finished so far."""

    def __init__(self, store: Store, largest: Solve):
        """Calibrates with a shortened form of the longest run."""
        short = dataclasses.replace(largest, rays=min(-(-largest.rays // 10), CALIBRATION_RAYS))
        begin = time.monotonic()
        with store.solution(short) as solution:
            self._seconds_per_ray = solution.row["seconds"] / short.rays
            self._seconds_per_run = time.monotonic() - begin - solution.row["seconds"]
            begin = time.monotonic()
            store.do(probe(short, short.view, "flat"), solution)
            self._seconds_per_picture = time.monotonic() - begin
        self._foretold = self._taken = 0.0

    def foretell(self, groups: dict[Solve, list[Task]]) -> float:
        planned = sum(self._planned(solve, tasks) for solve, tasks in groups.items())
        return planned * (self._taken / self._foretold if self._foretold > 0 else 1)

    def took(self, solve: Solve, tasks: list[Task], seconds: float) -> None:
        self._foretold += self._planned(solve, tasks)
        self._taken += seconds

    def _planned(self, solve: Solve, tasks: list[Task]) -> float:
        pictures = sum(1 if isinstance(task, Picture) else len(SHADINGS) for task in tasks)
        return solve.rays * self._seconds_per_ray + self._seconds_per_run + pictures * self._seconds_per_picture


def do(tasks: Iterable[Task], store: Store) -> None:
    """Runs the unfinished tasks. After an interruption, finished results remain."""
    missing = [task for task in with_references(tasks) if not store.has(task)]
    for reference in (task for task in missing if isinstance(task, Reference)):
        print(f"Reference: {reference.scene} {reference.view} {reference.options}", file=sys.stderr)
        store.trace(reference)
    groups = by_solution(missing)
    if not groups:
        print("Everything is there already.", file=sys.stderr)
        return
    clock = Clock(store, max(groups, key=lambda solve: solve.rays))
    rays = sum(solve.rays for solve in groups)
    print(f"{len(groups)} runs, {rays / 1e6:.0f} M rays: about {_minutes(clock.foretell(groups))}.", file=sys.stderr)
    for number, (solve, group) in enumerate(list(groups.items()), 1):
        begin = time.monotonic()
        with store.solution(solve) as solution:
            for task in group:
                store.do(task, solution)
        seconds = time.monotonic() - begin
        del groups[solve]
        clock.took(solve, group, seconds)
        what = f"{solve.scene} {solve.options} --rays {solve.rays} --seed {solve.seed}"
        left = f"{_minutes(clock.foretell(groups))} left" if groups else "done"
        print(f"[{number}/{number + len(groups)}] {what}: {seconds:.1f} s, {left}", file=sys.stderr)


def _minutes(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 90 else f"{seconds / 60:.0f} minutes"
