"""Illuminance at points and on grids: closed forms, point positions of EN 12464-1, CSV and summary."""

import csv
import json
import math
import re
import signal
import subprocess
import unittest

from command import BAD_INPUT, COMMAND, INTERRUPTED, WRONG_USAGE, CommandTest, room, vertices

BLACK = "m black =\n\trd 0\n"
HEADER = [
    "x [m]", "y [m]", "z [m]", "E [lx]", "standard error [lx]", "solution error [lx]", "direct [lx]", "indirect [lx]", "area"
]  # fmt: skip


def floor(x=6, y=5, light="v lamp =\n\tp 2 2 2.5\nlight point lamp 1000\n"):
    """A black floor from the origin, object 'floor', and a point light of 1000 cd 2.5 m above it."""
    return BLACK + "o floor\n" + vertices((0, 0, 0), (x, 0, 0), (x, y, 0), (0, y, 0)) + "f v0 v1 v2 v3\no\n" + light


def furnace(exitance=100, reflectance=0.5):
    """A closed box of 2 x 3 x 2.5 m with uniform emission and reflection: H = M / (1 - rho)."""
    return room(lamp="").split("m paint")[0] + f"m paint =\n\tc\n\trd {reflectance}\n\ted {exitance}\n" + (
        "o box\nf v0 v1 v3 v2\nf v4 v6 v7 v5\nf v0 v2 v6 v4\nf v1 v5 v7 v3\nf v0 v4 v5 v1\nf v2 v3 v7 v6\no\n"
    )


class ProbeTest(CommandTest):
    def probe(self, *arguments):
        summary = self.json("probe", *arguments, "-o", "out.csv")["areas"]
        with open(self.folder / "out.csv", newline="") as file:
            header, *rows = csv.reader(file)
        self.assertEqual(header, HEADER)
        return [[*map(float, row[:-1]), row[-1]] for row in rows], summary


class Illuminance(ProbeTest):
    def setUp(self):
        super().setUp()
        self.write("floor.mgf", floor())
        self.path = ("floor.mgf", "--shading", "path", "--samples", "16")

    def test_under_a_point_light_is_that_of_the_inverse_square_and_cosine(self):
        rows, (area,) = self.probe(*self.path, "--grid", "floor")
        self.assertEqual((area["columns"], area["rows"], area["points"], len(rows)), (9, 8, 72, 72))
        for x, y, z, e, error, of_solution, direct, indirect, name in rows:
            r = math.dist((x, y, z), (2, 2, 2.5))
            self.assertAlmostEqual(e, 1000 * 2.5 / r**3, delta=1e-3 * e)
            self.assertEqual((of_solution, direct, indirect, name), (0, e, 0, "floor"))
        values = [row[3] for row in rows]
        self.assertAlmostEqual(area["mean"], sum(values) / 72, delta=1e-3)
        self.assertAlmostEqual(area["uniformity"], min(values) / area["mean"], delta=1e-5)
        self.assertAlmostEqual(area["diversity"], min(values) / max(values), delta=1e-5)

    def test_by_paths_cuts_faces_at_contacts_as_solving_does(self):
        sheet = "m sheet =\n\trd 0.5\n" + vertices((1, 1, 0), (2, 1, 0), (2, 1, 1), (1, 1, 1)) + "f v0 v1 v2 v3\n"
        self.write("standing.mgf", floor() + sheet)
        path, message = ("standing.mgf", "--shading", "path", "--samples", "2", "--point", "3,3,1"), "faces are cut"
        self.assertIn(message, self.interflect("probe", *path).stderr)
        self.assertNotIn(message, self.interflect("probe", *path, "--no-contact-cuts").stderr)

    def test_of_every_quantity_at_a_point(self):
        # The lamp is 3 m to the side (+x) and 1.5 m above.
        point, r = ("--point", "-1,2,1"), math.hypot(3, 1.5)
        facing = 1000 / r**2
        sine = 3 / r
        for quantity, expected in {
            ("horizontal",): facing * 1.5 / r,
            ("vertical", "--direction", "2,0,0.5"): facing * sine,
            ("vertical", "--direction", "-1,0,0"): 0,
            ("cylindrical",): facing * sine / math.pi,
            ("semicylindrical", "--direction", "1,0,0"): facing * sine * 2 / math.pi,
            ("semicylindrical", "--direction", "0,1,0"): facing * sine / math.pi,
        }.items():
            with self.subTest(quantity):
                rows, _ = self.probe("floor.mgf", "--shading", "path", *point, "--quantity", *quantity)
                self.assertAlmostEqual(rows[0][3], expected, delta=max(0.01 * expected, 1e-6))

    def test_in_a_furnace_is_the_same_everywhere_and_by_either_way(self):
        self.write("box.mgf", furnace())
        self.interflect("solve", "box.mgf", "-o", "box.h5", "--rays", "200k", "--mesh-size", "1")
        for source in (("box.h5",), ("box.mgf", "--shading", "path"), ("box.mgf", "--rays", "200k")):
            with self.subTest(source):
                rows, areas = self.probe(*source, "--plane", "1", "--point", "1,1,2", "--samples", "4096")
                self.assertEqual([area["name"] for area in areas], ["z = 1 m", "points"])
                for *_, e, error, _, direct, indirect, _ in rows:
                    self.assertAlmostEqual(e, 200, delta=5 * error + 2)
                    self.assertLess(error, 3)
                    self.assertAlmostEqual(direct, 100, delta=5 * error + 2)

    def test_states_the_error_of_the_solution(self):
        """A solution of few rays has an error beyond its sampling noise. Path tracing has no such error."""
        self.write("room.mgf", room())
        places = ("--plane", "0.75", "--samples", "1024")
        rows, (area,) = self.probe("room.mgf", "--method", "srr", "--rays", "20k", "--mesh-size", "0.5", *places)
        _, (true,) = self.probe("room.mgf", "--shading", "path", *places)
        difference = abs(area["mean"] - true["mean"])
        self.assertGreater(difference, 4 * math.hypot(area["standard_error"], true["standard_error"]))
        self.assertLess(difference, 3 * area["solution_error"])
        self.assertLess(area["solution_error"], 2 * difference)
        self.assertEqual(true["solution_error"], 0)
        for *_, of_solution, _, indirect, _ in rows:
            self.assertAlmostEqual(of_solution / indirect, rows[0][5] / rows[0][7], delta=1e-2 * of_solution / indirect)

    def test_has_the_same_bits_on_any_number_of_threads(self):
        self.write("box.mgf", furnace())
        one, two = (
            self.probe("box.mgf", "--rays", "50k", "--plane", "1", "--samples", "64", "--threads", threads)[0]
            for threads in ("1", "2")
        )
        self.assertEqual(one, two)

    def test_until_an_error_takes_as_many_samples_as_it_needs(self):
        self.write("box.mgf", furnace())
        source = ("box.mgf", "--shading", "path", "--point", "1,1,1", "--samples", "64")
        rows, _ = self.probe(*source, "--until", "1%")
        self.assertLess(rows[0][4], 0.02 * 200)
        self.assertLess(rows[0][4], self.probe(*source)[0][0][4])

    def test_of_daylight_is_a_share_of_that_outside(self):
        self.write("sky.mgf", floor(light="light sky 1000\n"))
        _, (area,) = self.probe("sky.mgf", "--shading", "path", "--grid", "floor")
        self.assertAlmostEqual(area["daylight_factor"], 1, delta=0.01)
        _, (area,) = self.probe("sky.mgf", "--shading", "path", "--grid", "floor", "--exterior", "10000")
        self.assertAlmostEqual(area["daylight_factor"], math.pi / 10, delta=0.004)
        self.assertIn("daylight factor   mean", self.interflect("probe", "sky.mgf", "--shading", "path", "--grid", "floor").stdout)
        lit = self.interflect("probe", *self.path, "--grid", "floor")
        self.assertNotIn("daylight", lit.stdout)


class Places(ProbeTest):
    def setUp(self):
        super().setUp()
        self.write("floor.mgf", floor())

    def points(self, *places):
        return self.probe("floor.mgf", "--shading", "path", "--samples", "2", *places)[0]

    def test_a_boundary_strip_is_left_out(self):
        for option in ("--boundary", "--boundary=0.5"):
            rows = self.points("--grid", "floor", "--spacing", "1", option)
            self.assertEqual(len(rows), 20)
            self.assertEqual((min(r[0] for r in rows), max(r[0] for r in rows)), (1, 5))
            self.assertEqual((min(r[1] for r in rows), max(r[1] for r in rows)), (1, 4))

    def test_lines_points_and_planes(self):
        rows = self.points("--line", "0,1,1:4,1,1:5", "--line", "0,0,1:1,0,1", "--point", "1,2,3", "--point", "3,2,1")
        self.assertEqual([row[:3] for row in rows[:2]], [[1, 2, 3], [3, 2, 1]])
        self.assertEqual([row[0] for row in rows[2:7]], [0, 1, 2, 3, 4])
        self.assertEqual([row[-1] for row in rows[2:]], ["line 1"] * 5 + ["line 2"] * 11)
        rows = self.points("--plane", "0.75", "--over", "floor", "--spacing", "2")
        self.assertEqual([row[2] for row in rows], [0.75] * 9)

    def test_the_side_of_a_surface_is_the_lit_one_unless_it_is_told(self):
        up = self.points("--surface", "floor", "--spacing", "5")
        down = self.points("--surface", "floor", "--spacing", "5", "--facing", "0,0,-1")
        self.assertGreater(up[0][3], 1)
        self.assertEqual(down[0][3], 0)

    def test_names_are_fields_of_csv(self):
        self.write("floor.mgf", floor().replace("o floor", 'o a,"b"'))
        self.assertEqual(self.points("--grid", 'a,"b"', "--spacing", "5")[0][-1], 'a,"b"')


class Summary(ProbeTest):
    def test_is_text_with_units(self):
        self.write("floor.mgf", floor())
        text = self.interflect("probe", "floor.mgf", "--shading", "path", "--grid", "floor").stdout
        self.assertRegex(text, r"^floor: 72 points, 9 x 8, 0\.667 x 0\.625 m apart\n")
        for line in (r"mean +[\d.]+ lx, standard error", r"minimum +[\d.]+ lx", r"Emin/Emean \(U0\) +0\.\d+", r"Emin/Emax +0\.\d+"):
            self.assertRegex(text, line)


class Faults(ProbeTest):
    def setUp(self):
        super().setUp()
        self.write("floor.mgf", floor())

    def assert_refused(self, arguments, *words, exit_code=BAD_INPUT):
        with self.subTest(arguments):
            result = self.interflect("probe", "floor.mgf", "--shading", "path", *arguments, exit_code=exit_code)
            for word in words:
                self.assertIn(word, result.stderr)
            self.assertEqual((result.stdout, self.files()), ("", ["floor.mgf"]))

    def test_say_what_was_expected(self):
        csv_file = ("-o", "out.csv")
        self.assert_refused(csv_file, "expected --grid, --plane", exit_code=WRONG_USAGE)
        self.assert_refused(["--grid", "flor", *csv_file], "'flor'", "'floor'")
        self.assert_refused(["--grid", "floor", "--boundary=3", *csv_file], "boundary")
        self.assert_refused(["--grid", "floor", "--spacing", "1e-5", *csv_file], "at most 1000000")
        self.assert_refused(["--surface", "floor", "--facing", "1,0,0"], "faces 1,0,0")
        self.assert_refused(["--plane", "-1"], "no floor")
        self.assert_refused(["--point", "1,1,1", "--quantity", "vertical"], "--direction", exit_code=WRONG_USAGE)
        self.assert_refused(["--point", "1,1,1", "--quantity", "semicylindrical", "--direction", "0,0,1"], "--direction", exit_code=WRONG_USAGE)
        self.assert_refused(["--point", "1,1,1", "--direction", "1,0,0"], "--direction", exit_code=WRONG_USAGE)
        self.assert_refused(["--point", "1,1,1", "--spacing", "1"], "--spacing", exit_code=WRONG_USAGE)
        self.assert_refused(["--point", "1,1,1", "--over", "floor"], "--over", exit_code=WRONG_USAGE)
        self.assert_refused(["--point", "1,1,1", "--rays", "1M"], "--rays", exit_code=WRONG_USAGE)
        self.assert_refused(["--point", "1,1,1", "-o", "floor.mgf"], "floor.mgf", exit_code=WRONG_USAGE)

    def test_of_usage(self):
        for arguments in (
            ["--point", "1,1"], ["--line", "0,0,0"], ["--line", "0,0,0:1,1,1:1"], ["--line", "0,0,0:1,1,1:2.5"],
            ["--plane", "high"], ["--spacing", "0"], ["--boundary=-1"], ["--quantity", "luminous"], ["--exterior", "0"],
            ["--samples", "1"],
        ):  # fmt: skip
            self.assert_refused(arguments, arguments[0].split("=")[0], exit_code=WRONG_USAGE)

    def test_an_interruption_keeps_what_there_is(self):
        self.write("floor.mgf", furnace())
        process = subprocess.Popen(
            [COMMAND, "probe", "floor.mgf", "--shading", "path", "--point", "1,1,1", "--samples", "16000000", "-o", "out.csv"],
            cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        self.assertIn("rays", process.stderr.readline())
        process.send_signal(signal.SIGINT)
        output, messages = process.communicate(timeout=20)
        self.assertEqual(process.returncode, INTERRUPTED, messages)
        self.assertRegex(output, r"mean +(19\d\.\d|20\d\.\d|200)")
        self.assertEqual(len((self.folder / "out.csv").read_text().splitlines()), 2)

    def test_an_interruption_leaves_the_error_of_the_solution_unknown(self):
        self.write("floor.mgf", furnace())
        process = subprocess.Popen(
            [COMMAND, "probe", "floor.mgf", "--rays", "20k", "--point", "1,1,1", "--samples", "16000000", "--json", "-o", "out.csv"],
            cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        next(line for line in process.stderr if "elements" in line)  # gathering follows
        self.assertIn("rays", process.stderr.readline())
        process.send_signal(signal.SIGINT)
        output, messages = process.communicate(timeout=20)
        self.assertEqual(process.returncode, INTERRUPTED, messages)
        self.assertNotIn("solution_error", json.loads(output)["areas"][0])
        self.assertEqual((self.folder / "out.csv").read_text().splitlines()[1].split(",")[5], "")


if __name__ == "__main__":
    unittest.main()
