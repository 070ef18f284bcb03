"""`validate`: a sound room has no problem, and each planted fault is found, with its position."""

import json
import unittest

from command import DONE, FAILED, LAMP, PAINT, VIEWS, CommandTest, room, vertices

ROOM = room().replace(" 2.4\n", " 2.499\n")  # its lamp is flush with the ceiling
ONE_SIDED = PAINT.replace("rd .6", "sides 1\n\trd .6")


def panel(z=1, size=1, corner=(0.5, 1), material=PAINT, reverse=False):
    x, y = corner
    outline = "v3 v2 v1 v0" if reverse else "v0 v1 v2 v3"
    return vertices((x, y, z), (x + size, y, z), (x + size, y + size, z), (x, y + size, z)) + material + f"f {outline}\n"


def box(low, high):
    corners = [(x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])]
    walls = "f v0 v1 v3 v2\nf v4 v6 v7 v5\nf v0 v2 v6 v4\nf v1 v5 v7 v3\nf v0 v4 v5 v1\nf v2 v3 v7 v6\n"
    return vertices(*corners) + PAINT + walls


LIGHT = "v bulb =\n\tp 1 1 {z}\nlight point bulb {intensity}\n"
FAULTS = {  # addition to the room: kind, count and first place of the finding
    "degenerate-face": (vertices((0, 0, 1), (1, 0, 1), (2, 0, 1)) + PAINT + "f v0 v1 v2\n", 1, "room.mgf:"),
    "duplicate-face": (panel() + panel(), 1, [1, 1.5, 1]),
    "coincident-face": (panel() + panel(size=0.5), 1, [1, 1.5, 1]),
    "inverted-lamp": (panel(z=2.49, size=0.3, corner=(0.85, 0.35), material=LAMP), 1, [1, 0.5, 2.49]),
    "open-lamp-back": (panel(z=2.4, size=0.5, corner=(0.2, 2.2), material=LAMP, reverse=True), 1, [0.45, 2.45, 2.4]),
    "hidden-lamp": (
        panel(z=0.5, size=0.02, corner=(1, 1), material=LAMP) + box((0.97, 0.97, 0.48), (1.05, 1.05, 0.56)),
        1,
        [1.01, 1.01, 0.5],
    ),
    "zero-power-lamp": (LIGHT.format(z=1, intensity=0), 1, [1, 1, 1]),
    "high-reflectance": (panel(material="m snow =\n\tc\n\trd .95\n"), 1, "snow"),
}


class Validate(CommandTest):
    def findings(self, name, *options):
        """It solves for a second, on one thread."""
        return {finding["kind"]: finding for finding in self.json("validate", name, "--threads", "1", *options)["findings"]}

    def write_room(self, added="", base=None):
        self.write("room.mgf", (base or ROOM) + added)
        self.write("room.views.json", json.dumps(VIEWS))

    def test_a_sound_room_has_no_problem(self):
        self.write_room()
        report = self.json("validate", "room.mgf", "--strict")
        self.assertEqual(report["problems"], 0)
        self.assertEqual([finding["kind"] for finding in report["findings"]], ["open-edge"])
        self.assertEqual(report["findings"][0]["count"], 4)  # edges of the lamp
        self.assertGreater(report["memory"], 1e6)
        self.assertAlmostEqual(report["seconds"] * report["rays_per_second"], 20e6, delta=1e3)

    def test_each_fault_is_found_where_it_is(self):
        for kind, (added, count, place) in FAULTS.items():
            with self.subTest(kind):
                self.write_room(added)
                found = self.findings("room.mgf")
                self.assertLessEqual(set(found), {kind, "open-edge"})
                self.assertEqual(found[kind]["count"], count)
                first = found[kind]["places"][0]
                if isinstance(place, str):
                    self.assertIn(place, first["where"] + first["material"])
                else:
                    for a, b in zip(first["position"], place, strict=True):
                        self.assertAlmostEqual(a, b, places=5)

    def test_a_point_light_in_a_closed_box_is_enclosed(self):
        self.write_room(LIGHT.format(z=1, intensity=5) + box((0.9, 0.9, 0.9), (1.1, 1.1, 1.1)))
        self.assertEqual(self.findings("room.mgf")["enclosed-luminaire"]["count"], 1)
        self.write_room(LIGHT.format(z=1.5, intensity=5) + box((0.9, 0.9, 0.9), (1.1, 1.1, 1.1)))
        self.assertNotIn("enclosed-luminaire", self.findings("room.mgf"))

    def test_a_one_sided_wall_that_looks_out_is_inverted(self):
        inwards = ROOM.replace(PAINT, ONE_SIDED)
        self.write_room(base=inwards)
        self.assertNotIn("inverted-face", self.findings("room.mgf"))
        self.write_room(base=inwards.replace("f v0 v1 v3 v2", "f v2 v3 v1 v0"))
        self.assertEqual(self.findings("room.mgf")["inverted-face"]["count"], 1)

    def test_a_mesh_alone_has_no_light_no_view_and_perhaps_another_unit(self):
        self.write("part.stl", "solid\nfacet\nvertex 0 0 0\nvertex 4000 0 0\nvertex 0 3000 0\n")
        self.assertEqual(set(self.findings("part.stl")), {"no-light", "implausible-size", "open-edge", "no-view"})
        self.assertNotIn("implausible-size", self.findings("part.stl", "--unit", "mm"))
        self.assertNotIn("no-light", self.findings("part.stl", "--unit", "mm", "--sky", "overcast"))

    def test_strict_ends_with_one_where_there_is_a_problem(self):
        self.write_room(panel() + panel())
        self.assertIn("duplicate-face", self.interflect("validate", "room.mgf", "--threads", "1", exit_code=DONE).stdout)
        strict = ("--strict", "--places", "0", "--threads", "1")
        result = self.interflect("validate", "room.mgf", *strict, exit_code=FAILED)
        self.assertIn("problem duplicate-face", result.stdout)
        self.assertNotIn("at (", result.stdout)


class Misplaced(CommandTest):
    """Probable placement errors: `validate` lists them, and `solve`, `probe` and `report` warn."""

    LUMINAIRE = "IESNA:LM-63-2002\nTILT=NONE\n1 400 1 2 1 1 2 .2 .2 0\n1 1 30\n0 90\n0\n100 100\n"
    RAYS = ("--rays", "10k")

    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())
        self.write("lamp.ies", self.LUMINAIRE)

    def kinds(self, *arguments):
        return {finding["kind"] for finding in self.json("validate", "room.mgf", "--threads", "1", *arguments)["findings"]}

    def warnings(self, *arguments):
        return [line for line in self.interflect(*arguments).stderr.splitlines() if line.startswith("warning: ")]

    def test_luminaire_behind_the_ceiling(self):
        """At 0.2 mm above the ceiling the room was dark, without a warning."""
        behind, before = ("--luminaire", "lamp.ies@.2,.2,2.5002"), ("--luminaire", "lamp.ies@.2,.2,2.4998")
        self.assertIn("close-luminaire", self.kinds(*behind))
        self.assertNotIn("close-luminaire", self.kinds(*before))
        solve = ("solve", "room.mgf", "-o", "room.h5", *self.RAYS)
        self.assertNotIn("luminaires lie", "".join(self.warnings(*solve, *before)))
        commands = (
            (*solve, *behind),
            ("probe", "room.h5", "--point", "1,1,1", "--samples", "4"),
            ("probe", "room.mgf", *behind, "--shading", "path", "--point", "1,1,1", "--samples", "4"),
            ("report", "room.h5", "-o", "room.html", "--samples", "4", "--size", "8x8"),
        )
        for command in commands:
            with self.subTest(command=command):
                found = [line for line in self.warnings(*command) if "luminaires lie behind a surface" in line]
                self.assertEqual(len(found), 1)
                self.assertIn("'lamp-1', at (0.2, 0.2, 2.5002); move them", found[0])

    def test_sky_that_cannot_enter(self):
        self.assertIn("shut-out-sky", self.kinds("--sky", "overcast"))
        found = self.warnings("solve", "room.mgf", "-o", "room.h5", *self.RAYS, "--sky", "overcast")
        self.assertIn("lights only the outside", found[0])
        self.write("room.mgf", room().replace("f v0 v1 v3 v2\n", ""))  # without a floor
        self.assertNotIn("shut-out-sky", self.kinds("--sky", "overcast"))

    def test_maintenance_factor_above_one(self):
        for factor, expected in {"1.25": True, "1": False}.items():
            luminaire = ("--luminaire", f"lamp.ies@.2,.2,2,maintenance={factor}")
            self.assertEqual("maintenance-factor" in self.kinds(*luminaire), expected, factor)
            found = "".join(self.warnings("solve", "room.mgf", "-o", "room.h5", *self.RAYS, *luminaire))
            self.assertEqual("lamp.ies: the maintenance factor 1.25 makes light stronger" in found, expected, found)

    def test_measuring_points(self):
        self.write("room.mgf", room() + box((0.5, 0.5, 0.2), (1, 1, 0.9)))
        self.interflect("solve", "room.mgf", "-o", "room.h5", "--rays", "100k")
        at = {place: ("--point", place) for place in ("1.5,1.5,1", "1.5,1.5,2.6", "0.7,0.7,0.5")}
        probe = ("probe", "room.h5", "--samples", "64")
        self.assertEqual(self.warnings(*probe, *at["1.5,1.5,1"]), [])
        outside, dark = self.warnings(*probe, *at["1.5,1.5,1"], *at["1.5,1.5,2.6"], *at["0.7,0.7,0.5"])
        self.assertIn("1 of 3 measuring points lie outside of the scene, such as (1.5, 1.5, 2.6)", outside)
        self.assertIn("1 of 3 measuring points receive no light at all: they are in a room without light, inside", dark)
        self.assertIn("such as (0.7, 0.7, 0.5)", dark)

    def test_unit_and_up_axis(self):
        corners = [(x, y, z) for z in (0, 500) for y in (0, 300) for x in (0, 400)]  # [cm], with y up
        faces = ((1, 2, 4, 3), (5, 7, 8, 6), (1, 3, 7, 5), (2, 6, 8, 4), (1, 5, 6, 2), (3, 4, 8, 7))
        text = "".join(f"v {x} {y} {z}\n" for x, y, z in corners)
        text += "".join("f " + " ".join(map(str, face)) + "\n" for face in faces)
        for k in range(5):  # boards that stand on the floor
            x, z, i = 60 * k + 20, 80 * k + 30, len(corners) + 4 * k + 1
            text += f"v {x} 0 {z}\nv {x + 40} 0 {z + 20}\nv {x + 40} 90 {z + 20}\nv {x} 90 {z}\n"
            text += f"f {i} {i + 1} {i + 2} {i + 3}\n"
        self.write("room.obj", text)
        solve = ("solve", "room.obj", "-o", "room.h5", *self.RAYS)
        found = "".join(self.warnings(*solve))
        self.assertIn("probably in another unit than metres: light goes", found)
        self.assertIn("(--unit)", found)
        self.assertIn("y is probably up in this file, but z is taken; read it with y as the up axis (--up-axis)", found)
        found = "".join(self.warnings(*solve, "--unit", "cm", "--up-axis", "y"))
        self.assertNotIn("probably", found)


if __name__ == "__main__":
    unittest.main()
