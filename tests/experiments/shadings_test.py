"""The audit of shadings: each kind of scene is valid for any seed, and a small audit measures every run."""

import dataclasses
import os
import sys
import unittest
from pathlib import Path
from unittest import mock

from command import ROOT, CommandTest

sys.path.insert(0, str(ROOT / "experiments"))

from lab import program
from shadings import bench, page, pictures, scenes
from shadings.bench import MITSUBA, Bench
from shadings.runs import BAKES, Scale, picture_runs

# Kinds of findings of `validate`: harmless ones, and intended ones of a kind of scene.
HARMLESS = {"open-edge", "no-view"}
INTENDED = {"ies-and-sun": {"shut-out-sky"}, "corner-normals": {"contradicting-normals"}}


class Kinds(CommandTest):
    def write_scene(self, name: str) -> Path:
        scene = scenes.make_scene(name)
        return scene.write(self.folder, name.replace("@", "-"), scene.text)

    def test_have_no_fault(self):
        for kind in scenes.KINDS:
            with self.subTest(kind):
                # It solves for a second, on one thread.
                findings = self.json("validate", self.write_scene(kind), "--threads", "1")["findings"]
                self.assertLessEqual({f["kind"] for f in findings}, HARMLESS | INTENDED.get(kind, set()))

    def test_of_other_seeds_are_other_scenes_and_show_something_that_is_lit(self):
        for kind in scenes.KINDS:
            with self.subTest(kind):
                scene = scenes.make_scene(f"{kind}@another")
                self.assertNotEqual(scene.text, scenes.make_scene(kind).text)
                path = scene.write(self.folder, kind, scene.text)
                drawing = "--shading path --samples 4 --size 96x54 --layers -o picture.exr"
                run = self.interflect("render", path, *scene.view().split(), *drawing.split())
                finished = program.Finished("", run.stderr, 0, 0, 0)
                picture = pictures.read_picture(self.folder / "picture.exr", finished, True)
                reflected = picture.light > picture.emitted
                self.assertGreater(reflected.mean(), 0.2)  # a fifth of the picture
                self.assertGreater(picture.printed, 0)


# With few texels, because each takes light of its own.
SMALL_BAKES = [
    dataclasses.replace(run, options=run.options.replace("--lightmap", "--lightmap --texels-per-metre 4")) for run in BAKES
]


class Audit(CommandTest):
    SMALL = Scale((48, 27), 8, 4, 4, "--rays 20k", "20k", 1, 60, 8)

    def audit(self) -> list[dict]:
        """Measures a scene and returns the rows of the table."""
        table = self.folder / "table.csv"
        Bench(program.find_program(), self.SMALL, self.folder / "cache", table).measure("two-lamps")
        return page.read_rows(table)

    @mock.patch.object(bench, "BAKES", SMALL_BAKES)
    def test_a_row_for_every_run(self):
        os.environ.pop(MITSUBA, None)
        rows = {row["run"]: row for row in self.audit()}
        runs = picture_runs(self.SMALL) + SMALL_BAKES
        self.assertEqual(list(rows), [run.name for run in runs])
        self.assertIn(MITSUBA, rows.pop("mitsuba")["failure"])
        for run in runs:
            if run.name in rows:
                row = rows[run.name]
                self.assertEqual(row["failure"], "", run.name)
                self.assertAlmostEqual(row["mean"], 1, delta=0.3, msg=run.name)  # wrong units differ by more
                self.assertEqual(run.stated, row["stated"] > 0, run.name)
        # Only failures are measured again.
        written = {file: file.stat().st_mtime_ns for file in (self.folder / "cache").iterdir()}
        again = {row["run"]: row for row in self.audit()}
        self.assertEqual(again.pop("mitsuba")["failure"][:12], "not measured")
        seconds = lambda table: {run: row["seconds"] for run, row in table.items()}
        self.assertEqual(seconds(again), seconds(rows))
        self.assertEqual(written, {file: file.stat().st_mtime_ns for file in (self.folder / "cache").iterdir()})
        page.write_page(self.folder / "table.csv", self.folder / "table.md")
        self.assertEqual(len((self.folder / "table.md").read_text().splitlines()), 2 + len(runs))


class Names(unittest.TestCase):
    def test_the_seed_determines_the_scene(self):
        first, again, other = (scenes.make_scene(name).text for name in ("crate@1a", "crate@1a", "crate@1b"))
        self.assertEqual(first, again)
        self.assertNotEqual(first, other)

    def test_ten_kinds_are_drawn(self):
        drawn = scenes.drawn_scenes("0123456789ab")
        self.assertEqual(drawn, scenes.drawn_scenes("0123456789ab"))
        self.assertNotEqual(drawn, scenes.drawn_scenes("ba9876543210"))
        self.assertEqual(len({name.partition("@")[0] for name in drawn}), 10)
        self.assertEqual({name.partition("@")[2] for name in drawn}, {"0123456789ab"})
        self.assertEqual(sorted(drawn + ["two-lamps"], key=page.order_of)[0], "two-lamps")


if __name__ == "__main__":
    unittest.main()
