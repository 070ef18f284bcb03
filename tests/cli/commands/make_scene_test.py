"""Generated scenes: which existing files they may replace."""

import unittest

from command import BAD_INPUT, CommandTest


class MakeScene(CommandTest):
    OFFICE = ("make-scene", "office", "-o", "made.mgf", "--desk-rows", "1", "--desks-per-row", "1")

    def test_makes_the_same_again_over_its_own_files(self):
        self.interflect(*self.OFFICE)
        scene, views = self.bytes("made.mgf"), self.bytes("made.views.json")
        self.interflect(*self.OFFICE)
        self.assertEqual((self.bytes("made.mgf"), self.bytes("made.views.json")), (scene, views))
        self.assertEqual(self.files(), ["made.mgf", "made.views.json"])

    def test_replaces_other_views_only_when_forced(self):
        mine = '{"views": []}'
        self.write("made.views.json", mine)
        self.write("made.mgf", "# an earlier scene")
        result = self.interflect(*self.OFFICE, exit_code=BAD_INPUT)
        self.assertIn("made.views.json: has other views than the scene's: expected --force to replace them", result.stderr)
        self.assertEqual(self.bytes("made.views.json"), mine.encode())
        self.assertEqual(self.bytes("made.mgf"), b"# an earlier scene")
        self.assertEqual(self.files(), ["made.mgf", "made.views.json"])
        self.interflect(*self.OFFICE, "--force")
        self.assertIn(b"eye", self.bytes("made.views.json"))
        self.interflect("info", "made.mgf")

    def test_textures_are_seen_in_pictures(self):
        self.interflect("make-scene", "boxes", "--texture", "--boxes", "2", "-o", "b.mgf")
        images = [f"b.texture-{i}.png" for i in range(3)]
        self.assertEqual(self.files(), ["b.mgf", *images, "b.views.json"])
        self.assertEqual(self.json("info", "b.mgf")["warnings"], [])
        self.interflect("solve", "b.mgf", "-o", "b.h5", "--rays", "200k")
        view = ("--view", "room-0", "--size", "60x40", "--samples", "16")
        for name in images:  # the solution file contains them
            (self.folder / name).rename(self.folder / f"away-{name}")
        self.interflect("render", "b.h5", "-o", "solved.exr", *view)
        for name in images:
            (self.folder / f"away-{name}").rename(self.folder / name)
        self.interflect("render", "b.mgf", "-o", "traced.exr", "--shading", "path", *view)
        difference = self.json("compare", "solved.exr", "traced.exr")
        self.assertLess(abs(difference["ratio_of_means"] - 1), 0.03)

    def test_replaces_other_images_only_when_forced(self):
        boxes = ("make-scene", "boxes", "--texture", "-o", "b.mgf")
        self.interflect(*boxes)
        self.write("b.texture-1.png", "mine")
        result = self.interflect(*boxes, exit_code=BAD_INPUT)
        self.assertIn("b.texture-1.png: has other texels than the scene's: expected --force to replace them", result.stderr)
        self.assertEqual(self.bytes("b.texture-1.png"), b"mine")
        self.interflect(*boxes, "--force")
        self.interflect("info", "b.mgf")


if __name__ == "__main__":
    unittest.main()
