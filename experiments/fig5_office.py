"""The eight variants in a real office: a table."""

import sys
from pathlib import Path

from lab import results
from lab.program import expanded
from lab.results import Row
from lab.tasks import Entry, ladder, reference_of


def entries(config: dict) -> list[Entry]:
    scene = Path(expanded(config["scene"]))
    if not scene.is_file():
        print(f"fig5-office is left out: there is no {scene} (INTERFLECT_SCENES names its folder)", file=sys.stderr)
        return []
    return ladder(config, config["methods"], reference_of(config))


def draw(config: dict, rows: list[Row], folder: Path) -> None:
    results.write_summary(folder / "fig5-office.md", rows)
