"""Standard streams that are closed or full: a failed write is an error, and results are kept."""

import json
import os
import subprocess
import unittest

from command import COMMAND, DONE, FAILED, SMALL, VIEW, CommandTest, room

STDIN, STDOUT, STDERR = 0, 1, 2


class Streams(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())
        self.solve = ("solve", "room.mgf", "-o", "out.h5", "--rays", "20k")
        self.interflect("render", "room.mgf", "-o", "out.exr", *VIEW, *SMALL, "--rays", "20k")
        self.reports = (
            *(("--help",), ("solve", "--help"), ("--version",), ("info", "room.mgf"), ("info", "room.mgf", "--json")),
            *(("compare", "out.exr", "out.exr"), ("compare", "out.exr", "out.exr", "--json")),
        )

    def run_with_closed(self, streams, arguments):
        def close():
            for stream in streams:
                os.close(stream)

        command = [COMMAND, *arguments]
        with open(self.folder / "messages", "w") as messages:
            process = subprocess.Popen(
                command, cwd=self.folder, preexec_fn=close, stdin=subprocess.DEVNULL, stdout=messages, stderr=messages
            )
            return process.wait(timeout=60)

    def test_a_full_stdout_is_an_error(self):
        for arguments in self.reports:
            with self.subTest(arguments), open("/dev/full", "w") as full:
                result = subprocess.run(
                    [COMMAND, *arguments], cwd=self.folder, stdout=full, stderr=subprocess.PIPE, text=True, timeout=60
                )
                self.assertEqual(result.returncode, FAILED)
                self.assertIn("error: cannot write to standard output: No space left on device", result.stderr)

    def test_a_closed_stdout_is_an_error_where_it_is_written_to(self):
        for arguments in self.reports:
            with self.subTest(arguments):
                self.assertEqual(self.run_with_closed([STDOUT], arguments), FAILED)

    def test_no_result_is_lost_for_want_of_a_stream(self):
        self.interflect(*self.solve)
        expected = self.bytes("out.h5")
        for streams in ([STDIN], [STDOUT], [STDERR], [STDIN, STDOUT, STDERR]):
            with self.subTest(streams):
                (self.folder / "out.h5").unlink()
                self.assertEqual(self.run_with_closed(streams, self.solve), DONE)
                self.assertEqual(self.bytes("out.h5"), expected)

    def test_a_dash_is_stdout_for_statistics(self):
        lines = self.interflect(*self.solve, "--stats", "-").stdout.splitlines()
        self.assertEqual(json.loads(lines[0])["method"], "hsrr")
        self.assertGreater(json.loads(lines[-1])["rays"], 0)
        self.assertNotIn("-", self.files())


if __name__ == "__main__":
    unittest.main()
