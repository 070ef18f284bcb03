"""Progress on stderr: a bar on a terminal, plain lines in a log, and nothing of either on stdout."""

import os
import pty
import subprocess
import time
import unittest

from command import COMMAND, VIEW, CommandTest, room

# 100%  300.0 k rays, 1.2 M/s, error 4.5%, 0.0 s left
STATUS = r"\d+%  [\d.]+( [kMGT])? rays, [\d.]+( [kMGT])?/s, error [\d.]+%, [\d.]+ s left"


class Progress(CommandTest):
    SOLVE = ("solve", "room.mgf", "-o", "out.h5", "--rays", "300k", "--mesh-size", "0.5")

    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())

    def on_terminal(self):
        """What the command writes to stderr when that is a terminal."""
        terminal, stderr = pty.openpty()
        process = subprocess.Popen([COMMAND, *self.SOLVE], cwd=self.folder, stderr=stderr, stdout=subprocess.DEVNULL)
        os.close(stderr)
        text = b""
        try:
            while part := os.read(terminal, 4096):
                text += part
        except OSError:  # how Linux says that the other end was closed
            pass
        os.close(terminal)
        self.assertEqual(process.wait(timeout=60), 0, text)
        return text.decode()

    def test_lines_in_a_log(self):
        result = self.interflect(*self.SOLVE)
        self.assertEqual(result.stdout, "")
        self.assertNotIn("\x1b", result.stderr)
        self.assertNotIn("\r", result.stderr)
        first, *_, last, summary = result.stderr.splitlines()
        self.assertRegex(first, r"^ *\d+%  ")
        self.assertRegex(last, f"^{STATUS}$")
        self.assertIn("100%", last)
        self.assertRegex(summary, r"^info: hsrr: 300.0 k rays in .* elements, estimated relative error [\d.]+%")

    def test_drawing_has_none_unless_it_takes_long(self):
        self.interflect(*self.SOLVE)
        result = self.interflect("render", "out.h5", "-o", "out.png", *VIEW, "--size", "32x18")
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        size = 128
        seconds = 0
        while seconds < 3:  # of a picture that takes long enough on this machine
            size *= 2
            start = time.monotonic()
            said = self.interflect("render", "out.h5", "-o", "out.png", *VIEW, "--size", f"{size}x{size}").stderr
            seconds = time.monotonic() - start
        self.assertRegex(said, r"(?m)^ *\d+%  [\d.]+ [kMG] rays, [\d.]+ [kMG]/s, [\d.]+ s left$")
        self.assertRegex(said, r"(?m)^100%  ")

    def test_errors_are_readable_however_large(self):
        few = ("--method", "srr", "--rays", "60", "--rays-per-iteration", "20")
        said = self.interflect("solve", "room.mgf", "-o", "out.h5", *few).stderr
        self.assertRegex(said, r"/s, error \d{3,4}%,")
        self.assertRegex(said, r"relative error \d{3,4}% ")

    def test_bar_on_a_terminal(self):
        text = self.on_terminal()
        shown = text.split("\r\x1b[K")[1:]
        self.assertGreater(len(shown), 2, text)
        self.assertRegex(shown[-1], r"^\[={24}\] " + STATUS)
        self.assertRegex(shown[0], r"^\[=* +\] ")
        self.assertIn("\n", shown[-1])  # what follows is on a line of its own


if __name__ == "__main__":
    unittest.main()
