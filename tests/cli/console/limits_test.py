"""At the numeric limits all results are finite and the light is right; beyond them, scenes are refused.

Fails without the limits: scenes of 10^12 m and exitances of 10^30 had null in their statistics and unreadable
solution files; scenes of 10^-12 m leaked. Seen to fail with variances of means that sum squares of areas in single
precision.
"""

import json
import math
import unittest

from command import BAD_INPUT, LAMP, CommandTest, methods, room

REFINING = ("hwdrs", "ihwdrs", "hsrr", "ihsrr", "hr")
NARROWEST, WIDEST = 2.4e-7, 2.4e6  # the room is 4.3 times as wide [m]
WEAKEST, STRONGEST = 1.1e-9, 9.9e9  # [lm/m2]


def scaled_room(scale, exitance, offset=0.0):
    lines = []
    for line in room(LAMP.replace("1000", repr(exitance))).splitlines():
        words = line.split()
        if words[0] == "p":
            line = "\tp " + " ".join(repr(float(x) * scale + offset) for x in words[1:])
        lines.append(line)
    return "\n".join(lines) + "\n"


def view(scale, offset=0.0):
    def point(*coordinates):
        return ",".join(repr(x * scale + offset) for x in coordinates)

    return ("--eye", point(0.3, 0.2, 1.6), "--look-at", point(1.2, 3, 1))


class Limits(CommandTest):
    def power(self, method, scale, exitance, offset=0.0):
        """Returns the total power in the room, divided by the squared scale and the exitance."""
        self.write("room.mgf", scaled_room(scale, exitance, offset))
        mesh = () if method in REFINING else ("--mesh-size", "none")
        options = ("--method", method, "--rays", "20k", "--stats", "stats.json", *view(scale, offset), *mesh)
        solved = self.interflect("solve", "room.mgf", "-o", "room.h5", *options)
        self.assertNotIn("left the scene", solved.stderr)
        stats = (self.folder / "stats.json").read_text()
        for word in ("nan", "inf"):
            self.assertNotIn(word, stats.lower())
        first, *_, last = map(json.loads, stats.splitlines())
        for number in (first["area"], *first["emitted_power"], *last["total_power"]):
            self.assertTrue(math.isfinite(number) and number > 0, stats)
        if method != "hr":  # hr estimates no error after so few iterations
            self.assertTrue(0 < last["error_estimate"] < 1, last)
        self.interflect("render", "room.h5", "-o", "room.exr", "--size", "16x9", "--samples", "2")
        return last["total_power"][1] / scale**2 / exitance

    def test_at_the_limits_the_light_is_the_same(self):
        for method in methods():
            expected = self.power(method, 1, 1000)
            for scale, exitance in ((NARROWEST, STRONGEST), (WIDEST, WEAKEST), (WIDEST, STRONGEST)):
                with self.subTest(method=method, scale=scale, exitance=exitance):
                    self.assertAlmostEqual(self.power(method, scale, exitance) / expected, 1, delta=0.02)

    def test_elsewhere_the_light_is_the_same(self):
        expected = self.power("hsrr", 1, 1000)
        for offset in (3e5, 1e7, 1e12):
            with self.subTest(offset=offset):
                self.assertAlmostEqual(self.power("hsrr", 1, 1000, offset) / expected, 1, delta=0.02)

    def test_beyond_the_limits_scenes_are_refused(self):
        for scale, exitance, reason in (
            (NARROWEST / 1.1, 1000, "room.mgf: the scene is only"),
            (WIDEST * 1.1, 1000, "m wide; at most 1e+07 m"),
            (1, WEAKEST / 1.2, "room.mgf: the scene emits only"),
            (1, STRONGEST * 1.1, "exitance"),
        ):
            self.write("room.mgf", scaled_room(scale, exitance))
            with self.subTest(scale=scale, exitance=exitance):
                result = self.interflect("solve", "room.mgf", "-o", "room.h5", exit_code=BAD_INPUT)
                self.assertIn(reason, result.stderr)
                if "only" not in reason:  # faults of a face or a material have a line
                    self.assertRegex(result.stderr, r"room\.mgf:\d+: ")
        self.assertEqual(self.files(), ["room.mgf"])


class Views(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())

    def assert_refused(self, *options, reason):
        result = self.interflect("render", "room.mgf", "-o", "room.png", *options, exit_code=BAD_INPUT)
        self.assertIn(reason, result.stderr)

    def test_beyond_what_can_be_computed(self):
        self.write("far.vf", "rvu -vtv -vp 1e19 0 0\n")
        self.assert_refused("--view-file", "far.vf", reason="far.vf: (1e+19, 0, 0) is farther than 1e+15 m")
        views = '{"views": [{"name": "far", "eye": [0, 0, 1e19], "look_at": [0, 1, 0]}]}'
        self.write("room.views.json", views)
        self.assert_refused(reason="room.views.json: view 1: (0, 0, 1e+19) is farther than 1e+15 m")

    def test_numbers_beyond_double_precision(self):
        self.write("room.views.json", '{"views": [\n{"name": "far",\n"eye": [0, 0, 1e400], "look_at": [0, 1, 0]}]}')
        self.assert_refused(reason="room.views.json:3: no valid JSON: ")

    def test_from_far_away_but_not_too_far(self):
        for distance in ("1e6", "1e14"):
            for mode in ("flat", "path"):
                eye = ("--eye", f"{distance},0,0", "--look-at", "1,1.5,1.2")
                fast = ("--size", "16x9", "--samples", "2", "--shading", mode, *(("--rays", "20k") if mode == "flat" else ()))
                self.interflect("render", "room.mgf", "-o", "room.exr", *eye, *fast)


if __name__ == "__main__":
    unittest.main()
