"""Tests that the campaign finds each kind of fault, with programs that have the fault and one without faults."""

import signal
import tempfile
import unittest
from pathlib import Path

import check
from case import CRASH, EXIT_CODE, FAILED, HANG, LEFTOVER, MESSAGE, RESULT, UNNOTICED, Case, Signal
from execute import executed

SOUND = 'echo result >"$3"'


class Checker(unittest.TestCase):
    def faults(self, script, arguments=("solve", "-o", "out"), patience=1.0, **case):
        case.setdefault("outputs", ("out",))
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            program = folder / "program"
            program.write_text(f"#!/bin/sh\n{script}\n")
            program.chmod(0o755)
            (folder / "case").mkdir()
            with executed(str(program), Case("a test", list(arguments), **case), folder / "case", patience) as run:
                return check.faults_of(run)

    def assert_found(self, sort, script, **more):
        found = self.faults(script, **more)
        self.assertEqual({fault.sort for fault in found}, {sort}, found)

    def assert_sound(self, script, **more):
        self.assertEqual(self.faults(script, **more), [])

    def test_sound_program(self):
        self.assert_sound(SOUND)
        self.assert_sound("echo 'error: disk full' >&2; exit 1", allowed=frozenset({FAILED}))

    def test_crash(self):
        self.assert_found(CRASH, "kill -SEGV $$")
        self.assert_found(CRASH, "kill -PIPE $$")
        self.assert_found(CRASH, SOUND + "; echo 'a.cpp:1: runtime error: overflow' >&2")
        self.assert_found(CRASH, "echo '==1==ERROR: AddressSanitizer: heap' >&2; exit 1")

    def test_hang(self):
        self.assert_found(HANG, "exec sleep 60", patience=0.05)
        self.assert_found(HANG, "trap '' TERM; exec >&- 2>&-; while :; do :; done", patience=0.05)

    def test_exit_code(self):
        self.assert_found(EXIT_CODE, "echo 'error: no' >&2; exit 1")
        self.assert_found(EXIT_CODE, SOUND, allowed=frozenset({FAILED}), may_leave=("out",))

    def test_memory_may_run_out_only_where_that_is_said(self):
        script = "echo 'error: out of memory' >&2; exit 1"
        self.assert_sound(script, memory=True)
        self.assert_found(EXIT_CODE, script)
        self.assert_found(EXIT_CODE, "echo 'error: no' >&2; exit 1", memory=True)

    def test_leftover(self):
        failing = "; echo 'error: no' >&2; exit 1"
        allowed = frozenset({FAILED})
        self.assert_found(LEFTOVER, SOUND + "; touch .out.part7")
        self.assert_found(LEFTOVER, SOUND + '; touch "$TMPDIR/scratch"')
        self.assert_found(LEFTOVER, SOUND + failing, allowed=allowed)
        self.assert_found(LEFTOVER, "echo half >out" + failing, allowed=allowed, files={"out": b"an earlier result"})
        self.assert_found(LEFTOVER, SOUND + "; rm in", files={"in": b""})
        self.assert_found(LEFTOVER, SOUND + "; rm link; touch link", prepare=lambda folder: (folder / "link").symlink_to("x"))

    def test_result(self):
        self.assert_found(RESULT, "true")
        self.assert_found(RESULT, "echo '{\"area\": NaN}'", arguments=("info", "--json"), outputs=())
        self.assert_found(RESULT, "echo '{\"area\": '", arguments=("info", "--json"), outputs=())
        self.assert_found(RESULT, "echo '  area      -nan m2'", arguments=("info",), outputs=())
        self.assert_found(RESULT, SOUND, checks=(check.same_bytes({"out": b"another result\n"}),))
        self.assert_sound(SOUND, checks=(check.same_bytes({"out": b"result\n"}),))
        self.assert_found(RESULT, SOUND + '; echo \'{"seconds": Infinity}\' >out', checks=(check.stats_are_finite("out"),))

    def test_result_that_cannot_be_read_afterwards(self):
        reader = f"[ $1 = solve ] || {{ echo 'error: no' >&2; exit 3; }}; {SOUND}"
        self.assert_found(RESULT, reader, checks=(check.can_be_drawn("out"),))
        self.assert_found(RESULT, reader, checks=(check.scene_can_be_read("out"),))
        self.assert_found(RESULT, reader, checks=(check.picture_is_finite("out"),))

    def test_picture_that_is_not_finite(self):
        measure = f"[ $1 = compare ] && echo '{{\"non_finite_pixels\": 2}}' || {SOUND}"
        self.assert_found(RESULT, measure, checks=(check.picture_is_finite("out"),))

    def test_damage_that_is_not_noticed(self):
        for sort, expected in ((UNNOTICED, b"result\n"), (RESULT, b"another result\n")):
            checks = (check.damage_is_refused("out.exr", expected),)
            drawn = {"arguments": ("render", "-o", "out.exr"), "outputs": ("out.exr",), "checks": checks}
            self.assert_found(sort, SOUND, **drawn)

    def test_run_that_cannot_be_resumed(self):
        script = f"[ $1 = resume ] && exit 1; {SOUND}"
        self.assert_found(RESULT, script, checks=(check.can_be_resumed("out"),))

    def test_message(self):
        allowed = frozenset({FAILED})
        self.assert_found(MESSAGE, "exit 1", allowed=allowed)
        self.assert_found(MESSAGE, "echo 'error: ' >&2; exit 1", allowed=allowed)
        self.assert_found(MESSAGE, "echo 'error: std::bad_alloc' >&2; exit 1", allowed=allowed)
        self.assert_found(MESSAGE, "echo 'error: [json.exception.type_error.316]' >&2; exit 1", allowed=allowed)
        self.assert_found(MESSAGE, SOUND + "; printf 'warning: a\\033[31mb\\n' >&2")

    def test_signals(self):
        sent = (Signal(signal.SIGTERM, 0, follows=b"100%"),)
        lost = {"signals": sent, "allowed": frozenset({0, 130, -signal.SIGTERM}), "outputs": ()}
        checks = (check.interruption("out"),)
        self.assert_found(RESULT, "echo '100%  2 k rays' >&2; exec sleep 9", checks=checks, **lost)
        self.assert_sound("echo '100% read' >&2; exec sleep 9", checks=checks, **lost)
        self.assert_found(CRASH, "kill -SEGV $$", checks=checks, **lost)

    def test_second_signal_that_is_not_heeded(self):
        sent = (Signal(signal.SIGTERM, 0.05), Signal(signal.SIGTERM, 0.1))
        self.assert_found(HANG, "trap '' TERM; while :; do :; done", signals=sent, patience=0.1)

    def test_what_a_killed_run_leaves_is_removed_by_a_later_one(self):
        sent = (Signal(signal.SIGKILL, 0, follows=b"100%"),)
        killed = {"signals": sent, "allowed": frozenset({-signal.SIGKILL})}
        checks = (check.later_run_tidies_up("out", "again", "-o", "out"),)
        dirty = "[ $1 = again ] || { touch .part; echo 100% >&2; exec sleep 9; }; "
        self.assert_found(LEFTOVER, dirty + SOUND, checks=checks, **killed)
        self.assert_sound(dirty + "rm .part; " + SOUND, checks=checks, **killed)


if __name__ == "__main__":
    unittest.main()
