"""The eight variants in a real office: a table."""

import sys
from pathlib import Path

from paper import fig5_variants
from lab import results
from lab.program import expanded
from lab.results import Row
from lab.tasks import Entry


def entries(config: dict) -> list[Entry]:
    scene = Path(expanded(config["scene"]))
    if not scene.is_file():
        print(f"fig5-office is left out: there is no {scene} (INTERFLECT_SCENES names its folder)", file=sys.stderr)
        return []
    return fig5_variants.entries(config)


def draw(config: dict, rows: list[Row], folder: Path) -> None:
    results.write_summary(folder / "fig5-office.md", rows)
