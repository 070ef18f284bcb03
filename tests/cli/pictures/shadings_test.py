"""Pictures of one view agree, however the light is computed; limits of time hold. Takes many rays: not run under sanitizers."""

import json
import re
import time
import unittest

from command import SMALL, SOLVED, VIEW, RenderTest, methods


class TimeLimit(RenderTest):
    """--time limits solving and drawing together."""

    ENDLESS = ("--rays", "1e12", "--mesh-size", "0.5")

    def limited(self, name, seconds, *options):
        start = time.monotonic()
        said = self.interflect("render", "room.mgf", "-o", name, "--time", seconds, *options).stderr
        return time.monotonic() - start, said

    def test_of_per_pixel_shading(self):
        """The bound allows for a speed that changes threefold."""
        for shading in ("hybrid", "gather"):
            picture = ("--size", "64x36", "--shading", shading, "--samples", "65536")  # would take minutes
            took, said = self.limited("out.png", 4, *picture, *self.ENDLESS)
            self.assertGreater(took, 2, shading)
            self.assertLess(took, 12, shading)
            self.assertNotIn("warning", said)
            self.assertIn("shading:" if shading == "hybrid" else "gathering:", said)

    def test_of_pictures_of_elements(self):
        took, _ = self.limited("out.png", 4, "--size", "160x90", "--show", "mesh", *self.ENDLESS)
        self.assertGreater(took, 2)
        self.assertLess(took, 12)

    def test_too_short_for_per_pixel_shading(self):
        took, said = self.limited("out.png", 0.5, "--mesh-size", "0.5")
        self.assertLess(took, 10)
        self.assertRegex(said, r"--time is too short for all pixels: light is traced for one in [\d.]+ x [\d.]+")
        self.assertNotIn("not reached", said)

    def test_too_short_for_gathering(self):
        took, said = self.limited("out.png", 0.5, "--mesh-size", "0.5", "--shading", "gather")
        self.assertLess(took, 10)
        self.assertRegex(said, r"per-pixel shading takes about .*, but --time leaves .*: .* as with --shading smooth")

    def test_too_short_for_layers(self):
        _, said = self.limited("out.exr", 0.1, "--size", "320x180", "--mesh-size", "0.5", "--layers")
        self.assertIn("the picture will be late", said)
        self.assertNotIn("not reached", said)

    def test_a_long_time_changes_neither_rays_nor_picture(self):
        picture = ("--size", "64x36", "--samples", "16", "--mesh-size", "0.5", "--method", "srr", "--rays", "500k")
        self.interflect("render", "room.mgf", "-o", "a.exr", *picture, "--stats", "a.json")
        self.limited("b.exr", 1000, *picture, "--stats", "b.json")
        rays = [json.loads((self.folder / n).read_text().splitlines()[-1])["rays"] for n in ("a.json", "b.json")]
        self.assertEqual(*rays)
        difference = self.json("compare", "b.exr", "a.exr")
        self.assertAlmostEqual(difference["ratio_of_means"], 1, delta=0.01)


class Agreement(RenderTest):
    FINE = ("--rays", "2M")
    SIZE = ("--size", "32x18")

    def ratio(self, image, reference):
        return self.json("compare", image, reference)["ratio_of_means"]

    def draw(self, name, *options, source="room.mgf"):
        return self.interflect("render", source, "-o", name, *options).stderr

    def test_every_shading_draws_the_path_traced_picture(self):
        """Independent estimates; a wrong factor of rho, pi or the area would fail."""
        view = (*self.SIZE, *VIEW)
        self.draw("path.exr", *view, "--shading", "path", "--samples", "256")
        self.draw("solved.exr", *view, "--samples", "16", *self.FINE)
        solved = self.json("compare", "solved.exr", "path.exr")
        self.assertAlmostEqual(solved["ratio_of_means"], 1, delta=0.02)
        self.assertLess(solved["blocks"][1]["relative_rmse"], 0.08)

        log = self.draw("instant.exr", *view, "--shading", "instant", "--light-walks", "1000")
        self.assertRegex(log, r"info: instant radiosity: 36\.9 k paths, .* a pixel")
        self.assertAlmostEqual(self.ratio("instant.exr", "path.exr"), 1, delta=0.02)

        self.solve()
        for name, options in (("hybrid shading", ()), ("final gathering", ("--shading", "gather"))):
            log = self.draw("out.exr", *SMALL, *VIEW, *options, source="room.h5")
            self.assertRegex(log, rf"info: {name}: 2\.3 k paths, .* a pixel")
            self.assertAlmostEqual(self.ratio("out.exr", "path.exr"), 1, delta=0.03, msg=name)

    def test_every_shading_has_the_same_false_colours(self):
        self.write_solution("fine.h5", "room.mgf", *self.FINE)
        for name in ("lux", "cd/m2"):
            measure = ("--false-colour", name, "--view", "floor", *self.SIZE)
            self.draw("smooth.exr", *measure, source="fine.h5")
            for shading in ("path", "gather"):
                self.draw("out.exr", *measure, "--shading", shading, "--samples", "256", source="fine.h5")
                self.assertAlmostEqual(self.ratio("out.exr", "smooth.exr"), 1, delta=0.02, msg=f"{name} {shading}")

    def test_plans_show_the_light_of_what_is_cut_away(self):
        """The lamp above the plan lights the floor, in every shading; without the lamp it is dark."""
        self.write_solution("fine.h5", "room.mgf", *self.FINE)
        plan = ("--plan", "1", "--extent", "3", "--size", "20x30", "--false-colour", "lux")
        self.draw("smooth.exr", *plan, "--shading", "smooth", source="fine.h5")
        for shading in ("flat", "gather", "path"):
            self.draw("out.exr", *plan, "--shading", shading, "--samples", "64", source="fine.h5")
            self.assertAlmostEqual(self.ratio("out.exr", "smooth.exr"), 1, delta=0.02, msg=shading)

    def test_every_method_shows_the_same_room(self):
        """Flat methods use a fixed mesh; the difference is the mesh's discretisation error and noise."""
        render = ("render", "room.mgf", *SMALL, "--view", "door", "--mesh-size", "0.5", "-o")
        self.interflect(*render, "reference.exr", "--rays", "2M", "--seed", "9")
        for method in methods():
            self.interflect(*render, "out.exr", "--rays", "200k", "--method", method)
            self.assertAlmostEqual(self.ratio("out.exr", "reference.exr"), 1, delta=0.05, msg=method)

    def test_a_large_picture_replaces_coarser_ones(self):
        size = ("--size", "320x240", "--samples", "4")
        for kind, has_preview in (("png", True), ("exr", False)):
            said = self.interflect("render", "room.mgf", "-o", f"last.{kind}", *SOLVED, *size).stderr
            self.assertEqual("picture so far" in said, has_preview, kind)
        self.assertNotEqual(self.bytes("last.png"), self.render("smooth.png", "--shading", "smooth", size=size))

    def test_progressive_pictures_end_with_the_same_bits(self):
        size = ("--size", "80x60", "--samples", "8", "--rays", "4M", *VIEW)
        for kind in ("png", "exr"):
            said = self.draw(f"steps.{kind}", "--progressive", *size)
            self.assertGreaterEqual(said.count("picture so far"), 2, kind)
            self.draw(f"once.{kind}", *size)
            self.assertEqual(self.bytes(f"steps.{kind}"), self.bytes(f"once.{kind}"))

    def test_a_target_takes_more_samples_where_they_are_needed(self):
        def paths_and_error(*options):
            found = re.search(r"tracing: ([\d.]+) k paths.* error ([\d.]+)%", self.draw("out.hdr", "--shading", "path", *self.SIZE, *VIEW, *options))
            return float(found[1]), float(found[2])

        few, large = paths_and_error("--samples", "16")
        many, small = paths_and_error("--samples", "16", "--until", "6%")
        limited, _ = paths_and_error("--samples", "16", "--until", "6%", "--max-samples", "20")
        self.assertGreater(large, 8)
        self.assertLess(small, 7)
        self.assertLess(few, limited)
        self.assertLess(limited, many)


if __name__ == "__main__":
    unittest.main()
