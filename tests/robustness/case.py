"""One run of the command: what it is given, what may come of it, and what is wrong with what came."""

import os
import shlex
import signal
from dataclasses import dataclass, field
from pathlib import Path
from typing import Callable

DONE, FAILED, WRONG_USAGE, BAD_INPUT, INTERRUPTED = 0, 1, 2, 3, 130
PATIENCE = 5.0  # [s] that a run may take beyond the limits that it was given

# Sorts of faults, in the order of the report.
CRASH, HANG, EXIT_CODE, LEFTOVER, RESULT, UNNOTICED, MESSAGE = SORTS = (
    "crash",  # ended by a signal that nobody sent, or a sanitizer's report
    "hang",
    "exit code",
    "leftover",  # a file that should not be there, or an input or an earlier output that has changed
    "result",  # lost, changed in silence, not finite or not readable
    "unnoticed",  # damage that was not found, though it changed nothing that was drawn
    "message",  # none where one is due, text of a library, control characters
)


@dataclass(frozen=True)
class Fault:
    sort: str
    what: str


@dataclass(frozen=True)
class Signal:
    """Sent `delay` seconds after the start, or after `follows` was first read on stderr."""

    number: int
    delay: float
    follows: bytes = b""


@dataclass
class Case:
    """@param shell      What the shell does first, such as `ulimit -f 8`; `redirections` come after the command.
    @param outputs       Files that an exit with 0 or 130 has to leave; any other has to leave none that is new.
    @param may_leave     Files that may be there after any end.
    @param memory        Whether it may fail with a message that says that memory ran out.
    @param seconds       Limit on time that the run was asked to keep.
    @param prepare       Makes in the case's folder what `files` cannot say: links, devices, file systems.
    @param clean_up      Undoes what `prepare` did outside of the folder.
    @param checks        Further checks, called with the Run; each yields faults.
    """

    description: str
    arguments: list[str]
    files: dict[str, bytes] = field(default_factory=dict)
    allowed: frozenset[int] = frozenset({DONE})
    outputs: tuple[str, ...] = ()
    may_leave: tuple[str, ...] = ()
    shell: str = ""
    redirections: str = ""
    signals: tuple[Signal, ...] = ()
    memory: bool = False
    seconds: float = 0
    prepare: Callable[[Path], None] | None = None
    clean_up: Callable[[Path], None] | None = None
    checks: tuple[Callable[["Run"], object], ...] = ()

    def command_line(self, program, quote=shlex.quote):
        """@param quote  How the shell is to read a word that may hold anything."""
        command = " ".join(["exec", quote(program), *map(quote, self.arguments)])
        return f"{self.shell + '; ' if self.shell else ''}{command} {self.redirections}".rstrip()

    def says_why(self):
        """Whether stderr can be read."""
        return "2>" not in self.redirections


@dataclass
class Run:
    """A case that has run. @param program  Runs the command once more in the same folder, undisturbed."""

    case: Case
    folder: Path
    exit_code: int
    stdout: bytes
    stderr: bytes
    seconds: float
    timed_out: bool
    before: dict[str, str]
    after: dict[str, str]
    program: Callable[..., object]

    def new_files(self):
        return sorted(name for name in self.after if name not in self.before)

    def kept_result(self):
        return self.exit_code in (DONE, INTERRUPTED) and not self.timed_out

    def has_file(self, name):
        """Whether it is there, and a file rather than a device, which may have no end."""
        return self.after.get(name, "").startswith("file ")

    def bytes(self, name):
        return (self.folder / name).read_bytes()


def signal_name(number):
    return signal.Signals(number).name


def write_files(folder, files):
    for name, content in files.items():
        path = os.path.join(os.fsencode(folder), os.fsencode(name))
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "wb") as file:
            file.write(content)
