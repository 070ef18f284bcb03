"""Progress on stderr: a bar on a terminal, plain lines in a log, and nothing of either on stdout."""

import os
import pty
import subprocess
import unittest

from command import COMMAND, CommandTest, room

# 100%  300.0 k rays, 1.2 M/s, error 4.5%, 0.0 s left
STATUS = r"\d+%  [\d.]+( [kMGT])? rays, [\d.]+( [kMGT])?/s, error [\d.e+]+%, [\d.]+ s left"


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

    def test_bar_on_a_terminal(self):
        text = self.on_terminal()
        shown = text.split("\r\x1b[K")[1:]
        self.assertGreater(len(shown), 2, text)
        self.assertRegex(shown[-1], r"^\[={24}\] " + STATUS)
        self.assertRegex(shown[0], r"^\[=* +\] ")
        self.assertIn("\n", shown[-1])  # what follows is on a line of its own


if __name__ == "__main__":
    unittest.main()
