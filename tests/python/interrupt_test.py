"""Ctrl-C ends long work soon, and the solver keeps its light."""

import os
import signal
import subprocess
import sys
import time
import unittest

SOLVE = """
import sys, interflect as ifl
from scenes import room
solver = ifl.Solver(room(), rays=1e12)
print("ready", flush=True)
try:
    solver.advance(progress=lambda now: None)
except KeyboardInterrupt:
    solution = solver.solution
    print("interrupted", solution.irradiance.max() > 0, solver.advance(rays=1000).rays > 0)
"""
RENDER = """
import sys, interflect as ifl
from scenes import room
print("ready", flush=True)
try:
    ifl.trace(room(), samples=100000)
except KeyboardInterrupt:
    print("interrupted")
"""

CONSTRUCT = """
import interflect as ifl
import numpy as np
random = np.random.default_rng(1)
shape = np.array([(0, 0, 0), (1, 0, 0.1), (1, 1, 0.2), (0, 1, 0.1)])
corners = (random.uniform(0, 1000, (800_000, 1, 3)) + shape).reshape(-1, 3)
scene = ifl.Scene(corners, np.arange(len(corners)).reshape(-1, 4), ifl.Material("leaf", exitance=1))
print("ready", flush=True)
try:
    ifl.Solver(scene)
except KeyboardInterrupt:
    print("interrupted")
"""


def interrupted(program: str) -> tuple[str, float]:
    """Returns the output and the seconds from Ctrl-C to the end."""
    path = os.pathsep.join([os.path.dirname(__file__), os.environ["PYTHONPATH"]])
    process = subprocess.Popen([sys.executable, "-B", "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               text=True, env={**os.environ, "PYTHONPATH": path})
    assert process.stdout.readline() == "ready\n"
    time.sleep(1)
    process.send_signal(signal.SIGINT)
    start = time.monotonic()
    output, errors = process.communicate(timeout=60)
    return output + errors, time.monotonic() - start


class CtrlC(unittest.TestCase):
    def test_of_a_solver_keeps_its_light(self):
        output, seconds = interrupted(SOLVE)
        self.assertEqual(output, "interrupted True True\n")
        self.assertLess(seconds, 20)  # usually 0.1; a machine may be busy

    def test_of_a_picture(self):
        output, seconds = interrupted(RENDER)
        self.assertEqual(output, "interrupted\n")
        self.assertLess(seconds, 20)

    def test_of_the_construction_of_a_solver(self):
        """Of 800,000 faces: most of the time goes to parallel loops without a monitor."""
        output, seconds = interrupted(CONSTRUCT)
        self.assertEqual(output, "interrupted\n")
        self.assertLess(seconds, 10)  # usually 1


if __name__ == "__main__":
    unittest.main()
