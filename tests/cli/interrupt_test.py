"""Ctrl-C: the first ends the iteration and keeps what there is, the second ends at once and keeps nothing."""

import json
import os
import re
import signal
import subprocess
import time
import unittest
from pathlib import Path

from command import COMMAND, INTERRUPTED, SMALL, VIEW, CommandTest, room

ENDLESS = ("--rays", "10T", "--mesh-size", "0.5")
SHORT_ITERATIONS = ("--rays-per-iteration", "20k")
ONE_LONG_ITERATION = ("--rays-per-iteration", "10T", "--one-bounce")
SOON = 30  # [s]


class Interrupt(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())

    def start(self, *arguments):
        process = subprocess.Popen(
            [COMMAND, *arguments], cwd=self.folder, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True
        )
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def wait_until_it_heeds(self, process, awaited):
        status = Path(f"/proc/{process.pid}/status")
        deadline = time.monotonic() + SOON
        while not int(re.search(r"SigCgt:\s*(\w+)", status.read_text())[1], 16) >> (awaited - 1) & 1:
            self.assertLess(time.monotonic(), deadline, "no handler of signals was set")
            time.sleep(0.01)

    def wait_until_it_has_worked(self, process, seconds):
        """@param seconds  Of processor time: more than anything takes before the first iteration, however slow."""
        status = Path(f"/proc/{process.pid}/stat")
        deadline = time.monotonic() + SOON
        while sum(map(int, status.read_text().split()[13:15])) < seconds * os.sysconf("SC_CLK_TCK"):
            self.assertLess(time.monotonic(), deadline, "it does nothing")
            time.sleep(0.05)

    def interrupt_after_first_progress(self, *arguments, by=signal.SIGINT):
        process = self.start(*arguments)
        self.assertIn("rays", process.stderr.readline())
        process.send_signal(by)
        rest = process.communicate(timeout=SOON)[1]
        self.assertEqual(process.returncode, INTERRUPTED, rest)
        self.assertIn("stopping after this iteration", rest)

    def test_solve_keeps_a_solution_that_can_be_drawn(self):
        self.interrupt_after_first_progress(
            "solve", "room.mgf", "-o", "out.h5", "--stats", "stats", *ENDLESS, *SHORT_ITERATIONS
        )
        self.assertEqual(self.files(), ["out.h5", "room.mgf", "stats"])
        header, *iterations = map(json.loads, (self.folder / "stats").read_text().splitlines())
        self.assertEqual(header["options"]["rays"], 10**13)
        self.assertGreater(iterations[-1]["rays"], 0)
        self.interflect("render", "out.h5", "-o", "out.exr", *VIEW, *SMALL)

        # A picture of the light, not of a start in darkness: it is near that of a whole solve.
        self.interflect("render", "room.mgf", "-o", "whole.exr", *VIEW, *SMALL, "--mesh-size", "0.5", "--rays", "200k")
        self.assertAlmostEqual(self.json("compare", "out.exr", "whole.exr")["ratio_of_means"], 1, delta=0.1)

    def test_render_keeps_a_picture(self):
        self.interrupt_after_first_progress(
            "render", "room.mgf", "-o", "out.exr", *VIEW, *SMALL, *ENDLESS, *SHORT_ITERATIONS
        )
        self.assertEqual(self.files(), ["out.exr", "room.mgf"])
        self.assertEqual(self.json("compare", "out.exr", "out.exr")["non_finite_pixels"], 0)

    def test_path_tracing_keeps_a_picture_and_its_error(self):
        self.interrupt_after_first_progress(
            *("render", "room.mgf", "--shading", "path", "-o", "out.exr", "--error-image", "error.exr", *VIEW),
            *("--size", "32x18", "--samples", "65536"),
        )
        self.assertEqual(self.files(), ["error.exr", "out.exr", "room.mgf"])
        self.assertEqual(self.json("compare", "out.exr", "out.exr")["non_finite_pixels"], 0)

    def test_drawing_ends_at_once_and_leaves_nothing(self):
        self.interflect("solve", "room.mgf", "-o", "room.h5", "--rays", "20k", "--mesh-size", "1")
        large = ("render", "room.h5", "-o", "out.png", *VIEW, "--size", "4000x3000", "--samples", "4096")
        for shown in ("light", "mesh", "level"):
            process = self.start(*large, "--show", shown)
            self.assertRegex(process.stderr.readline(), r"^ *\d+%  .* rays, .*/s, .* left$")
            process.send_signal(signal.SIGINT)
            rest = process.communicate(timeout=SOON)[1]
            self.assertEqual(process.returncode, INTERRUPTED, rest)
            self.assertIn("interrupted: no picture is written", rest)
            self.assertEqual(self.files(), ["room.h5", "room.mgf"])

    def test_a_request_to_terminate_is_heeded_alike(self):
        self.interrupt_after_first_progress(
            "solve", "room.mgf", "-o", "out.h5", *ENDLESS, *SHORT_ITERATIONS, by=signal.SIGTERM
        )
        self.assertEqual(self.files(), ["out.h5", "room.mgf"])

    def test_the_second_ends_at_once_and_leaves_nothing(self):
        # The iteration under way would take hours, so that only the second signal can have ended it.
        process = self.start("solve", "room.mgf", "-o", "out.h5", "--stats", "stats", *ENDLESS, *ONE_LONG_ITERATION)
        self.wait_until_it_heeds(process, signal.SIGINT)
        self.wait_until_it_has_worked(process, 4)
        process.send_signal(signal.SIGINT)
        self.assertIn("stopping after this iteration", process.stderr.readline())
        process.send_signal(signal.SIGINT)
        process.wait(timeout=SOON)
        self.assertEqual(process.returncode, -signal.SIGINT)
        self.assertEqual(self.files(), ["room.mgf"])

    def test_an_earlier_result_survives(self):
        self.write("out.h5", "an earlier result")
        process = self.start("solve", "room.mgf", "-o", "out.h5", *ENDLESS, *SHORT_ITERATIONS)
        self.assertIn("rays", process.stderr.readline())
        process.kill()
        process.wait(timeout=SOON)
        self.assertEqual(self.bytes("out.h5"), b"an earlier result")
        self.assertEqual(self.files(), ["out.h5", "room.mgf"])


if __name__ == "__main__":
    unittest.main()
