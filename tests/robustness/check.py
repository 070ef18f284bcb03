"""Checks of every run, and checks that single cases add."""

import json
import re
import signal
import subprocess

from case import (
    CRASH,
    DONE,
    EXIT_CODE,
    FAILED,
    HANG,
    INTERRUPTED,
    LEFTOVER,
    MESSAGE,
    RESULT,
    UNNOTICED,
    Fault,
    signal_name,
)

SANITIZER = re.compile(rb"ERROR: (?:Address|Leak|Memory|Thread)Sanitizer|runtime error:|WARNING: ThreadSanitizer")
LIBRARY_TEXT = re.compile(
    rb"json\.exception|HDF5-DIAG|terminate called|std::|filesystem error|\bH5[A-Z]\w|\bImf_|\bstbi|basic_string|bad_alloc"
)
CONTROL = re.compile(rb"[\x00-\x08\x0b-\x1f\x7f]")
REASON = re.compile(rb"^(?:error: .|stopping)", re.MULTILINE)
NOT_FINITE = re.compile(rb"^ .*[ :(]-?(?:nan|inf)\b", re.MULTILINE)  # in the indented lines of figures
SOLVING = re.compile(rb"rays|stopping")  # on stderr once the solver has started
DRAW = ("--eye", "1,1,1", "--look-at", "2,2,1", "--size", "4x4", "--samples", "2")


def faults_of(run):
    """Returns all faults of a run. After a crash or a hang, only the files left over are checked."""
    grave = [*crashes(run), *hangs(run)]
    if grave:
        return [*grave, *leftovers(run)]
    found = [*exit_codes(run), *leftovers(run), *messages(run)]
    found += results(run) if not found else ()
    for check in run.case.checks:
        found += check(run)
    return found


def last_line(text):
    lines = text.decode(errors="replace").strip().splitlines()
    return lines[-1][:200] if lines else ""


# ---- checks of every run


def sent(run):
    return {s.number for s in run.case.signals}


def crashes(run):
    report = SANITIZER.search(run.stderr)
    if report:
        line = run.stderr[report.start() :].splitlines()[0]
        yield Fault(CRASH, line.decode(errors="replace")[:200])
    elif run.exit_code < 0 and not run.timed_out and -run.exit_code not in sent(run):
        yield Fault(CRASH, f"ended by {signal_name(-run.exit_code)}: {last_line(run.stderr)}")


def hangs(run):
    if run.timed_out:
        yield Fault(HANG, f"still there after {run.seconds:.1f} s: {last_line(run.stderr)}")


def ran_out_of_memory(run):
    return run.case.memory and run.exit_code == FAILED and b"memory" in run.stderr


def exit_codes(run):
    if run.exit_code not in run.case.allowed and not ran_out_of_memory(run):
        allowed = " or ".join(map(str, sorted(run.case.allowed)))
        yield Fault(EXIT_CODE, f"{run.exit_code} instead of {allowed}: {last_line(run.stderr)}")


def leftovers(run):
    if run.exit_code == -signal.SIGKILL and signal.SIGKILL in sent(run):
        return  # its temporary files are for a later run to remove
    may_be_new = set(run.case.may_leave)
    may_change = set(run.case.may_leave)
    if run.kept_result():
        may_be_new.update(run.case.outputs)
        may_change.update(run.case.outputs)
    for name in run.new_files():
        if name not in may_be_new:
            yield Fault(LEFTOVER, f"{name!a} (exit code {run.exit_code})")
    for name, state in run.before.items():
        if name not in may_change and run.after.get(name) != state:
            yield Fault(LEFTOVER, f"{name!a} has changed (exit code {run.exit_code})")


def messages(run):
    if run.exit_code > 0 and run.case.says_why() and not REASON.search(run.stderr):
        yield Fault(MESSAGE, f"exit code {run.exit_code} without a reason: {last_line(run.stderr)}")
    for name, text in (("stdout", run.stdout), ("stderr", run.stderr)):
        if name == "stderr" and (library := LIBRARY_TEXT.search(text)):
            yield Fault(MESSAGE, f"{library[0].decode()} in: {last_line(text)}")
        if CONTROL.search(text):
            yield Fault(MESSAGE, f"control characters on {name}: {CONTROL.sub(b'?', text)[-200:]!a}")


def results(run):
    """All outputs exist, and all numbers in them are finite."""
    if run.kept_result():
        for name in run.case.outputs:
            if name not in run.after:
                yield Fault(RESULT, f"exit code {run.exit_code}, but there is no {name!a}")
    if "--json" in run.case.arguments and run.stdout:
        yield from faults_of_json("stdout", run.stdout)
    if NOT_FINITE.search(run.stdout):
        yield Fault(RESULT, f"not finite: {NOT_FINITE.search(run.stdout)[0].decode(errors='replace')}")


def refuse_constant(name):
    raise ValueError(f"{name} is no JSON")


def faults_of_json(name, text):
    try:
        json.loads(text.decode(), parse_constant=refuse_constant)
    except ValueError as error:
        yield Fault(RESULT, f"{name}: {error}")


# ---- checks that cases add


def succeeds(run, *arguments):
    """Runs the command once more. @return a fault unless it succeeds."""
    try:
        again = run.program(*arguments)
    except subprocess.TimeoutExpired:
        return [Fault(HANG, f"afterwards: {' '.join(arguments)}")]
    if again.returncode != DONE:
        return [Fault(RESULT, f"`{' '.join(arguments)}` fails afterwards with {again.returncode}: {last_line(again.stderr)}")]
    return []


def can_be_drawn(name):
    """`render` reads the output of `solve`."""

    def check(run):
        return succeeds(run, "render", name, "-o", "drawn.exr", *DRAW) if run.has_file(name) else []

    return check


def can_be_resumed(name):
    """`resume` continues from the output of `--checkpoint`."""

    def check(run):
        return succeeds(run, "resume", name, "-o", "resumed.h5", "--time", "0.01") if run.has_file(name) else []

    return check


def scene_can_be_read(name):
    def check(run):
        return succeeds(run, "info", name) if run.has_file(name) and run.kept_result() else []

    return check


def picture_is_finite(name):
    """For .exr and .hdr: the other formats cannot represent non-finite numbers."""

    def check(run):
        if not run.has_file(name) or not run.kept_result():
            return
        measured = run.program("compare", name, name, "--json")
        if measured.returncode != DONE:
            yield Fault(RESULT, f"{name!a} cannot be read: {last_line(measured.stderr)}")
        elif count := json.loads(measured.stdout)["non_finite_pixels"]:
            yield Fault(RESULT, f"{count} pixels of {name!a} are not finite")

    return check


def stats_are_finite(name):
    def check(run):
        for line in run.bytes(name).splitlines() if run.has_file(name) else ():
            yield from faults_of_json(name, line)

    return check


def same_bytes(expected):
    """Existing outputs equal those of an undisturbed run. @param expected  Name to bytes."""

    def check(run):
        for name, content in expected.items():
            if run.exit_code != INTERRUPTED and run.has_file(name) and run.bytes(name) != content:
                yield Fault(RESULT, f"{name!a} differs from that of an undisturbed run")

    return check


def damage_is_refused(output, expected):
    """A damaged solution is refused, even if the same picture would result."""

    def check(run):
        if run.exit_code == DONE and run.has_file(output):
            same = run.bytes(output) == expected
            yield Fault(UNNOTICED, f"the same {output!a}") if same else Fault(RESULT, f"another {output!a} in silence")

    return check


def interruption(output):
    """After one signal, the result so far is kept. Before the solve, the signal may end the program as any other,
    without output."""

    def check(run):
        if run.exit_code == DONE or (run.exit_code == INTERRUPTED and run.has_file(output)):
            return
        if SOLVING.search(run.stderr):
            yield Fault(RESULT, f"nothing is kept of the solve (exit code {run.exit_code})")

    return check


def later_run_tidies_up(output, *arguments):
    """A killed run cannot clean up; the next run to the same output does."""

    def check(run):
        yield from succeeds(run, *arguments)
        names = {path.relative_to(run.folder.parent).as_posix() for path in run.folder.parent.rglob("*")}
        known = {f"run/{name}" for name in (*run.before, output)} | {"run", "temporary"}
        for name in sorted(names - known):
            yield Fault(LEFTOVER, f"{name!a}, even after a later run")

    return check
