"""Rows of results: CSV files, groups by series and budget, and Markdown tables."""

import csv
import math
from collections.abc import Callable, Collection, Iterable
from pathlib import Path

import numpy as np

from .analysis import statistics
from .store import COLUMNS

Row = dict[str, str | float]

TEXT = {"renderer", "series", "scene", "view", "picture", "version", "command", "reference", "machine", "room", "camera", "channels"}


def write_csv(path: Path, rows: Iterable[dict], columns: Iterable[str] = COLUMNS) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def read_csv(path: Path, texts: Collection[str] = TEXT) -> list[Row]:
    """Reads all columns as numbers except `texts`; empty cells are nan."""

    def value(column: str, text: str) -> str | float:
        return text if column in texts else float(text or math.nan)

    with path.open(newline="") as file:
        return [{column: value(column, text) for column, text in row.items()} for row in csv.DictReader(file)]


def grouped(rows: Iterable[Row], column: str) -> dict[str | float, list[Row]]:
    """Groups rows by the values of a column, in order of first appearance."""
    groups: dict[str | float, list[Row]] = {}
    for row in rows:
        groups.setdefault(row[column], []).append(row)
    return groups


def values(rows: Iterable[Row], column: str) -> np.ndarray:
    return np.array([row[column] for row in rows], dtype=float)


def curve(rows: Iterable[Row], x: str, y: str) -> statistics.Curve:
    """Returns the curve of one series: the columns x and y over its budgets."""
    budgets = grouped(sorted(rows, key=lambda row: row["budget"]), "budget").values()
    return statistics.curve([(values(seeds, x), values(seeds, y)) for seeds in budgets])


def write_table(path: Path, header: list[str], lines: Iterable[Iterable[str]]) -> None:
    """Writes a Markdown table, to be included in a text."""
    path.parent.mkdir(parents=True, exist_ok=True)
    rule = ["---"] * len(header)
    path.write_text("".join(f"| {' | '.join(line)} |\n" for line in [header, rule, *lines]))


COST_AND_ERRORS: dict[str, tuple[str, Callable[[np.ndarray], str]]] = {
    "elements": ("elements", lambda v: f"{v.mean():,.0f}"),
    "peak MiB": ("peak_mib", lambda v: f"{v.mean():,.0f}"),
    "seconds": ("seconds", lambda v: f"{v.mean():.3g}"),
    "relative MSE, flat": ("relative_mse_flat", lambda v: str(statistics.mean(v))),
    "relative MSE, smooth": ("relative_mse_smooth", lambda v: str(statistics.mean(v))),
    "perceptual distance": ("perceptual_distance_smooth", lambda v: str(statistics.mean(v))),
    "ꟻLIP": ("flip_smooth", lambda v: str(statistics.mean(v))),
}


def write_summary(path: Path, rows: Iterable[Row]) -> None:
    """Writes a line for each series and budget: its cost and errors, means over the seeds with their confidence
    intervals."""
    lines = []
    for series, runs in grouped(rows, "series").items():
        for budget, seeds in grouped(runs, "budget").items():
            cells = [show(values(seeds, column)) for column, show in COST_AND_ERRORS.values()]
            lines.append([str(series), f"{budget / 1e6:g} M", str(len(seeds)), *cells])
    write_table(path, ["method", "rays", "seeds", *COST_AND_ERRORS], lines)
