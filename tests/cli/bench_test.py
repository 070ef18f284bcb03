"""Output of `bench`; speed is not tested."""

import unittest

from command import BAD_INPUT, CommandTest, room


class Bench(CommandTest):
    TINY = ("--rays", "20k", "--rounds", "2", "--mesh-size", "none", "--threads", "1")

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

    def test_there_is_nothing_to_measure_in_the_dark(self):
        self.write("dark.mgf", room().replace("ed 1000", "ed 0"))
        result = self.interflect("bench", "dark.mgf", *self.TINY, exit_code=BAD_INPUT)
        self.assertIn("nothing in the scene emits light", result.stderr)


if __name__ == "__main__":
    unittest.main()
