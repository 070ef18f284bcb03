"""The runs that the experiments' files define, and their order."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "experiments"))

from lab import experiment, work
from lab.tasks import Entry, Measure, Picture, Reference, Solve, ladder, probe, reference_of

REFERENCE = Solve("maze:1", "--view room-0", "--method hwdrs", 5_000_000, 99)
CONFIG = {"scene": "maze:1", "view": "--view room-0", "budgets": [1000, 4000], "seeds": [2, 1]}


class Ladder(unittest.TestCase):
    def test_a_run_for_every_seed_of_every_budget(self):
        entries = ladder(CONFIG, [{"name": "a", "options": "--method ihsrr"}], REFERENCE)
        self.assertEqual([entry.series for entry in entries], ["a", "a", "a"])
        self.assertEqual([(e.task.solve.rays, e.task.solve.seed) for e in entries], [(1000, 1), (1000, 2), (4000, 1)])
        self.assertEqual({entry.task.reference for entry in entries}, {REFERENCE})

    def test_iterations_share_the_rays(self):
        entries = ladder(CONFIG, [{"name": "a", "options": "--method srr", "iterations": 100}], REFERENCE)
        self.assertEqual(entries[-1].task.solve.options, "--method srr --rays-per-iteration 40")

    def test_each_budget_needs_its_number_of_seeds(self):
        with self.assertRaises(ValueError):
            ladder(CONFIG | {"seeds": [2]}, [{"name": "a", "options": ""}], REFERENCE)


class Order(unittest.TestCase):
    def test_references_come_first_and_nothing_is_done_twice(self):
        solve = Solve("maze:1", "--view room-0", "--method ihsrr", 1000, 1)
        picture = Picture(solve, solve.view, "--shading smooth")
        measure = Measure(solve, solve.view, REFERENCE)
        groups = work.by_solution(work.with_references([picture, measure, picture, measure]))
        self.assertEqual(list(groups), [REFERENCE, solve])
        self.assertEqual(groups[REFERENCE], [probe(REFERENCE, solve.view, shading) for shading in ("flat", "smooth")])
        self.assertEqual(groups[solve], [picture, measure])

    def test_path_traced_references_need_no_solution(self):
        traced = reference_of(CONFIG | {"reference": {"paths": 64, "seed": 99}})
        self.assertEqual(traced, Reference("maze:1", "--view room-0", 64, 99))
        solve = Solve("maze:1", "--view room-0", "--method ihsrr", 1000, 1)
        tasks = work.with_references([Measure(solve, solve.view, traced)] * 2)
        self.assertEqual(tasks, [traced, Measure(solve, solve.view, traced)])
        self.assertEqual(list(work.by_solution(tasks)), [solve])


class Configuration(unittest.TestCase):
    TEXT = 'view = "a"\nbudgets = [1, 2]\n[reference]\nrays = 9\nseed = 3\n[quick]\nbudgets = [1]\nreference.rays = 4\n'

    def read(self, quick):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "a.toml")
            path.write_text(self.TEXT)
            return experiment.read_config(path, quick)

    def test_quick_lies_over_the_rest(self):
        self.assertEqual(self.read(True), {"view": "a", "budgets": [1], "reference": {"rays": 4, "seed": 3}})
        self.assertEqual(self.read(False), {"view": "a", "budgets": [1, 2], "reference": {"rays": 9, "seed": 3}})

    def test_the_paper_at_its_own_scale(self):
        """110 million rays a method, 433 million for the reference; at least 5 seeds for the lower budgets."""
        entries = {name: experiment.Experiment(name).entries for name in experiment.PAPER}
        self.assertEqual(entries["fig1-reference"][0].task.solve.rays, 433_000_000)
        self.assertEqual({entry.task.solve.rays for entry in entries["fig2-equal-rays"]}, {110_000_000})
        runs = [entry.task.solve for entry in entries["fig3-distance"] if entry.series == "with importance"]
        self.assertEqual(max(run.rays for run in runs), 110_000_000)
        self.assertEqual(sum(run.rays == 1_100_000 for run in runs), 5)
        variants = {e.series for e in entries["fig5-variants"] if "program" not in e.series}
        of_the_paper = {"si", "si+dr", "si+hi", "si+dr+hi", "ci", "ci+dr", "ci+hi", "ci+dr+hi"}
        self.assertEqual(variants, of_the_paper | {"without importance"})

    def test_quick_is_less_in_every_experiment(self):
        for name in experiment.PAPER + experiment.BEYOND:
            full, quick = (self.rays(experiment.Experiment(name, quick=quick).entries) for quick in (False, True))
            self.assertLessEqual(quick, full / 3, name)

    def test_a_plan_writes_nothing(self):
        """Python reports each file that is opened. An experiment without a list of runs refuses to make a plan."""
        watch = (
            "import runpy, sys\n"
            "def report(event, arguments):\n"
            "    if event == 'open' and set(str(arguments[1])) & set('wax+') or event in ('os.mkdir', 'os.rename'):\n"
            "        print('wrote', arguments[0], file=sys.stderr)\n"
            "import matplotlib.font_manager, matplotlib.pyplot\n"
            "sys.argv = sys.argv[1:]\n"
            "sys.path.insert(0, sys.argv[0].rpartition('/')[0])\n"
            "sys.addaudithook(report)\n"
            "runpy.run_path(sys.argv[0], run_name='__main__')\n"
        )
        for name, code in (("all", 0), ("pictures", 2), ("acceptance", 2), ("audit", 2)):
            command = [sys.executable, "-B", "-c", watch, str(ROOT / "experiments/run"), name, "--plan"]
            result = subprocess.run(command, capture_output=True, text=True, timeout=60)
            self.assertEqual(result.returncode, code, result.stderr)
            self.assertNotIn("wrote", result.stderr)

    def rays(self, entries: list[Entry]) -> int:
        return sum(solve.rays for solve in work.by_solution(work.with_references(e.task for e in entries)))


if __name__ == "__main__":
    unittest.main()
