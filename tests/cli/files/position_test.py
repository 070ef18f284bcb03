"""Scenes at any position, scenes that cannot be computed, and warnings about lost light."""

import json
import unittest

from command import BAD_INPUT, LAMP, SMALL, VIEW, WRONG_USAGE, CommandTest, room, vertices

FEW = ("--method", "srr", "--mesh-size", "0.5", "--rays", "200k")
OFFSET = (100000, -200000, 3000)


def moved_view():
    eye, look_at = ((float(x) + d for x, d in zip(VIEW[i].split(","), OFFSET, strict=True)) for i in (1, 3))
    return ("--eye", ",".join(map(repr, eye)), "--look-at", ",".join(map(repr, look_at)))


def room_with_hole(width):
    ceiling = vertices((0, 0, 2.5), (0, 3, 2.5), (2 - width, 3, 2.5), (2 - width, 0, 2.5)) + "f v0 v1 v2 v3\n"
    return room().replace("f v4 v6 v7 v5\n", "") + "m paint\n" + ceiling


def box():
    """Five one-sided faces that face outwards, on the floor of the room."""
    corners = [(x, y, z) for z in (0, 0.6) for y in (1, 2) for x in (0.5, 1.5)]
    faces = "f v4 v5 v7 v6\nf v0 v4 v6 v2\nf v1 v3 v7 v5\nf v0 v1 v5 v4\nf v2 v6 v7 v3\n"
    return vertices(*corners) + "m box =\n\tc\n\tsides 1\n\trd .5\n" + faces


class Position(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())
        self.write("far.mgf", "i room.mgf -t {} {} {}\n".format(*OFFSET))

    def total_power(self, scene):
        self.interflect("solve", scene, "-o", "out.h5", *FEW, "--stats", "stats.json")
        return json.loads((self.folder / "stats.json").read_text().splitlines()[-1])["total_power"][1]

    def test_far_away_the_light_is_the_same(self):
        near = self.total_power("room.mgf")
        self.assertLess(abs(self.total_power("far.mgf") / near - 1), 0.01)

    def test_info_tells_of_the_world(self):
        low, high = (self.json("info", "far.mgf")["bounds"][end] for end in ("min", "max"))
        for axis, size in enumerate((2, 3, 2.5)):
            self.assertAlmostEqual(low[axis], OFFSET[axis], places=4)
            self.assertAlmostEqual(high[axis], OFFSET[axis] + size, places=4)
        text = self.interflect("info", "far.mgf").stdout
        self.assertIn("x 100000 to 100002, y -200000 to -199997, z 3000 to 3002.5 m", text)

    def test_views_are_in_the_world(self):
        from_scene = self.interflect("render", "far.mgf", "-o", "a.exr", *moved_view(), *FEW, *SMALL)
        self.assertNotIn("left the scene", from_scene.stderr)
        self.interflect("solve", "far.mgf", "-o", "far.h5", *moved_view(), *FEW)
        self.interflect("render", "far.h5", "-o", "b.exr", *SMALL)
        self.interflect("render", "room.mgf", "-o", "c.exr", *VIEW, *FEW, *SMALL)
        for other in ("b.exr", "c.exr"):
            self.assertAlmostEqual(self.json("compare", other, "a.exr")["ratio_of_means"], 1, delta=0.03)

    def test_named_views_keep_their_precision(self):
        eye = [100000.3, -199999.8, 3001.6]
        views = {"views": [{"name": "door", "eye": eye, "look_at": [100001.2, -199997, 3001]}]}
        self.write("far.views.json", json.dumps(views))
        self.assertEqual(self.json("info", "far.mgf")["views"][0]["eye"], eye)

    def test_what_cannot_be_computed_is_refused(self):
        triangle = "v a =\n\tp {0} 0 0\nv b =\n\tp {0} 1 0\nv c =\n\tp {0} 0 1\nm paint\nf a b c\n"
        self.write("lost.mgf", room() + triangle.format("1e9"))
        self.write("beyond.mgf", room() + triangle.format("1e16"))
        for scene, reason in (("lost.mgf", "lost to rounding"), ("beyond.mgf", "farther than 1e+15 m")):
            result = self.interflect("solve", scene, "-o", "out.h5", exit_code=BAD_INPUT)
            self.assertRegex(result.stderr, scene + r":\d+: .*" + reason.replace("+", r"\+"))
        result = self.interflect(
            "render", "room.mgf", "-o", "a.png", "--eye", "1e20,0,0", "--look-at", "0,0,0", exit_code=WRONG_USAGE
        )
        self.assertIn("--eye: expected three numbers with commas between, from -1e15 to 1e15", result.stderr)


class LostLight(CommandTest):
    def warnings(self, text, command=("solve", "-o", "out.h5", *FEW)):
        self.write("room.mgf", text)
        return self.interflect(command[0], "room.mgf", *command[1:]).stderr

    def test_a_leak_is_reported(self):
        self.assertIn("looks closed but leaks", self.warnings(room_with_hole(0.06)))

    def test_a_closed_and_an_open_room_are_not(self):
        for text in (room(), room_with_hole(0), room_with_hole(1.5), room().replace("f v4 v6 v7 v5\n", "")):
            self.assertNotIn("leaks", self.warnings(text))

    def test_light_through_the_backs_of_faces_is_reported(self):
        """The sky outside a closed room whose faces look inwards, and a shade that only stops light from outside."""
        one_sided = room().replace("rd .6", "rd .6\n\tsides 1")
        shade = vertices((0.4, 0.9, 2.3), (0.4, 2.1, 2.3), (1.6, 2.1, 2.3), (1.6, 0.9, 2.3)) + "m paint\no shade\nf v0 v1 v2 v3\no\n"
        for lit in ("light sky 1000\n", shade):
            self.assertIn("through the backs of one-sided faces", self.warnings(one_sided + lit))
            self.assertNotIn("backs", self.warnings(room(LAMP.replace("sides 1", "sides 2")) + lit))
        self.assertIn("most of it in 'shade' (material 'paint')", self.warnings(one_sided + shade))
        self.assertNotIn("backs", self.warnings(one_sided))

    def test_a_one_sided_sheet_that_is_seen_from_behind_is_reported(self):
        """Half of the light of the lamp hits a sheet that is transparent from the floor."""
        sheet = vertices((0.5, 1, 1.2), (1.5, 1, 1.2), (1.5, 2, 1.2), (0.5, 2, 1.2)) + "m sheet =\n\tc\n\tsides 1\n\trd .5\no sheet\nf {}\no\n"
        upwards, downwards = "v0 v1 v2 v3", "v3 v2 v1 v0"
        said = self.warnings(room() + sheet.format(upwards))
        self.assertRegex(said, r"too dark by \d+%, .*most of it in 'sheet' \(material 'sheet'\)")
        self.assertRegex(self.warnings(room() + sheet.format(downwards)), r"too bright by \d")
        for harmless in (room() + sheet.replace("sides 1", "sides 2").format(upwards), room() + box()):
            self.assertNotIn("one-sided", self.warnings(harmless))

    def test_covered_lamps_are_counted(self):
        lamp = "f v0 v1 v2 v3\n"
        twice = self.warnings(room() + LAMP.replace("lamp", "other") + lamp)
        self.assertRegex(twice, r"patches \d+ lie wholly and 0 partly under coincident faces, which take 1000 lm")
        self.assertIn("patches 1 lie wholly and 0 partly", self.warnings(room() + lamp, ("info",)))
        half = vertices((0.5, 1, 2.4), (0.5, 1.5, 2.4), (1.5, 1.5, 2.4), (1.5, 1, 2.4)) + "m paint\nf v0 v1 v2 v3\n"
        partly = self.warnings(room() + half, ("info",))
        self.assertIn("patches 0 lie wholly and 1 partly", partly)
        self.assertIn("500 lm", partly)
        self.assertNotIn("coincident", self.warnings(room()))

    def test_info_counts_what_is_emitted(self):
        self.write("room.mgf", room() + "f v0 v1 v2 v3\n")
        self.assertAlmostEqual(self.json("info", "room.mgf")["emitted_power"][1], 1000, places=2)


if __name__ == "__main__":
    unittest.main()
