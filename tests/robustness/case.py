"""One run of the command: its inputs, the accepted ends, and the faults found."""

import os
import shlex
import signal
from dataclasses import dataclass, field
from pathlib import Path
from typing import Callable

DONE, FAILED, WRONG_USAGE, BAD_INPUT, INTERRUPTED = 0, 1, 2, 3, 130
PATIENCE = 5.0  # [s] allowed beyond the limits that the run was given
REPORT = 15.0  # [s] allowed in addition for a report, which takes 2 s on an idle machine

# Kinds of faults, in the order of the report.
CRASH, HANG, EXIT_CODE, LEFTOVER, RESULT, UNNOTICED, MESSAGE = SORTS = (
    "crash",  # ended by a signal that the case did not send, or a sanitizer's report
    "hang",
    "exit code",
    "leftover",  # an unexpected file, or a changed input or earlier output
    "result",  # lost, silently changed, not finite or not readable
    "unnoticed",  # undetected damage, even if the picture is unchanged
    "message",  # missing message, text of a library, control characters
)


@dataclass(frozen=True)
class Fault:
    sort: str
    what: str


@dataclass(frozen=True)
class Signal:
    """Sent `delay` seconds after the start, or after `follows` first appeared on stderr."""

    number: int
    delay: float
    follows: bytes = b""


@dataclass
class Case:
    """@param shell      Shell code to run first, such as `ulimit -f 8`; `redirections` come after the command.
    @param outputs       Files that must exist after exit code 0 or 130. After any other end, no new ones may exist.
    @param may_leave     Files that may exist after any end.
    @param memory        Whether the run may fail with a message about lack of memory.
    @param seconds       Time limit that was passed to the run.
    @param prepare       Creates links, devices and file systems in the case's folder, which `files` cannot express.
    @param clean_up      Undoes the work of `prepare` outside the folder.
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
        """@param quote  Quotes an arbitrary word for the shell."""
        command = " ".join(["exec", quote(program), *map(quote, self.arguments)])
        return f"{self.shell + '; ' if self.shell else ''}{command} {self.redirections}".rstrip()

    def says_why(self):
        return "2>" not in self.redirections


@dataclass
class Run:
    """The result of a case. @param program  Runs the command once more in the same folder, undisturbed."""

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
        """Returns whether `name` is a regular file. A device might have no end."""
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
