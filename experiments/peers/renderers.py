"""Draws a scene by each program, as whole processes, and reads the picture: luminance [cd/m2], seconds and memory."""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from lab import program
from lab.analysis.picture import luminance, read_exr

from .pic import read_pic
from .scenes import PeerScene

BOUNCES = 24
PYTHON = program.ROOT / "build/peers/bin/python"  # made by `scripts/setup peers`
LLVM = "libLLVM.so.19.1"  # for Mitsuba, which needs version 16 or later
RENDERPARK = "RENDERPARK"  # environment variable: the program rpk
HERE = Path(__file__).parent
RADIANCE_SIDE = 2  # camera rays per pixel along each axis
RENDERPARK_SIDE = 2  # it draws the centre of each pixel, so a larger picture is reduced
# Exitance of white lamps in MGF files over the one that RenderPark prints for them [lm/W], in two scenes.
RENDERPARK_EFFICACY = 183.07


@dataclass(frozen=True)
class Job:
    command: program.Program
    scene: PeerScene
    size: tuple[int, int]
    folder: Path  # for exported scenes and pictures
    seed: int = 1

    @property
    def size_text(self) -> str:
        return f"{self.size[0]}x{self.size[1]}"

    def exported(self, extension: str) -> Path:
        """Exports the scene into a folder of its own, once."""
        folder = self.folder / f"{extension}-{self.size_text}"
        file = folder / f"scene.{extension}"
        if not file.is_file():
            folder.mkdir(parents=True, exist_ok=True)
            options = [*self.scene.options, "--size", self.size_text]
            program.run(self.command, ["export", str(self.scene.file), *options, "-o", str(file)])
        return file


@dataclass(frozen=True)
class Drawn:
    luminance: np.ndarray
    seconds: float
    processor_seconds: float
    peak_mib: float  # of the largest process


def by_interflect(job: Job, options: str) -> Drawn:
    picture = job.folder / "ours.exr"
    drawing = f"--size {job.size_text} --no-mirrors --seed {job.seed} {options} -o {picture}"
    finished = program.run(job.command, ["render", str(job.scene.file), *job.scene.options, *drawing.split()])
    return drawn(luminance(read_exr(picture)), finished)


def by_mitsuba(job: Job, options: str) -> Drawn:
    """@param options  Samples per pixel, optionally followed by "denoise"."""
    samples, *switches = options.split()
    picture = job.folder / "mitsuba.npy"
    arguments = [job.exported("xml"), picture, samples, str(job.seed), str(BOUNCES), *switches]
    return drawn_by_script("draw_in_mitsuba.py", arguments, picture)


def by_cycles(job: Job, options: str) -> Drawn:
    """@param options  Samples per pixel, optionally followed by "denoise" and "guide"."""
    samples, *switches = options.split()
    picture = job.folder / "cycles.exr"
    numbers = [samples, str(job.seed), str(BOUNCES), *map(str, job.size)]
    return drawn_by_script("draw_in_cycles.py", [job.exported("py"), picture, *numbers, *switches], picture)


def by_radiance(job: Job, options: str) -> Drawn:
    """@param options  Options of rtrace."""
    picture = job.folder / "radiance.npy"
    numbers = [*map(str, job.size), str(RADIANCE_SIDE)]
    bounces = ["-lr", str(-BOUNCES)]  # of specular rays; negative: Russian roulette below the weight -lw
    arguments = [job.exported("rad"), picture, *numbers, *bounces, *options.split()]
    return drawn_by_script("draw_in_radiance.py", arguments, picture)


def by_renderpark(job: Job, options: str) -> Drawn:
    """@param options  Options of RenderPark, which reads the MGF file itself and supports neither skies nor suns."""
    executable = os.environ.get(RENDERPARK)
    if not executable:
        raise program.ExperimentError(f"{RENDERPARK} does not name RenderPark's program rpk")
    if job.scene.daylight:
        raise program.ExperimentError("RenderPark supports neither skies nor suns")
    picture = job.folder / "renderpark.pic"
    scene = job.scene
    places = [("-eyepoint", scene.eye), ("-center", scene.look_at), ("-updir", scene.up)]
    camera = [word for name, place in places for word in (name, *(f"{x:.9g}" for x in place))]
    width, height = (RENDERPARK_SIDE * side for side in job.size)
    size = ["-fov", f"{scene.fov / 2:.9g}", "-width", str(width), "-height", str(height)]
    saving = ["-raycast", "-radiance-image-savefile", str(picture)]
    method = ["-dont-force-onesided", "-raytracing-method", "none", *options.split()]
    command = [executable, str(scene.file), *method, *camera, *size, *saving]
    finished = succeeded(command, picture)
    fine = luminance(read_pic(picture)) * RENDERPARK_EFFICACY
    small = fine.reshape(job.size[1], RENDERPARK_SIDE, job.size[0], RENDERPARK_SIDE).mean(axis=(1, 3))
    return drawn(small, finished)


def drawn_by_script(script: str, arguments: Sequence[str | Path], picture: Path) -> Drawn:
    """Runs a script beside this file in the environment of `scripts/setup peers`."""
    if not PYTHON.is_file():
        raise program.ExperimentError(f"{PYTHON} is missing: install it with scripts/setup peers")
    finished = succeeded([PYTHON, HERE / script, *arguments], picture)
    values = read_exr(picture) if picture.suffix == ".exr" else np.load(picture).astype(float)
    return drawn(luminance(values), finished)


def succeeded(command: Sequence[str | Path], picture: Path) -> program.Finished:
    """Runs a command that writes the picture."""
    picture.unlink(missing_ok=True)
    environment = {"PATH": "/usr/bin:/bin"}  # Blender takes its modules from any python3 that comes first
    found = sorted(Path("/usr/lib").glob(f"*/{LLVM}"))
    if found and "DRJIT_LIBLLVM_PATH" not in os.environ:
        environment["DRJIT_LIBLLVM_PATH"] = str(found[0])
    exit_code, finished = program.launch(list(map(str, command)), environment)
    if exit_code != 0 or not picture.is_file():
        said = "\n".join((finished.output + finished.messages).splitlines()[-5:])
        raise program.ExperimentError(f"{' '.join(map(str, command))}\nended with exit code {exit_code}:\n{said}")
    return finished


def drawn(picture: np.ndarray, finished: program.Finished) -> Drawn:
    return Drawn(picture, finished.seconds, finished.processor_seconds, finished.peak_mib)
