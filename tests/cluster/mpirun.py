"""Runs of the command under mpirun, for tests."""

import os
import subprocess
import time
from pathlib import Path

from command import COMMAND, VIEW, CommandTest, room

MPIRUN = ("mpirun", "--oversubscribe", "--bind-to", "none")
ENVIRONMENT = os.environ | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
MOST_SECONDS = 10  # from a fault to the end of all processes


def solve(rays):
    return ("solve", "room.mgf", *VIEW, "--rays", rays, "--mesh-size", "0.5")


def with_checkpoints(rays):
    return (*solve(rays), "-o", "shared.h5", "--checkpoint", "run.h5", "--every", "0.1s")


def is_alive(process: int) -> bool:
    """Returns False for zombies too: the new parent of an orphan may reap it late or never."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False


def rank_of(process: int) -> int | None:
    """Returns None before mpirun has started the command in this process."""
    try:
        variables = Path(f"/proc/{process}/environ").read_bytes().split(b"\0")
    except OSError:
        return None
    ranks = [int(v.partition(b"=")[2]) for v in variables if v.startswith(b"OMPI_COMM_WORLD_RANK=")]
    return ranks[0] if ranks else None


def processes_of(launcher: subprocess.Popen) -> dict[int, int]:
    """Returns the processes of mpirun by rank."""
    found = subprocess.run(["pgrep", "-P", str(launcher.pid)], capture_output=True, text=True).stdout.split()
    return {rank: process for process in map(int, found) if (rank := rank_of(process)) is not None}


class RanksTest(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())

    def start(self, ranks, *arguments):
        return self.start_programs("-n", str(ranks), COMMAND, *arguments)

    def start_programs(self, *words):
        return subprocess.Popen(
            [*MPIRUN, *words],
            cwd=self.folder, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )

    def run_ranks(self, ranks, *arguments):
        process = self.start(ranks, *arguments)
        _, messages = process.communicate()
        return process.returncode, messages

    def wait_for_file(self, name, process):
        while not (self.folder / name).exists():
            self.assertIsNone(process.poll(), f"ended before there was {name}")
            time.sleep(0.01)

    def end_of(self, launcher, processes):
        """Waits for the end after a fault; fails if it takes too long. Returns the messages."""
        try:
            _, messages = launcher.communicate(timeout=MOST_SECONDS)
        finally:
            launcher.kill()
        self.assertNotEqual(launcher.returncode, 0)
        # mpirun may end before the system has removed the processes that it killed.
        end = time.monotonic() + 5
        while (alive := [p for p in processes if is_alive(p)]) and time.monotonic() < end:
            time.sleep(0.05)
        self.assertEqual(alive, [])
        return messages
