"""Processes of mpirun that share a run: the same bytes as one process, and messages by the first process alone."""

import shutil
import signal
import subprocess
import unittest

from command import BAD_INPUT, COMMAND, FAILED, INTERRUPTED
from crew import ENVIRONMENT, CrewTest, solve, with_checkpoints


class Mpi(CrewTest):
    def test_any_number_of_processes_and_threads_gives_the_same_bytes(self):
        self.interflect(*solve("500k"), "-o", "alone.h5")
        for ranks, threads in ((1, 1), (2, 1), (1, 2), (3, 2)):
            with self.subTest(ranks=ranks, threads=threads):
                code, messages = self.run_ranks(ranks, *solve("500k"), "--threads", str(threads), "-o", "shared.h5")
                self.assertEqual(code, 0, messages)
                self.assertEqual(self.bytes("shared.h5"), self.bytes("alone.h5"))

    def test_the_first_process_alone_reports_errors(self):
        code, messages = self.run_ranks(3, "solve", "missing.mgf", "-o", "out.h5")
        self.assertEqual(code, BAD_INPUT)
        self.assertEqual(messages.count("missing.mgf"), 1, messages)

    def test_another_build_is_refused(self):
        """An additional byte at the end of an executable file changes only its checksum."""
        other = self.folder / "other"
        shutil.copy(COMMAND, other)
        with other.open("ab") as file:
            file.write(b"\n")
        arguments = (*solve("500k"), "-o", "out.h5")
        process = self.start_programs("-n", "2", COMMAND, *arguments, ":", "-n", "1", str(other), *arguments)
        _, messages = process.communicate()
        self.assertEqual(process.returncode, FAILED)
        self.assertEqual(messages.count("error: process 2 runs another build"), 1, messages)
        self.assertFalse((self.folder / "out.h5").exists())

    def test_processes_without_connection_are_refused(self):
        """As srun starts them without support of MPI."""
        for variables in ({"SLURM_STEP_NUM_TASKS": "2"}, {"PMI_SIZE": "2"}, {"PMIX_RANK": "1"}):
            with self.subTest(variables=variables):
                result = subprocess.run(
                    [COMMAND, "info", "room.mgf"],
                    cwd=self.folder, env=ENVIRONMENT | variables, capture_output=True, text=True,
                )
                self.assertEqual(result.returncode, FAILED)
                self.assertIn("several processes, but MPI connects 1", result.stderr)

    def test_a_forwarded_signal_ends_the_run_after_a_step(self):
        process = self.start(3, *with_checkpoints("1G"))
        self.wait_for_file("run.h5", process)
        process.send_signal(signal.SIGUSR1)
        _, messages = process.communicate()
        self.assertEqual(process.returncode, INTERRUPTED, messages)
        self.assertEqual(messages.count("stopping"), 1, messages)
        self.json("info", "shared.h5")


if __name__ == "__main__":
    unittest.main()
