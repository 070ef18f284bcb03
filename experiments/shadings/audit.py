"""Compares every shading and bake with path tracing: `experiments/run audit --only shadings`.

Each shading draws a picture of each scene (scenes.py) with each of two seeds; bakes are compared at visible points with
`probe --shading path`. The references are two independent path-traced pictures, kept for all builds until their folder
is deleted. Instant radiosity and, if available, Mitsuba 3 are second methods, compared like any other. Every measured
run is a row of results/audit-shadings.csv. Rows of the same build are not measured again, except failures.

Limits, each widened by two standard errors, for the whole picture and for its darkest fifth: mean within 0.5%; blocks
of 9 x 9 pixels within 3% (root mean square, of their mean); stated over true error 0.8 to 1.25; 95% intervals of blocks
cover 93 to 97%. Pixels with a lamp and their neighbours are left out, except from the error that the command prints.
"""

import subprocess
from pathlib import Path

from lab import program

from .bench import Bench
from .page import write_page
from .runs import QUICK, Scale
from .scenes import KINDS, drawn_scenes

WORK = program.ROOT / "out/experiments/cache/audit-shadings"
TABLE = program.ROOT / "experiments/results/audit-shadings.csv"


def seed_of_commit() -> str:
    git = subprocess.run(["git", "rev-parse", "--short=12", "HEAD"], cwd=program.ROOT, capture_output=True, text=True)
    if git.returncode != 0:
        raise program.ExperimentError(f"--from-commit: {git.stderr.strip()}")
    return git.stdout.strip()


def main(
    names: list[str], seed: str | None, command: program.Program, quick: bool, only_draw: bool, out: Path | None
) -> None:
    """@param names  KIND or KIND@SEED. If empty: the scenes that `seed` draws, or one of each kind without a seed."""
    if seed and not names:
        names = drawn_scenes(seed)
    out = out or (program.ROOT / "out/experiments/quick" if quick else None)
    table = out / "results/audit-shadings.csv" if out else TABLE
    if not only_draw:
        folder = out / "cache/audit-shadings" if out else WORK
        bench = Bench(command, QUICK if quick else Scale(), folder, table)
        for name in names or KINDS:
            bench.measure(name)
    page = (out / "figures" if out else program.ROOT / "docs/figures") / "audit-shadings.md"
    write_page(table, page)
    print(page.read_text(), end="")
