"""`compare` as a script uses it."""

import struct
import unittest

from command import BAD_INPUT, LARGE, SMALL, VIEW, WRONG_USAGE, CommandTest, room


def png_size(content):
    """Width and height are big-endian numbers in the header chunk at the start of every PNG file."""
    return struct.unpack(">II", content[16:24])


class Compare(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())
        self.write_solution("room.h5", "room.mgf", "--rays", "100k", "--mesh-size", "0.5")

    def render(self, name, size=SMALL, fov=45, options=()):
        self.interflect("render", "room.h5", "-o", name, *VIEW, "--fov", fov, *size, *options)

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
                    "perceptual_distance": 0,
                    "fov": 45,
                    "flip": 0,
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

    def test_linear_against_tone_mapped_is_warned_of(self):
        for kind in ("exr", "hdr", "png"):
            self.render(f"a.{kind}")
        for image, reference in (("a.png", "a.exr"), ("a.hdr", "a.png")):
            said = self.interflect("compare", image, reference, "--json").stderr
            self.assertRegex(said, r"warning: a\.png is tone-mapped .* and a\.(exr|hdr) holds linear values")
        for image, reference in (("a.png", "a.png"), ("a.hdr", "a.exr")):
            self.assertEqual(self.interflect("compare", image, reference, "--json").stderr, "")

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
        for words in ("ratio of mean luminances", "RMSE", "blocks of 5", "FLIP", "perceptual distance", "45 degrees"):
            self.assertIn(words, text)

    def test_field_of_view(self):
        """From the option, else from the .exr files (the reference first), else 45 degrees."""
        self.render("wide.exr", fov=60)
        self.render("narrow.exr", fov=30)
        self.render("narrow.hdr", fov=30)
        for pictures, fov in {
            ("narrow.exr", "narrow.exr"): 30,
            ("wide.exr", "narrow.hdr"): 60,
            ("narrow.hdr", "wide.exr"): 60,
            ("narrow.hdr", "narrow.hdr"): 45,
            ("wide.exr", "wide.exr", "--fov", "20"): 20,
        }.items():
            self.assertEqual(self.json("compare", *pictures)["fov"], fov, pictures)
        self.assertIn("--fov", self.interflect("compare", "wide.exr", "narrow.exr").stderr)
        self.assertEqual(self.json("compare", "wide.exr", "narrow.exr")["fov"], 30)

        pictures = ("narrow.hdr", "narrow.exr")
        distances = [self.json("compare", *pictures, "--fov", fov)["perceptual_distance"] for fov in (0.5, 5, 50)]
        self.assertEqual(len(set(distances)), 3)
        for fov in ("0", "180", "nan", "wide"):
            self.interflect("compare", *pictures, "--fov", fov, exit_code=WRONG_USAGE)

    def test_perceptual_measures_rise_with_noise(self):
        self.render("a.exr")
        noisy = ("solve", "room.mgf", "-o", "room.h5", "--mesh-size", "0.5", "--seed", "2", "--rays")
        found = []
        for rays in ("20k", "2k"):
            self.interflect(*noisy, rays)
            self.render("b.exr", options=("--shading", "flat"))
            found.append(self.json("compare", "b.exr", "a.exr"))
        for measure in ("perceptual_distance", "flip"):
            self.assertGreater(found[0][measure], 0)
            self.assertGreater(found[1][measure], found[0][measure])

    def test_difference_picture(self):
        """As wide as the reference and higher by its legend; for equal pictures, of one colour."""
        self.render("a.exr")
        self.render("b.exr", options=("--shading", "flat"))
        shown = self.json("compare", "b.exr", "a.exr", "--difference", "b.png")
        self.assertEqual(shown, self.json("compare", "b.exr", "a.exr"))
        self.interflect("compare", "a.exr", "a.exr", "--difference", "a.png")
        self.assertEqual(png_size(self.bytes("b.png")), png_size(self.bytes("a.png")))
        width, height = png_size(self.bytes("b.png"))
        self.assertEqual(width, 32)
        self.assertGreater(height, 18)
        self.assertNotEqual(self.bytes("a.png"), self.bytes("b.png"))

    def test_difference_picture_that_cannot_be_drawn(self):
        self.render("a.exr")
        before = self.files()
        for name, words, exit_code in (
            ("d.exr", "--difference: .*.png", WRONG_USAGE),
            ("d.txt", "--difference: .*d.txt", WRONG_USAGE),
            ("missing/d.png", "missing", BAD_INPUT),
        ):
            text = self.interflect("compare", "a.exr", "a.exr", "--difference", name, exit_code=exit_code).stderr
            self.assertRegex(text, words)
        self.interflect("compare", "a.exr", "b.exr", "--difference", "d.png", exit_code=BAD_INPUT)
        self.assertEqual(self.files(), before)


if __name__ == "__main__":
    unittest.main()
