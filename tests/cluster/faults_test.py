"""Faults of one process of mpirun: one error, the end of all, and a checkpoint that fewer processes can resume."""

import os
import signal
import time
import unittest

from command import COMMAND, FAILED, VIEW
from mpirun import RanksTest, processes_of, solve, with_checkpoints

HOST = os.uname().nodename
REMEDY = "all processes end; `interflect resume run.h5` goes on from the last checkpoint"


class Faults(RanksTest):
    def messages_after(self, number, victim):
        """Returns the messages after this signal to the process of rank `victim`, of three."""
        process = self.start(3, *with_checkpoints("2M"))
        self.wait_for_file("run.h5", process)
        self.wait_for_file("run.previous.h5", process)  # so the others have heard of the first one
        processes = processes_of(process)
        os.kill(processes[victim], number)
        return self.end_of(process, processes.values())

    def test_a_death_is_reported_once_and_fewer_go_on(self):
        self.interflect(*solve("2M"), "-o", "alone.h5")
        messages = self.messages_after(signal.SIGKILL, 0)
        self.assertEqual(messages.count("error: "), 1, messages)
        self.assertIn(f"error: process 0 on {HOST} has ended unexpectedly", messages)
        self.assertIn(REMEDY, messages)
        code, messages = self.run_ranks(2, "resume", "run.h5", "-o", "resumed.h5")
        self.assertEqual(code, 0, messages)
        self.assertEqual(self.bytes("resumed.h5"), self.bytes("alone.h5"))
        self.assertEqual(self.files(), ["alone.h5", "resumed.h5", "room.mgf", "run.h5", "run.previous.h5"])

    def test_a_stopped_process_is_reported_once(self):
        messages = self.messages_after(signal.SIGSTOP, 1)
        self.assertEqual(messages.count("error: "), 1, messages)
        self.assertIn(f"error: process 1 on {HOST} has not answered", messages)
        self.assertIn(REMEDY, messages)

    def test_a_process_that_stops_before_its_heartbeat_is_reported(self):
        stopped = ("-x", f"LD_PRELOAD={os.environ['INTERFLECT_STOPPED_START']}")
        process = self.start_programs(*stopped, "-n", "3", COMMAND, *solve("2M"), "-o", "out.h5")
        messages = self.end_of(process, [])  # of two processes: mpirun is slow beside their fast clock
        self.assertIn("error: not all processes have started within a minute: one is stopped", messages)
        self.assertEqual(self.files(), ["room.mgf"])

    def test_a_death_while_drawing_leaves_no_picture(self):
        picture = ("--shading", "path", "--size", "64x48", "--samples", "65536", "-o", "long.exr")
        process = self.start(3, "render", "room.mgf", *VIEW, *picture)
        time.sleep(2)
        self.assertIsNone(process.poll(), "ended before it was killed")
        processes = processes_of(process)
        os.kill(processes[2], signal.SIGKILL)
        self.end_of(process, processes.values())
        self.assertEqual(self.files(), ["room.mgf"])

    def test_lack_of_memory_is_reported_with_its_process(self):
        """A shell limits the address space of the second process: enough to start, too little for this mesh."""
        limited = 'if [ "$OMPI_COMM_WORLD_RANK" = 1 ]; then ulimit -v 700000; fi; exec "$@"'
        run = ("solve", "room.mgf", "--rays", "3M", "--mesh-size", "0.01", "--threads", "1", "-o", "out.h5")
        process = self.start_programs("-n", "2", "sh", "-c", limited, "sh", COMMAND, *run)
        _, messages = process.communicate()
        self.assertEqual(process.returncode, FAILED)
        self.assertEqual(messages.count("error: "), 1, messages)
        self.assertRegex(messages, f"error: process 1 on {HOST}: .*(enough memory|address space)")


if __name__ == "__main__":
    unittest.main()
