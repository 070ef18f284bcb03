"""`compare` as a script uses it."""

import unittest

from command import BAD_INPUT, LARGE, SMALL, VIEW, CommandTest, room


class Compare(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())
        self.interflect("solve", "room.mgf", "-o", "room.h5", "--rays", "100k", "--mesh-size", "0.5")

    def render(self, name, size=SMALL):
        self.interflect("render", "room.h5", "-o", name, *VIEW, *size)

    def test_equal_pictures(self):
        for kind in ("exr", "hdr", "png"):
            self.render(f"a.{kind}")
            self.assertEqual(
                self.json("compare", f"a.{kind}", f"a.{kind}"),
                {
                    "ratio_of_means": 1,
                    "rmse": 0,
                    "relative_mse": 0,
                    "maximum": 0,
                    "blocks": [
                        {"block": block, "relative_rmse": 0, "trimmed_relative_rmse": 0} for block in (1, 5, 9)
                    ],
                    "non_finite_pixels": 0,
                },
            )

    def test_formats_hold_the_same_light(self):
        self.render("a.exr")
        self.render("a.hdr")
        difference = self.json("compare", "a.hdr", "a.exr")
        self.assertAlmostEqual(difference["ratio_of_means"], 1, delta=0.005)  # RGBE keeps 8 bits
        self.assertGreater(difference["rmse"], 0)

    def test_a_larger_picture_is_averaged(self):
        self.render("a.exr")
        self.render("large.exr", LARGE)
        difference = self.json("compare", "large.exr", "a.exr")
        self.assertAlmostEqual(difference["ratio_of_means"], 1, delta=0.01)
        text = self.interflect("compare", "a.exr", "large.exr", exit_code=BAD_INPUT).stderr
        self.assertIn("32", text)
        self.assertIn("96", text)

    def test_text_is_for_people(self):
        self.render("a.exr")
        text = self.interflect("compare", "a.exr", "a.exr").stdout
        for words in ("ratio of mean luminances", "RMSE", "blocks of 5"):
            self.assertIn(words, text)


if __name__ == "__main__":
    unittest.main()
