"""Processes of mpirun that share a run: the same bytes as one process, and messages by the first process alone."""

import json
import shutil
import signal
import subprocess
import unittest

from command import BAD_INPUT, COMMAND, FAILED, INTERRUPTED, VIEW
from mpirun import ENVIRONMENT, RanksTest, solve, with_checkpoints

SMALL_PICTURE = ("--size", "64x48", "--samples", "16")
# Commands whose light all processes compute, by the name of their output.
OF_LIGHT = {
    "path.exr": ("render", "room.mgf", *VIEW, "--shading", "path", *SMALL_PICTURE),
    "instant.exr": ("render", "room.mgf", *VIEW, "--shading", "instant", "--light-walks", "1000", *SMALL_PICTURE),
    "solved.exr": ("render", "room.mgf", *VIEW, "--rays", "100k", *SMALL_PICTURE),
    "gather.exr": ("render", "light.h5", *VIEW, "--shading", "gather", "--until", "20%", *SMALL_PICTURE),
    "hybrid.png": ("render", "light.h5", *VIEW, *SMALL_PICTURE),
    "grid.csv": ("probe", "light.h5", "--plane", "0.8", "--samples", "64"),
    "paths.csv": ("probe", "room.mgf", "--plane", "0.8", "--samples", "64", "--shading", "path"),
    "map.gltf": ("export", "light.h5", "--lightmap", "--texels-per-metre", "8"),
    "groups.gltf": ("export", "light.h5", "--lightmap", "--texels-per-metre", "4", "--lightmap-groups"),
    "gathered.gltf": ("export", "light.h5", "--lightmap", "--texels-per-metre", "4", "--shading", "gather"),
    "vertices.glb": ("export", "light.h5", "--max-triangles", "3000"),
    "probes.json": ("export", "light.h5", "--probe-spacing", "0.7", "--probe-rays", "128"),
}


class Mpi(RanksTest):
    def test_any_number_of_processes_and_threads_gives_the_same_bytes(self):
        self.interflect(*solve("500k"), "-o", "alone.h5")
        for ranks, threads in ((1, 1), (2, 1), (1, 2), (3, 2)):
            with self.subTest(ranks=ranks, threads=threads):
                code, messages = self.run_ranks(ranks, *solve("500k"), "--threads", str(threads), "-o", "shared.h5")
                self.assertEqual(code, 0, messages)
                self.assertEqual(self.bytes("shared.h5"), self.bytes("alone.h5"))

    def test_statistics_have_the_traffic_of_each_process(self):
        self.interflect(*solve("200k"), "-o", "alone.h5", "--stats", "alone.json")
        code, messages = self.run_ranks(3, *solve("200k"), "-o", "shared.h5", "--stats", "shared.json")
        self.assertEqual(code, 0, messages)
        alone, shared = (
            [json.loads(line) for line in (self.folder / name).read_text().splitlines()[1:]]
            for name in ("alone.json", "shared.json")
        )
        self.assertEqual([line["rays"] for line in shared], [line["rays"] for line in alone])
        self.assertNotIn("ranks", alone[-1])
        for line in shared:
            self.assertEqual((line["ranks"], len(line["sent_bytes"]), len(line["exchange_seconds"])), (3, 3, 3))
            self.assertGreater(min(line["sent_bytes"]), 0)

    def test_pictures_measurements_and_exports_have_the_bytes_of_one_process(self):
        self.interflect("solve", "room.mgf", *VIEW, "--rays", "100k", "--light-groups", "-o", "light.h5")
        (self.folder / "shared").mkdir()
        for name, arguments in OF_LIGHT.items():
            with self.subTest(name):
                self.interflect(*arguments, "-o", name)
                code, messages = self.run_ranks(3, *arguments, "--threads", "1", "-o", f"shared/{name}")
                self.assertEqual(code, 0, messages)
                for file in (self.folder / "shared").iterdir():
                    self.assertEqual(file.read_bytes(), self.bytes(file.name), file)

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

    def test_other_arguments_are_refused(self):
        process = self.start_programs("-n", "1", COMMAND, *solve("500k"), "-o", "out.h5", ":", "-n", "1", COMMAND,
                                      *solve("600k"), "-o", "out.h5")
        _, messages = process.communicate()
        self.assertEqual(process.returncode, FAILED)
        self.assertEqual(messages.count("error: process 1 has other arguments than process 0"), 1, messages)
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
