"""Runs the commands of a bake in order, and puts their messages in Blender's terms. Independent of Blender."""

import math
import re
import subprocess
import threading
from dataclasses import dataclass, field
from pathlib import Path

PERCENT = re.compile(rb"^\s*(\d+)%")
WARNING = re.compile(rb"^warning: (.*(?:\n  .*)*)", re.MULTILINE)  # indented lines belong to it
PREVIEW_SHARE = 16  # divisor of the rays: a preview adds 6% to the solver's time
KEPT_LINES = 20  # of the command's last output, in error messages
NUMBER = r"(-?\d[\d.]*(?:e[+-]?\d+)?)"
PLACE = re.compile(rf"\bat \({NUMBER}, {NUMBER}, {NUMBER}\)")
WORLD = re.compile(r"'environment-\d+'")  # the command's name for a light without one


class BakeError(Exception):
    """The command failed; the message is its output."""


@dataclass
class Stage:
    name: str  # shown beside the progress
    command: list[str]
    is_preview: bool = False  # without warnings, since the final stages give them again
    shown: Path | None = None  # a written file that is shown before the end


@dataclass
class Settings:
    command: str = "interflect"
    rays: int = 20_000_000
    views: list[str] = field(default_factory=list)  # cameras that steer the solver; empty: equal importance everywhere
    kind: str = "LIGHTMAP"  # or "VERTEX"
    is_copied: bool = True  # lit copies of the surfaces, else the scene's own objects
    has_preview: bool = False
    texels_per_metre: float = 16
    gather: bool = False  # texels by final gathering, slower and cleaner
    options: list[str] = field(default_factory=list)  # further options of `interflect solve`


def stages(scene: Path, solution: Path, lit: Path, settings: Settings) -> list[Stage]:
    solve = [settings.command, "solve", str(scene), "-o", str(solution), *settings.options]
    for view in settings.views:
        solve += ["--view", view]
    export = [settings.command, "export", str(solution), "--up", "0,1,0"]
    if settings.kind == "LIGHTMAP":
        export += ["--lightmap", "--texels-per-metre", f"{settings.texels_per_metre:g}"]
        if settings.is_copied:
            # Both sides of a sheet need light of their own, which the file of the scene itself has no place for.
            export += ["--rewrite"]
    final = ["--shading", "gather"] if settings.kind == "LIGHTMAP" and settings.gather else []
    made = [
        Stage("Solving", [*solve, "--rays", str(settings.rays)]),
        Stage("Exporting", [*export, "-o", str(lit), *final]),
    ]
    if settings.has_preview:
        preview, few = lit.with_name("preview.glb"), str(math.ceil(settings.rays / PREVIEW_SHARE))
        made[:0] = [
            Stage("Solving a preview", [*solve, "--rays", few], is_preview=True),
            Stage("Exporting a preview", [*export, "-o", str(preview), "--shading", "smooth"], is_preview=True, shown=preview),
        ]
    return made


class Bake:
    """Runs the stages in sequence in a separate thread, whose state a user interface can poll."""

    def __init__(self, stages: list[Stage]):
        self.stage, self.fraction = stages[0].name, 0.0
        self.warnings: list[str] = []
        self.error: BakeError | None = None
        self.preview: Path | None = None  # the file to be shown
        self.is_cancelled = False
        self._process: subprocess.Popen | None = None
        self._lock = threading.Lock()  # guards the two members above
        self._thread = threading.Thread(target=self._run, args=(stages,), daemon=True)
        self._thread.start()

    def is_running(self) -> bool:
        return self._thread.is_alive()

    def wait(self, seconds: float | None = None) -> None:
        self._thread.join(seconds)

    def fail(self, error: str) -> None:
        """Ends the command with an error from outside, such as the import of the preview."""
        self.error = BakeError(error)
        self.cancel()

    def cancel(self) -> None:
        """Ends the command at once: its files are temporary."""
        with self._lock:
            self.is_cancelled = True
            if self._process and self._process.poll() is None:
                self._process.kill()

    def _run(self, stages: list[Stage]) -> None:
        try:
            for stage in stages:
                self.stage, self.fraction = stage.name, 0.0
                self._run_stage(stage)
                if self.is_cancelled:
                    return
                if stage.shown:
                    self.preview = stage.shown
        except BakeError as error:
            self.error = error
        except OSError as error:
            self.error = BakeError(f"cannot run '{stage.command[0]}': {error.strerror}. Set its path in the add-on's preferences")

    def _run_stage(self, stage: Stage) -> None:
        with self._lock:
            if self.is_cancelled:
                return
            self._process = subprocess.Popen(
                stage.command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL
            )
        said = b""
        for line in self._process.stderr:
            if found := PERCENT.match(line):
                self.fraction = int(found[1]) / 100
            else:
                said += line
        if not stage.is_preview:
            self.warnings += [" ".join(each.decode(errors="replace").split()) for each in WARNING.findall(said)]
        if self._process.wait() != 0 and not self.is_cancelled:
            last = b"".join(said.splitlines(keepends=True)[-KEPT_LINES:])
            raise BakeError(last.decode(errors="replace").strip() or f"{stage.name} failed")


def for_blender(message: str, folder: str) -> str:
    """Converts places from the exported file's axes, with y up, to Blender's. Calls the environment the world, and
    files in the temporary folder by their names only."""
    message = PLACE.sub(lambda found: f"at ({found[1]}, {_negated(found[3])}, {found[2]})", message)
    return WORLD.sub("the world", message).replace(folder, "")


def _negated(number: str) -> str:
    if float(number) == 0:
        return "0"
    return number[1:] if number.startswith("-") else "-" + number
