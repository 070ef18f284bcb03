"""Solving step by step: the same light as in one call, arrays that stay, threads, and solvers that are closed."""

import gc
import tempfile
import threading
import unittest
from pathlib import Path

import numpy as np

import interflect as ifl
from scenes import CORNERS, LAMP, LIGHT, PAINT, VIEW, WALLS, furnace, room

RAYS = 200_000


class Light(unittest.TestCase):
    def test_of_a_furnace_is_exact(self):
        """H = M / (1 - rho) everywhere. 5 standard errors: correct code fails once in 1.7 million runs."""
        solution = ifl.solve(furnace(0.5, 100), rays=2e6, seed=3)
        mean = np.average(solution.irradiance[:, 1], weights=solution.area)
        self.assertAlmostEqual(mean, 200, delta=5 * np.sqrt(np.sum((solution.standard_error * solution.area) ** 2)) / 6)
        self.assertLess(5 * np.sqrt(np.sum((solution.standard_error * solution.area) ** 2)) / 6, 2)  # 1%: a lost rho is 50%

    def test_escapes_through_the_missing_faces_alone(self):
        """The open side of a black cube receives 20% of the light of each wall; 5 standard errors are 0.008."""
        closed = ifl.solve(furnace(0, 100), rays=1000).find_escapes()
        self.assertEqual((closed.rays, closed.escaped, closed.share, closed.is_leak), (65536, 0, 0, False))
        cube = furnace(0, 100)
        open_cube = ifl.Scene(cube.vertices, cube.faces[:5], cube.materials, name="open cube")
        self.assertAlmostEqual(ifl.solve(open_cube, rays=1000).find_escapes().share, 0.2, delta=0.008)

    def test_one_way_light_is_that_of_a_one_sided_sheet(self):
        """The front of a sheet below the lamp stops its light, although the floor sees the lamp through the back."""
        corners = np.vstack([CORNERS, LAMP, LAMP - (0, 0, 0.5)])
        faces = np.vstack([WALLS, [(8, 9, 10, 11), (15, 14, 13, 12)]])

        def light(two_sided):
            scene = ifl.Scene(corners, faces, [PAINT, LIGHT], face_materials=[0] * 6 + [1, 0], two_sided=two_sided)
            return ifl.solve(scene, rays=RAYS).find_one_way_light()

        self.assertLess(light(False).share, -0.1)
        self.assertEqual(light(True).share, 0)

    def test_same_seed_same_bits(self):
        one = ifl.solve(room(), view="door", rays=RAYS, threads=1)
        other = ifl.solve(room(), views=[VIEW], rays=RAYS, threads=3)
        np.testing.assert_array_equal(one.irradiance, other.irradiance)
        np.testing.assert_array_equal(one.vertices, other.vertices)
        self.assertFalse(np.array_equal(one.irradiance[:7], ifl.solve(room(), view="door", rays=RAYS, seed=2).irradiance[:7]))

    def test_steps_give_the_bits_of_one_call(self):
        with ifl.Solver(room(), views="door", rays=RAYS) as solver:
            while not solver.advance(rays=20_000).is_finished:
                solver.solution  # noqa: B018 - must not matter
            np.testing.assert_array_equal(solver.solution.irradiance,
                                          ifl.solve(room(), view="door", rays=RAYS).irradiance)

    def test_save_and_open_continue_with_the_same_bits(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "run.h5"
            solver = ifl.Solver(room(), views="door", rays=RAYS)
            solver.advance(rays=50_000)
            solver.save(path)
            again = ifl.Solver.open(path)
            while not solver.advance().is_finished or not again.advance().is_finished:
                pass
            np.testing.assert_array_equal(solver.solution.irradiance, again.solution.irradiance)
            solver.solution.save(path)
            read = ifl.Solution.open(path)
            np.testing.assert_array_equal(read.irradiance, solver.solution.irradiance)
            self.assertEqual(read.options["method"], "ihsrr")

    def test_files_that_cannot_be_written_are_named(self):
        solution = ifl.solve(room(), rays=1000)
        for call in (lambda: solution.save("/nowhere/light.h5"), lambda: ifl.Solver(room()).save("/nowhere/run.h5")):
            with self.assertRaisesRegex(ifl.Error, "/nowhere"):
                call()

    def test_groups_are_dimmed(self):
        scene = room(light_groups=[ifl.LightGroup("lamp", "light")])
        solution = ifl.solve(scene, rays=RAYS)
        half = solution.dim("lamp", 0.5)
        np.testing.assert_allclose(half.irradiance, solution.irradiance / 2, rtol=1e-6)
        solver = ifl.Solver(scene, rays=RAYS)
        solver.advance()
        solver.set_dimming("lamp", 0)
        self.assertEqual(solver.solution.irradiance.max(), 0)
        for factors in ({3: 1}, {"lamp": "half"}):
            with self.assertRaisesRegex(TypeError, r"dim: expected Dict\[str, float\], found {"):
                solution.dim(factors)
        with self.assertRaises(ifl.InputError) as raised:
            solver.set_dimming("lamb", 1)
        self.assertEqual(raised.exception.object, "lamb")

    def test_settings_are_checked(self):
        for error, settings in ((TypeError, {"ray": 5}), (TypeError, {"rays": "many"}), (ifl.InputError, {"rays": 0}),
                                (ifl.InputError, {"rays": 1.5}), (ifl.InputError, {"rays": float("nan")}),
                                (ifl.InputError, {"until": 2}), (ifl.InputError, {"method": "magic"}),
                                (TypeError, {"shrinkage": 1}), (TypeError, {"epsilon": "small"}),
                                (ifl.InputError, {"importance": "some"}), (TypeError, {"views": [None]}),
                                (ifl.InputError, {"threads": -1}), (TypeError, {"view": "door", "views": "door"})):
            with self.subTest(settings), self.assertRaises(error):
                ifl.solve(room(), **settings)
        for settings, expected in (({"method": 3}, "method: expected str, found 3"),
                                   ({"method": "\ud800"}, r"method: expected str, found '\\ud800'"),
                                   ({"importance": "\ud800"}, "importance: expected a word"),
                                   ({"views": "\ud800"}, "view: expected str")):
            with self.subTest(settings), self.assertRaisesRegex(TypeError, expected):
                ifl.Solver(room(), **settings)
        with self.assertRaises(ifl.InputError) as raised:
            ifl.Solver(room(), alpha=2, beta=-1)
        self.assertEqual([fault.setting for fault in raised.exception.faults], ["alpha", "beta"])

    def test_settings_are_kept(self):
        solver = ifl.Solver(room(), views=[ifl.WeightedView(VIEW, 2, 1.5, 100)], rays=1e5, seed=7, epsilon=1e-6,
                            one_bounce=True, keep_direct=False, max_elements=5000)
        for name, value in {"rays": 100_000, "seed": 7, "epsilon": 1e-6, "one_bounce": True, "max_elements": 5000}.items():
            self.assertEqual(solver.options[name], value)
        self.assertEqual(solver.views, [ifl.WeightedView(VIEW, 2, 1.5, 100)])


class Arrays(unittest.TestCase):
    NAMES = ("irradiance", "direct", "importance", "standard_error", "discretisation_error", "level", "area", "patch",
             "vertices", "element", "vertex_count")

    def test_are_read_only_views_of_one_row_per_leaf(self):
        solution = ifl.solve(room(), view="door", rays=RAYS)
        for name in self.NAMES:
            array = getattr(solution, name)
            self.assertEqual(len(array), len(solution), name)
            self.assertFalse(array.flags.writeable or array.flags.owndata, name)
            self.assertTrue(np.shares_memory(array, getattr(solution, name)), name)
        self.assertEqual(solution.irradiance.dtype, np.float32)
        self.assertEqual(solution.vertices.shape, (len(solution), 4, 3))
        np.testing.assert_array_equal(solution.elements.irradiance[solution.element], solution.irradiance)
        self.assertAlmostEqual(solution.area.sum(), 2 * 2 * 3 + 2 * 2.5 * (2 + 3) + 1, places=4)

    def test_stay_when_the_solver_goes_on_and_is_gone(self):
        solver = ifl.Solver(room(), views="door", rays=RAYS)
        solver.advance(rays=20_000)
        arrays = {name: getattr(solver.solution, name) for name in self.NAMES}
        of_elements = solver.solution.elements.irradiance
        before = {name: array.copy() for name, array in arrays.items()}, of_elements.copy()
        solver.advance()
        solver.close()
        del solver
        gc.collect()
        ifl.solve(room(), rays=RAYS)  # would reuse the memory
        for name, array in arrays.items():
            np.testing.assert_array_equal(array, before[0][name], name)
        np.testing.assert_array_equal(of_elements, before[1])


class Closed(unittest.TestCase):
    def test_taking_the_solution_closes(self):
        solver = ifl.Solver(room(), views="door", rays=RAYS)
        solver.advance()
        kept = solver.solution.irradiance
        np.testing.assert_array_equal(solver.take_solution().irradiance, kept)
        self.assertRaises(ifl.Error, solver.advance)

    def test_solvers_refuse_calls(self):
        solver = ifl.Solver(room(), rays=RAYS)
        solver.advance()
        solution = solver.solution
        solver.close()
        solver.close()
        for call in (solver.advance, lambda: solver.solution, lambda: solver.save("x.h5"), lambda: solver.scene,
                     lambda: solver.set_views(None), lambda: solver.options):
            with self.assertRaisesRegex(ifl.Error, "the solver is closed"):
                call()
        self.assertIn("closed", repr(solver))
        self.assertGreater(solution.irradiance.max(), 0)


class Threads(unittest.TestCase):
    def test_python_runs_while_rays_are_traced(self):
        """Without the release of the lock, the counter would stand still."""
        solver = ifl.Solver(room(), rays=1e9)
        counted, done = [0], threading.Event()

        def count():
            while not done.is_set():
                counted[0] += 1
                done.wait(0.001)

        counter = threading.Thread(target=count)
        counter.start()
        solver.advance(time=0.5)
        done.set()
        counter.join()
        self.assertGreater(counted[0], 20)

    def test_solvers_of_several_threads_have_the_bits_of_one(self):
        expected = [ifl.solve(room(), view="door", rays=RAYS, seed=seed).irradiance for seed in range(1, 5)]
        found = [None] * 4

        def work(i):
            found[i] = ifl.solve(room(), view="door", rays=RAYS, seed=i + 1).irradiance

        threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for a, b in zip(expected, found):
            np.testing.assert_array_equal(a, b)

    def test_one_solver_serves_one_thread(self):
        solver = ifl.Solver(room(), rays=1e9)
        errors = []

        def interfere(_):
            for call in (solver.advance, solver.close, lambda: solver.solution):
                try:
                    call()
                except ifl.Error as error:
                    errors.append(str(error))

        solver.advance(time=0.2, progress=interfere)
        self.assertGreaterEqual(len(errors), 3)
        self.assertEqual({error.split(" by")[0] for error in errors}, {"the solver is in use"})
        self.assertGreater(solver.solution.irradiance.max(), 0)


class Progress(unittest.TestCase):
    def test_is_reported(self):
        seen = []
        ifl.solve(room(), view="door", rays=2e6, progress=lambda now: seen.append((now.rays, now.fraction)))
        self.assertTrue(seen)
        self.assertEqual(seen, sorted(seen))
        self.assertEqual(seen[-1], (2_000_000, 1.0))

    def test_functions_may_fail(self):
        def fail(_):
            raise KeyError("progress")

        solver = ifl.Solver(room(), rays=1e9)
        with self.assertRaises(KeyError):
            solver.advance(progress=fail)
        self.assertGreater(solver.advance(rays=10_000).rays, 0)


if __name__ == "__main__":
    unittest.main()
