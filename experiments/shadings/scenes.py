"""Scenes on which shadings and bakes are audited. Each kind draws proportions, reflectances, positions and lamps from a
seed, so a kind stands for many scenes."""

import math
import random
from collections.abc import Callable

import numpy as np
from measured.audit_scenes import Mgf, Point, Scene

FIRST_SEED = 1  # of the scenes with a name of their own


def paint(m: Mgf, draw: random.Random, sides: int = 1) -> None:
    """Defines the paints white, grey, red and blue with drawn reflectances."""
    for name, low, high, colour in (
        ("white", 0.6, 0.85, None),
        ("grey", 0.25, 0.5, None),
        ("red", 0.2, 0.35, (0.45, 0.34)),
        ("blue", 0.25, 0.45, (0.27, 0.29)),
    ):
        m.material(name, f"rd {draw.uniform(low, high):.3f}", sides=sides, colour=colour)


def closed_room(m: Mgf, size: Point, without: str = "") -> None:
    walls = {"-x": "red", "+x": "blue", "-y": "white", "+y": "white", "-z": "grey", "+z": "white"}
    m.sides(walls, (0, 0, 0), size, inwards=True, without=without)


def furnish(m: Mgf, draw: random.Random, low: Point, high: Point, count: int = 3) -> None:
    """Places boxes on the floor between two corners, one in each of `count` cells, where none meets another."""
    width = (high[0] - low[0]) / count
    for k in range(count):
        side, depth = draw.uniform(0.35, 0.6) * width, draw.uniform(0.25, 0.4) * (high[1] - low[1])
        x = low[0] + (k + 0.5) * width - side / 2
        y = draw.uniform(low[1], high[1] - depth)
        tilt = draw.uniform(-15, 15)
        m.box(("white", "blue", "red")[k % 3], (x, y, 0), (side, depth, draw.uniform(0.4, 1.4)), tilt, without="-z")


def sun(m: Mgf, azimuth: float, altitude: float, illuminance: float) -> None:
    """Adds light from this azimuth (counter-clockwise from x) and altitude [degrees]."""
    a, h = math.radians(azimuth), math.radians(altitude)
    towards = (-math.cos(h) * math.cos(a), -math.cos(h) * math.sin(a), -math.sin(h))
    vertex = m.vertex((0, 0, 0), "n " + " ".join(f"{x:.6f}" for x in towards))
    m.add(f"light directional {vertex} {illuminance:.0f}")


def downlight(draw: random.Random, side: float) -> str:
    """Returns an LM-63 file of a downlight with a square opening [m]."""
    width = draw.uniform(25, 40)  # of the beam [degrees]
    angles = range(0, 91, 10)
    candela = " ".join(f"{1000 * math.exp(-((angle / width) ** 2)) * (angle < 90):.1f}" for angle in angles)
    return f"""IESNA:LM-63-1995
[TEST] audit
TILT=NONE
1 3000 1 {len(angles)} 1 1 2 {side:.3f} {side:.3f} 0
1 1 10
{" ".join(map(str, angles))}
0
{candela}
"""


def textured_quad(m: Mgf, material: str, corner: Point, u: Point, v: Point, repeats: float = 1) -> None:
    """Adds a parallelogram with its image, repeated along both sides, visible from the side of u x v."""
    a, u, v = np.array(corner, float), np.array(u, float), np.array(v, float)
    places = ((0, 0), (1, 0), (1, 1), (0, 1))
    corners = [m.vertex(a + s * u + t * v, f"uv {repeats * s:g} {repeats * t:g}") for s, t in places]
    m.add(f"m {material}\nf {' '.join(corners)}")


def slats(draw: random.Random) -> Scene:
    """A small room with a grid of thin slats close below its luminous ceiling, seen from within the grid."""
    m = Mgf()
    paint(m, draw)
    x, y, z = draw.uniform(2, 3), draw.uniform(2, 3), draw.uniform(2.4, 2.8)
    closed_room(m, (x, y, z), "+z")
    m.lamp("lamp", draw.uniform(8000, 25000), 0)
    m.quad("lamp", (0, 0, z), (0, y, 0), (x, 0, 0))
    m.material("slat", f"rd {draw.uniform(0.5, 0.7):.3f}", sides=2)
    spacing, depth = draw.uniform(0.08, 0.11), draw.uniform(0.045, 0.06)
    bottom = z - depth - draw.uniform(0.04, 0.06)
    for k in range(1, int(x / spacing)):
        m.quad("slat", (k * spacing, 0, bottom), (0, y, 0), (0, 0, depth))
    for k in range(1, int(y / spacing)):
        m.quad("slat", (0, k * spacing, bottom), (x, 0, 0), (0, 0, depth))
    middle = np.array([(int(x / 2 / spacing) + 0.5) * spacing, (int(y / 2 / spacing) + 0.5) * spacing, bottom])
    # At this distance and angle, the next slats hide the lamp.
    eye = middle - (0, 0, 0.01)
    return Scene(m.text(), eye, middle + (-0.06, 0.012, 0.35 * depth), 30)


def louvres(draw: random.Random) -> Scene:
    """Lamps in the ceiling, each above a grid of blades, which cast soft shadows."""
    m = Mgf()
    paint(m, draw)
    x, y, z = draw.uniform(4, 5.5), draw.uniform(3.5, 5), draw.uniform(2.6, 3)
    closed_room(m, (x, y, z))
    m.lamp("lamp", draw.uniform(10000, 25000))
    m.material("blade", f"rd {draw.uniform(0.3, 0.7):.3f}", sides=2)
    length, width, blade, across = 1.2, draw.uniform(0.3, 0.6), draw.uniform(0.04, 0.07), draw.randint(8, 12)
    for k in range(2):
        low = np.array([x / 2 - length / 2, y * (1 + 2 * k) / 4 - width / 2, z - blade - 0.02])
        m.fixture("lamp", low + (0, 0, blade), (length, width), z)
        for i in range(across + 1):
            m.quad("blade", low + (i * length / across, 0, 0), (0, width, 0), (0, 0, blade))
        for j in range(5):
            m.quad("blade", low + (0, j * width / 4, 0), (length, 0, 0), (0, 0, blade))
    furnish(m, draw, (0.8, 1.2, 0), (x - 0.3, y - 0.4, 0))
    return Scene(m.text(), (0.4, 0.3, 1.6), (0.6 * x, 0.7 * y, 0.5), 60)


def blinds(draw: random.Random) -> Scene:
    """Sun and sky through tilted slats before a window in the wall x = 0."""
    m = Mgf()
    paint(m, draw, sides=2)
    x, y, z = draw.uniform(4, 5.5), draw.uniform(3.5, 4.5), draw.uniform(2.6, 3)
    closed_room(m, (x, y, z), "-x")
    hole = (draw.uniform(0.2, 0.3), 0.3, draw.uniform(0.65, 0.8), 0.85)
    m.wall_with_hole("white", (0, 0, 0), (0, y, 0), (0, 0, z), hole)
    m.material("slat", f"rd {draw.uniform(0.4, 0.7):.3f}", sides=2)
    spacing, depth, tilt = draw.uniform(0.05, 0.09), draw.uniform(0.05, 0.08), math.radians(draw.uniform(15, 40))
    low, high = hole[1] * z, hole[3] * z
    for k in range(int((high - low) / spacing)):
        run = np.array([depth * math.cos(tilt), 0, depth * math.sin(tilt)])
        m.quad("slat", (0.03, hole[0] * y, low + k * spacing), run, (0, (hole[2] - hole[0]) * y, 0))
    furnish(m, draw, (1, 1, 0), (x - 0.4, y - 0.5, 0))
    sun(m, 180 + draw.uniform(-25, 25), draw.uniform(25, 45), draw.uniform(30000, 80000))
    m.add(f"light sky {draw.uniform(1500, 5000):.0f}")
    return Scene(m.text(), (x - 0.3, 0.3, 1.6), (0.3 * x, 0.65 * y, 0.6), 65)


def crate(draw: random.Random) -> Scene:
    """An open crate of boards with gaps; the view is into the crate."""
    m = Mgf()
    paint(m, draw)
    x, y, z = draw.uniform(4, 5), draw.uniform(3.5, 4.5), 2.7
    closed_room(m, (x, y, z))
    m.lamp("lamp", draw.uniform(10000, 30000))
    m.fixture("lamp", (0.3 * x, 0.6 * y, z - 0.05), (draw.uniform(0.3, 0.6), draw.uniform(0.3, 0.6)), z)
    low = np.array([0.5 * x, 0.35 * y, 0])
    length, width, height = draw.uniform(0.9, 1.2), draw.uniform(0.6, 0.8), draw.uniform(0.5, 0.7)
    board, gap, thick = draw.uniform(0.08, 0.12), draw.uniform(0.015, 0.03), 0.012
    rows = int(height / (board + gap))
    for k in range(rows):
        at = k * (board + gap) + gap
        for shift, size in (
            ((0, 0), (length, thick)),
            ((0, width - thick), (length, thick)),
            ((0, thick + 0.001), (thick, width - 2 * thick - 0.002)),
            ((length - thick, thick + 0.001), (thick, width - 2 * thick - 0.002)),
        ):
            m.box("white", low + (*shift, at), (*size, board))
    m.box("red", low + (0.25 * length, 0.3 * width, 0), (0.3 * length, 0.3 * width, 0.2), without="-z")
    eye = low + (-0.55, -0.45, 1.5)
    return Scene(m.text(), eye, low + (0.5 * length, 0.5 * width, 0.15), 45)


def ies_and_sun(draw: random.Random) -> Scene:
    """A closed room with a measured downlight; the sun lights only the outside."""
    m = Mgf()
    paint(m, draw, sides=2)
    x, y, z = draw.uniform(3.5, 5), draw.uniform(3.5, 5), draw.uniform(2.6, 3)
    closed_room(m, (x, y, z))
    furnish(m, draw, (0.4, 1, 0), (x - 0.3, y - 0.6, 0))
    m.add(f"ies audit-downlight.ies -t {0.55 * x:.3f} {0.5 * y:.3f} {z - draw.uniform(0.1, 0.4):.3f}")
    sun(m, draw.uniform(0, 360), draw.uniform(30, 60), draw.uniform(50000, 100000))
    m.add("light sky 50")
    files = {"audit-downlight.ies": downlight(draw, draw.uniform(0.1, 0.3))}
    return Scene(m.text(), (0.3, 0.3, 1.6), (0.7 * x, 0.7 * y, 0.6), 60, files=files)


def sun_and_sphere(draw: random.Random) -> Scene:
    """A ball above or on a plane in the sun, without a sky: most rays escape."""
    m = Mgf()
    m.material("ground", f"rd {draw.uniform(0.3, 0.6):.3f}", sides=2)
    m.material("ball", f"rd {draw.uniform(0.3, 0.7):.3f}", sides=2, colour=(0.36, 0.35))
    side, radius = draw.uniform(4, 6), draw.uniform(0.6, 1)
    m.quad("ground", (-side, -side, 0), (2 * side, 0, 0), (0, 2 * side, 0))
    height = radius + draw.choice((0, draw.uniform(0.2, 0.8)))
    m.add("m ball")
    m.add(f"sph {m.vertex((0, 0, height))} {radius:.4f}")
    sun(m, draw.uniform(20, 70), draw.uniform(35, 55), draw.uniform(30000, 80000))
    return Scene(m.text(), (1.2, -4, 2.6), (-0.5, 0, 0.3), 45)


def two_rooms(m: Mgf, draw: random.Random, ratio: float) -> tuple[Point, float, float]:
    """Adds a bright room, and behind it a room with a lamp dimmer by `ratio`. The wall between them is missing. Returns
    the size of both rooms together, and the place and the thickness of the wall."""
    paint(m, draw)
    size = (draw.uniform(6.5, 8), draw.uniform(3.5, 4.5), draw.uniform(2.6, 3))
    closed_room(m, size)
    place, thickness = draw.uniform(0.48, 0.55) * size[0], draw.uniform(0.03, 0.1)
    lamp = draw.uniform(15000, 30000)
    m.lamp("bright", lamp)
    m.lamp("dim", lamp / ratio)
    m.fixture("bright", (0.4 * place, 0.4 * size[1], size[2] - 0.02), (0.6, 0.6), size[2])
    dim = (place + 0.55 * (size[0] - place), 0.35 * size[1], size[2] - 0.02)
    m.fixture("dim", dim, (0.5, 0.5), size[2])
    furnish(m, draw, (place + 0.9, 0.45 * size[1], 0), (size[0] - 0.3, size[1] - 0.3, 0), 2)
    return size, place, thickness


def view_of_dim_room(size: Point, place: float) -> tuple[Point, Point, float]:
    return (size[0] - 0.3, 0.3, 1.6), (place + 0.3, 0.6 * size[1], 0.2), 60


def sealed_rooms(draw: random.Random) -> Scene:
    """A dim room beside a bright one, without a gap."""
    m = Mgf()
    size, place, thickness = two_rooms(m, draw, draw.uniform(50, 200))
    m.box("white", (place, 0, 0), (thickness, size[1], size[2]), without="-y +y -z +z")
    return Scene(m.text(), *view_of_dim_room(size, place))


def wall_gap(draw: random.Random) -> Scene:
    """As sealed_rooms(), but the wall ends 1 mm above the floor."""
    m = Mgf()
    size, place, thickness = two_rooms(m, draw, draw.uniform(100, 300))
    m.box("white", (place, 0, 0.001), (thickness, size[1], size[2] - 0.001), without="-y +y +z")
    return Scene(m.text(), *view_of_dim_room(size, place))


def door_gap(draw: random.Random) -> Scene:
    """Two rooms joined by the gap below a door, which lights the dark one almost alone."""
    m = Mgf()
    size, place, thickness = two_rooms(m, draw, 10000)
    left = draw.uniform(0.4, 0.55) * size[1]
    right, gap = left + 0.9, draw.uniform(0.002, 0.01)
    m.box("white", (place, 0, 0), (thickness, left, size[2]), without="-y -z +z")
    m.box("white", (place, right, 0), (thickness, size[1] - right, size[2]), without="+y -z +z")
    m.box("blue", (place, left, gap), (thickness, 0.9, size[2] - gap), without="-y +y +z")
    return Scene(m.text(), *view_of_dim_room(size, place))


def corner_normals(draw: random.Random) -> Scene:
    """A room and boxes whose files give each corner the mean normal of its three faces."""
    m = Mgf()
    paint(m, draw)
    x, y, z = draw.uniform(3.5, 5), draw.uniform(3.5, 4.5), draw.uniform(2.5, 3)

    def averaged_box(material: str, low: Point, size: Point, inwards: bool) -> None:
        names = {}
        for k in range(8):
            share = np.array([k & 1, k >> 1 & 1, k >> 2])
            normal = (2.0 * share - 1) / math.sqrt(3) * (-1 if inwards else 1)
            at = np.array(low) + share * np.array(size)
            names[k] = m.vertex(at, "n " + " ".join(f"{c:.6f}" for c in normal))
        m.add(f"m {material}")
        for face in ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)):
            m.add("f " + " ".join(names[k] for k in (face[::-1] if inwards else face)))

    averaged_box("white", (0, 0, 0), (x, y, z), True)
    for k, (material, height) in enumerate((("blue", draw.uniform(0.5, 0.8)), ("red", draw.uniform(0.9, 1.4)))):
        averaged_box(material, ((0.3 + 0.3 * k) * x, (0.55 - 0.15 * k) * y, 0.01), (0.7, 0.6, height), False)
    m.lamp("lamp", draw.uniform(10000, 25000))
    m.fixture("lamp", (0.5 * x, 0.4 * y, z - 0.05), (draw.uniform(0.3, 0.6), draw.uniform(0.3, 0.6)), z)
    return Scene(m.text(), (x - 0.3, 0.3, 1.6), (0.35 * x, 0.7 * y, 0.6), 60)


def poster(draw: random.Random) -> Scene:
    """A furnished room with an image on a wall and a repeated one on the floor."""
    m = Mgf()
    paint(m, draw)
    x, y, z = draw.uniform(3.5, 5), draw.uniform(3.5, 4.5), draw.uniform(2.5, 3)
    closed_room(m, (x, y, z), "-z")
    m.material("poster", "rd 0.85", "texture rd audit-poster.png")
    m.material("tiles", "rd 0.8", "texture rd audit-tiles.png")
    textured_quad(m, "tiles", (0, 0, 0), (x, 0, 0), (0, y, 0), draw.randint(3, 6))
    width = draw.uniform(1, 1.6)
    textured_quad(m, "poster", (0.3 * x, y - 0.01, 0.9), (width, 0, 0), (0, 0, 1.2))
    m.box("white", (0.3 * x, y - 0.01, 0.9), (width, 0.01, 1.2), without="-y +y")
    furnish(m, draw, (0.5, 0.3 * y, 0), (x - 0.3, 0.75 * y, 0), 2)
    m.lamp("lamp", draw.uniform(10000, 25000))
    m.fixture("lamp", (0.45 * x, 0.35 * y, z - 0.03), (0.5, draw.uniform(0.3, 0.6)), z)
    noise = np.random.default_rng(draw.randrange(2**32))
    coarse = noise.uniform(20, 255, (12, 10, 3)).repeat(12, axis=0).repeat(12, axis=1)
    fine = noise.uniform(0.4, 1, (144, 120, 1))
    squares = (np.indices((64, 64)) // 32).sum(axis=0) % 2 * 130 + 90
    images = {
        "audit-poster.png": (coarse * fine).astype(np.uint8),
        "audit-tiles.png": np.repeat(squares[:, :, None], 3, axis=2).astype(np.uint8),
    }
    return Scene(m.text(), (0.3, 0.3, 1.6), (0.55 * x, y, 0.9), 60, images=images)


def grazing_bumps(draw: random.Random) -> Scene:
    """A bumpy ground in the light of a low sun."""
    m = Mgf()
    m.material("ground", f"rd {draw.uniform(0.2, 0.5):.3f}", sides=2)
    n, side, height = 32, draw.uniform(5, 7), draw.uniform(0.04, 0.12)
    heights = [[draw.uniform(0, height) for _ in range(n + 1)] for _ in range(n + 1)]
    place = lambda i, j: (i / n * side, j / n * side, heights[i][j])
    for i in range(n):
        for j in range(n):
            m.face("ground", place(i, j), place(i + 1, j), place(i + 1, j + 1))
            m.face("ground", place(i, j), place(i + 1, j + 1), place(i, j + 1))
    sun(m, draw.uniform(0, 360), draw.uniform(6, 14), draw.uniform(30000, 60000))
    m.add(f"light sky {draw.uniform(100, 400):.0f}")
    return Scene(m.text(), (0.2 * side, -0.3, 1.6), (0.55 * side, 0.5 * side, 0), 50)


def corridor(draw: random.Random) -> Scene:
    """A long corridor; the lamps of the near part are off."""
    m = Mgf()
    paint(m, draw)
    x, y, z = draw.uniform(28, 40), draw.uniform(1.8, 2.4), draw.uniform(2.4, 2.8)
    closed_room(m, (x, y, z))
    m.lamp("lamp", draw.uniform(8000, 20000))
    m.material("off", "rd 0.6")
    step = draw.uniform(3.5, 5)
    for k in range(int(x / step)):
        material = "lamp" if (k + 0.5) * step > 0.35 * x else "off"
        m.fixture(material, ((k + 0.4) * step, y / 2 - 0.15, z - 0.05), (1.2, 0.3), z)
    for k in range(5):
        low = ((0.08 + 0.17 * k) * x, 0 if k % 2 else y - 0.3, 0)
        m.box("blue", low, (0.9, 0.3, draw.uniform(0.8, 2)), without="-z")
    return Scene(m.text(), (0.4, 0.5 * y, 1.6), (8, 0.5 * y, 1), 60)


def hundred_desks(draw: random.Random) -> Scene:
    """An open office: a hundred desks, each with a screen, below rows of lamps."""
    m = Mgf()
    paint(m, draw)
    x, y, z = draw.uniform(22, 26), draw.uniform(20, 24), draw.uniform(2.8, 3.4)
    closed_room(m, (x, y, z))
    for k in range(100):
        low = np.array([(k % 10 + 0.2) * x / 10, (k // 10 + 0.3) * y / 10, 0])
        m.box("white", low + (0, 0, 0.72), (1.4, 0.7, 0.03))
        for shift in (0.05, 1.31):
            m.box("grey", low + (shift, 0.05, 0), (0.04, 0.6, 0.72), without="-z +z")
        screen = (0.5, 0.04, draw.uniform(0.3, 0.45))
        m.box(("blue", "red")[k % 2], low + (0.45, 0.45, 0.751), screen, draw.uniform(-20, 20))
    m.lamp("lamp", draw.uniform(8000, 16000))
    for k in range(36):
        m.fixture("lamp", ((k % 6 + 0.4) * x / 6, (k // 6 + 0.45) * y / 6, z - 0.05), (1.2, 0.3), z)
    return Scene(m.text(), (0.12 * x, 0.13 * y, 1.6), (0.3 * x, 0.36 * y, 0.4), 55)


def glass_box(draw: random.Random) -> Scene:
    """A box of glass panes over an object, in a room with a lamp."""
    m = Mgf()
    paint(m, draw)
    x, y, z = draw.uniform(3.5, 4.5), draw.uniform(3.5, 4.5), draw.uniform(2.5, 3)
    closed_room(m, (x, y, z))
    m.lamp("lamp", draw.uniform(10000, 25000))
    m.fixture("lamp", (0.4 * x, 0.35 * y, z - 0.05), (0.5, draw.uniform(0.3, 0.5)), z)
    m.material("glass", f"rd {draw.uniform(0.03, 0.08):.3f}", f"ts {draw.uniform(0.6, 0.85):.3f} 0", sides=2)
    low, side = np.array([0.45 * x, 0.5 * y, 0]), draw.uniform(0.7, 1)
    m.box("glass", low, (side, side, side), draw.uniform(0, 40), without="-z")
    m.box("red", low + 0.3 * side * np.array([1, 1, 0]), (0.4 * side, 0.35 * side, 0.6 * side), 10, without="-z")
    return Scene(m.text(), (0.3, 0.3, 1.5), (0.45 * x + side / 2, 0.5 * y + side / 2, 0.4), 45)


def mixed_sizes(draw: random.Random) -> Scene:
    """Sheets of a millimetre and cubes of a centimetre on a table in a hall of 30 m."""
    m = Mgf()
    paint(m, draw)
    x, y, z = draw.uniform(25, 35), draw.uniform(15, 20), draw.uniform(6, 9)
    closed_room(m, (x, y, z))
    m.lamp("lamp", draw.uniform(20000, 40000))
    for k in range(8):
        m.fixture("lamp", ((k % 4 + 0.45) * x / 4, (k // 4 + 0.45) * y / 2, z - 0.3), (1.5, 1.2), z)
    low = np.array([0.4 * x, 0.4 * y, 0])
    m.box("white", low, (1.6, 0.8, 0.75), without="-z")
    top = low + (0, 0, 0.75)
    for k in range(40):
        at = top + (0.1 + 0.035 * k, draw.uniform(0.1, 0.5), 0)
        side = draw.uniform(0.008, 0.015)
        m.box(("red", "blue", "grey")[k % 3], at, (side, side, side), draw.uniform(0, 90), without="-z")
    for k in range(6):
        m.box("white", top + (0.1 + 0.25 * k, 0.6, 0), (0.001, 0.15, draw.uniform(0.05, 0.2)), without="-z")
    return Scene(m.text(), top + (0.3, -0.45, 0.55), top + (0.7, 0.4, 0), 50)


def mirror(draw: random.Random) -> Scene:
    """A furnished room with a mirror on a wall."""
    m = Mgf()
    paint(m, draw)
    x, y, z = draw.uniform(3.5, 5), draw.uniform(3.5, 4.5), draw.uniform(2.5, 3)
    closed_room(m, (x, y, z))
    furnish(m, draw, (0.6, 0.3 * y, 0), (x - 0.3, 0.8 * y, 0))
    m.material("mirror", "rd 0.02", f"rs {draw.uniform(0.7, 0.9):.3f} 0")
    width = draw.uniform(1, 1.8)
    m.quad("mirror", (0.35 * x, y - 0.01, 0.8), (width, 0, 0), (0, 0, 1.3))
    m.box("grey", (0.35 * x, y - 0.01, 0.8), (width, 0.01, 1.3), without="-y +y")
    m.lamp("lamp", draw.uniform(10000, 25000))
    m.fixture("lamp", (0.5 * x, 0.3 * y, z - 0.05), (0.5, draw.uniform(0.3, 0.6)), z)
    return Scene(m.text(), (0.3, 0.3, 1.6), (0.6 * x, 0.9 * y, 0.9), 65, mirrors=True)


def mask(draw: random.Random) -> Scene:
    """A screen with holes, which an image defines, between the lamp and most of the room."""
    m = Mgf()
    paint(m, draw)
    x, y, z = draw.uniform(4, 5), draw.uniform(3.5, 4.5), draw.uniform(2.5, 3)
    closed_room(m, (x, y, z))
    m.material("screen", "rd 0.6", "ts 0.99 0", "texture rd audit-sheet.png", "texture ts audit-holes.png", sides=2)
    place = draw.uniform(0.55, 0.65) * x
    textured_quad(m, "screen", (place, 0, 0), (0, y, 0), (0, 0, z), draw.randint(3, 5))
    m.lamp("lamp", draw.uniform(15000, 30000))
    m.fixture("lamp", (place + 0.5, 0.45 * y, z - 0.2), (0.25, 0.25), z)
    furnish(m, draw, (0.4, 0.4 * y, 0), (place - 0.3, y - 0.3, 0), 2)
    rows, columns = np.indices((32, 32)) - 15.5
    holes = np.hypot(rows, columns) < draw.uniform(7, 11)
    images = {
        "audit-holes.png": np.repeat(255 * holes[:, :, None], 3, axis=2).astype(np.uint8),
        "audit-sheet.png": np.repeat(255 * ~holes[:, :, None], 3, axis=2).astype(np.uint8),
    }
    return Scene(m.text(), (0.3, 0.3, 1.6), (0.8 * place, 0.7 * y, 0.5), 65, images=images)


def two_lamps(draw: random.Random) -> Scene:
    """A closed box with boxes and two lamps: the simplest scene."""
    m = Mgf()
    paint(m, draw)
    x, y, z = draw.uniform(3, 5), draw.uniform(3, 5), draw.uniform(2.5, 3)
    closed_room(m, (x, y, z))
    m.lamp("lamp", draw.uniform(5000, 15000))
    m.fixture("lamp", (0.2 * x, 0.3 * y, z - 0.05), (0.5, 0.4), z)
    m.fixture("lamp", (0.6 * x, 0.6 * y, z - 0.05), (0.3, draw.uniform(0.3, 0.7)), z)
    furnish(m, draw, (0.5, 0.35 * y, 0), (x - 0.3, y - 0.3, 0))
    return Scene(m.text(), (0.3, 0.3, 1.6), (0.6 * x, 0.7 * y, 0.6), 60)


KINDS: dict[str, Callable[[random.Random], Scene]] = {
    "slats": slats,
    "louvres": louvres,
    "blinds": blinds,
    "crate": crate,
    "ies-and-sun": ies_and_sun,
    "sun-and-sphere": sun_and_sphere,
    "sealed-rooms": sealed_rooms,
    "wall-gap": wall_gap,
    "door-gap": door_gap,
    "corner-normals": corner_normals,
    "poster": poster,
    "grazing-bumps": grazing_bumps,
    "corridor": corridor,
    "hundred-desks": hundred_desks,
    "glass-box": glass_box,
    "mixed-sizes": mixed_sizes,
    "mirror": mirror,
    "mask": mask,
    "two-lamps": two_lamps,
}


def make_scene(name: str) -> Scene:
    """Makes a scene from its kind, or from KIND@SEED; a seed is any text."""
    kind, _, seed = name.partition("@")
    return KINDS[kind](random.Random(f"{kind} {seed or FIRST_SEED}"))


def drawn_scenes(seed: str, count: int = 10) -> list[str]:
    """Returns the names of scenes of different kinds, drawn from the seed."""
    return [f"{kind}@{seed}" for kind in random.Random(seed).sample(sorted(KINDS), count)]
