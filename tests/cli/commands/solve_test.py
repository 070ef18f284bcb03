"""Properties of `solve` that scripts rely on: reproducibility, limits, statistics."""

import json
import time
import unittest

from command import LAMP, CommandTest, room, vertices

COARSE = ("--mesh-size", "0.5")


class Reproducibility(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())

    def solve(self, name, *options, rays="200k"):
        self.interflect("solve", "room.mgf", "-o", name, "--rays", rays, *COARSE, *options)
        return self.bytes(name)

    def test_same_seed_same_bytes_on_any_number_of_threads(self):
        one = self.solve("one.h5", "--threads", "1")
        self.assertEqual(self.solve("two.h5", "--threads", "2"), one)
        self.assertEqual(self.solve("all.h5"), one)
        self.assertEqual(self.solve("seed.h5", "--seed", "1"), one)

    def test_another_seed_other_bytes(self):
        self.assertNotEqual(self.solve("one.h5"), self.solve("other.h5", "--seed", "2"))

    def test_pseudo_random_points_are_reproducible_too(self):
        one = self.solve("one.h5", "--points", "random", "--threads", "1")
        self.assertEqual(self.solve("two.h5", "--points", "random", "--threads", "2"), one)
        self.assertNotEqual(self.solve("sobol.h5"), one)


    def test_the_preset_of_the_paper_is_its_settings(self):
        settings = "--one-bounce --warm-up 10 --iterations 100 --refinement-criterion power --no-shrinkage --inherited-weight 1"
        settings += " --epsilon-decay 0 --importance-smoothing 0 --importance-exponent 1"
        rays = "22k"
        size = ("--rays-per-iteration", "200")  # in 110 iterations
        published = self.solve("published.h5", *settings.split(), *size, rays=rays)
        self.assertEqual(self.solve("preset.h5", "--preset", "paper", rays=rays), published)
        other = self.solve("other.h5", "--inherited-weight", "0.5", "--preset", "paper", rays=rays)
        settings = settings.replace("--inherited-weight 1", "--inherited-weight 0.5")
        self.assertEqual(other, self.solve("changed.h5", *settings.split(), *size, rays=rays))
        self.assertNotEqual(other, published)


class Dark(CommandTest):
    def test_a_scene_without_light_is_solved_with_one_warning(self):
        self.write("dark.mgf", room().replace("ed 1000", "ed 0"))
        result = self.interflect("solve", "dark.mgf", "-o", "dark.h5", "--stats", "stats", *COARSE)
        self.assertEqual(result.stderr.count("warning: "), 1, result.stderr)
        self.assertIn("emits no light", result.stderr)
        self.bytes("dark.h5")
        (header,) = (self.folder / "stats").read_text().splitlines()
        self.assertEqual(json.loads(header)["emitted_power"], [0, 0, 0])


class Statistics(CommandTest):
    def solve(self, *options, timeout=60):
        self.write("room.mgf", room())
        self.interflect("solve", "room.mgf", "-o", "out.h5", "--stats", "stats", *COARSE, *options, timeout=timeout)
        header, *iterations = map(json.loads, (self.folder / "stats").read_text().splitlines())
        self.assertGreater(len(iterations), 1)
        return header, iterations

    def test_header(self):
        header, _ = self.solve("--rays", "100k", "--seed", "18446744073709551615", "--threads", "2")
        keys = ["scene", "method", "options", "seed", "threads", "version", "patches", "area", "emitted_power"]
        self.assertEqual(list(header), keys)
        self.assertEqual((header["method"], header["seed"], header["threads"]), ("hsrr", 2**64 - 1, 2))
        self.assertEqual(header["options"]["rays"], 100_000)
        for channel in header["emitted_power"]:
            self.assertAlmostEqual(channel, 1000, places=2)

    def test_iterations(self):
        _, iterations = self.solve("--rays", "300k")
        for line in iterations:
            self.assertEqual(
                list(line),
                ["iteration", "seconds", "rays", "power_rays", "importance_rays", "escaped_rays", "elements", "leaves"]
                + ["total_power", "escaped_power", "error_estimate", "noise_estimate", "discretisation_estimate"]
                + ["largest_payload", "high_payload", "discarded_hits"],
            )
            self.assertEqual(line["power_rays"] + line["importance_rays"], line["rays"])
            self.assertEqual(line["escaped_power"], [0, 0, 0])  # closed room
        rays = [line["rays"] for line in iterations]
        self.assertEqual(rays, sorted(set(rays)))
        self.assertEqual([line["iteration"] for line in iterations], list(range(len(iterations))))
        seconds = [line["seconds"] for line in iterations]
        self.assertEqual(seconds, sorted(seconds))

    def test_rays_are_traced_exactly(self):
        for count in (1, 1000, 123_457):
            with self.subTest(count=count):
                self.write("room.mgf", room())
                self.interflect(
                    "solve", "room.mgf", "-o", "out.h5", "--stats", "stats", *COARSE, "--rays", count
                )
                last = (self.folder / "stats").read_text().splitlines()[-1]
                self.assertEqual(json.loads(last)["rays"], count)

    def test_until_an_error(self):
        _, iterations = self.solve("--until", "1%", "--method", "srr")
        self.assertLessEqual(iterations[-1]["error_estimate"], 0.01)
        self.assertGreater(len(iterations), 4)
        for line in iterations[:-1]:
            self.assertTrue(line["error_estimate"] is None or line["error_estimate"] > 0.01, line)

    def test_until_an_error_or_a_number_of_rays(self):
        _, iterations = self.solve("--until", "0.01%", "--rays", "100k")
        self.assertEqual(iterations[-1]["rays"], 100_000)
        self.assertGreater(iterations[-1]["error_estimate"], 0.0001)

    def test_time(self):
        """The bounds hold even if the machine's speed changes, because a step that takes too long is undone."""
        asked = 1.0  # [s]
        start = time.monotonic()
        _, iterations = self.solve("--time", asked, "--rays", "1e12")
        took = time.monotonic() - start
        self.assertGreater(took, 0.8 * asked)
        self.assertLess(took, 20 * asked)
        self.assertLess(iterations[-1]["seconds"], 2 * asked)


class BlackView(CommandTest):
    def test_has_no_error_and_says_so(self):
        """The view shows only a black surface: the error is unknown, so --until never ends the run."""
        black = vertices((-1, 4, 0), (3, 4, 0), (3, 4, 3), (-1, 4, 3)) + "m black =\n\trd 0\n"
        self.write("dark.mgf", room() + black + "f v0 v1 v2 v3\n")
        view = ("--eye", "1,6,1.5", "--look-at", "1,4,1.5", "--fov", "30")
        run = ("-o", "out.h5", "--stats", "stats", "--rays", "100k", "--until", "99%", *COARSE)
        result = self.interflect("solve", "dark.mgf", *view, *run)
        self.assertEqual(result.stderr.count("the error is not known"), 1, result.stderr)
        _, *iterations = map(json.loads, (self.folder / "stats").read_text().splitlines())
        self.assertEqual({line["error_estimate"] for line in iterations}, {None})
        self.assertGreater(iterations[-1]["rays"], 90_000)  # the light may be absorbed before the rays are spent
        inside = ("--eye", "1,2.5,1.5", "--look-at", "1,0,1.2")  # the room
        self.assertNotIn("the error is not known", self.interflect("solve", "dark.mgf", *inside, *run).stderr)


class Light(CommandTest):
    def test_a_closed_grey_room_reflects_what_the_geometric_series_says(self):
        """Each lumen reaches a surface, and a share rho of it is reflected: in total Phi (1 + rho + rho^2 + ...)."""
        rho, emitted = 0.6, 1000  # 1, [lm]
        grey = room(LAMP + f"\trd {rho}\n").replace("cxy .36 .34", "")
        self.write("room.mgf", grey)
        self.interflect("solve", "room.mgf", "-o", "out.h5", "--stats", "stats", "--rays", "400k", *COARSE)
        last = json.loads((self.folder / "stats").read_text().splitlines()[-1])
        for channel in last["total_power"]:
            self.assertAlmostEqual(channel / (emitted / (1 - rho)), 1, delta=0.005)


if __name__ == "__main__":
    unittest.main()
