"""Skies, the sun and environment maps, on the command line."""

import math
import unittest

from command import BAD_INPUT, SMALL, VIEW, WRONG_USAGE, CommandTest

GROUND = "m grey =\n rd .5\nv a =\n p -2 -2 0\nv b =\n p 2 -2 0\nv c =\n p 2 2 0\nv d =\n p -2 2 0\nf a b c d\n"
DAYLIGHT = ("--sky", "clear:9000", "--sun", "180,30,50000", "--ground", "0.2")


def radiance_picture(width, height, mantissas=(128, 128, 128), exponent=129):
    """A picture of one colour; the default values give 1."""
    header = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode()
    return header + bytes((*mantissas, exponent)) * (width * height)


class Skies(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("open.mgf", GROUND)
        (self.folder / "map.hdr").write_bytes(radiance_picture(4, 2))

    def info(self, *arguments):
        return self.json("info", "open.mgf", *arguments)

    def test_info_tells_the_illuminance_of_the_sky(self):
        info = self.info(*DAYLIGHT)
        self.assertEqual(info["lights"], {"directional": 1, "sky-dome": 1})
        self.assertAlmostEqual(info["sky_illuminance"], 9000, delta=0.1)
        info = self.info("--environment", "map.hdr,30,200")
        self.assertAlmostEqual(info["sky_illuminance"], 200 * math.pi, delta=0.1)
        self.assertTrue(any(file.endswith("map.hdr") for file in info["files"]))
        self.assertIsNone(self.info()["sky_illuminance"])
        self.assertIn("9000 lx on an unobstructed", self.interflect("info", "open.mgf", *DAYLIGHT).stdout)

    def test_ground_receives_sky_and_sun(self):
        self.interflect("solve", "open.mgf", "-o", "out.h5", *VIEW, "--rays", "200k", *DAYLIGHT)
        areas = self.json("probe", "out.h5", "--point", "0,0,0")["areas"]
        self.assertAlmostEqual(areas[0]["mean"], 9000 + 50_000 / 2, delta=0.01 * 34_000)

    def test_a_solution_needs_no_map(self):
        self.interflect("solve", "open.mgf", "-o", "out.h5", "--rays", "50k", "--environment", "map.hdr,0,100")
        (self.folder / "map.hdr").unlink()
        for shading in ("gather", "path"):
            self.interflect("render", "out.h5", "-o", f"{shading}.exr", *VIEW, "--size", "32x18", "--shading", shading)
        comparison = self.json("compare", "gather.exr", "path.exr")
        self.assertAlmostEqual(comparison["ratio_of_means"], 1, delta=0.01)
        error = self.interflect("render", "out.h5", "-o", "no.png", *VIEW, *SMALL, "--sky", "overcast",
                                exit_code=WRONG_USAGE).stderr
        self.assertIn("--sky: it has no effect", error)

    def test_light_groups_dim_the_sky(self):
        self.interflect("solve", "open.mgf", "-o", "out.h5", "--rays", "100k", *DAYLIGHT[:4], "--group", "sun=sun-*",
                        "--group", "sky=sky-*")
        error = self.interflect("render", "out.h5", "-o", "no.exr", *VIEW, *SMALL, "--dim", "moon=1", exit_code=BAD_INPUT).stderr
        for word in ("--dim moon=1", "'moon'", "sun", "sky"):
            self.assertIn(word, error)
        self.interflect("render", "out.h5", "-o", "sky.exr", *VIEW, *SMALL, "--dim", "sun=0", "--dim", "sky=0.5",
                        "--shading", "path")
        self.interflect("solve", "open.mgf", "-o", "alone.h5", "--rays", "100k", "--sky", "clear:4500", "--sun", "180,30,0")
        self.interflect("render", "alone.h5", "-o", "alone.exr", *VIEW, *SMALL, "--shading", "path")
        self.assertLess(self.json("compare", "sky.exr", "alone.exr")["relative_mse"], 1e-6)

    def test_bad_files(self):
        self.write("text.hdr", "no picture")
        (self.folder / "flat.png").write_bytes(b"\x89PNG\r\n\x1a\n")
        (self.folder / "large.hdr").write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16384 +X 16384\n")
        for value, message in (("none.exr", "none.exr: no such file"), ("text.hdr", "text.hdr: cannot read"),
                               ("flat.png", "expected .exr or .hdr"), ("large.hdr", "expected 1 to 33554432"),
                               ("open.mgf", "no image format")):
            with self.subTest(value=value):
                error = self.interflect("info", "open.mgf", "--environment", value, exit_code=BAD_INPUT).stderr
                self.assertIn(message, error)

    def test_wrong_usage(self):
        for option, value in (("--sky", "blue"), ("--sky", "clear:-1"), ("--sky", "clear:x"), ("--sky", "perez:100"),
                              ("--sky", "cie-17"), ("--sky", ""), ("--sun", "200"), ("--sun", "200,0"), ("--sun", "200,91"),
                              ("--sun", "200,35,-1"), ("--sun", "south,35"), ("--ground", "1.5"), ("--ground", "-0.1"), ("--ground", "0.2"),
                              ("--environment", ""), ("--environment", "map.hdr,0,-1"), ("--zenith", "0,1"), ("--zenith", "1,0,0"),
                              ("--sky", "overcast:1e30"), ("--sun", "200,35,1e30")):
            with self.subTest(option=option, value=value):
                error = self.interflect("info", "open.mgf", f"{option}={value}", exit_code=WRONG_USAGE).stderr
                self.assertIn(option, error)

    def test_what_does_not_go_together(self):
        for arguments, message in ((("--sky", "clear"), "--sky: a sky of CIE type 12 needs a sun"),
                                   (("--sky", "perez:500,100"), "--sky: a sky by Perez needs a sun"),
                                   (("--sky", "perez:5000,100", "--sun", "200,35"), "--sky: irradiances of 5000 W/m2"),
                                   (("--sky", "overcast", "--zenith", "0,0,0"), "--zenith: the zenith has no direction")):
            with self.subTest(arguments=arguments):
                result = self.interflect("info", "missing.mgf", *arguments, exit_code=WRONG_USAGE)
                self.assertIn(message, result.stderr)


if __name__ == "__main__":
    unittest.main()
