"""A build without MPI refuses to run as several processes, which would all write the same files."""

import os
import subprocess
import unittest

from command import COMMAND, DONE, FAILED


def info(**variables):
    return subprocess.run([COMMAND, "info", "--help"], env=os.environ | variables, capture_output=True, text=True)


class Alone(unittest.TestCase):
    def test_several_processes_are_refused(self):
        counts = dict.fromkeys(("OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"), "2")
        for name, value in (counts | {"PMIX_RANK": "0"}).items():
            with self.subTest(variable=name):
                result = info(**{name: value})
                self.assertEqual(result.returncode, FAILED)
                self.assertIn("built without MPI", result.stderr)

    def test_one_process_of_a_launcher_runs(self):
        self.assertEqual(info(SLURM_STEP_NUM_TASKS="1", PMIX_RANK="0").returncode, DONE)


if __name__ == "__main__":
    unittest.main()
