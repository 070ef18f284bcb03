"""Runs the `interflect` command and reports its cost and the machine."""

import hashlib
import json
import os
import platform
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
INTERRUPTED = 130  # exit code of the command after Ctrl-C
BUILT = "build/release/bin/interflect"
SCENES = "$INTERFLECT_SCENES"  # in a path: folder of scenes outside this repository
MAZE = re.compile(r"\bmaze:(\d+)(:furniture)?")  # in arguments: a maze of so many rooms, made where it is missing
MADE = ROOT / "out/experiments/scenes"


class ExperimentError(Exception):
    """A problem that the user can solve; the message explains how."""


@dataclass(frozen=True)
class Program:
    path: Path
    version: str  # and the last commit of its sources, for builds by scripts/build
    fingerprint: str  # of the executable; results of different builds are kept apart
    machine: str


@dataclass(frozen=True)
class Finished:
    output: str  # stdout
    messages: str  # stderr
    seconds: float  # wall time, including reading the scene
    processor_seconds: float  # of all threads
    peak_mib: float  # peak resident memory


def find_program(named: str | None = None) -> Program:
    """Returns the named command, else that in the environment variable INTERFLECT_COMMAND or INTERFLECT, else the build
    of scripts/build."""
    named = named or os.environ.get("INTERFLECT_COMMAND") or os.environ.get("INTERFLECT")
    path = Path(named or ROOT / BUILT)
    if not path.is_file():
        raise ExperimentError(
            f"{path} is not there: build it with scripts/build, or name another with --program or in INTERFLECT_COMMAND"
        )
    printed = subprocess.run([path, "--version"], capture_output=True, text=True, check=True).stdout
    fingerprint = hashlib.sha256(path.read_bytes()).hexdigest()
    version = printed.split()[-1] + ("" if named else _commit())
    return Program(path, version, fingerprint, _machine())


def blender_script(*script: str) -> list[str]:
    """Returns a command that runs a script in Blender: in INTERFLECT_BPY, a Python with the package bpy, else in the
    program blender."""
    python = os.environ.get("INTERFLECT_BPY")
    if python:
        return [python, *script]
    if not shutil.which("blender"):
        raise ExperimentError(
            "blender is missing: install it with scripts/setup experiments, or name a Python with the package bpy in "
            "INTERFLECT_BPY"
        )
    return ["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python", *script]


def expanded(text: str) -> str:
    """Replaces SCENES with its environment variable, else ../shared/scenes."""
    return text.replace(SCENES, os.environ.get(SCENES[1:], str(ROOT.parent / "shared/scenes")))


def prepared(program: Program, text: str) -> str:
    """As expanded(), and replaces each MAZE with a file, made by `make-scene`."""
    return MAZE.sub(lambda maze: str(_maze(program, maze[1], bool(maze[2]))), expanded(text))


def _maze(program: Program, rooms: str, has_furniture: bool) -> Path:
    path = MADE / f"maze-{rooms}{'-furniture' if has_furniture else ''}.mgf"
    if not path.is_file():
        MADE.mkdir(parents=True, exist_ok=True)
        furniture = ["--furniture"] if has_furniture else []
        subprocess.run([program.path, "make-scene", "maze", "--rooms", rooms, *furniture, "-o", path], check=True)
    return path


def run(program: Program, arguments: list[str]) -> Finished:
    """Runs `interflect ARGUMENTS`, prepared(), in the repository's root.

    Raises ExperimentError with the command and the end of its messages on failure, KeyboardInterrupt on interruption.
    """
    command = [program.path, *(prepared(program, argument) for argument in arguments)]
    exit_code, finished = launch(command)
    if exit_code in (INTERRUPTED, -signal.SIGINT):
        raise KeyboardInterrupt
    if exit_code != 0:
        said = "\n".join(finished.messages.splitlines()[-5:])
        raise ExperimentError(f"interflect {' '.join(arguments)}\nended with exit code {exit_code}:\n{said}")
    return finished


def launch(command: Sequence[str | Path], environment: Mapping[str, str] | None = None) -> tuple[int, Finished]:
    """Runs a command, whose first word is a path, in the repository's root. Returns its exit code and its cost.

    @param environment  Variables that are added to those of this process.
    """
    with tempfile.NamedTemporaryFile("r") as report:
        launcher = [sys.executable, "-I", "-S", Path(__file__).with_name("launch.py"), report.name]
        variables = os.environ | (environment or {})
        process = subprocess.Popen(
            [*launcher, *command], cwd=ROOT, env=variables, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        try:
            output, messages = process.communicate()
        finally:
            process.wait()  # on Ctrl-C the command ends by itself, and removes its temporary files
        cost = json.loads(report.read())
    return cost["exit_code"], Finished(output, messages, cost["seconds"], cost["processor_seconds"], cost["peak_mib"])


def read_stats(path: Path) -> tuple[dict, dict]:
    """Returns the header of a file from `solve --stats` and the line of its last iteration."""
    lines = path.read_text().splitlines()
    return json.loads(lines[0]), json.loads(lines[-1])


def _commit() -> str:
    """Returns the last commit of the program's sources, in parentheses; marked if the sources have changed since."""
    sources = ["src", "apps", "cmake", "CMakeLists.txt", "CMakePresets.json"]

    def git(*arguments: str) -> str:
        command = ["git", *arguments, "--", *sources]
        return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()

    try:
        return f" ({git('log', '-1', '--format=%h')}{' and changes' if git('status', '--porcelain') else ''})"
    except (OSError, subprocess.CalledProcessError):
        return ""  # not in a repository


def _machine() -> str:
    models = (line for line in Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("model name"))
    model = next(models, platform.machine()).partition(":")[2].strip() or platform.machine()
    return f"{model}, {os.cpu_count()} cores"
