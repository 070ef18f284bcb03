"""`viewfactors`: tables and arrays of View3D's files, against View3D itself, and of groups by name.

View3D 4.0.0 (github.com/jasondegraw/View3D) computed the figures below, with a convergence limit of 1e-6. The
standard errors have 31 degrees of freedom: with a probability of 0.1%, a correct factor deviates by more than 5 errors.
"""

import ast
import csv
import io
import math
import signal
import struct
import subprocess
import time
import unittest
import zipfile

from command import BAD_INPUT, COMMAND, INTERRUPTED, WRONG_USAGE, CommandTest, room

CORNERS = [(x, y, z) for z in (0, 1) for (x, y) in ((0, 0), (1, 0), (1, 1), (0, 1))]
CUBE_FACES = {"zeq0": "1 2 3 4", "xeq0": "1 4 8 5", "yeq0": "1 5 6 2", "zeq1": "7 6 5 8", "xeq1": "7 3 2 6", "yeq1": "7 8 4 3"}


def view3d_file(vertices, surfaces):
    """Surfaces: kind, vertices, base and combined surface, emittance, name."""
    lines = ["F 3"]
    lines += [f"V {k} {x} {y} {z}" for k, (x, y, z) in enumerate(vertices, 1)]
    lines += [f"{surface[0]} {k} {surface[1:]}" for k, surface in enumerate(surfaces, 1)]
    return "\n".join(lines) + "\nEnd of data\n"


CUBE = view3d_file(CORNERS, [f"S {face} 0 0 0.5 {name}" for name, face in CUBE_FACES.items()])
OBSTRUCTED = view3d_file(
    CORNERS + [(0, 0, 0.5), (0.5, 0, 0.5), (0.5, 0.5, 0.5), (0, 0.5, 0.5)],
    [f"S {CUBE_FACES['zeq0']} 0 0 0.5 low", f"S {CUBE_FACES['zeq1']} 0 0 0.5 high", "O 9 10 11 12"],
)
# The L-shaped room of Pinney and Bean (test 4, BRE), whose floor and ceiling are combined from three rectangles each.
L_CORNERS = [
    *((0, 3, 3), (1, 3, 3), (0, 3, 0), (1, 3, 0), (0, 1, 0), (1, 1, 0), (3, 1, 0), (0, 0, 0)),
    *((1, 0, 0), (3, 0, 0), (0, 0, 3), (1, 0, 3), (3, 0, 3), (0, 1, 3), (1, 1, 3), (3, 1, 3)),
]
L_FACES = [
    *("11 13 10 8 0 0", "10 13 16 7 0 0", "6 7 16 15 0 0", "4 6 15 2 0 0", "3 4 2 1 0 0", "8 3 1 11 0 0"),
    *("11 14 15 12 0 0", "8 9 6 5 0 0", "1 2 15 14 0 7", "15 16 13 12 0 7", "5 6 4 3 0 8", "9 10 7 6 0 8"),
]
L_ROOM = view3d_file(L_CORNERS, [f"S {face} 0.9 srf-{k}" for k, face in enumerate(L_FACES, 1)])
VIEW3D = {  # rows of View3D's output
    "cube.vs3": (CUBE, {"zeq0": [0, 0.200044, 0.200044, 0.199825, 0.200044, 0.200044]}),
    "obstructed.vs3": (OBSTRUCTED, {"low": [0, 0.149869], "high": [0.149869, 0]}),
    "l-room.vs3": (
        L_ROOM,
        {
            "srf-1": [0, 0.113154, 0.378093, 0.027473, 0.032894, 0.182356, 0.133017, 0.133017],
            "srf-2": [0.339463, 0, 0.318997, 0, 0, 0.098683, 0.121434, 0.121434],
            "srf-3": [0.567139, 0.159498, 0, 0, 0, 0.041210, 0.116076, 0.116076],
            "srf-7": [0.239430, 0.072861, 0.139291, 0.139291, 0.072861, 0.239430, 0, 0.096836],
        },
    ),
}


def npy(content):
    """Returns the array of a file in NumPy's format, as a list."""
    length = struct.unpack("<H", content[8:10])[0]
    header = ast.literal_eval(content[10 : 10 + length].decode())
    data, kind = content[10 + length :], header["descr"]
    if kind.startswith("<U"):
        width = 4 * int(kind[2:])
        return [data[i : i + width].decode("utf-32-le").rstrip("\0") for i in range(0, len(data), width)]
    return [x for (x,) in struct.iter_unpack("<" + {"<f4": "f", "<f8": "d", "<i4": "i", "<i8": "q"}[kind], data)]


class ViewFactors(CommandTest):
    def table(self, *arguments):
        """Returns {(from, to): (factor, standard error)} and {from: area}."""
        self.interflect("viewfactors", *arguments, "-o", "f.csv")
        rows = list(csv.DictReader(io.StringIO((self.folder / "f.csv").read_text())))
        factors = {(r["from"], r["to"]): (float(r["factor"]), float(r["standard error"])) for r in rows}
        return factors, {r["from"]: float(r["area [m2]"]) for r in rows}

    def test_are_those_of_view3d(self):
        for name, (text, expected) in VIEW3D.items():
            self.write(name, text)
            factors, areas = self.table(name, "--rays", "1M")
            for row, values in expected.items():
                for to, value in zip(areas, values):
                    with self.subTest(name, row=row, to=to):
                        factor, error = factors.get((row, to), (0, 1e-6))
                        self.assertLess(abs(factor - value), 5 * error + 1e-6)

    def test_of_an_obstruction_are_blocked_or_escape(self):
        self.write("obstructed.vs3", OBSTRUCTED)
        factors, areas = self.table("obstructed.vs3", "--rays", "200k")
        self.assertEqual(areas, {"low": 1, "high": 1})
        self.assertEqual({to for row, to in factors if row == "low"}, {"high", "(sky)", "(blocked)"})
        self.assertEqual(
            {to for row, to in factors if row == "high"}, {"low", "(ground)", "(blocked)"}, "it faces down"
        )
        self.assertAlmostEqual(sum(f for (row, _), (f, _) in factors.items() if row == "low"), 1, delta=1e-6)

    def test_arrays_are_those_of_the_table(self):
        self.write("l-room.vs3", L_ROOM)
        factors, areas = self.table("l-room.vs3", "--rays", "100k")
        self.interflect("viewfactors", "l-room.vs3", "-o", "f.npz", "--rays", "100k")
        with zipfile.ZipFile(self.folder / "f.npz") as arrays:
            self.assertIsNone(arrays.testzip())
            data = {name.removesuffix(".npy"): npy(arrays.read(name)) for name in arrays.namelist()}
        self.assertEqual(data["names"], list(areas))
        self.assertEqual(data["areas"], [9, 3, 6, 6, 3, 9, 5, 5])
        self.assertEqual(data["shape"], [8, 8])
        for i, row in enumerate(data["names"]):
            for entry in range(data["row_offsets"][i], data["row_offsets"][i + 1]):
                factor, error = factors[row, data["names"][data["columns"][entry]]]
                self.assertAlmostEqual(data["values"][entry], factor, delta=1e-6)
                self.assertAlmostEqual(data["errors"][entry], error, delta=0.01 * error)
        self.assertEqual(len(data["values"]), len(factors))

    def test_laws_hold_after_the_fit(self):
        self.write("l-room.vs3", L_ROOM)
        factors, areas = self.table("l-room.vs3", "--rays", "100k", "--enforce", "closure,reciprocity")
        for row, area in areas.items():
            self.assertAlmostEqual(sum(f for (name, _), (f, _) in factors.items() if name == row), 1, delta=1e-6)
            for to, other_area in areas.items():
                there, back = factors.get((row, to), (0, 0))[0], factors.get((to, row), (0, 0))[0]
                self.assertTrue(math.isclose(area * there, other_area * back, rel_tol=1e-6), (row, to))

    def test_groups_are_chosen_by_name(self):
        self.write("l-room.vs3", L_ROOM)
        _, areas = self.table("l-room.vs3", "--rays", "10k", "--group", "floor=srf-8", "--group", "rest=srf-?")
        self.assertEqual(areas, {"floor": 5, "rest": 41})
        _, areas = self.table("l-room.vs3", "--rays", "10k", "--groups", "materials")
        self.assertEqual(areas, {"emittance-0.9": 46})
        self.write("room.mgf", room())
        _, areas = self.table("room.mgf", "--rays", "10k", "--sides", "front")
        self.assertEqual(set(areas), {"paint", "lamp"}, "without objects, by materials")

    def test_summary_has_few_groups(self):
        self.write("cube.vs3", CUBE)
        printed = self.interflect("viewfactors", "cube.vs3", "-o", "f.csv", "--rays", "10k").stdout
        self.assertIn("zeq0: 1 m2\n", printed)
        self.assertIn("6 groups, 30 non-zero factors, 1024 rays a group", printed)
        self.assertIn("reciprocity  without the fit", printed)

    def test_depend_on_the_seed_alone(self):
        self.write("cube.vs3", CUBE)
        tables = []
        for options in (("--threads", "1"), ("--threads", "2"), ("--seed", "2")):
            self.interflect("viewfactors", "cube.vs3", "-o", "f.npz", "--rays", "100k", *options)
            tables.append(self.bytes("f.npz"))
        self.assertEqual(tables[0], tables[1])
        self.assertNotEqual(tables[0], tables[2])

    def test_an_interrupt_leaves_no_file(self):
        self.write("cube.vs3", CUBE)
        command = [COMMAND, "viewfactors", "cube.vs3", "-o", "f.csv", "--rays", "10T"]
        with subprocess.Popen(command, cwd=self.folder, stderr=subprocess.PIPE, text=True) as run:
            time.sleep(1)
            run.send_signal(signal.SIGINT)
            _, stderr = run.communicate(timeout=10)
        self.assertEqual(run.returncode, INTERRUPTED)
        self.assertIn("the view factors of 6 of 6 groups are missing: nothing is written", stderr)
        self.assertEqual(self.files(), ["cube.vs3"])

    def test_faults_name_their_option(self):
        self.write("cube.vs3", CUBE)
        self.write("bare.stl", "solid\nfacet\nvertex 0 0 0\nvertex 2 0 0\nvertex 2 3 0\n")
        for arguments, exit_code, message in (
            (("cube.vs3", "-o", "f.txt"), WRONG_USAGE, "expected a name that ends in .csv or .npz, found 'f.txt'"),
            (("cube.vs3", "-o", "f.csv", "--enforce", "law"), WRONG_USAGE, "--enforce: expected closure"),
            (("cube.vs3", "-o", "f.csv", "--sky", "overcast"), WRONG_USAGE, "view factors do not depend on light"),
            (
                ("cube.vs3", "-o", "f.csv", "--groups", "facets", "--group", "a=b"),
                WRONG_USAGE,
                "--group and --groups exclude each other",
            ),
            (("cube.vs3", "-o", "f.csv", "--group", "a=b"), BAD_INPUT, "no object or material of a face matches 'b'"),
        ):
            with self.subTest(arguments):
                stderr = self.interflect("viewfactors", *arguments, exit_code=exit_code).stderr
                self.assertIn(message, stderr)
        self.assertNotIn("f.csv", self.files())


if __name__ == "__main__":
    unittest.main()
