"""Memory: constant over many solvers, and large arrays are not copied."""

import gc
import os
import resource
import subprocess
import sys
import unittest

import numpy as np

import interflect as ifl
from scenes import room

MIB = 1 << 20


def resident() -> int:
    """Memory of this process [bytes]."""
    with open("/proc/self/statm", encoding="ascii") as statm:
        return int(statm.read().split()[1]) * resource.getpagesize()


class Memory(unittest.TestCase):
    def test_is_constant_over_hundreds_of_solvers(self):
        """Each keeps its scene, ray caster, mesh and a solution with arrays: a leak of one solver costs more than 100 kB."""
        scene = room()

        def make(count):
            for seed in range(count):
                solver = ifl.Solver(scene, views="door", rays=1e4, seed=seed)
                solver.advance(rays=1000)
                solver.solution.irradiance, solver.solution.elements.irradiance, solver.scene.vertices
                if seed % 2:
                    solver.close()

        make(100)
        gc.collect()
        before = resident()
        make(300)
        gc.collect()
        self.assertLess(resident() - before, 3 * MIB)

    def test_of_scenes_is_not_copied(self):
        """A million vertices have 12 MB, half a million faces 16 MB."""
        n = 1000
        x, y = np.meshgrid(np.arange(n, dtype=np.float32), np.arange(n, dtype=np.float32))
        corner = (np.arange(n - 1)[:, None] * n + np.arange(0, n - 1, 2)[None]).ravel()
        faces = np.stack([corner, corner + 1, corner + n + 1, corner + n], axis=1)
        scene = ifl.Scene(np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1), faces, ifl.Material("floor", 0.5))
        before = resident()
        views = [(scene.vertices, scene.faces, scene.face_materials) for _ in range(100)]
        self.assertLess(resident() - before, 2 * MIB)
        self.assertEqual(views[99][0].shape, (n * n, 3))

    def test_of_solutions_is_not_copied(self):
        """The first request makes the mesh of the leaves; further ones, pictures of it and the raw arrays cost nothing."""
        solution = ifl.solve(room(), rays=2e6, min_area=1e-5, mesh_size=0.01)
        self.assertGreater(len(solution), 100_000)
        before = resident()
        solution.irradiance
        self.assertLess(resident() - before, 170 * len(solution))
        before = resident()
        views = [(solution.irradiance, solution.vertices, solution.area, solution.elements.irradiance) for _ in range(100)]
        self.assertLess(resident() - before, 2 * MIB)
        self.assertEqual(len(views), 100)

    def test_of_the_machine_limits_refinement(self):
        """An address space of 4 GB has room for fewer elements than the default limit."""
        code = "import interflect as ifl; from scenes import room; print(ifl.Solver(room()).options['max_elements'])"
        path = os.pathsep.join([os.path.dirname(__file__), os.environ["PYTHONPATH"]])
        limit = 4 << 30
        printed = subprocess.run([sys.executable, "-B", "-c", code], env={**os.environ, "PYTHONPATH": path}, check=True,
                                 text=True, capture_output=True,
                                 preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit))).stdout
        self.assertLess(int(printed), limit // 100)
        self.assertGreater(int(printed), 1_000_000)


if __name__ == "__main__":
    unittest.main()
