"""An experiment: NAME.toml in paper/ or beyond/ defines the runs, NAME.py beside it draws the results."""

import importlib
import tomllib
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

from . import results
from .program import ROOT, ExperimentError
from .store import Store
from .tasks import Entry

FOLDER = ROOT / "experiments"
PAPER = ["fig1-reference", "fig2-equal-rays", "fig3-distance", "fig4-unseen", "fig5-variants", "fig5-office"]
BEYOND = ["world-size", "convergence", "methods", "points", "averaging"]


@dataclass(frozen=True)
class Places:
    results: Path  # NAME.csv
    figures: Path  # NAME.svg, NAME.png, tables

    @staticmethod
    def below(folder: Path) -> "Places":
        return Places(folder / "results", folder / "figures")


COMMITTED = Places(FOLDER / "results", ROOT / "docs/figures")


class Experiment:
    """Its module has `entries(config)`, which returns the tasks, and `draw(config, rows, folder)`, which makes the
    figures. `prepare(config)`, if it is there, writes files that the tasks read."""

    def __init__(self, name: str, config: Path | None = None, quick: bool = False):
        self.name = name
        folder = "paper" if name in PAPER else "beyond"
        self.module: ModuleType = importlib.import_module(f"{folder}.{name.replace('-', '_')}")
        self.config = read_config(config or FOLDER / folder / f"{name}.toml", quick)
        self.entries: list[Entry] = self.module.entries(self.config)

    def prepare(self) -> None:
        if hasattr(self.module, "prepare"):
            self.module.prepare(self.config)

    def collect(self, store: Store, places: Places) -> None:
        """Writes NAME.csv from the finished tasks, if the experiment has any entries."""
        rows = [{"series": entry.series, **store.row(entry.task)} for entry in self.entries]
        if rows:
            results.write_csv(places.results / f"{self.name}.csv", rows)

    def draw(self, places: Places) -> None:
        """Makes the figures from NAME.csv, if the experiment has any entries."""
        if not self.entries:
            return
        table = places.results / f"{self.name}.csv"
        if not table.is_file():
            raise ExperimentError(f"{table} is not there: run the experiment once without --only-draw")
        self.module.draw(self.config, results.read_csv(table), places.figures)


def read_config(path: Path, quick: bool) -> dict:
    """Reads the file. For a quick run, its table `quick` overrides the rest."""
    with path.open("rb") as file:
        config = tomllib.load(file)
    over = config.pop("quick", {})
    return _laid_over(config, over) if quick else config


def _laid_over(below: dict, above: dict) -> dict:
    merged = dict(below)
    for key, value in above.items():
        both = isinstance(value, dict) and isinstance(below.get(key), dict)
        merged[key] = _laid_over(below[key], value) if both else value
    return merged
