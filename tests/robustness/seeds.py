"""Sound input files, and the outputs of undisturbed runs of the usual commands."""

import os
import subprocess
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

from case import write_files

SCENES = Path(__file__).parent / "scenes"
SCENE = ("room.mgf", "room.views.json")
ENTITIES = ("entities.mgf", "part.mgf", "lamp.ies")
SOLUTION = ("room.h5",)
RUN = ("run.h5",)  # can be resumed
PICTURES = ("a.exr", "b.exr", "a.hdr", "a.png")

ROOM_RAYS = ("--rays", "2k", "--seed", "3")
RESUMED = ("--rays", "4k")
TINY = ("--size", "16x12", "--samples", "2")


@dataclass(frozen=True)
class Command:
    """A typical use of the command, which takes well below a second."""

    arguments: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...] = ()

    def output(self):
        return self.outputs[0]


def render_to(name, *options):
    return Command(("render", "room.h5", "-o", name, "--view", "room-0", *TINY, *options), SOLUTION, (name,))


PATH_TRACING = ("--shading", "path", "--view", "room-0", "--size", "4x3", "--samples", "4")
PATH = ("render", "room.mgf", "-o", "out.exr", "--error-image", "error.exr", *PATH_TRACING)

WRITERS = {
    "solve": Command(("solve", "room.mgf", "-o", "out.h5", "--view", "room-0", *ROOM_RAYS), SCENE, ("out.h5",)),
    "render .png": render_to("out.png"),
    "render .jpg": render_to("out.jpg"),
    "render .exr": render_to("out.exr"),
    "render .hdr": render_to("out.hdr"),
    "render --show rays": render_to("out.png", "--show", "rays"),
    "render --shading path": Command(PATH, SCENE, ("out.exr", "error.exr")),
    "probe": Command(("probe", "room.h5", "--plane", "1", "-o", "out.csv", "--samples", "16"), SOLUTION, ("out.csv",)),
    "report": Command(("report", "room.h5", "-o", "out.html", "--date", "today", *TINY), SOLUTION, ("out.html",)),
    "compare --difference": Command(("compare", "a.exr", "b.exr", "--difference", "out.png"), PICTURES, ("out.png",)),
    "make-scene": Command(("make-scene", "maze", "--rooms", "1", "-o", "out.mgf"), (), ("out.mgf", "out.views.json")),
}

# Commands that write only to stdout.
TELLERS = {
    "info": Command(("info", "room.mgf"), SCENE),
    "info --json": Command(("info", "room.mgf", "--json"), SCENE),
    "compare": Command(("compare", "a.exr", "b.exr"), PICTURES),
    "compare --json": Command(("compare", "a.exr", "b.exr", "--json"), PICTURES),
    "bench": Command(("bench", "room.mgf", "--rays", "1k", "--rounds", "1"), SCENE),
    "--help": Command(("--help",), ()),
    "solve --help": Command(("solve", "--help"), ()),
    "--version": Command(("--version",), ()),
}


class SeedError(Exception):
    """The command fails even without a disturbance."""


@dataclass
class Seeds:
    """@param files     Sound inputs: name to bytes.
    @param written      For each of WRITERS, the output of an undisturbed run: name to bytes.
    @param resumed      Result of resuming run.h5.
    @param helps        Help of each subcommand.
    @param sanitized    Whether the command was built with a sanitizer, which is slower and needs an unlimited address
    space.
    """

    program: str
    files: dict[str, bytes] = field(default_factory=dict)
    written: dict[str, dict[str, bytes]] = field(default_factory=dict)
    resumed: bytes = b""
    helps: dict[tuple[str, ...], str] = field(default_factory=dict)
    sanitized: bool = False
    makes_devices: bool = False
    mounts: bool = False

    def some(self, *names):
        return {name: self.files[name] for name in names}


SUBCOMMANDS = [("info",), ("solve",), ("resume",), ("render",), ("probe",), ("report",), ("compare",)]
SUBCOMMANDS += [("bench",)] + [("make-scene", kind) for kind in ("maze", "office", "boxes", "two-rooms")]


def run_or_raise(program, folder, arguments):
    result = subprocess.run([program, *arguments], cwd=folder, capture_output=True, timeout=300)
    if result.returncode != 0:
        raise SeedError(f"`{' '.join(arguments)}` fails:\n{result.stderr.decode(errors='replace')}")
    return result.stdout.decode(errors="replace")


def may(folder, *command):
    return subprocess.run(command, cwd=folder, capture_output=True).returncode == 0


def make_files(program, folder):
    for path in SCENES.iterdir():
        (folder / path.name).write_bytes(path.read_bytes())
    make = ("make-scene", "maze", "--rooms", "1", "-o", "room.mgf")
    solve = ("solve", "room.mgf", "-o", "room.h5", "--view", "room-0", *ROOM_RAYS)
    for arguments in (make, (*solve, "--checkpoint", *RUN)):
        run_or_raise(program, folder, arguments)
    for k, picture in enumerate(PICTURES):
        size = ("--size", "16x12", "--samples", str(2 + k))
        run_or_raise(program, folder, ("render", "room.h5", "-o", picture, "--view", "room-0", *size))
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


def written_by(program, seeds, command):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_files(folder, seeds.some(*command.inputs))
        run_or_raise(program, folder, command.arguments)
        return {output: (folder / output).read_bytes() for output in command.outputs}


def make_seeds(program):
    """@throws SeedError"""
    seeds = Seeds(program)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        seeds.files = make_files(program, folder)
        seeds.makes_devices = may(folder, "mknod", "full", "c", "1", "7") and not may(folder, "sh", "-c", "echo >full")
        os.mkdir(folder / "disk")
        seeds.mounts = may(folder, "mount", "-t", "tmpfs", "none", "disk") and may(folder, "umount", "disk")
    seeds.written = {key: written_by(program, seeds, command) for key, command in WRITERS.items()}
    resume = Command(("resume", *RUN, "-o", "out.h5", *RESUMED), RUN, ("out.h5",))
    seeds.resumed = written_by(program, seeds, resume)["out.h5"]
    seeds.helps = {words: run_or_raise(program, ".", (*words, "--help-all")) for words in SUBCOMMANDS}
    seeds.sanitized = b"__asan_init" in Path(program).read_bytes()
    return seeds
