"""Measures runs of several processes and compares them with a model of their time: `experiments/run scaling`.

The network is the loopback device in a namespace of its own, with a limited rate (tc, which needs root). All processes
share it and the cores of this machine. docs/develop/scaling.md explains the model and its results.
"""

import itertools
import json
import math
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from lab import program, results
from lab.analysis import drawing
from lab.results import Row

TABLE = program.ROOT / "experiments/results/scaling.csv"
FIGURES = program.ROOT / "docs/figures"
TEXTS = {"scene", "version", "machine"}
BITS = 8
STEPS = 7.5  # in an iteration: one for each bounce of light that is followed
TERMS = 5  # integers of 8 bytes of an element: three channels of power, its square, importance
MPI = ["mpirun", "--oversubscribe", "--bind-to", "none"]
OVER_LOOPBACK = ["--mca", "btl", "tcp,self", "--mca", "btl_tcp_if_include", "lo", "--mca", "oob_tcp_if_include", "lo"]
AS_ROOT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


@dataclass(frozen=True)
class Subject:
    name: str
    arguments: str
    rays: int


@dataclass(frozen=True)
class Network:
    bytes_per_second: float = math.inf  # of one process, or of all if shared
    latency: float = 0  # of a message [s]
    is_shared: bool = False


SUBJECTS = [
    Subject(
        "office-graz",
        f"{program.SCENES}/office-graz.mgf --eye 3.7037,0.0788,2.2690 --look-at 1.0023,8.9229,-1.1130",
        8_000_000,
    ),
    Subject("64 furnished rooms", "maze:64:furniture --view room-27", 8_000_000),
]
RATES = [0, 1000, 200]  # [Mbit/s]; 0: not limited
RANKS = [2, 3, 4, 6, 8]
CALIBRATED = 2  # ranks
MANY = [2**k for k in range(1, 13)]  # ranks of predictions


def run(command: program.Program, subject: Subject, ranks: int, rate: int) -> list[Row]:
    """Returns a row for each iteration of a run on one thread in each process."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        stats = folder / "stats.json"
        solve = [command.path, "solve", *program.prepared(command, subject.arguments).split(), "--rays", str(subject.rays)]
        solve += ["--threads", "1", "-o", folder / "out.h5", "--stats", stats]
        launch = Path(program.__file__).with_name("launch.py")
        measured = ["sh", "-c", f'exec "$0" -I -S {launch} {folder}/cost.${{OMPI_COMM_WORLD_RANK:-0}} "$@"', sys.executable]
        launcher = [] if ranks == 1 else [*MPI, *OVER_LOOPBACK, "-n", str(ranks)]
        limit = f"tc qdisc add dev lo root tbf rate {rate}mbit burst 256k latency 2s && " if rate else ""
        network = ["unshare", "-n", "sh", "-c", f'ip link set lo up && {limit}exec "$0" "$@"']
        done = subprocess.run([*network, *launcher, *measured, *solve], cwd=program.ROOT, env=os.environ | AS_ROOT, capture_output=True, text=True)
        if done.returncode != 0:
            raise program.ExperimentError(f"{ranks} processes at {rate} Mbit/s: {done.stderr[-1000:]}")
        peaks = [json.loads(file.read_text())["peak_mib"] for file in folder.glob("cost.*")]
        iterations = [json.loads(line) for line in stats.read_text().splitlines()[1:]]
    rows, before = [], {"rays": 0, "seconds": 0}
    for iteration in iterations:
        sent = iteration.get("sent_bytes", [0])
        rows.append(
            {
                "scene": subject.name,
                "ranks": ranks,
                "mbit_per_second": rate,
                "iteration": iteration["iteration"],
                "rays": iteration["rays"] - before["rays"],
                "elements": iteration["elements"],
                "leaves": iteration["leaves"],
                "seconds": round(iteration["seconds"] - before["seconds"], 4),
                "most_sent_bytes": max(sent),
                "all_sent_bytes": sum(sent),
                "exchange_seconds": round(sum(iteration.get("exchange_seconds", [0])) / ranks, 4),
                "peak_mib": round(max(peaks)),
                "version": command.version,
                "machine": command.machine,
            }
        )
        before = iteration
    return rows


def measure() -> None:
    command = program.find_program()
    rows: list[Row] = []
    for subject in SUBJECTS:
        for ranks, rate in [(1, 0), *((r, m) for m in RATES for r in RANKS)]:
            print(subject.name, ranks, "processes", f"{rate} Mbit/s" if rate else "", file=sys.stderr, flush=True)
            rows += run(command, subject, ranks, rate)
            results.write_csv(TABLE, rows, rows[0])


def steady(rows: Iterable[Row]) -> list[Row]:
    """Returns the iterations without the preparation, which has other work."""
    return [row for row in rows if row["iteration"] > 0]


def column(rows: Iterable[Row], name: str) -> np.ndarray:
    return results.values(rows, name)


@dataclass(frozen=True)
class Model:
    """Of an iteration with n rays and e elements."""

    per_ray: float  # processor seconds
    per_element: float  # processor seconds of one process alone
    per_element_shared: float  # processor seconds of each of several, which pack and unpack sums
    bytes_per_ray: float  # sent to the process that adds its element, and by that one with the results
    bytes_per_element: float

    def sent(self, ranks: int, rays: float, elements: float) -> float:
        """Returns the bytes that a process sends: sums to the processes that add them, and its part of the results."""
        return (ranks - 1) / ranks * (self.bytes_per_ray * rays * (1 / ranks + 1) + self.bytes_per_element * elements)

    def messages(self, ranks: int) -> float:
        """Returns the messages that follow one another: about four exchanges in a step, each in ranks - 1 rounds of
        pairs, and four broadcasts."""
        return STEPS * (4 * (ranks - 1) + 4 * math.ceil(math.log2(ranks)))

    def seconds(self, ranks: int, rays: float, elements: float, network: Network, cores: float = math.inf, threads: int = 1) -> float:
        """@param cores  That all processes share."""
        work = self.per_ray * rays / ranks + (self.per_element if ranks == 1 else self.per_element_shared) * elements
        if ranks == 1:
            return work / threads
        sharing = max(1, ranks * threads / cores)
        traffic = self.sent(ranks, rays, elements) * (ranks if network.is_shared else 1)
        return work / threads * sharing + traffic / network.bytes_per_second + network.latency * self.messages(ranks)


def least_squares(columns: list[np.ndarray], target: np.ndarray) -> np.ndarray:
    """Returns the factors, not negative, with the least squared relative errors."""
    matrix = np.stack(columns, axis=1) / target[:, None]
    factors = np.linalg.lstsq(matrix, np.ones(len(target)), rcond=None)[0]
    return np.maximum(factors, 0)


def fit(rows: list[Row]) -> Model:
    """Uses the run of one process, and of CALIBRATED ones on a network without a limit."""
    alone = steady(row for row in rows if row["ranks"] == 1)
    shared = steady(row for row in rows if row["ranks"] == CALIBRATED and not row["mbit_per_second"])
    per_ray, per_element = least_squares([column(alone, "rays"), column(alone, "elements")], column(alone, "seconds"))
    left = column(shared, "seconds") - per_ray * column(shared, "rays") / CALIBRATED
    per_element_shared = float(np.sum(left) / np.sum(column(shared, "elements")))
    sent = column(shared, "all_sent_bytes") / CALIBRATED
    share = (CALIBRATED - 1) / CALIBRATED
    rays_sent = share * column(shared, "rays") * (1 / CALIBRATED + 1)
    bytes_per_ray, bytes_per_element = least_squares([rays_sent, share * column(shared, "elements")], sent)
    return Model(per_ray, per_element, per_element_shared, bytes_per_ray, bytes_per_element)


def network_of(rate: float) -> Network:
    return Network(rate * 1e6 / BITS if rate else math.inf, is_shared=True)


def runs(rows: list[Row]) -> Iterable[tuple[str, int, float, list[Row]]]:
    for scene, of_scene in results.grouped(rows, "scene").items():
        for rate, of_rate in results.grouped(of_scene, "mbit_per_second").items():
            for ranks, of_ranks in results.grouped(of_rate, "ranks").items():
                yield scene, int(ranks), rate, steady(of_ranks)


def compare(rows: list[Row], cores: int) -> list[list[str]]:
    models = {scene: fit(of_scene) for scene, of_scene in results.grouped(rows, "scene").items()}
    lines = []
    for scene, ranks, rate, of_run in runs(rows):
        if ranks == 1:
            continue
        model, network = models[scene], network_of(rate)
        measured = sum(column(of_run, "seconds"))
        predicted = sum(model.seconds(ranks, row["rays"], row["elements"], network, cores) for row in of_run)
        bytes_measured = sum(column(of_run, "all_sent_bytes")) / ranks
        bytes_predicted = sum(model.sent(ranks, row["rays"], row["elements"]) for row in of_run)
        dense = sum(2 * (ranks - 1) / ranks * STEPS * TERMS * 8 * column(of_run, "elements"))
        cells = [f"{measured:.2f}", f"{predicted:.2f}", f"{predicted / measured:.2f}"]
        cells += [f"{bytes_measured / len(of_run) / 1e6:.2f}", f"{bytes_predicted / bytes_measured:.2f}"]
        cells += [f"{sum(column(of_run, 'most_sent_bytes')) / dense:.2f}", f"{column(of_run, 'peak_mib')[0]:.0f}"]
        lines.append([scene, f"{rate:g}" if rate else "not limited", str(ranks), *cells])
    return lines


COMPARED = ["scene", "network [Mbit/s]", "processes", "measured [s]", "predicted [s]", "predicted over measured",
            "sent by each, iteration [MB]", "predicted over sent", "most sent over dense", "peak [MiB]"]  # fmt: skip
# Each process has 16 cores, as fast as 12 independent ones, and 10 Gbit/s.
THREADS = 12
CLUSTER = Network(1.1e9, 20e-6)
ELEMENTS, RAYS_PER_ELEMENT = (1e5, 1e7, 1e8), (10, 100)  # of an iteration
SHOWN = [2, 4, 8, 16, 32, 64, 128, 256, 1024, 4096]


def speeds(model: Model, elements: float, rays: float) -> tuple[float, list[float]]:
    """Returns the seconds of one process, and the speed of 2, 4, ... processes relative to it."""
    alone = model.seconds(1, rays, elements, CLUSTER, threads=THREADS)
    return alone, [alone / model.seconds(r, rays, elements, CLUSTER, threads=THREADS) for r in MANY]


def draw(rows: list[Row]) -> None:
    cores = int(str(rows[0]["machine"]).rpartition(",")[2].split()[0])
    results.write_table(FIGURES / "scaling.md", COMPARED, compare(rows, cores))
    models = {scene: fit(of_scene) for scene, of_scene in results.grouped(rows, "scene").items()}
    lines = []
    for scene, m in models.items():
        values = [m.per_ray * 1e9, m.per_element * 1e9, m.per_element_shared * 1e9, m.bytes_per_ray, m.bytes_per_element]
        lines.append([scene, *(f"{value:.3g}" for value in values)])
    header = ["scene", "a ray [ns]", "an element, alone [ns]", "an element, shared [ns]", "a ray [bytes]", "an element [bytes]"]
    results.write_table(FIGURES / "scaling-model.md", header, lines)
    model = models[SUBJECTS[0].name]
    figure, (ax,) = drawing.panels(1, 1, size=(5, 3.4))
    lines = []
    for number, (elements, per_element) in enumerate(itertools.product(ELEMENTS, RAYS_PER_ELEMENT)):
        alone, found = speeds(model, elements, elements * per_element)
        power = round(math.log10(elements))
        ax.plot(MANY, found, label=f"$10^{power}$ elements, {per_element} rays each", **drawing.style_of(number))
        shown = [f"{speed:.1f}" for ranks, speed in zip(MANY, found) if ranks in SHOWN]
        lines.append([f"10<sup>{power}</sup>", str(per_element), f"{alone:.2f}", *shown])
    ax.set(xscale="log", yscale="log", xlabel="processes", ylabel="speed, one process = 1")
    ax.legend(frameon=False)
    caption = f"Predicted speed of an iteration, {THREADS} threads in each process, {CLUSTER.bytes_per_second * BITS / 1e9:.3g} Gbit/s."
    drawing.save(figure, FIGURES, "scaling", caption)
    results.write_table(FIGURES / "scaling-speed.md", ["elements", "rays of each", "one process [s]", *map(str, SHOWN)], lines)


def main(only_draw: bool) -> None:
    if not only_draw:
        measure()
    draw(results.read_csv(TABLE, TEXTS))
