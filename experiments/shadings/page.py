"""Rows of the audit, the limits that they meet or miss, and the table of all rows."""

import math
import re
from pathlib import Path

from lab import results
from lab.analysis.blocks import Interval

from .scenes import KINDS

LIMITS = {
    "mean": (0.995, 1.005),
    "blocks": (0, 0.03),
    "stated": (0.8, 1.25),
    "printed": (0.8, 1.25),
    "coverage": (0.93, 0.97),
}
TIME_TOLERANCE = 1.1  # of --time
RESOLVED = 0.01  # a mean with larger bounds is not resolved: they are twice its limit

PARTS = ("", "dark_")  # the whole picture, and its darkest fifth
MEASURES = [f"{part}{name}" for name in (*LIMITS, "bias", "stated_blocks") for part in PARTS]
COLUMNS = ["scene", "run", *(f"{name}{end}" for name in MEASURES for end in ("", "_low", "_high"))]
COLUMNS += ["printed_error", "reference_blocks", "seconds", "failure", "size", "build", "version"]
TEXTS = {"scene", "run", "failure", "size", "build", "version"}


def read_rows(table: Path) -> list[dict]:
    return results.read_csv(table, TEXTS) if table.is_file() else []


def misses(row: dict) -> list[str]:
    """Returns the names of the limits that a row misses."""
    if row["failure"]:
        return ["not measured"]
    missed = []
    for part in PARTS:
        for name, limits in LIMITS.items():
            interval = Interval(*(row[f"{part}{name}{end}"] for end in ("", "_low", "_high")))
            # Without a measurable error, as in a black background, the ratio to it is infinite.
            if math.isfinite(interval.value) and not interval.overlaps(*limits):
                missed.append(f"{part}{name}")
    limit = re.search(r"--time (\d+)", row["run"])
    if limit and row["seconds"] > TIME_TOLERANCE * float(limit[1]):
        missed.append("time")
    return missed


# Known reasons for missed limits, by kind of scene and start of the run's name; "" stands for all.
REASONS: dict[tuple[str, str], str] = {
    ("", "instant"): "pixels share virtual lights, but the intervals of blocks assume independent pixels",
    ("", "flat"): "light is constant on elements, and no error of a pixel is stated",
    ("", "smooth"): "light is interpolated between elements, and no error of a pixel is stated",
    ("", "vertices smooth"): "light is interpolated between elements, and no error of a vertex is stated",
    ("louvres", "mitsuba"): "its shadow rays end 1/1000 of their length before the lamps, which the blades touch",
}


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
    """Writes a line for each run. Cells contain the values of the whole picture and of its darkest fifth."""
    lines = []
    for row in sorted(read_rows(table), key=lambda row: order_of(row["scene"])):
        missed = misses(row)
        doubt = (row["mean_high"] - row["mean_low"]) / 2
        verdict = ", ".join(m.replace("_", " ") for m in missed) or ("pass" if doubt <= RESOLVED else "not resolved")

        def cell(name: str, text: str, subtracted: float = 0) -> str:
            shown = [(n, text.format(row[n] - subtracted)) for n in (name, f"dark_{name}") if not math.isnan(row[n])]
            return "; ".join(f"**{value}**" if n in missed else value for n, value in shown)

        lines.append(
            [
                row["scene"],
                row["run"],
                cell("mean", "{:+.2%}", 1) + (f" (± {doubt:.2%})" if doubt >= 0 else ""),
                cell("blocks", "{:.1%}"),
                cell("stated", "{:.2f}"),
                cell("printed", "{:.2f}"),
                cell("stated_blocks", "{:.2f}"),
                cell("coverage", "{:.1%}"),
                f"{row['seconds']:.1f}",
                verdict,
                reason(row, missed) if verdict != "pass" else "",
            ]
        )
    header = "scene;run;mean;blocks of 9;stated over true;printed over true;stated over true, blocks;coverage;seconds"
    results.write_table(page, [*header.split(";"), "missed", "reason"], lines)


def order_of(name: str) -> tuple[bool, int]:
    """Scenes with a name of their own come before drawn ones."""
    kind, _, seed = name.partition("@")
    return bool(seed), list(KINDS).index(kind)
