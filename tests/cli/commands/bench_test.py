"""Output of `bench`; speed is not tested."""

import unittest

from command import BAD_INPUT, WRONG_USAGE, CommandTest, room


class Bench(CommandTest):
    TINY = ("--rays", "20k", "--rounds", "2", "--mesh-size", "none", "--threads", "1")
    PICTURE = ("--picture", "--size", "16x9", "--samples", "4")

    def test_json(self):
        self.write("room.mgf", room())
        report = self.json("bench", "room.mgf", *self.TINY)
        for key in ("ceiling_rays_per_second", "solver_rays_per_second", "ratio"):
            self.assertGreater(report[key], 0, key)
        self.assertEqual(set(report["shares_of_time"]), {"making_rays", "tracing", "receiving", "refinement", "sweeps"})
        self.assertEqual((report["patches"], report["threads"], report["rays"]), (13, 1, 20_000))
        self.assertGreaterEqual(report["ceiling_rays_per_second"], min(report["embree"].values()))

    def test_text(self):
        self.write("room.mgf", room())
        text = self.interflect("bench", "room.mgf", *self.TINY).stdout
        for words in ("Embree alone", "whole solver", "solver over Embree", "rays/s", "tracing"):
            self.assertIn(words, text)

    def test_picture_as_json(self):
        self.write("room.mgf", room())
        for shading in ("hybrid", "gather", "path", "instant"):
            with self.subTest(shading=shading):
                report = self.json("bench", "room.mgf", *self.TINY, *self.PICTURE, "--shading", shading)
                self.assertEqual([report[key] for key in ("shading", "width", "height", "samples")], [shading, 16, 9, 4])
                self.assertGreaterEqual(report["picture_rays"], 16 * 9 * 4)
                self.assertGreater(report["recorded_rays"], 0)
                self.assertGreater(report["seconds"], 0)
                self.assertLessEqual(report["recorded_rays"], min(20_000, report["picture_rays"]))
                self.assertAlmostEqual(sum(report["shares_of_rays"].values()), 1)
                for share in (*report["shares_of_rays"].values(), report["ratio"]):
                    self.assertGreater(share, 0)
                self.assertGreaterEqual(report["ceiling_rays_per_second"], min(report["embree"].values()))

    def test_picture_as_text(self):
        self.write("room.mgf", room())
        text = self.interflect("bench", "room.mgf", *self.TINY, *self.PICTURE).stdout
        for words in ("Embree alone", "whole picture", "picture over Embree", "16 x 9 pixels", "hybrid", "reflected"):
            self.assertIn(words, text)

    def test_options_of_pictures_alone(self):
        self.write("room.mgf", room())
        for option in (("--size", "8x8"), ("--shading", "path"), ("--samples", "4")):
            result = self.interflect("bench", "room.mgf", *self.TINY, *option, exit_code=WRONG_USAGE)
            self.assertIn("--picture", result.stderr)
        views = ("--eye", "1,1,1", "--look-at", "2,1,1", "--view", "desk")
        self.assertIn("one view", self.interflect("bench", "room.mgf", "--picture", *views, exit_code=WRONG_USAGE).stderr)

    def test_there_is_nothing_to_measure_in_the_dark(self):
        self.write("dark.mgf", room().replace("ed 1000", "ed 0"))
        result = self.interflect("bench", "dark.mgf", *self.TINY, exit_code=BAD_INPUT)
        self.assertIn("the scene emits no light", result.stderr)


if __name__ == "__main__":
    unittest.main()
