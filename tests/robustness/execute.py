"""Runs one case in its own folder and watches it until it ends."""

import contextlib
import hashlib
import os
import selectors
import signal
import stat
import subprocess
import time

from case import PATIENCE, REPORT, Run, write_files

LONGEST_READ = 1 << 16
LARGEST_READ_BACK = 1 << 32  # [bytes]
A_DAY = 86400.0  # [s]
SECOND_CHANCE = 20.0  # [s] for runs that only check the files of an earlier run


def state_of(path):
    """Returns the kind and content of a file, to detect changes."""
    status = os.lstat(path)
    mode = status.st_mode
    if status.st_size > LARGEST_READ_BACK:
        return f"file of {status.st_size} bytes"
    if stat.S_ISLNK(mode):
        return "link to " + os.readlink(path)
    if stat.S_ISREG(mode):
        with open(path, "rb") as file:
            return "file " + hashlib.sha256(file.read()).hexdigest()
    return f"kind {stat.S_IFMT(mode)}"


def snapshot(folder):
    """Returns the state of every file by name, including hidden files and subfolders. Names are relative to `work`;
    those in the folder of temporary files begin with `../temporary`."""
    found = {}
    for parent, folders, files in os.walk(folder):
        for name in folders + files if parent != str(folder) else ():
            path = os.path.join(parent, name)
            found[os.path.relpath(path, folder / "run")] = state_of(path)
    return found


class Watch:
    """Reads both streams of a process, sends the case's signals when they are due, and kills the process at the time
    limit."""

    def __init__(self, process, signals, seconds):
        self.process, self.signals = process, list(signals)
        self.started = time.monotonic()
        self.deadline = self.started + seconds
        self.read = {process.stdout: bytearray(), process.stderr: bytearray()}
        self.timed_out = False

    def run(self):
        with selectors.DefaultSelector() as selector:
            for stream in self.read:
                selector.register(stream, selectors.EVENT_READ)
            while selector.get_map():
                for key, _ in selector.select(self.seconds_to_next_event()):
                    self.take(selector, key.fileobj)
                self.send_what_is_due()
        self.wait()
        return time.monotonic() - self.started

    def wait(self):
        """The streams end before the process if it has closed them."""
        while self.process.poll() is None:
            self.send_what_is_due()
            time.sleep(0.002)

    def take(self, selector, stream):
        content = os.read(stream.fileno(), LONGEST_READ)
        self.read[stream] += content
        if not content:
            selector.unregister(stream)
            stream.close()
        self.arm_followers()

    def arm_followers(self):
        elapsed = time.monotonic() - self.started
        for k, s in enumerate(self.signals):
            if s.follows and s.follows in self.read[self.process.stderr]:
                self.signals[k] = type(s)(s.number, elapsed + s.delay)

    def due(self):
        return [self.started + s.delay for s in self.signals if not s.follows]

    def seconds_to_next_event(self):
        return max(0.0, min([self.deadline, *self.due()]) - time.monotonic())

    def send_what_is_due(self):
        now = time.monotonic()
        for s in [s for s in self.signals if not s.follows and self.started + s.delay <= now]:
            self.signals.remove(s)
            self.process.send_signal(s.number)
        if now >= self.deadline and not self.timed_out:
            self.timed_out = True
            self.process.send_signal(signal.SIGKILL)
            self.deadline = now + A_DAY


def environment(temporary):
    return {**os.environ, "TMPDIR": str(temporary), "LC_ALL": "C.UTF-8"}


@contextlib.contextmanager
def executed(program, case, folder, patience):
    """Runs the case and yields the Run while the case's file systems are mounted.

    @param folder    Empty; the command works in its subfolder `work` and has `temporary` for temporary files.
    @param patience  Factor on all time limits, for programs with sanitizers."""
    work = folder / "run"
    work.mkdir()
    (folder / "temporary").mkdir()
    write_files(work, case.files)
    try:
        if case.prepare:
            case.prepare(work)
        yield watched(program, case, folder, patience)
    finally:
        if case.clean_up:
            case.clean_up(work)


def watched(program, case, folder, patience):
    work, variables = folder / "run", environment(folder / "temporary")
    before = snapshot(folder)
    process = subprocess.Popen(
        ["/bin/sh", "-c", case.command_line(program)],
        cwd=work,
        env=variables,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    allowed = case.seconds + PATIENCE + (REPORT if list(case.arguments[:1]) == ["report"] else 0)
    watch = Watch(process, case.signals, allowed * patience)
    stdout, stderr = (watch.read[stream] for stream in (process.stdout, process.stderr))
    seconds = watch.run()

    def once_more(*arguments):
        limit = SECOND_CHANCE * patience
        return subprocess.run([program, *arguments], cwd=work, env=variables, capture_output=True, timeout=limit)

    return Run(
        case=case,
        folder=work,
        exit_code=process.returncode,
        stdout=bytes(stdout),
        stderr=bytes(stderr),
        seconds=seconds,
        timed_out=watch.timed_out,
        before=before,
        after=snapshot(folder),
        program=once_more,
    )
