"""Shared by the tests of the command."""

import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COMMAND = os.environ["INTERFLECT_COMMAND"]
DONE, FAILED, WRONG_USAGE, BAD_INPUT, INTERRUPTED = 0, 1, 2, 3, 130

PAINT = "m paint =\n\tc grey =\n\t\tcxy .36 .34\n\trd .6\n"
LAMP = "m lamp =\n\tc\n\tsides 1\n\ted 1000\n"


def vertices(*points):
    return "".join(f"v v{k} =\n\tp {x} {y} {z}\n" for k, (x, y, z) in enumerate(points))


def room(lamp=LAMP):
    """A closed room of 2 x 3 x 2.5 m with a lamp under its ceiling."""
    corners = [(x, y, z) for z in (0, 2.5) for y in (0, 3) for x in (0, 2)]
    walls = "f v0 v1 v3 v2\nf v4 v6 v7 v5\nf v0 v2 v6 v4\nf v1 v5 v7 v3\nf v0 v4 v5 v1\nf v2 v3 v7 v6\n"
    lamp_corners = vertices((0.5, 1, 2.4), (0.5, 2, 2.4), (1.5, 2, 2.4), (1.5, 1, 2.4))
    return vertices(*corners) + PAINT + walls + lamp_corners + lamp + "f v0 v1 v2 v3\n"


VIEW = ("--eye", "0.3,0.2,1.6", "--look-at", "1.2,3,1")
VIEWS = {
    "views": [
        {"name": "door", "eye": [0.3, 0.2, 1.6], "look_at": [1.2, 3, 1], "up": [0, 0, 1], "fov": 45},
        {"name": "floor", "eye": [1, 0.1, 2.2], "look_at": [1, 2, 0], "up": [0, 0, 1], "fov": 60},
    ]
}
SMALL = ("--size", "32x18", "--samples", "4")
LARGE = ("--size", "96x54", "--samples", "4")
SOLVED = ("--rays", "50k", "--mesh-size", "0.5")


def methods():
    text = subprocess.run([COMMAND, "solve", "--help-all"], capture_output=True, text=True, check=True).stdout
    return re.search(r"--method (\S+)", text)[1].split("|")


solutions = {}  # of files and options, for all tests of a program


class CommandTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def maze(self, rooms):
        """Makes a maze and returns the file's name."""
        name = f"maze-{rooms}.mgf"
        if not (self.folder / name).exists():
            subprocess.run([COMMAND, "make-scene", "maze", "--rooms", str(rooms), "-o", name], cwd=self.folder, check=True)
        return name

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    def interflect(self, *arguments, exit_code=DONE, timeout=60):
        """Fails on another exit code and on a hang."""
        result = subprocess.run(
            [COMMAND, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True, timeout=timeout
        )
        self.assertEqual(result.returncode, exit_code, f"interflect {' '.join(map(str, arguments))}\n{result.stderr}")
        return result

    def write_solution(self, name, scene, *options):
        """Solves a scene. Tests of one program with the same files and options share the solution."""
        key = (tuple((file, self.bytes(file)) for file in self.files()), scene, options)
        if key not in solutions:
            self.interflect("solve", scene, "-o", name, *options)
            solutions[key] = self.bytes(name)
        (self.folder / name).write_bytes(solutions[key])

    def json(self, *arguments):
        return json.loads(self.interflect(*arguments, "--json").stdout)

    def bytes(self, name):
        content = (self.folder / name).read_bytes()
        self.assertGreater(len(content), 0, name)
        return content

    def files(self):
        """Returns all files in the test's folder, including hidden ones."""
        return sorted(path.relative_to(self.folder).as_posix() for path in self.folder.rglob("*") if path.is_file())


class RenderTest(CommandTest):
    """Pictures of the closed room."""

    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())
        self.write("room.views.json", json.dumps(VIEWS))

    def render(self, name, *options, source="room.mgf", size=SMALL):
        solver = SOLVED if source.endswith(".mgf") else ()
        self.interflect("render", source, "-o", name, *size, *solver, *options)
        return self.bytes(name)

    def solve(self, *options):
        self.write_solution("room.h5", "room.mgf", *SOLVED, *options)
