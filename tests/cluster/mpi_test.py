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

    def test_a_process_that_dies_while_drawing_ends_all_without_a_picture(self):
        process = self.start(3, *OF_LIGHT["path.exr"][:-1], "65536", "-o", "long.exr")
        time.sleep(2)
        self.assertIsNone(process.poll(), "ended before it was killed")
        os.kill(helpers_of(process)[-1], signal.SIGKILL)
        killed_at = time.monotonic()
        _, messages = process.communicate()
        self.assertLess(time.monotonic() - killed_at, MOST_SECONDS)
        self.assertNotEqual(process.returncode, 0)
        self.assertIn("signal 9", messages)
        self.assertEqual(self.files(), ["room.mgf"])

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
