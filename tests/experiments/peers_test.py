"""The comparison with other renderers: errors on pictures with known ones, scenes, and small pictures of each program."""

import dataclasses
import sys
import unittest
from unittest import mock

from command import ROOT, CommandTest

sys.path.insert(0, str(ROOT / "experiments"))

import numpy as np
from lab import program
from peers import bench, page, pic, renderers, scenes
from peers.errors import DARKEST, Reference, without_lamps

SHAPE = (180, 320)
LUMINANCE = 50.0
SHARE = 1 / (1 + DARKEST)  # of an error relative to a pixel of mean luminance
HARMLESS = {"open-edge", "no-view"}  # findings of `validate`


def reference(noise: float = 0.0, theirs: float = 1.0, seed: int = 1, shared: bool = False) -> Reference:
    """@param noise  Relative standard deviation of a pixel of each half. @param theirs  Factor of the second program."""
    draw = np.random.default_rng(seed)
    halves = [LUMINANCE * (1 + noise * draw.standard_normal(SHAPE)) for _ in range(4)]
    ours = halves[0], halves[1]
    other = ours if shared else (halves[2], halves[3])
    return Reference(ours, tuple(theirs * half for half in other), np.ones(SHAPE, bool))


def checkerboard() -> np.ndarray:
    return np.indices(SHAPE).sum(axis=0) % 2 * 2.0 - 1


class KnownErrors(unittest.TestCase):
    def test_of_a_constant_factor_are_the_same_at_all_sizes(self):
        found = reference().errors(np.full(SHAPE, 1.1 * LUMINANCE))
        for error in (found.pixels, found.trimmed, found.blocks_4, found.blocks_9):
            self.assertAlmostEqual(error, 0.1 * SHARE, 12)
        self.assertAlmostEqual(found.mean, 1.1, 12)

    def test_that_alternate_vanish_in_even_blocks(self):
        found = reference().errors(LUMINANCE * (1 + 0.1 * checkerboard()))
        self.assertAlmostEqual(found.pixels, 0.1 * SHARE, 12)
        self.assertAlmostEqual(found.blocks_4, 0, 12)
        self.assertAlmostEqual(found.blocks_9, 0.1 * SHARE / 81, 12)  # one pixel of 81 remains
        self.assertAlmostEqual(found.mean, 1, 12)

    def test_of_few_pixels_are_trimmed(self):
        picture = np.full(SHAPE, LUMINANCE)
        worst = np.random.default_rng(2).choice(picture.size, picture.size // 125, replace=False)  # 0.8%
        picture.flat[worst] *= 11
        found = reference().errors(picture)
        self.assertAlmostEqual(found.pixels, 10 * SHARE * np.sqrt(len(worst) / picture.size), 12)
        self.assertAlmostEqual(found.trimmed, 0, 12)

    def test_do_not_include_the_noise_of_references(self):
        # Products of one half have the variance 2 e^2 s^2 + s^4 = 1.5e-4 with e = 0.05 and s = 0.1. The mean of both halves'
        # 57,600 has a standard deviation of 3.6e-5, and the error one of 3.6e-4. The noise of the scale adds 0.8%.
        exact = LUMINANCE * (1 + 0.05 * checkerboard())
        for seed in range(3):
            found = reference(noise=0.1, seed=seed).errors(exact)
            self.assertAlmostEqual(found.pixels, 0.05 * SHARE, delta=0.0022)
            self.assertAlmostEqual(found.trimmed, 0.05 * SHARE, delta=0.0022)

    def test_would_include_noise_that_references_share(self):
        exact = LUMINANCE * (1 + 0.05 * checkerboard())
        self.assertGreater(reference(noise=0.1, shared=True).errors(exact).pixels, 0.1)

    def test_do_not_include_lamps_and_their_neighbours(self):
        emitted = np.zeros(SHAPE)
        emitted[20, 30] = 1
        counts = without_lamps(emitted)
        self.assertEqual((~counts).sum(), 9)
        flat = np.full(SHAPE, LUMINANCE)
        picture = np.where(counts, 1.02, 100) * flat
        found = Reference((flat, flat), (flat, flat), counts).errors(picture)
        for error in (found.pixels, found.blocks_4, found.blocks_9):
            self.assertAlmostEqual(error, 0.02 * SHARE, 12)

    def test_of_two_references_are_reported(self):
        # The factor of both programs is 1.01, with DARKEST on top. Noise of blocks is 0.05 / 9 and cancels in products.
        found = reference(noise=0.05, theirs=1.02).agreement()
        self.assertAlmostEqual(found.ratio_of_means, 1.02, delta=5 * 0.05 / np.sqrt(57600))
        self.assertAlmostEqual(found.blocks_9, 0.02 / 1.01 * SHARE, delta=0.003)
        for noise in (found.noise_of_ours, found.noise_of_theirs):
            self.assertAlmostEqual(noise, 0.05 / np.sqrt(2) * SHARE, delta=0.001)

    def test_are_precise_to_the_smallest_error_that_is_found(self):
        """The error of an exact picture is the root of a mean of products of noise, which exceeds twice its standard error
        with a probability of 2.3%."""
        exact = np.full(SHAPE, LUMINANCE)
        halves = [reference(noise=0.1, seed=seed) for seed in range(20)]
        smallest = halves[0].agreement().smallest
        self.assertAlmostEqual(smallest, 0.1 * SHARE * (2 / 4 / 57600) ** 0.25, delta=1e-4)
        found = [half.errors(exact).pixels for half in halves]
        self.assertLess(max(found), 2 * smallest)
        self.assertGreater(sorted(found)[16], 0.3 * smallest)

class Times(unittest.TestCase):
    RUNS = [{"seconds": s, "pixels": 1 / np.sqrt(s)} for s in (16.0, 1.0, 4.0)]

    def time(self, error: float, unbiased: bool) -> str:
        return str(page.seconds_to(error, self.RUNS, "pixels", unbiased))

    def test_between_runs_are_interpolated_in_logarithms(self):
        for seconds in (2.0, 4.0, 9.0):
            self.assertEqual(self.time(1 / np.sqrt(seconds), False), f"{seconds}")

    def test_beyond_the_runs_are_extrapolated_only_without_bias(self):
        self.assertEqual(self.time(0.01, True), "about 10,000")
        self.assertEqual(self.time(0.01, False), "> 16.0")
        self.assertEqual(self.time(2, True), "< 1.0")


class RadiancePictures(CommandTest):
    def test_are_read_with_and_without_encoding(self):
        texels = [(2, 4, 8, 136), (0, 0, 0, 0)] * 8
        columns = [bytes(channel) for channel in zip(*texels)]
        plain = b"".join(bytes(texel) for texel in texels)
        encoded = bytes([2, 2, 0, 16]) + b"".join(bytes([10]) + c[:10] + bytes([6]) + c[10:] for c in columns)
        run = bytes([2, 2, 0, 16]) + b"".join(bytes([128 + 16, value]) for value in texels[0])
        path = self.folder / "picture.pic"
        path.write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 3 +X 16\n" + plain + encoded + run)
        found = pic.read_pic(path)
        for line in found[:2]:
            np.testing.assert_array_equal(line[0::2], [[2.5, 4.5, 8.5]] * 8)
            np.testing.assert_array_equal(line[1::2], 0)
        np.testing.assert_array_equal(found[2], [[2.5, 4.5, 8.5]] * 16)


class Scenes(CommandTest):
    def made(self, name: str) -> scenes.PeerScene:
        return scenes.make(program.find_program(), self.folder / name, name)

    def test_have_no_fault_for_any_seed(self):
        for name in (*scenes.DRAWN, *(f"{name}@held-out" for name in scenes.DRAWN)):
            with self.subTest(name):  # `validate` solves for a second, on one thread
                scene = self.made(name)
                findings = self.json("validate", scene.file, *scene.daylight.split(), "--threads", "1")["findings"]
                self.assertLessEqual({finding["kind"] for finding in findings}, HARMLESS)

    def test_differ_between_seeds(self):
        for name in scenes.DRAWN:
            with self.subTest(name):
                texts = {self.made(f"{name}{seed}").file.read_text() for seed in ("", "@2", "@3")}
                self.assertEqual(len(texts), 3)

    def test_of_an_office_have_a_hundred_luminaires(self):
        for seed in ("", "@2", "@3", "@4"):
            lamps = self.json("info", self.made(f"hundred-luminaires{seed}").file)["emitters"]
            self.assertIn(sum(lamp["patches"] for lamp in lamps), (99, 100, 105))


class Programs(CommandTest):
    """Mean luminance of a closed room with two lamps at 32 x 18 pixels, against path tracing with 1,024 samples."""

    JOB_SIZE = (32, 18)
    exact = None  # for all tests of this class

    def job(self) -> renderers.Job:
        scene = scenes.written("two-lamps", scenes.make_scene("two-lamps"), self.folder)
        return renderers.Job(program.find_program(), scene, self.JOB_SIZE, self.folder)

    def exact_mean(self, job: renderers.Job) -> float:
        if Programs.exact is None:
            traced = dataclasses.replace(job, seed=9)
            Programs.exact = renderers.by_interflect(traced, "--shading path --samples 1024").luminance.mean()
        return Programs.exact

    def check(self, draw, options: str, within: float):
        job = self.job()
        try:
            drawn = draw(job, options)
        except program.ExperimentError as error:
            if "missing" not in str(error) and "does not name" not in str(error):
                raise
            self.skipTest(str(error))
        self.assertEqual(drawn.luminance.shape, self.JOB_SIZE[::-1])
        ratio = drawn.luminance.mean() / self.exact_mean(job)
        print(f"{draw.__name__} {options}: mean {ratio:.4f}", flush=True)
        self.assertAlmostEqual(ratio, 1, delta=within)
        self.assertGreater(drawn.seconds, 0)
        self.assertGreater(drawn.peak_mib, 5)

    def test_interflect(self):
        self.check(renderers.by_interflect, "--shading hybrid --denoise --rays 1M --samples 16", 0.02)

    def test_mitsuba(self):
        self.check(renderers.by_mitsuba, "256", 0.02)

    def test_mitsuba_with_oidn(self):
        self.check(renderers.by_mitsuba, "256 denoise", 0.02)

    def test_cycles(self):
        self.check(renderers.by_cycles, "256", 0.02)

    def test_cycles_with_oidn(self):
        self.check(renderers.by_cycles, "256 denoise", 0.02)

    def test_cycles_with_guiding(self):
        self.check(renderers.by_cycles, "256 denoise guide", 0.02)

    def test_radiance(self):
        settings = f"{bench.CACHES[0]} {bench.ACCURATE}"
        all_light = settings.replace("-ab 4", "-ab 8").replace("-lw 0.002", "-lw 0.0005")
        self.check(renderers.by_radiance, all_light, 0.05)

    def test_renderpark(self):
        self.check(renderers.by_renderpark, f"{bench.STOCHASTIC_JACOBI} -srr-ray-units 30 -srr-epsilon 5e-4", 0.05)


class SmallBench(CommandTest):
    """The whole comparison at 32 x 18 pixels. Interflect takes the place of Mitsuba in the references."""

    SCALE = bench.Scale((32, 18), (64, 36), batch=8, most_samples=16, seconds=60, settings=1)

    def run_bench(self) -> list[tuple]:
        drawn = []

        def in_place_of_mitsuba(job: renderers.Job, samples: str) -> renderers.Drawn:
            drawn.append(("reference", job.seed))
            traced = dataclasses.replace(job, seed=job.seed + 5000)
            return renderers.by_interflect(traced, f"--shading path --samples {samples}")

        def recorded(job: renderers.Job, options: str) -> renderers.Drawn:
            drawn.append((options, job.size))
            if "path" in options:
                raise program.ExperimentError("missing")
            return renderers.by_interflect(job, f"{options.replace('--time 5', '--time 1')} --rays 100k")  # less work

        series = [bench.Series(one.name, recorded, one.version, one.settings) for one in bench.all_series()[:2]]
        with mock.patch.object(renderers, "by_mitsuba", in_place_of_mitsuba):
            table = self.folder / "results/peers.csv"
            bench.Bench(program.find_program(), self.SCALE, self.folder / "cache", table).measure("door-gap", series)
        page.write(table, self.folder / "figures")
        return drawn

    def test_measures_each_setting_once(self):
        drawn = self.run_bench()
        of_reference = [seed for name, seed in drawn if name == "reference"]
        self.assertEqual(of_reference, [1000, 1001, 1002, 1003])
        measured = [bench.HYBRID[0], bench.DEFAULT, "--shading path --samples 4"]
        self.assertEqual(drawn[4:], [(options, (32, 18)) for options in measured])
        table = (self.folder / "figures/peers.md").read_text().splitlines()
        self.assertEqual(len(table), 2 + 2)
        self.assertIn("| default |", table[3] + table[2])
        self.assertIn("| door-gap | Interflect | ", (self.folder / "figures/peers-times.md").read_text())
        self.assertIn("| door-gap | 32 x 18 | 32 |", (self.folder / "figures/peers-references.md").read_text())
        self.assertTrue((self.folder / "figures/peers.svg").is_file())
        # The second run repeats only the failed setting.
        self.assertEqual(self.run_bench(), [("--shading path --samples 4", (32, 18))])


if __name__ == "__main__":
    unittest.main()
