"""The exceptions of the library."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple, Sequence


class Error(RuntimeError):
    """A failure that is not the fault of the arguments, such as a file that cannot be written or a closed solver."""


class Fault(NamedTuple):
    """One fault of an input.

    Attributes:
        text: A sentence with the expected and the found value, without the file.
        object: Name of the material, light, view, texture or object at fault, or "patch 3"; or "".
        setting: Argument that is wrong or too strict, such as "max_patches"; or "".
        file: Path of the file at fault; or "".
        line: Line in it, from 1; 0 if no line applies.
    """

    text: str
    object: str = ""
    setting: str = ""
    file: str = ""
    line: int = 0


class InputError(Error, ValueError):
    """Invalid input: a file, an argument, a scene. The message contains the location, the expected and the found value.

    Attributes:
        faults: All faults of a scene or of settings, each a :class:`Fault`; at least one.
        file: Path of the file at fault, or None.
        line: Line in it, from 1, or None.
        object: See :class:`Fault`; or None. Like the file, of the first fault.
        setting: See :class:`Fault`; or None.
    """

    def __init__(self, message: str, faults: Sequence[Fault] = ()) -> None:
        super().__init__(message, faults)
        self.faults = tuple(faults) or (Fault(message),)
        first = self.faults[0]
        self.file = Path(first.file) if first.file else None
        self.line = first.line or None
        self.object = first.object or None
        self.setting = first.setting or None

    def __str__(self) -> str:
        return str(self.args[0])


class TooManyPatches(InputError):
    """A scene would exceed a limit of patches, which the message names."""


class Stopped(Error):
    """Work was stopped before it had a usable result. The message names the missing part."""


class Warning(UserWarning):  # noqa: A001 - interflect.Warning beside interflect.Error
    """Unsupported input, or probable mistakes."""
