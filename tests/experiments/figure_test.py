"""One complete experiment: a tiny Figure 3 of a maze of one room."""

import csv
import os
import signal
import struct
import subprocess
import unittest
import xml.etree.ElementTree

from command import ROOT, CommandTest

CONFIG = """
scene = "maze:1"
view = "--view room-0"
budgets = [20_000, 80_000]
seeds = [2, 1]
[[methods]]
name = "with importance"
options = "--method ihsrr --epsilon 1e-4"
[[methods]]
name = "without importance"
options = "--method hsrr --epsilon 1e-4"
[reference]
paths = 16
seed = 99
"""
RUNS = 2 * (2 + 1)


class Figure(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("tiny.toml", CONFIG)

    def start(self, *arguments, **environment):
        command = [ROOT / "experiments/run", "fig3-distance", "--config", "tiny.toml", "--out", "out", *arguments]
        return subprocess.Popen(
            command,
            cwd=self.folder,
            env=os.environ | environment,
            stdout=-1,
            stderr=-1,
            text=True,
            start_new_session=True,
        )

    def run_experiment(self, *arguments, exit_code=0, **environment):
        process = self.start(*arguments, **environment)
        output, messages = process.communicate(timeout=300)
        self.assertEqual(process.returncode, exit_code, output + messages)
        return messages

    def rows(self):
        with (self.folder / "out/results/fig3-distance.csv").open() as file:
            return list(csv.DictReader(file))

    def interrupt(self):
        """Interrupts the experiment after half of its runs."""
        process = self.start()
        seen = ""
        while f"[{RUNS // 2}/{RUNS}]" not in seen:
            line = process.stderr.readline()
            self.assertTrue(line, seen)
            seen += line
        self.assertIn(f"{RUNS} runs, 0 M rays: about ", seen)
        os.killpg(process.pid, signal.SIGINT)  # like a terminal
        _, messages = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, messages)
        self.assertIn("goes on from there", messages)
        self.assertNotIn("Traceback", messages)

    def test_an_interrupted_run_goes_on_to_results_and_figures(self):
        self.interrupt()
        self.assertRegex(self.run_experiment(), r"(?m)^[23] runs")
        rows = self.rows()
        self.assertEqual(len(rows), RUNS)
        for row in rows:
            self.assertEqual(row["rays"], row["budget"])
            self.assertEqual(row["version"], "0.2.0")
            self.assertIn(row["command"].split()[0:3], [["interflect", "solve", "maze:1"]])
            self.assertIn(f"--rays {row['rays']} --seed {row['seed']}", row["command"])
            self.assertEqual(row["reference"], "--shading path --no-mirrors --samples 16 --seed 99")
            self.assertTrue(0 < float(row["reference_noise"]) < 0.1, row["reference_noise"])
            self.assertRegex(row["machine"], r"\w.*, \d+ cores")
            self.assertGreater(int(row["threads"]), 0)
            self.assertGreater(float(row["seconds"]), 0)
            self.assertGreater(int(row["elements"]), 40)
            self.assertGreater(float(row["peak_mib"]), 5)
            self.assertLess(float(row["peak_mib"]), 2000)
            for metric in ("relative_mse", "perceptual_distance", "flip"):
                for shading in ("flat", "smooth"):
                    self.assertGreater(float(row[f"{metric}_{shading}"]), 0)
        errors = {int(row["rays"]): float(row["relative_mse_flat"]) for row in rows}
        self.assertLess(errors[80_000], errors[20_000])

        figures = self.folder / "out/figures"
        image = (figures / "fig3-distance.png").read_bytes()
        self.assertEqual(image[:8], b"\x89PNG\r\n\x1a\n")
        width, height = struct.unpack(">II", image[16:24])
        self.assertTrue(400 < height < width < 4000, (width, height))
        drawing = figures / "fig3-distance.svg"
        self.assertTrue(xml.etree.ElementTree.parse(drawing).getroot().tag.endswith("svg"))
        self.assertLess(drawing.stat().st_size, 300_000)
        table = (figures / "fig3-distance.md").read_text().splitlines()
        self.assertEqual(len(table), 2 + 4)
        self.assertEqual({line.count("|") for line in table}, {11})

        drawing.unlink()
        self.assertIn("Everything is there already", self.run_experiment())
        self.assertTrue(drawing.exists())
        drawing.unlink()
        self.run_experiment("--only-draw", INTERFLECT_COMMAND="/nowhere")  # needs no program
        self.assertEqual((figures / "fig3-distance.png").read_bytes(), image)
        self.assertTrue(drawing.exists())

    def test_without_the_program(self):
        messages = self.run_experiment(exit_code=1, INTERFLECT_COMMAND="/nowhere/interflect")
        self.assertIn("/nowhere/interflect is not there: build it with scripts/build", messages)
        self.assertNotIn("Traceback", messages)

    def test_without_matplotlib(self):
        self.write("none/matplotlib.py", "raise ModuleNotFoundError(name='matplotlib')")
        messages = self.run_experiment(exit_code=1, PYTHONPATH=str(self.folder / "none"))
        self.assertIn("matplotlib is missing: install it with scripts/setup", messages)

    def test_a_failing_run_is_told_with_its_command(self):
        self.write("tiny.toml", CONFIG.replace("--method ihsrr", "--method none-such"))
        messages = self.run_experiment(exit_code=1)
        self.assertIn("interflect solve maze:1", messages)
        self.assertIn("none-such", messages)
        self.assertNotIn("Traceback", messages)


if __name__ == "__main__":
    unittest.main()
