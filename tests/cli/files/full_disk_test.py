"""A file that exceeds the disk: the message has its name and the system's reason, and no partial file remains."""

import resource
import signal
import subprocess
import unittest

from command import COMMAND, FAILED, SMALL, VIEW, CommandTest, room


def let_no_file_exceed(size):
    """Limits file sizes in the child process: a larger write fails like on a full disk."""

    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    return limit


class FullDisk(CommandTest):
    def assert_fails(self, name, *arguments, remaining=("room.mgf",)):
        result = subprocess.run(
            [COMMAND, *arguments],
            cwd=self.folder,
            capture_output=True,
            text=True,
            timeout=60,
            preexec_fn=let_no_file_exceed(1000),
            restore_signals=False,  # including SIGXFSZ
        )
        self.assertEqual(result.returncode, FAILED, result.stderr)
        self.assertRegex(result.stderr, f"error: cannot write '{name}': (HDF5: .*: |Seek error: )?File too large\n")
        self.assertEqual(self.files(), list(remaining))

    def test_pictures(self):
        self.write("room.mgf", room())
        for kind in ("png", "jpg", "hdr", "exr"):
            path = ("--shading", "path", "--size", "64x36", "--samples", "2")
            self.assert_fails(f"out.{kind}", "render", "room.mgf", "-o", f"out.{kind}", *VIEW, *path)

    def test_other_files(self):
        """All kinds of output: each is larger than the limit."""
        self.write("room.mgf", room())
        factors = ("viewfactors", "room.mgf", "--rays", "10k", "--groups", "facets")
        for name, *arguments in (
            ("out.csv", *factors),
            ("out.npz", *factors),
            ("out.csv", "probe", "room.mgf", "--shading", "path", "--plane", "0.8", "--samples", "4"),
            ("out.csv", "probe", "room.mgf", "--shading", "path", "--quantity", "ugr", "--plane", "0.8", "--samples", "4"),
            ("out.py", "export", "room.mgf"),
            ("out.mgf", "make-scene", "boxes", "--texture"),
        ):
            with self.subTest(name, arguments=arguments):
                self.assert_fails(name, *arguments, "-o", name)

    def test_files_of_a_solution(self):
        self.write("room.mgf", room())
        self.write_solution("room.h5", "room.mgf", *VIEW, "--rays", "20k")
        for name, *arguments in (
            ("out.glb", "export", "room.h5", "--shading", "smooth"),
            ("out.vtkhdf", "export", "room.h5"),
            ("out.html", "report", "room.h5", "--samples", "2", *SMALL[:2]),
        ):
            with self.subTest(name):
                self.assert_fails(name, *arguments, "-o", name, remaining=["room.h5", "room.mgf"])

    def test_solutions(self):
        self.write("room.mgf", room())
        self.assert_fails("out.h5", "solve", "room.mgf", "-o", "out.h5", "--rays", "20k", "--mesh-size", "none")

    def test_statistics_that_cannot_be_written_lose_no_solution(self):
        self.write("room.mgf", room())
        stats = ("--stats", "/dev/full")
        result = self.interflect("solve", "room.mgf", "-o", "out.h5", "--rays", "20k", *stats, exit_code=FAILED)
        self.assertIn("error: cannot write '/dev/full': No space left on device\n", result.stderr)
        self.assertEqual(self.files(), ["out.h5", "room.mgf"])
        self.interflect("render", "out.h5", "-o", "out.exr", *VIEW, *SMALL)


if __name__ == "__main__":
    unittest.main()
