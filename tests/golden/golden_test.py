"""Compares the office with approved pictures. README.md beside this file explains the tolerances."""

import shutil
import unittest

from command import BAD_INPUT, ROOT, CommandTest

REFERENCE = ROOT / "tests" / "golden" / "office-desk.hdr"
OFFICE = ROOT / "scenes" / "office.mgf"
RATIO_OF_MEANS, BLOCKS_OF_5 = 0.01, 0.03  # tolerances: of the mean, of relative RMSE


class Golden(CommandTest):
    def difference(self, scene=OFFICE, view="desk", seed=1, rays="6M"):
        picture = ("--view", view, "--size", "160x90", "--shading", "smooth")
        self.interflect("render", scene, "-o", "out.exr", *picture, "--rays", rays, "--seed", seed)
        difference = self.json("compare", "out.exr", REFERENCE)
        self.assertEqual(difference["non_finite_pixels"], 0)
        (blocks,) = (b["trimmed_relative_rmse"] for b in difference["blocks"] if b["block"] == 5)
        return abs(difference["ratio_of_means"] - 1), blocks

    def changed_office(self, old, new):
        """Returns a copy of the scene with one line of its materials replaced."""
        folder = self.folder / "scenes"
        shutil.copytree(OFFICE.parent, folder)
        materials = folder / "furniture" / "materials.mgf"
        text = materials.read_text()
        self.assertEqual(text.count(old), 1, old)
        materials.write_text(text.replace(old, new))
        return folder / OFFICE.name

    def assert_within_tolerance(self, difference):
        mean, blocks = difference
        self.assertLess(mean, RATIO_OF_MEANS)
        self.assertLess(blocks, BLOCKS_OF_5)

    def assert_noticed(self, difference):
        mean, blocks = difference
        self.assertTrue(mean > RATIO_OF_MEANS or blocks > BLOCKS_OF_5, difference)

    def test_office(self):
        self.assert_within_tolerance(self.difference())

    def test_office_from_other_rays(self):
        self.assert_within_tolerance(self.difference(seed=2))

    # Negative controls:

    def test_another_view_is_noticed(self):
        _, blocks = self.difference(view="bookcase", rays="600k")  # the noise of these is 0.06 in blocks
        self.assertGreater(blocks, 10 * BLOCKS_OF_5)

    def test_panels_a_tenth_dimmer_are_noticed(self):
        self.assert_noticed(self.difference(self.changed_office("ed 8500", "ed 7650")))

    def test_walls_that_reflect_a_little_less_are_noticed(self):
        self.assert_noticed(self.difference(self.changed_office("rd .76", "rd .72")))

    def test_a_missing_reference_is_an_error(self):
        self.interflect("compare", REFERENCE, self.folder / REFERENCE.name, exit_code=BAD_INPUT)


if __name__ == "__main__":
    unittest.main()
