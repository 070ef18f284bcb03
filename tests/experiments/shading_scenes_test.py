"""The scenes of the audit of shadings: each kind is a valid scene, for any seed."""

import json
import sys
import unittest
from pathlib import Path

from command import ROOT, CommandTest

sys.path.insert(0, str(ROOT / "experiments"))

from lab import program
from shadings import page, pictures, scenes

# Kinds of findings of `validate`: harmless ones, and intended ones of a kind of scene.
HARMLESS = {"open-edge", "no-view"}
INTENDED = {"ies-and-sun": {"shut-out-sky"}}


class Kinds(CommandTest):
    def write_scene(self, name: str) -> Path:
        scene = scenes.make_scene(name)
        return scene.write(self.folder, name.replace("@", "-"), scene.text)

    def test_have_no_fault(self):
        for kind in scenes.KINDS:
            with self.subTest(kind):
                findings = self.json("validate", self.write_scene(kind))["findings"]
                self.assertLessEqual({f["kind"] for f in findings}, HARMLESS | INTENDED.get(kind, set()))

    def test_are_read_for_other_seeds(self):
        for kind in scenes.KINDS:
            with self.subTest(kind):
                path = self.write_scene(f"{kind}@another")
                self.interflect("info", path)
                self.assertNotEqual(path.read_text(), scenes.make_scene(kind).text)

    def test_show_something_that_is_lit(self):
        for kind in scenes.KINDS:
            with self.subTest(kind):
                scene = scenes.make_scene(f"{kind}@another")
                path = scene.write(self.folder, kind, scene.text)
                drawing = "--shading path --samples 4 --size 96x54 --layers -o picture.exr"
                run = self.interflect("render", path, *scene.view().split(), *drawing.split())
                finished = program.Finished("", run.stderr, 0, 0, 0)
                picture = pictures.read_picture(self.folder / "picture.exr", finished, True)
                reflected = picture.light > picture.emitted
                self.assertGreater(reflected.mean(), 0.2)  # a fifth of the picture
                self.assertGreater(picture.printed, 0)


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
