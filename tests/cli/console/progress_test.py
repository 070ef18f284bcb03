"""Progress on stderr: a bar on a terminal, plain lines in a log; stdout stays clean."""

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
        terminal, stderr = pty.openpty()
        process = subprocess.Popen([COMMAND, *self.SOLVE], cwd=self.folder, stderr=stderr, stdout=subprocess.DEVNULL)
        os.close(stderr)
        text = b""
        try:
            while part := os.read(terminal, 4096):
                text += part
        except OSError:  # Linux reports the closed end this way
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
        self.assertRegex(
            summary, r"^info: hsrr: 300.0 k rays in .* elements, estimated relative error [\d.]+% \(noise [\d.]+%, mesh "
        )

    def test_the_error_of_fixed_elements_is_that_of_noise(self):
        fixed = (*self.SOLVE, "--method", "srr")
        self.assertRegex(self.interflect(*fixed).stderr.splitlines()[-1], r"estimated relative error [\d.]+% \(noise alone\)")

    def test_drawing_has_none_unless_it_takes_long(self):
        self.interflect(*self.SOLVE)
        draw = ("render", "out.h5", "-o", "out.png", *VIEW, "--shading", "smooth", "--size")
        result = self.interflect(*draw, "32x18")
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        size, seconds = 64, 0.25
        while seconds < 3:  # find a size that takes long enough on this machine
            size = int(size * min(4, (4.5 / seconds) ** 0.5))
            start = time.monotonic()
            said = self.interflect(*draw, f"{size}x{size}").stderr
            seconds = time.monotonic() - start
        self.assertRegex(said, r"(?m)^ *\d+%  [\d.]+ [kMG] rays, [\d.]+ [kMG]/s, [\d.]+ s left$")
        self.assertRegex(said, r"(?m)^100%  ")

    def test_errors_are_readable_however_large(self):
        few = ("--method", "srr", "--rays", "60", "--rays-per-iteration", "20")
        said = self.interflect("solve", "room.mgf", "-o", "out.h5", *few).stderr
        self.assertRegex(said, r"/s, error \d{3,4}%,")
        self.assertRegex(said, r"relative error \d{3,4}% ")

    # Seen to fail when the time left is extrapolated from the share of the default limit of rays.
    def test_time_left_is_not_known_before_the_error_is(self):
        until = ("--until", "30%", "--mesh-size", "0.5")
        first = self.interflect("solve", "room.mgf", "-o", "out.h5", *until).stderr.splitlines()[0]
        self.assertRegex(first, r"^  0%  .* rays, .*/s, error -, - left$")

    # Seen to fail when each report of long work takes a line, and when the first batch reports no error.
    def test_path_tracing_to_an_error(self):
        path = ("--shading", "path", "--size", "64x36", "--until", "2%", "--max-samples", "4096")
        start = time.monotonic()
        *shown, summary, _ = self.interflect("render", "room.mgf", "-o", "out.exr", *VIEW, *path).stderr.splitlines()
        seconds = time.monotonic() - start
        self.assertLess(len(shown), seconds / 2 + 3, shown)
        self.assertIn("100%", shown[-1])
        self.assertRegex(summary, "^info: path tracing: ")
        for line in shown:
            self.assertNotIn("error 0%", line)

    def test_bar_on_a_terminal(self):
        text = self.on_terminal()
        shown = text.split("\r\x1b[K")[1:]
        self.assertGreater(len(shown), 2, text)
        self.assertRegex(shown[-1], r"^\[={24}\] " + STATUS)
        self.assertRegex(shown[0], r"^\[=* +\] ")
        self.assertIn("\n", shown[-1])  # later output starts on a new line


if __name__ == "__main__":
    unittest.main()
