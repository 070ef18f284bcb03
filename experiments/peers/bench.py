"""Measures scenes: pictures of each program by settings in increasing time, against references by two programs.

Rows of the same version of a program are not measured again, and references grow in batches, so an interrupted run
continues where it was.
"""

import dataclasses
import hashlib
import itertools
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from lab import program, results
from lab.analysis.picture import luminance, read_exr

from . import renderers
from .errors import Agreement, Errors, Reference, without_lamps
from .renderers import Drawn, Job
from .scenes import make

TEXTS = {"scene", "size", "series", "settings", "version", "machine"}
COSTS = ("seconds", "processor_seconds", "peak_mib")
ERRORS = tuple(field.name for field in dataclasses.fields(Errors))
COLUMNS = ["scene", "size", "series", "settings", *COSTS, *ERRORS, "version", "machine"]
AGREEMENT = ["scene", "size", "samples", *(field.name for field in dataclasses.fields(Agreement))]
FIRST_REFERENCE_SEED = 1000  # far from the seeds of measured pictures


@dataclass(frozen=True)
class Series:
    name: str
    draw: Callable[[Job, str], Drawn]
    version: str  # of the program; "" for ours
    settings: tuple[str, ...]  # in increasing time
    unbiased: bool = False  # its error falls with the root of time


@dataclass(frozen=True)
class Scale:
    """Size and effort of the measurements."""

    size: tuple[int, int] = (960, 540)
    large: tuple[int, int] = (1920, 1080)  # one row for each program, on the scenes of LARGE_SCENES
    batch: int = 64  # samples per pixel in each half of each program's reference, doubled until `precise` is reached
    most_samples: int = 512  # of each half
    precise: float = 0.005  # error of a pixel that stands out of the noise of the references
    seconds: float = 240  # settings that are expected to take longer are left out
    settings: int | None = None  # number of settings of each series; ours by default is always measured


QUICK = Scale((96, 54), (192, 108), 16, 32, seconds=20, settings=2)
LARGE_SCENES = ("office-graz",)
GROWTH = 4  # of the time from one setting to the next
OURS, DEFAULT = "Interflect", "--shading hybrid --denoise"  # its other options have their defaults

LIMITED = ("--time 5", "--rays 1M --samples 2", "--time 15", "--rays 2M --samples 8")
HYBRID = (*(f"{DEFAULT} {limits}" for limits in LIMITED), DEFAULT, f"{DEFAULT} --rays 40M --samples 64")
SAMPLES = (4, 16, 64, 256, 1024)
# Column "accurate" of the table of options in Radiance's documentation, with a coarser and a finer cache. It has few
# ambient bounces: with 23, a picture of 96 x 54 pixels takes more than eight minutes.
ACCURATE = "-dj 0.7 -ds 0.15 -dt 0.05 -dc 0.75 -st 0.15 -lw 0.002"
CACHES = (
    "-ab 4 -aa 0.2 -ar 64 -ad 256 -as 128",
    "-ab 4 -aa 0.15 -ar 128 -ad 512 -as 256",
    "-ab 6 -aa 0.1 -ar 256 -ad 2048 -as 1024",
)
STOCHASTIC_JACOBI = "-radiance-method StochJacobi -srr-hierarchical yes -srr-importance-driven yes -iterations 10"
RAYS_AND_LINKS = (("10", "5e-4"), ("100", "1e-4"), ("400", "1e-5"), ("1600", "2e-6"))


def versions() -> dict[str, str]:
    """Returns the pinned version of each package."""
    lines = (renderers.HERE / "requirements.txt").read_text().splitlines()
    return dict(line.split("==") for line in lines if "==" in line)


def all_series() -> list[Series]:
    pinned = versions()
    mitsuba, cycles = f"Mitsuba {pinned['mitsuba']}", f"bpy {pinned['bpy']}"
    plain = tuple(map(str, SAMPLES))
    denoised, guided = tuple(f"{n} denoise" for n in SAMPLES), tuple(f"{n} denoise guide" for n in SAMPLES)
    with_oidn = f"{mitsuba}, pyoidn {pinned['pyoidn']}"
    paths = tuple(f"--shading path --samples {n}" for n in SAMPLES)
    caches = tuple(f"{cache} {ACCURATE}" for cache in CACHES)
    meshes = tuple(f"{STOCHASTIC_JACOBI} -srr-ray-units {n} -srr-epsilon {e}" for n, e in RAYS_AND_LINKS)
    return [
        Series(OURS, renderers.by_interflect, "", HYBRID),
        Series("Interflect, paths", renderers.by_interflect, "", paths, unbiased=True),
        Series("Mitsuba", renderers.by_mitsuba, mitsuba, plain, unbiased=True),
        Series("Mitsuba, OIDN", renderers.by_mitsuba, with_oidn, denoised),
        Series("Cycles", renderers.by_cycles, cycles, plain, unbiased=True),
        Series("Cycles, OIDN", renderers.by_cycles, cycles, denoised),
        Series("Cycles, guided, OIDN", renderers.by_cycles, cycles, guided),
        Series("Radiance", renderers.by_radiance, f"pyradiance {pinned['pyradiance']}", caches),
        Series("RenderPark", renderers.by_renderpark, "rpkCpp", meshes),
    ]


class Bench:
    """@param folder  For references, which are kept for all builds. @param table  Rows of results."""

    def __init__(self, command: program.Program, scale: Scale, folder: Path, table: Path):
        self.command, self.scale, self.folder, self.table = command, scale, folder, table
        self.rows = results.read_csv(table, TEXTS) if table.is_file() else []

    def measure(self, name: str, chosen: list[Series]) -> None:
        """Measures a scene by each series; ours comes first, because its error decides when the others stop."""
        with tempfile.TemporaryDirectory() as temporary:
            scene = make(self.command, Path(temporary), name)
            job = Job(self.command, scene, self.scale.size, Path(temporary))
            reference = self.reference(name, job)
            for series in chosen:
                self._measure_settings(name, series, job, reference)
            if name in LARGE_SCENES:
                large = dataclasses.replace(job, size=self.scale.large)
                reference = self.reference(name, large)
                for series in chosen:
                    setting = self._setting_of_equal_time(name, series)
                    if setting is not None:
                        self._measured(name, series, setting, large, reference)

    def _measure_settings(self, name: str, series: Series, job: Job, reference: Reference) -> None:
        for number, setting in enumerate(series.settings):
            if self.scale.settings is not None and number >= self.scale.settings and setting != DEFAULT:
                continue
            row = self._measured(name, series, setting, job, reference)
            if row is None or series.name != OURS and self._is_enough(name, row):
                return

    def _is_enough(self, name: str, row: dict) -> bool:
        """Whether the next setting would be too slow, or this one has no more error than ours."""
        ours = self._row(name, self.scale.size, OURS, DEFAULT)
        better = ours is not None and all(row[kind] <= ours[kind] for kind in ("pixels", "blocks_4"))
        return better or row["seconds"] * GROWTH > self.scale.seconds

    def _setting_of_equal_time(self, name: str, series: Series) -> str | None:
        """Returns the setting whose time is closest to the time of our default settings."""
        ours = self._row(name, self.scale.size, OURS, DEFAULT)
        found = [row for row in self.rows if (row["scene"], row["series"]) == (name, series.name)]
        found = [row for row in found if row["size"] == size_text(self.scale.size)]
        if ours is None or not found:
            return None
        return min(found, key=lambda row: abs(np.log(row["seconds"] / ours["seconds"])))["settings"]

    def _measured(self, name: str, series: Series, setting: str, job: Job, reference: Reference) -> dict | None:
        """Returns the row of the table, measured if it is missing; None if the program cannot draw the scene."""
        version = series.version or self.command.version
        known = self._row(name, job.size, series.name, setting)
        if known and known["version"] == version:
            return known
        print(f"{name}, {job.size_text}: {series.name} {setting}", file=sys.stderr, flush=True)
        try:
            drawn = series.draw(job, setting)
        except program.ExperimentError as error:
            print(f"{name}: {series.name} is left out: {error}", file=sys.stderr, flush=True)
            return None
        row = {"scene": name, "size": size_text(job.size), "series": series.name, "settings": setting}
        row |= {cost: round(getattr(drawn, cost), 2) for cost in COSTS}
        row |= {kind: round(error, 6) for kind, error in dataclasses.asdict(reference.errors(drawn.luminance)).items()}
        row |= {"version": version, "machine": self.command.machine}
        self.rows = [other for other in self.rows if other is not known] + [row]
        results.write_csv(self.table, self.rows, COLUMNS)
        return row

    def _row(self, name: str, size: tuple[int, int], series: str, setting: str) -> dict | None:
        key = (name, size_text(size), series, setting)
        return next((r for r in self.rows if (r["scene"], r["size"], r["series"], r["settings"]) == key), None)

    def reference(self, name: str, job: Job) -> Reference:
        """Returns the references of a scene, path-traced where they are missing, and writes their agreement."""
        samples = self.scale.batch
        while True:
            reference = self._traced(job, samples)
            agreement = reference.agreement()
            if agreement.smallest <= self.scale.precise or 2 * samples > self.scale.most_samples:
                break
            samples *= 2
        row = {"scene": name, "size": job.size_text, "samples": samples}
        row |= {key: f"{value:.6g}" for key, value in dataclasses.asdict(agreement).items()}
        table = references_of(self.table)
        others = results.read_csv(table, TEXTS) if table.is_file() else []
        others = [r for r in others if (r["scene"], r["size"]) != (name, job.size_text)]
        results.write_csv(table, [*others, row], AGREEMENT)
        return reference

    def _traced(self, job: Job, samples: int) -> Reference:
        """@param samples  Per pixel in each half of each program's reference, at least."""
        ours, theirs = ([self._half(job, who, half, samples) for half in range(2)] for who in ("ours", "theirs"))
        counts = without_lamps(sum(half["emitted"] for half in ours))
        return Reference(*(tuple(half["sum"] / half["samples"] for half in one) for one in (ours, theirs)), counts)

    def _half(self, job: Job, who: str, half: int, samples: int) -> dict[str, np.ndarray]:
        """Returns the sum of one half of a program's samples, from the cache and from further batches."""
        content = hashlib.sha256(job.scene.file.read_bytes() + " ".join(job.scene.options).encode()).hexdigest()[:16]
        file = self.folder / f"{job.scene.name}-{content}-{job.size_text}-{who}-{half}.npz"
        found = dict(np.load(file)) if file.is_file() else {"sum": np.zeros(job.size[::-1]), "samples": 0, "emitted": 0}
        for batch in itertools.count():
            done = batch * self.scale.batch
            if done >= samples:
                return found
            if done < found["samples"]:
                continue
            print(f"{job.scene.name}, {job.size_text}: reference by {who}, {half}, {done}", file=sys.stderr, flush=True)
            traced = dataclasses.replace(job, seed=FIRST_REFERENCE_SEED + 2 * batch + half)
            found = self._with_batch(found, traced, who)
            self.folder.mkdir(parents=True, exist_ok=True)
            partial = file.with_name(f"partial-{file.name}")
            np.savez_compressed(partial, **found)
            partial.rename(file)

    def _with_batch(self, found: dict[str, np.ndarray], job: Job, who: str) -> dict[str, np.ndarray]:
        count = self.scale.batch
        if who == "theirs":
            drawn, emitted = renderers.by_mitsuba(job, str(count)), 0
        else:
            drawn = renderers.by_interflect(job, f"--shading path --layers --samples {count}")
            emitted = luminance(read_exr(job.folder / "ours.exr", "emitted"))
        return {
            "sum": found["sum"] + count * drawn.luminance,
            "samples": found["samples"] + count,
            "emitted": found["emitted"] + emitted,
        }


def size_text(size: tuple[int, int]) -> str:
    return f"{size[0]}x{size[1]}"


def references_of(table: Path) -> Path:
    """Returns the table of the agreement of references beside the table of rows."""
    return table.with_name(f"{table.stem}-references.csv")
