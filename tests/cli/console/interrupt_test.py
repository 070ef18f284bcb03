"""Signals: the first ends the run and keeps the result so far; the second ends at once without a result."""

import json
import os
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from command import COMMAND, DONE, INTERRUPTED, SMALL, VIEW, CommandTest, room

ENDLESS = ("--rays", "10T", "--mesh-size", "0.5")
SHORT_ITERATIONS = ("--rays-per-iteration", "20k")
ONE_LONG_ITERATION = ("--rays-per-iteration", "100G")
GATHERED = ("--lightmap", "--shading", "gather", "--texels-per-metre", "4")
METHODS = ("ihsrr", "ihsrr --one-bounce", "hwdrs", "random-walk", "photon-mesh", "global-lines", "pr")
SOON = 30  # [s]
A_MOMENT = 10  # [s], on a busy machine with a sanitizer


class Interrupt(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())
        temporary_folder = tempfile.TemporaryDirectory()
        self.addCleanup(temporary_folder.cleanup)
        self.temporary_folder = Path(temporary_folder.name)

    def start(self, *arguments):
        process = subprocess.Popen(
            [COMMAND, *arguments],
            cwd=self.folder,
            stderr=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            text=True,
            env={**os.environ, "TMPDIR": str(self.temporary_folder)},
            preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL),  # under nohup it would be ignored
        )
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def wait_until_it_has_worked(self, process, seconds):
        """@param seconds  Processor time, longer than any phase before the first iteration, however slow."""
        status = Path(f"/proc/{process.pid}/stat")
        deadline = time.monotonic() + SOON
        while sum(map(int, status.read_text().split()[13:15])) < seconds * os.sysconf("SC_CLK_TCK"):
            self.assertLess(time.monotonic(), deadline, "it does nothing")
            time.sleep(0.05)

    def wait_for_progress(self, process):
        """Skips the reports of long work, which come first on a slow machine."""
        while "rays" not in (line := process.stderr.readline()):
            self.assertIn("so far", line)

    def interrupt_after_first_progress(self, *arguments, by=signal.SIGINT):
        process = self.start(*arguments)
        self.wait_for_progress(process)
        process.send_signal(by)
        rest = process.communicate(timeout=SOON)[1]
        self.assertEqual(process.returncode, INTERRUPTED, rest)
        self.assertIn("stopping, and keeping usable results", rest)

    def test_solve_keeps_a_solution_that_can_be_drawn(self):
        self.interrupt_after_first_progress(
            "solve", "room.mgf", "-o", "out.h5", "--stats", "stats", *ENDLESS, *SHORT_ITERATIONS
        )
        self.assertEqual(self.files(), ["out.h5", "room.mgf", "stats"])
        header, *iterations = map(json.loads, (self.folder / "stats").read_text().splitlines())
        self.assertEqual(header["options"]["rays"], 10**13)
        self.assertGreater(iterations[-1]["rays"], 0)
        self.interflect("render", "out.h5", "-o", "out.exr", *VIEW, *SMALL)

        # The picture is near that of a complete solve, not of a start in darkness.
        self.interflect("render", "room.mgf", "-o", "whole.exr", *VIEW, *SMALL, "--mesh-size", "0.5", "--rays", "200k")
        self.assertAlmostEqual(self.json("compare", "out.exr", "whole.exr")["ratio_of_means"], 1, delta=0.1)

    def test_render_keeps_a_picture(self):
        self.interrupt_after_first_progress(
            "render", "room.mgf", "-o", "out.exr", *VIEW, *SMALL, *ENDLESS, *SHORT_ITERATIONS
        )
        self.assertEqual(self.files(), ["out.exr", "room.mgf"])
        self.assertEqual(self.json("compare", "out.exr", "out.exr")["non_finite_pixels"], 0)

    def test_path_tracing_and_gathering_keep_a_picture_and_its_error(self):
        self.interflect("solve", "room.mgf", "-o", "room.h5", "--rays", "20k", "--mesh-size", "1")
        for source in ("room.mgf", "room.h5"):
            shading = "path" if source == "room.mgf" else "gather"
            self.interrupt_after_first_progress(
                *("render", source, "--shading", shading, "-o", "out.exr", "--error-image", "error.exr", *VIEW),
                *("--size", "32x18", "--samples", "65536"),
            )
            self.assertEqual(self.files(), ["error.exr", "out.exr", "room.h5", "room.mgf"])
            self.assertEqual(self.json("compare", "out.exr", "out.exr")["non_finite_pixels"], 0)

    def test_render_that_is_stopped_while_it_solves_shows_the_light(self):
        self.interrupt_after_first_progress(
            "render", "room.mgf", "-o", "out.exr", *VIEW, *SMALL, *ENDLESS, *SHORT_ITERATIONS
        )
        self.interflect("render", "room.mgf", "-o", "whole.exr", *VIEW, *SMALL, "--mesh-size", "0.5", "--rays", "200k")
        self.assertAlmostEqual(self.json("compare", "out.exr", "whole.exr")["ratio_of_means"], 1, delta=0.1)

    def test_an_export_that_gathers_keeps_a_lightmap(self):
        self.interflect("solve", "room.mgf", "-o", "room.h5", "--rays", "20k", "--mesh-size", "1")
        self.interrupt_after_first_progress("export", "room.h5", "-o", "out.gltf", *GATHERED, "--samples", "16000000")
        lightmap = "out.gltf.lightmap-0.exr"
        self.assertEqual(self.files(), ["out.gltf", lightmap, "room.h5", "room.mgf"])
        self.interflect("export", "room.h5", "-o", "whole.gltf", *GATHERED, "--samples", "256")
        compared = self.json("compare", lightmap, "whole.gltf.lightmap-0.exr")
        self.assertAlmostEqual(compared["ratio_of_means"], 1, delta=0.02)

    def test_an_export_without_a_result_says_so(self):
        self.interflect("solve", "room.mgf", "-o", "room.h5", "--rays", "20k", "--mesh-size", "1")
        for by, reason, *arguments in (
            (signal.SIGINT, r"stopped when \d+ of \d+ texels", "out.glb", *GATHERED[:3], "--texels-per-metre", "100"),
            (signal.SIGTERM, r"stopped at \d+ of \d+ probes", "out.json", "--probe-spacing", "0.03"),
        ):
            process = self.start("export", "room.h5", "-o", *arguments)
            self.wait_for_progress(process)
            process.send_signal(by)
            said = process.communicate(timeout=SOON)[1]
            self.assertEqual(process.returncode, INTERRUPTED, said)
            self.assertRegex(said, reason + ".*: nothing is written")
            self.assertEqual(self.files(), ["room.h5", "room.mgf"])

    def test_a_probe_keeps_the_points_with_an_error(self):
        for quantity, missing in (("horizontal", "of 100000 points were not measured"), ("ugr", "of 400000 ratings were not")):
            process = self.start(
                *("probe", "room.mgf", "--shading", "path", "--quantity", quantity, "--samples", "4096", "-o", "out.csv"),
                *("--line", "0.1,0.1,1:1.9,2.9,1:100000"),
            )
            self.wait_for_progress(process)
            process.send_signal(signal.SIGINT)
            said = process.communicate(timeout=SOON)[1]
            self.assertEqual(process.returncode, INTERRUPTED, said)
            self.assertIn(missing, said)
            self.assertEqual(self.files(), ["out.csv", "room.mgf"])

    def test_drawing_ends_at_once_and_leaves_nothing(self):
        self.interflect("solve", "room.mgf", "-o", "room.h5", "--rays", "20k", "--mesh-size", "1")
        large = ("render", "room.h5", "-o", "out.png", *VIEW, "--size", "4000x3000", "--samples", "4096", "--shading")
        for shown in ("light", "mesh", "level"):
            process = self.start(*large, "smooth", "--show", shown)
            self.assertRegex(process.stderr.readline(), r"^ *\d+%  .* rays, .*/s, .* left$")
            process.send_signal(signal.SIGINT)
            rest = process.communicate(timeout=SOON)[1]
            self.assertEqual(process.returncode, -signal.SIGINT, rest)
            self.assertIn("ended by a signal, without a result", rest)
            self.assertEqual(self.files(), ["room.h5", "room.mgf"])

    # Earlier pictures were black in one half, and too dark where samples were missing.
    def test_a_picture_without_all_pixels_is_drawn_otherwise(self):
        self.interflect("solve", "room.mgf", "-o", "room.h5", "--rays", "20k", "--mesh-size", "1")
        picture = ("render", "room.h5", *VIEW, "--samples")
        process = self.start(*picture, "4096", "--size", "800x600", "-o", "out.exr", "--no-denoise")
        for _ in range(2):  # during the first samples
            self.wait_for_progress(process)
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=SOON)[1]
        self.assertEqual(process.returncode, INTERRUPTED, said)
        self.assertIn("stopped before each pixel had enough light: the picture is a rough one", said)
        self.interflect(*picture, "4", "--size", "200x150", "-o", "whole.exr")  # `compare` averages the larger picture
        self.assertAlmostEqual(self.json("compare", "out.exr", "whole.exr")["ratio_of_means"], 1, delta=0.01)

    def test_a_request_to_terminate_is_heeded_alike(self):
        self.interrupt_after_first_progress(
            "solve", "room.mgf", "-o", "out.h5", *ENDLESS, *SHORT_ITERATIONS, by=signal.SIGTERM
        )
        self.assertEqual(self.files(), ["out.h5", "room.mgf"])

    def test_the_end_of_the_terminal_is_heeded_alike(self):
        self.interrupt_after_first_progress(
            "solve", "room.mgf", "-o", "out.h5", *ENDLESS, *SHORT_ITERATIONS, by=signal.SIGHUP
        )
        self.assertEqual(self.files(), ["out.h5", "room.mgf"])

    def test_an_iteration_that_would_take_hours_is_cut_short(self):
        for method in METHODS:
            with self.subTest(method):
                # The light comes from the initialisation, which takes a moment.
                process = self.start(
                    *("solve", "room.mgf", "-o", "out.h5", *ENDLESS, *ONE_LONG_ITERATION, *VIEW, "--method", *method.split())
                )
                self.wait_until_it_has_worked(process, 1)
                process.send_signal(signal.SIGTERM)
                asked = time.monotonic()
                self.assertEqual(process.wait(timeout=SOON), INTERRUPTED)
                self.assertLess(time.monotonic() - asked, A_MOMENT)
                self.assertEqual(self.files(), ["out.h5", "room.mgf"])

    def test_a_limit_of_time_holds_within_an_iteration(self):
        for method in METHODS:
            with self.subTest(method):
                started = time.monotonic()
                self.interflect(
                    *("solve", "room.mgf", "-o", "out.h5", *ENDLESS, *ONE_LONG_ITERATION, "--time", "0.5"),
                    *("--method", *method.split()),
                )
                self.assertLess(time.monotonic() - started, 0.5 + A_MOMENT)

    def test_a_signal_while_the_result_is_written_loses_nothing(self):
        process = self.start_writing_into_a_pipe()
        process.send_signal(signal.SIGINT)
        self.assertIn("stopping, and keeping usable results", process.stderr.readline())
        (self.folder / "out.h5").write_bytes((self.folder / "pipe.h5").read_bytes())
        self.assertEqual(process.wait(timeout=SOON), INTERRUPTED)
        self.interflect("render", "out.h5", "-o", "out.exr", *VIEW, *SMALL)
        self.assertEqual(self.temporary_files(), [])

    def test_long_work_is_reported(self):
        self.interflect("solve", "room.mgf", "-o", "room.h5", "--rays", "20k", "--mesh-size", "1")
        os.mkfifo(self.folder / "pipe.exr")
        process = self.start("render", "room.h5", "-o", "pipe.exr", "--shading", "flat", *VIEW, *SMALL)
        self.assertRegex(process.stderr.readline(), r"^writing pipe\.exr: \d\.\d s so far, \d+ MiB of memory$")
        self.assertTrue((self.folder / "pipe.exr").read_bytes())
        self.assertEqual(process.wait(timeout=SOON), DONE)

    def test_the_second_ends_at_once_and_leaves_nothing(self):
        process = self.start_writing_into_a_pipe()
        process.send_signal(signal.SIGINT)
        self.assertIn("stopping, and keeping usable results", process.stderr.readline())
        self.assertNotEqual(self.temporary_files(), [])
        time.sleep(0.5)  # longer than between the copies of one signal
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=SOON), -signal.SIGINT)
        self.assertEqual(self.temporary_files(), [])

    def test_copies_of_a_signal_count_once(self):
        """As of `timeout`, which signals the process and then its group."""
        process = self.start("solve", "room.mgf", "-o", "out.h5", *ENDLESS)
        self.wait_for_progress(process)
        process.send_signal(signal.SIGINT)
        self.assertIn("stopping, and keeping usable results", process.stderr.readline())
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=SOON)[1]
        self.assertEqual(process.returncode, INTERRUPTED, said)
        self.assertEqual(self.files(), ["out.h5", "room.mgf"])

    def start_writing_into_a_pipe(self):
        """Starts a process that has solved and waits for a reader of the result."""
        os.mkfifo(self.folder / "pipe.h5")
        process = self.start("solve", "room.mgf", "-o", "pipe.h5", "--rays", "20k")
        while not process.stderr.readline().startswith("info:"):
            pass
        deadline = time.monotonic() + SOON
        while not self.is_asleep(process) or not self.temporary_files():
            self.assertLess(time.monotonic(), deadline, "it does not write")
            time.sleep(0.05)
        return process

    def is_asleep(self, process):
        return Path(f"/proc/{process.pid}/stat").read_text().split()[2] == "S"

    def temporary_files(self):
        return sorted(path.name for path in self.temporary_folder.iterdir())

    def test_a_reader_of_messages_that_goes_away_ends_nothing(self):
        process = self.start("solve", "room.mgf", "-o", "out.h5", "--rays", "500k", *SHORT_ITERATIONS)
        self.assertIn("rays", process.stderr.readline())
        process.stderr.close()
        self.assertEqual(process.wait(timeout=SOON), DONE)
        self.interflect("render", "out.h5", "-o", "out.exr", *VIEW, *SMALL)

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
