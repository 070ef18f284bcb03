"""scripts/setup waits while another process holds the locks of apt, with a private folder of lists and no network."""

import fcntl
import os
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HELD = 2  # [s]


class Setup(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "lists/partial").mkdir(parents=True)
        self.program("id", "echo 0")
        self.program("dpkg-query", "exit 1")  # every package is missing
        config = self.folder / "apt.conf"
        config.write_text(
            f'Dir::State::lists "{self.folder}/lists";\nDir::Etc::sourcelist "/dev/null";\n'
            'Dir::Etc::sourceparts "/dev/null";\nDir::Cache "/dev/null";\n'
        )
        self.environment = os.environ | {"APT_CONFIG": str(config), "PATH": f"{self.folder}:{os.environ['PATH']}"}

    def program(self, name, command):
        path = self.folder / name
        path.write_text(f"#!/bin/sh\n{command}\n")
        path.chmod(0o755)

    def setup(self):
        return subprocess.run(
            [ROOT / "scripts/setup", "build"], env=self.environment, capture_output=True, text=True, timeout=60
        )

    def test_waits_for_the_lock_of_the_lists(self):
        self.program("apt-get", '[ "$1" = install ] || exec /usr/bin/apt-get "$@"')
        with (self.folder / "lists/lock").open("w") as lock:
            fcntl.lockf(lock, fcntl.LOCK_EX)
            threading.Timer(HELD, fcntl.lockf, (lock, fcntl.LOCK_UN)).start()
            start = time.monotonic()
            result = self.setup()
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertGreater(time.monotonic() - start, HELD)

    def test_lets_apt_wait_for_the_lock_of_dpkg(self):
        self.program("apt-get", 'echo "$@"')
        self.assertIn("-o DPkg::Lock::Timeout=600 ", self.setup().stdout)

    def test_other_failures_end_it_at_once(self):
        self.program("apt-get", "echo 'E: no network' >&2; exit 100")
        result = self.setup()
        self.assertEqual((result.returncode, result.stderr), (1, "E: no network\n"))


if __name__ == "__main__":
    unittest.main()
