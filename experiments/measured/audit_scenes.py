"""Difficult scenes for experiments/measured/audit.py, as MGF text with a view; identical on every machine and in every run."""

import math
import random
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from PIL import Image

Point = Sequence[float]


class Mgf:
    """Writes materials and faces. The front of a face is the side from which its corners run counter-clockwise."""

    def __init__(self, scale: float = 1.0, offset: Point = (0, 0, 0)):
        self._lines: list[str] = []
        self._vertices = 0
        self._scale, self._offset = scale, offset

    def text(self) -> str:
        return "\n".join(self._lines) + "\n"

    def add(self, line: str) -> None:
        self._lines.append(line)

    def material(self, name: str, *properties: str, sides: int = 1, colour: Point | None = None) -> None:
        """`colour` is the chromaticity x, y of the reflectance."""
        self._lines += [f"m {name} =", "\tc", *([f"\t\tcxy {colour[0]} {colour[1]}"] if colour else [])]
        self._lines += [f"\t{line}" for line in (f"sides {sides}", *properties)]

    def lamp(self, name: str, exitance: float, reflectance: float = 0.1) -> None:
        """The lamp is white and resets the colour."""
        self.material(name, f"rd {reflectance}", f"ed {exitance}")

    def vertex(self, point: Point, *properties: str) -> str:
        self._vertices += 1
        place = " ".join(f"{self._scale * x + dx:.9g}" for x, dx in zip(point, self._offset, strict=True))
        self._lines += [f"v v{self._vertices} =", f"\tp {place}", *(f"\t{line}" for line in properties)]
        return f"v{self._vertices}"

    def face(self, material: str, *points: Point) -> None:
        corners = [self.vertex(point) for point in points]
        self._lines += [f"m {material}", f"f {' '.join(corners)}"]

    def quad(self, material: str, corner: Point, u: Point, v: Point) -> None:
        """Adds a parallelogram, visible from the side of u x v."""
        a, u, v = np.array(corner, float), np.array(u, float), np.array(v, float)
        self.face(material, a, a + u, a + u + v, a + v)

    def box(self, material: str, low: Point, size: Point, turn: float = 0.0, inwards: bool = False, without: str = "") -> None:
        """Adds a box, rotated about the vertical axis through its middle by `turn` degrees, without some sides ("-z")."""
        self.sides(dict.fromkeys(("-x", "+x", "-y", "+y", "-z", "+z"), material), low, size, turn, inwards, without)

    def sides(self, materials: dict[str, str], low: Point, size: Point, turn=0.0, inwards=False, without="") -> None:
        low, size = np.array(low, float), np.array(size, float)
        middle, (c, s) = low + size / 2, (math.cos(math.radians(turn)), math.sin(math.radians(turn)))

        def place(*share: int) -> np.ndarray:
            x, y, z = low + size * share - middle
            return middle + (c * x - s * y, s * x + c * y, z)

        corners = {
            "-x": (place(0, 0, 0), place(0, 0, 1), place(0, 1, 1), place(0, 1, 0)),
            "+x": (place(1, 0, 0), place(1, 1, 0), place(1, 1, 1), place(1, 0, 1)),
            "-y": (place(0, 0, 0), place(1, 0, 0), place(1, 0, 1), place(0, 0, 1)),
            "+y": (place(0, 1, 0), place(0, 1, 1), place(1, 1, 1), place(1, 1, 0)),
            "-z": (place(0, 0, 0), place(0, 1, 0), place(1, 1, 0), place(1, 0, 0)),
            "+z": (place(0, 0, 1), place(1, 0, 1), place(1, 1, 1), place(0, 1, 1)),
        }
        for name, points in corners.items():
            if name not in without.split():
                self.face(materials[name], *(points[::-1] if inwards else points))

    def fixture(self, lamp: str, low: Point, size: Point, ceiling: float | None = None, shines: str = "-z") -> None:
        """Adds a closed box with one luminous side; with `ceiling`, it reaches up to the ceiling."""
        size = [*size[:2], ceiling - low[2]] if ceiling else size
        housing = dict.fromkeys(("-x", "+x", "-y", "+y", "-z", "+z"), "grey")
        self.sides(housing | {shines: lamp}, low, size, without="+z" if ceiling else "")

    def room(self, size: Point, without: str = "") -> None:
        """Defines four paints for use elsewhere: white, grey, red and blue."""
        self.material("white", "rd 0.71")
        self.material("grey", "rd 0.34")
        self.material("red", "rd 0.27", colour=(0.45, 0.34))
        self.material("blue", "rd 0.42", colour=(0.27, 0.29))
        paints = {"-x": "red", "+x": "blue", "-y": "white", "+y": "white", "-z": "grey", "+z": "white"}
        self.sides(paints, (0, 0, 0), size, inwards=True, without=without)

    def wall_with_hole(self, material: str, corner: Point, u: Point, v: Point, hole: Point) -> None:
        """Adds a parallelogram without the part from u0, v0 to u1, v1 (`hole`, as shares of its sides)."""
        a, u, v = np.array(corner, float), np.array(u, float), np.array(v, float)
        u0, v0, u1, v1 = hole
        for left, bottom, right, top in ((0, 0, u0, 1), (u1, 0, 1, 1), (u0, 0, u1, v0), (u0, v1, u1, 1)):
            self.quad(material, a + left * u + bottom * v, (right - left) * u, (top - bottom) * v)


@dataclass
class Scene:
    text: str
    eye: Point
    look_at: Point
    fov: float = 60.0
    up: Point = (0, 0, 1)
    options: str = ""  # for commands that read it
    reference_text: str = ""  # the same scene in a form that the path tracer draws exactly
    total: bool = False  # also solve it without a view, and compare the total power
    images: dict[str, np.ndarray] = field(default_factory=dict)  # image files beside it
    files: dict[str, str] = field(default_factory=dict)  # text files beside it, such as .ies
    mirrors: bool = False  # has a mirror in its view
    samples: int = 8  # paths per pixel of each of the two reference pictures

    def view(self) -> str:
        places = [",".join(f"{x:g}" for x in place) for place in (self.eye, self.look_at, self.up)]
        return f"--eye {places[0]} --look-at {places[1]} --up {places[2]} --fov {self.fov:g}"

    def write(self, folder: Path, name: str, text: str) -> Path:
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / f"{name}.mgf"
        path.write_text(text)
        for file, texels in self.images.items():
            Image.fromarray(texels).save(folder / file)
        for file, content in self.files.items():
            (folder / file).write_text(content)
        return path


def cornell(size: float = 1.0, offset: Point = (0, 0, 0)) -> Scene:
    """The measured Cornell box, in units of 10 mm times `size`; its front is open."""
    unit = 0.01 * size
    m = Mgf(unit, offset)
    m.material("white", "rd 0.74")
    m.material("red", "rd 0.16", colour=(0.57, 0.33))
    m.material("green", "rd 0.22", colour=(0.31, 0.54))
    m.lamp("lamp", 4000, 0.78)
    a, b, c, d = (552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2)
    e, f, g, h = (556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0)
    m.face("white", a, b, c, d)
    m.face("white", e, f, g, h)
    m.face("white", d, c, g, f)
    m.face("green", c, b, h, g)
    m.face("red", a, d, f, e)
    m.face("lamp", (343, 548.7, 227), (343, 548.7, 332), (213, 548.7, 332), (213, 548.7, 227))
    short = [(130, 65), (82, 225), (240, 272), (290, 114)]
    tall = [(423, 247), (265, 296), (314, 456), (472, 406)]
    for base, height in ((short, 165), (tall, 330)):
        m.face("white", *((x, height, z) for x, z in base))
        for (x0, z0), (x1, z1) in zip(base, base[1:] + base[:1]):
            m.face("white", (x0, 0, z0), (x1, 0, z1), (x1, height, z1), (x0, height, z0))
    eye, target = ([unit * x + dx for x, dx in zip(point, offset)] for point in ((278, 273, -800), (278, 273, 0)))
    return Scene(m.text(), eye, target, 39, (0, 1, 0))


def soup() -> Scene:
    m, random_ = Mgf(), random.Random(1)
    m.room((6.2, 5.1, 3.3))
    m.lamp("lamp", 9000)
    m.fixture("lamp", (2.1, 2.6, 3.25), (0.9, 0.7), 3.3)
    for name, share in (("leaf", 0.31), ("petal", 0.62)):
        m.material(name, f"rd {share}", sides=2)
    for k in range(100_000):
        middle = [random_.uniform(0.05, side - 0.05) for side in (6.2, 5.1, 3.1)]
        points = [[x + random_.uniform(-0.02, 0.02) for x in middle] for _ in range(3)]
        m.face("petal" if k % 3 == 0 else "leaf", *points)
    return Scene(m.text(), (0.5, 0.4, 1.9), (4.5, 4.1, 0.9), 55)


def white_box() -> Scene:
    """All surfaces reflect 0.95, so the total power is the power of the lamp / (1 - 0.95)."""
    m = Mgf()
    m.material("white", "rd 0.95")
    m.box("white", (0, 0, 0), (4.1, 2.9, 3.3), inwards=True)
    m.lamp("lamp", 3000, 0.95)
    m.box("white", (2.4, 1.2, 0), (0.9, 0.8, 1.3), 25, without="-z")
    m.box("lamp", (0.9, 1.7, 2.2), (0.4, 0.5, 0.3))
    return Scene(m.text(), (0.3, 0.2, 1.5), (3.1, 2.3, 1.1), 60, total=True, samples=4)


def huge_lamp() -> Scene:
    m = Mgf()
    m.room((31, 17, 6), "+z")
    m.lamp("lamp", 700, 0.45)
    m.quad("lamp", (0, 0, 6), (0, 17, 0), (31, 0, 0))
    for k, (x, y) in enumerate(((5, 4), (9, 11), (15, 6), (19, 13), (24, 5), (12.5, 3))):
        m.box("white", (x, y, 0), (0.8, 0.6, 6 if k % 2 else 1.7 + 0.4 * k), 13 * k, without="-z")
    return Scene(m.text(), (1.2, 1.5, 2.6), (17, 9, 1.2), 55)


def furnish(m: Mgf) -> None:
    """Adds four boxes in a room of 5.2 x 4.1 x 2.8 m."""
    m.box("blue", (1.4, 2.1, 0), (0.9, 0.7, 0.75), 20, without="-z")
    m.box("white", (3.3, 1.0, 0), (0.6, 0.6, 1.6), -35, without="-z")
    m.box("red", (2.5, 3.2, 0), (1.1, 0.4, 1.1), 4, without="-z")
    m.box("white", (1.7, 2.3, 0.75), (0.25, 0.2, 0.3), 50, without="-z")


def tiny_lamp() -> Scene:
    m = Mgf()
    m.room((5.2, 4.1, 2.8))
    furnish(m)
    m.lamp("lamp", 2e9)
    m.fixture("lamp", (2.9, 2.2, 2.6), (0.001, 0.001, 0.001))
    return Scene(m.text(), (0.4, 0.3, 1.7), (3.1, 2.6, 0.7), 60)


def thousand_lamps() -> Scene:
    m, random_ = Mgf(), random.Random(2)
    m.room((12.3, 8.1, 3.1))
    for k in range(5):
        m.lamp(f"lamp{k}", 2000 * 3**k)
        m.box("red" if k % 2 else "white", (1.5 + 2.1 * k, 2 + k % 3 * 1.7, 0), (0.8, 0.9, 0.6 + 0.4 * k), 17 * k, without="-z")
    for k in range(1000):
        x, y, side = random_.uniform(0.1, 12.1), random_.uniform(0.1, 7.9), random_.uniform(0.01, 0.03)
        m.fixture(f"lamp{k % 5}", (x, y, random_.uniform(2.9, 3.05)), (side, side), 3.1)
    return Scene(m.text(), (0.6, 0.5, 1.7), (8, 5.5, 0.6), 60)


def pane() -> Scene:
    """A room divided by a pane; the light comes from the other half."""
    m = Mgf()
    m.room((5.2, 4.1, 2.8))
    furnish(m)
    m.material("glass", "rd 0.06", "ts 0.61 0", sides=2)
    m.quad("glass", (2.95, 0, 0), (0, 4.1, 0), (0, 0, 2.8))
    m.lamp("lamp", 21000)
    m.fixture("lamp", (4.1, 2.9, 2.7), (0.4, 0.5), 2.8)
    return Scene(m.text(), (0.4, 0.3, 1.7), (3.1, 2.6, 0.9), 65)


def textured_emitter() -> Scene:
    """An emitter whose texels differ strongly, beside a wall."""
    m, random_ = Mgf(), random.Random(3)
    m.room((5.2, 4.1, 2.8))
    furnish(m)
    texels = [[[int(255 * random_.random() ** 4 * share) for share in (1, 0.8, 0.6)] for _ in range(24)] for _ in range(16)]
    m.material("screen", "rd 0.05", "ed 9000", "texture ed audit-screen.png")
    corners = [m.vertex((0.9 + 1.3 * u, 4.0, 1.5 + 0.9 * v), f"uv {u} {v}") for u, v in ((0, 0), (1, 0), (1, 1), (0, 1))]
    m.add(f"m screen\nf {' '.join(corners)}")
    m.box("grey", (0.9, 4.0, 1.5), (1.3, 0.1, 0.9), without="-y +y")
    images = {"audit-screen.png": np.array(texels, dtype=np.uint8)}
    return Scene(m.text(), (0.4, 0.3, 1.7), (3.1, 3.4, 0.9), 65, images=images)


def coincident_faces() -> Scene:
    """Duplicate faces, coincident faces back to back, a rug in the plane of the floor, and boxes with common faces.
    Coincident faces have the same paint."""
    m = Mgf()
    m.room((5.2, 4.1, 2.8))
    furnish(m)
    furnish(m)
    m.quad("grey", (0.7, 0.6, 0), (2.3, 0.4, 0), (-0.3, 1.6, 0))  # the rug
    m.box("white", (3.9, 2.4, 0), (0.5, 0.7, 0.8))
    m.box("white", (3.9, 2.4, 0.8), (0.5, 0.7, 0.5))
    m.box("white", (4.4, 2.6, 0), (0.3, 0.4, 1.0))
    m.quad("white", (0, 0, 2.8), (0, 4.1, 0), (5.2, 0, 0))
    m.quad("blue", (1.0, 3.3, 0.2), (0.9, 0, 0), (0, 0, 1.4))
    m.quad("blue", (1.9, 3.3, 0.2), (-0.9, 0, 0), (0, 0, 1.4))
    m.lamp("lamp", 11000)
    m.fixture("lamp", (2.6, 1.6, 2.79), (0.5, 0.6), 2.8)
    return Scene(m.text(), (0.4, 0.3, 1.7), (3.1, 2.6, 0.7), 60)


def house(m: Mgf, hole: Point) -> None:
    """Adds a house of 5.2 x 4.1 x 2.8 m with walls of zero thickness, and a window in its wall x = 0."""
    for name, share in (("white", 0.71), ("grey", 0.34), ("red", 0.27), ("blue", 0.42)):
        m.material(name, f"rd {share}", sides=2)
    m.sides({s: "grey" if s == "-z" else "white" for s in ("+x", "-y", "+y", "-z", "+z")} | {"-x": "white"}, (0, 0, 0), (5.2, 4.1, 2.8), without="-x")
    m.wall_with_hole("white", (0, 0, 0), (0, 4.1, 0), (0, 0, 2.8), hole)
    furnish(m)


def sun_window() -> Scene:
    m = Mgf()
    house(m, (0.4, 0.5, 0.5, 0.65))
    m.add(f"light directional {m.vertex((0, 0, 0), 'n 0.8 0.22 -0.5')} 60000")
    return Scene(m.text(), (0.4, 0.3, 1.7), (3.1, 2.6, 0.7), 65, samples=16)


def black_wall() -> Scene:
    """The view shows mostly a wall that reflects 0.4%, beside a corner; the light falls in steeply."""
    m = Mgf()
    m.room((5.2, 4.1, 2.8), "+y")
    m.material("black", "rd 0.004")
    m.quad("black", (5.2, 4.1, 0), (-5.2, 0, 0), (0, 0, 2.8))
    furnish(m)
    m.lamp("lamp", 30000)
    m.fixture("lamp", (1.2, 3.7, 2.7), (0.3, 0.15), 2.8)
    m.fixture("lamp", (4.7, 2.0, 2.2), (0.1, 0.1), 2.8)
    return Scene(m.text(), (2.7, 2.3, 1.9), (2.3, 4.1, 1.85), 60)


def slivers() -> Scene:
    """A floor of triangles of 4 m x 1.3 mm, crossed by a shadow."""
    m = Mgf()
    m.room((4.0, 1.3, 2.4), "-z")
    for k in range(1000):
        y = 0.0013 * k
        m.face("grey", (0, y, 0), (4, y, 0), (4, y + 0.0013, 0))
        m.face("grey", (0, y, 0), (4, y + 0.0013, 0), (0, y + 0.0013, 0))
    m.box("white", (1.5, 0.4, 0.3), (0.5, 0.4, 0.2), 10)
    m.lamp("lamp", 15000)
    m.fixture("lamp", (0.7, 0.3, 1.3), (0.2, 0.2), 2.4)
    return Scene(m.text(), (3.7, 0.15, 1.7), (1.3, 0.8, 0.0), 55)


def hall() -> Scene:
    """A hall of 100 m with cubes of 1 cm on its floor; the view shows some of them from near."""
    m, random_ = Mgf(), random.Random(4)
    m.room((100, 61, 12))
    m.lamp("lamp", 12000)
    for k in range(12):
        m.fixture("lamp", (9 + 16 * (k % 6), 17 + 23 * (k // 6), 11.5), (1.1, 1.4), 12)
    for k in range(400):
        x, y = random_.gauss(37, 0.25), random_.gauss(21, 0.25)
        m.box(("white", "red", "blue")[k % 3], (x, y, 0), (0.01, 0.01, 0.01), random_.uniform(0, 90), without="-z")
    return Scene(m.text(), (36.6, 20.5, 0.35), (37, 21, 0), 45)


def up_lights() -> Scene:
    """Lamps 2 cm below the ceiling that shine up."""
    m = Mgf()
    m.room((6.3, 4.4, 2.9))
    m.lamp("lamp", 16000, 0.5)
    m.material("housing", "rd 0.5")
    for x, y in ((1.1, 1.0), (3.9, 1.3), (2.2, 3.1), (5.2, 3.3)):
        m.sides(dict.fromkeys(("-x", "+x", "-y", "+y", "-z"), "housing") | {"+z": "lamp"}, (x, y, 2.83), (0.4, 0.3, 0.05), 9)
    m.box("blue", (2.6, 1.7, 0), (1.2, 0.8, 0.7), 20, without="-z")
    m.box("white", (4.3, 2.5, 0), (0.7, 0.7, 1.5), -30, without="-z")
    return Scene(m.text(), (0.5, 0.4, 1.6), (3.6, 2.6, 0.6), 60, total=True, samples=16)


def slit() -> Scene:
    """Two rooms joined by a slit of 1 cm; the view shows the room without a lamp."""
    m = Mgf()
    m.room((7.5, 3.2, 2.7))
    m.box("white", (4.0, 0.01, 0), (0.1, 3.19, 2.7), without="+y -z +z")
    m.box("red", (5.6, 1.5, 0), (0.5, 0.6, 0.9), 30, without="-z")
    m.box("blue", (1.6, 1.9, 0), (0.7, 0.6, 0.8), 15, without="-z")
    m.lamp("lamp", 40000)
    m.fixture("lamp", (2.1, 1.2, 2.6), (0.8, 0.6), 2.7)
    return Scene(m.text(), (7.2, 2.9, 1.6), (4.6, 0.8, 0.9), 65, total=True, samples=48)


def landscape(m: Mgf, clear: float) -> None:
    """Adds hills of 1 km x 1 km around a flat square of side 2 `clear` at height 0."""
    m.material("grass", "rd 0.19", sides=2, colour=(0.35, 0.42))
    random_, n, step = random.Random(5), 24, 1000 / 24
    heights = [[random_.uniform(0, 22) for _ in range(n + 1)] for _ in range(n + 1)]

    def place(i: int, j: int) -> Point:
        x, y = (i - n / 2) * step, (j - n / 2) * step
        return (x, y, 0 if max(abs(x), abs(y)) < clear else heights[i][j])

    for i in range(n):
        for j in range(n):
            a, b, c, d = place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)
            m.face("grass", a, b, c)
            m.face("grass", a, c, d)


def outdoor() -> Scene:
    m, random_ = Mgf(), random.Random(6)
    landscape(m, 130)
    for name, share in (("white", 0.68), ("brick", 0.24)):
        m.material(name, f"rd {share}", sides=2)
    for k in range(30):
        x, y = -100 + 34 * (k % 6), -95 + 41 * (k // 6)
        size = [random_.uniform(6, 15), random_.uniform(6, 15), random_.uniform(3, 18)]
        m.box("brick" if k % 3 else "white", (x, y, 0), size, random_.uniform(0, 90), without="-z")
    return Scene(m.text(), (-150, -180, 55), (10, 5, 0), 40, options="--sky clear --sun 205,38 --ground 0.2")


def landscape_window() -> Scene:
    """A room in a landscape of 1 km, lit by sun and sky through a window of 0.49 x 0.42 m."""
    m = Mgf()
    landscape(m, 40)
    m.add("xf -t 0 0 0.3")
    house(m, (0.4, 0.45, 0.52, 0.6))
    m.add("xf")
    view = Scene("", (0.4, 0.3, 2.0), (3.1, 2.6, 1.0), 65)
    return Scene(m.text(), view.eye, view.look_at, view.fov, options="--sky clear --sun 280,33 --ground 0.2", samples=24)


def one_sided_sheet() -> Scene:
    """A one-sided sheet between lamp and wall. Light from behind passes it, as documented."""
    m = Mgf()
    m.room((5.2, 4.1, 2.8))
    furnish(m)
    m.quad("white", (1.1, 1.4, 1.9), (1.8, 0.2, 0), (-0.2, 1.7, 0))
    m.lamp("lamp", 14000)
    m.fixture("lamp", (2.0, 1.9, 1.35), (0.4, 0.4, 0.05), shines="+z")
    m.fixture("lamp", (3.6, 2.9, 2.7), (0.3, 0.3), 2.8)
    return Scene(m.text(), (0.4, 0.3, 1.2), (3.1, 2.6, 1.9), 65)


def t_junctions() -> Scene:
    """Walls and floor of tiles whose corners lie on the edges of other tiles."""
    m, random_ = Mgf(), random.Random(7)
    m.room((5.2, 4.1, 2.8), "-z +y")
    furnish(m)

    def bricks(material: str, corner: Point, u: Point, v: Point, rows: int) -> None:
        corner, u, v = np.array(corner, float), np.array(u, float), np.array(v, float)
        for k in range(rows):
            cuts = [0, *sorted(random_.uniform(0.02, 0.98) for _ in range(11)), 1]
            for left, right in zip(cuts, cuts[1:]):
                m.quad(material, corner + left * u + k / rows * v, (right - left) * u, v / rows)

    bricks("grey", (0, 0, 0), (5.2, 0, 0), (0, 4.1, 0), 9)
    bricks("white", (5.2, 4.1, 0), (-5.2, 0, 0), (0, 0, 2.8), 7)
    m.lamp("lamp", 20000)
    m.fixture("lamp", (1.9, 3.1, 2.6), (0.6, 0.4), 2.8)
    return Scene(m.text(), (0.4, 0.3, 1.7), (3.1, 3.0, 0.7), 62)


def quad_or_triangles(m: Mgf, material: str, corners: Sequence[Point], triangles: bool) -> None:
    """Adds a quadrilateral, or its triangles for ray intersection: split between the second corner and the fourth."""
    a, b, c, d = corners
    for points in ((a, b, d), (c, d, b)) if triangles else (corners,):
        m.face(material, *points)


def both_ways(make: Callable[[bool], Mgf], *view) -> Scene:
    """A scene of non-planar quadrilaterals, which the reference replaces with triangles."""
    return Scene(make(False).text(), *view, reference_text=make(True).text())


def non_planar_tiles() -> Scene:
    """The floor and a wall are of tiles whose corners are displaced by up to 3 cm."""

    def make(triangles: bool) -> Mgf:
        m, random_ = Mgf(), random.Random(8)
        m.room((5.2, 4.1, 2.8), "-z +y")
        furnish(m)
        for material, corner, u, v, out, n, k in (
            ("grey", (0, 0, 0), (5.2, 0, 0), (0, 4.1, 0), (0, 0, 1), 26, 20),
            ("white", (5.2, 4.1, 0), (-5.2, 0, 0), (0, 0, 2.8), (0, -1, 0), 26, 14),
        ):
            corner, u, v, out = (np.array(x, float) for x in (corner, u, v, out))
            inside = lambda i, j: 0 < i < n and 0 < j < k
            points = [
                [corner + i / n * u + j / k * v + (random_.uniform(-0.03, 0.03) * out if inside(i, j) else 0) for j in range(k + 1)]
                for i in range(n + 1)
            ]
            for i in range(n):
                for j in range(k):
                    tile = (points[i][j], points[i + 1][j], points[i + 1][j + 1], points[i][j + 1])
                    quad_or_triangles(m, material, tile, triangles)
        m.lamp("lamp", 20000)
        m.fixture("lamp", (1.9, 2.9, 2.6), (0.6, 0.4), 2.8)
        return m

    return both_ways(make, (0.4, 0.3, 1.7), (3.1, 3.0, 0.7), 62)


def displaced_corner() -> Scene:
    """Two rooms divided by one quadrilateral with a corner displaced by 1 mm. The view shows the room with a twentieth
    of the light."""

    def make(triangles: bool) -> Mgf:
        m = Mgf()
        m.room((7.4, 4.2, 2.7))
        m.material("wall", "rd 0.55", sides=2)
        quad_or_triangles(m, "wall", ((4.1, 0, 0), (4.1, 4.2, 0), (4.101, 4.2, 2.7), (4.1, 0, 2.7)), triangles)
        m.box("blue", (1.4, 1.7, 0), (0.8, 0.6, 0.9), 20, without="-z")
        m.box("red", (5.4, 2.2, 0), (0.6, 0.8, 1.2), -25, without="-z")
        m.lamp("bright", 20000)
        m.lamp("dim", 1000)
        m.fixture("bright", (1.9, 1.7, 2.65), (0.6, 0.5), 2.7)
        m.fixture("dim", (5.3, 1.2, 2.65), (0.6, 0.5), 2.7)
        return m

    return both_ways(make, (7.1, 0.3, 1.6), (4.6, 3.0, 0.9), 65)


SCENES: dict[str, Callable[[], Scene]] = {
    "cornell": cornell,
    "cornell-1-cm": lambda: cornell(1 / 550),
    "cornell-1-km": lambda: cornell(180),
    "cornell-far-away": lambda: cornell(1, (4000, -7000, 900)),
    "soup": soup,
    "white-box": white_box,
    "huge-lamp": huge_lamp,
    "tiny-lamp": tiny_lamp,
    "thousand-lamps": thousand_lamps,
    "pane": pane,
    "textured-emitter": textured_emitter,
    "coincident-faces": coincident_faces,
    "sun-window": sun_window,
    "landscape-window": landscape_window,
    "outdoor": outdoor,
    "black-wall": black_wall,
    "slivers": slivers,
    "hall": hall,
    "up-lights": up_lights,
    "slit": slit,
    "one-sided-sheet": one_sided_sheet,
    "t-junctions": t_junctions,
    "non-planar-tiles": non_planar_tiles,
    "displaced-corner": displaced_corner,
}
