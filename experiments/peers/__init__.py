"""Pictures of other renderers from exported scenes: error against time on equal terms (`experiments/run peers`)."""

from pathlib import Path

from lab import program

from . import page
from .bench import QUICK, Bench, Scale, all_series
from .scenes import DRAWN, SCENES

WORK = program.ROOT / "out/experiments/cache/peers"
TABLE = program.ROOT / "experiments/results/peers.csv"


def main(
    names: list[str], held_out: str | None, command: program.Program | None, quick: bool, only_draw: bool, out: Path | None
) -> None:
    """@param names  NAME or NAME@SEED. If empty: all scenes, or the drawn ones with the seed `held_out`.
    @param command  Not used with `only_draw`."""
    unknown = [name for name in names if name.partition("@")[0] not in SCENES]
    if unknown:
        raise program.ExperimentError(f"--only {' '.join(unknown)}: no such scene; there are {', '.join(SCENES)}")
    if not names:
        names = [f"{name}@{held_out}" for name in DRAWN] if held_out else list(SCENES)
    out = out or (program.ROOT / "out/experiments/quick" if quick else None)
    table = out / "results/peers.csv" if out else TABLE
    if not only_draw:
        bench = Bench(command, QUICK if quick else Scale(), out / "cache/peers" if out else WORK, table)
        for name in names:
            bench.measure(name, all_series())
    figures = out / "figures" if out else program.ROOT / "docs/figures"
    if not table.is_file():
        raise program.ExperimentError(f"{table} is missing: no picture was measured")
    page.write(table, figures)
    print((figures / "peers-times.md").read_text(), end="")
