"""The exceptions of the library."""

from __future__ import annotations

from pathlib import Path


class Error(RuntimeError):
    """A failure that is not the fault of the arguments, such as a file that cannot be written or a closed solver."""


class InputError(Error, ValueError):
    """Invalid input: a file, an argument, a scene. The message contains the location, the expected and the found value.

    Attributes:
        file: Path of the file at fault, or None.
        line: Line in it, from 1, or None.
        object: Name of the material, light, view, texture or object at fault, or "patch 3"; of the first fault if there
            are several; None if no object applies.
        faults: All faults of a scene or of settings, a sentence each; empty for a single fault.
    """

    def __init__(self, message: str, file: str | None = None, line: int | None = None, object: str | None = None,
                 faults: tuple[str, ...] = ()) -> None:
        super().__init__(message, file, line, object, faults)
        self.file = Path(file) if file else None
        self.line = line or None
        self.object = object or None
        self.faults = tuple(faults)

    def __str__(self) -> str:
        return str(self.args[0])


class TooManyPatches(InputError):
    """A scene would exceed a limit of patches, which the message names."""


class Stopped(Error):
    """Work was stopped before it had a usable result. The message names the missing part."""


class Warning(UserWarning):  # noqa: A001 - interflect.Warning beside interflect.Error
    """Unsupported input, or probable mistakes."""
