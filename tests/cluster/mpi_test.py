"""Processes of mpirun that share a run: the same bytes as one process, errors by the first process alone, and a clear end if one
dies."""

import os
import signal
import subprocess
import time
import unittest

from command import BAD_INPUT, COMMAND, VIEW, CommandTest, room

MPIRUN = ("mpirun", "--oversubscribe", "--bind-to", "none")
ENVIRONMENT = os.environ | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
RUN = ("solve", "room.mgf", *VIEW, "--rays", "500k", "--mesh-size", "0.5")
MOST_SECONDS = 10  # from a death to the end of all


def helpers_of(process: subprocess.Popen) -> list[int]:
    found = subprocess.run(["pgrep", "-P", str(process.pid)], capture_output=True, text=True).stdout.split()
    return [int(number) for number in found]


class Mpi(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())

    def start(self, ranks, *arguments):
        return subprocess.Popen(
            [*MPIRUN, "-n", str(ranks), COMMAND, *arguments],
            cwd=self.folder, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )

    def run_ranks(self, ranks, *arguments):
        process = self.start(ranks, *arguments)
        output, messages = process.communicate()
        return process.returncode, messages

    def test_any_number_of_processes_and_threads_gives_the_same_bytes(self):
        self.interflect(*RUN, "-o", "alone.h5")
        for ranks, threads in ((1, 1), (2, 1), (1, 2), (3, 2)):
            with self.subTest(ranks=ranks, threads=threads):
                code, messages = self.run_ranks(ranks, *RUN, "--threads", str(threads), "-o", "shared.h5")
                self.assertEqual(code, 0, messages)
                self.assertEqual(self.bytes("shared.h5"), self.bytes("alone.h5"))

    def test_the_first_process_alone_reports_errors(self):
        code, messages = self.run_ranks(3, "solve", "missing.mgf", "-o", "out.h5")
        self.assertEqual(code, BAD_INPUT)
        self.assertEqual(messages.count("missing.mgf"), 1, messages)

    def test_a_process_that_dies_ends_all_and_the_checkpoint_goes_on_with_fewer(self):
        long_run = (*RUN[:-4], "--rays", "2M", "--mesh-size", "0.5")
        self.interflect(*long_run, "-o", "alone.h5")
        process = self.start(3, *long_run, "-o", "shared.h5", "--checkpoint", "run.h5", "--every", "0.1s")
        while not (self.folder / "run.h5").exists():
            self.assertIsNone(process.poll(), "ended before it was killed")
            time.sleep(0.01)
        os.kill(helpers_of(process)[-1], signal.SIGKILL)
        killed_at = time.monotonic()
        _, messages = process.communicate()
        self.assertLess(time.monotonic() - killed_at, MOST_SECONDS)
        self.assertNotEqual(process.returncode, 0)
        self.assertIn("signal 9", messages)
        code, messages = self.run_ranks(2, "resume", "run.h5", "-o", "resumed.h5")
        self.assertEqual(code, 0, messages)
        self.assertEqual(self.bytes("resumed.h5"), self.bytes("alone.h5"))


if __name__ == "__main__":
    unittest.main()
