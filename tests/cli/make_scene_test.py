"""Scenes that are made: which files they replace, and which they do not."""

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


if __name__ == "__main__":
    unittest.main()
