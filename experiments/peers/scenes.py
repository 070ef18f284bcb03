"""Scenes of the comparison. Most are drawn from a seed, so held-out variants have other proportions, lamps and paints."""

import json
import random
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from lab import program
from measured.audit_scenes import Mgf, Point, Scene
from shadings.scenes import furnish, make_scene, paint

FIRST_SEED = "1"
DESKS = ((10, 12), (9, 15), (6, 20))  # rows of desks and desks in a row: 100, 99 and 105 luminaires


@dataclass(frozen=True)
class PeerScene:
    name: str
    file: Path
    eye: Point
    look_at: Point
    fov: float  # vertical [degrees]
    daylight: str = ""  # options
    up: Point = (0, 0, 1)

    @property
    def options(self) -> list[str]:
        """Returns the options of the view and of daylight, for `render` and `export`."""
        places = [",".join(f"{x:.9g}" for x in place) for place in (self.eye, self.look_at, self.up)]
        view = f"--eye {places[0]} --look-at {places[1]} --up {places[2]} --fov {self.fov:g}"
        return [*view.split(), *self.daylight.split()]


def office_graz(command: program.Program, folder: Path, seed: str) -> PeerScene:
    file = Path(program.expanded(f"{program.SCENES}/office-graz.mgf"))
    return PeerScene("office-graz", file, (3.7037, 0.0788, 2.2690), (1.0023, 8.9229, -1.1130), 45)


def office(command: program.Program, folder: Path, seed: str) -> PeerScene:
    return with_view_of_file("office", program.ROOT / "scenes/office.mgf", "desk")


def hundred_luminaires(command: program.Program, folder: Path, seed: str) -> PeerScene:
    draw = random.Random(f"hundred-luminaires {seed}")
    rows, in_a_row = DESKS[0] if seed == FIRST_SEED else draw.choice(DESKS)
    file = folder / "hundred-luminaires.mgf"
    desks = f"--desk-rows {rows} --desks-per-row {in_a_row} --seed {draw.randrange(2**31)}"
    program.run(command, ["make-scene", "office", *desks.split(), "-o", str(file), "--force"])
    return with_view_of_file("hundred-luminaires", file, "room-0")


def with_view_of_file(name: str, file: Path, view: str) -> PeerScene:
    views = json.loads(file.with_suffix(".views.json").read_text())["views"]
    found = next(one for one in views if one["name"] == view)
    return PeerScene(name, file, found["eye"], found["look_at"], found["fov"], up=found["up"])


def door_gap(command: program.Program, folder: Path, seed: str) -> PeerScene:
    return written("door-gap", make_scene(f"door-gap@{seed}"), folder)


def sunlit_room(command: program.Program, folder: Path, seed: str) -> PeerScene:
    """A furnished room. The sun and a clear sky shine through two windows in the wall x = 0, which faces west."""
    draw = random.Random(f"sunlit-room {seed}")
    m = Mgf()
    paint(m, draw, sides=2)
    x, y, z = draw.uniform(4.5, 6), draw.uniform(4.5, 6), draw.uniform(2.6, 3)
    walls = {"+x": "blue", "-y": "white", "+y": "red", "-z": "grey", "+z": "white"}
    m.sides(walls, (0, 0, 0), (x, y, z), inwards=True, without="-x")
    sill, head = draw.uniform(0.25, 0.35), draw.uniform(0.75, 0.88)
    for k in range(2):
        left, right = draw.uniform(0.15, 0.3), draw.uniform(0.7, 0.85)
        m.wall_with_hole("white", (0, k * y / 2, 0), (0, y / 2, 0), (0, 0, z), (left, sill, right, head))
    table(m, (0.35 * x, 0.45 * y, 0), (draw.uniform(1.2, 1.6), draw.uniform(0.7, 0.9), 0.74))
    furnish(m, draw, (0.2 * x, 0.72 * y, 0), (0.95 * x, 0.97 * y, 0))
    altitude, azimuth = draw.uniform(25, 45), 270 + draw.uniform(-30, 30)
    scene = Scene(m.text(), (x - 0.3, 0.3, 1.6), (0.3 * x, 0.6 * y, 0.7), 60)
    return written("sunlit-room", scene, folder, f"--sky clear --sun {azimuth:.1f},{altitude:.1f} --ground 0.2")


def table(m: Mgf, low: Point, size: Point) -> None:
    low, top, leg = np.array(low), 0.03, 0.05
    m.box("white", low + (0, 0, size[2] - top), (size[0], size[1], top))
    for i in (0, size[0] - leg):
        for j in (0, size[1] - leg):
            m.box("grey", low + (i, j, 0), (leg, leg, size[2] - top), without="-z +z")


def rooms_along_corridor(command: program.Program, folder: Path, seed: str) -> PeerScene:
    """Furnished rooms on both sides of a corridor, each with a lamp and an open doorway. The camera is at one end of the
    corridor, which has a lamp of its own at the other end."""
    draw = random.Random(f"corridor {seed}")
    m = Mgf()
    paint(m, draw, sides=2)
    rooms, width, depth = draw.randint(4, 6), draw.uniform(3, 4), draw.uniform(3, 4.5)
    aisle, z = draw.uniform(1.6, 2.2), draw.uniform(2.5, 2.9)
    length, far = rooms * width, depth + aisle
    walls = {"-x": "red", "+x": "blue", "-y": "white", "+y": "white", "-z": "grey", "+z": "white"}
    m.sides(walls, (0, -depth, 0), (length, depth + far, z), inwards=True)
    m.lamp("lamp", draw.uniform(10000, 20000))
    m.fixture("lamp", (length - 1.2, aisle / 2 - 0.3, z - 0.05), (0.6, 0.6), z)
    for k in range(rooms):
        for side, wall in ((-1, 0.0), (1, aisle)):
            door = draw.uniform(0.15, 0.5) * width
            wall_with_door(m, (k * width, wall, 0), width, z, door, 0.95, 2.1)
            inner = -depth if side < 0 else aisle
            if k > 0:
                m.quad("white", (k * width, inner, 0), (0, depth, 0), (0, 0, z))
            middle = (k * width + width / 2 - 0.3, inner + depth / 2 - 0.3, z - 0.05)
            m.fixture("lamp", middle, (0.6, 0.6), z)
            furnish(m, draw, (k * width + 0.3, inner + 0.35 * depth, 0), ((k + 1) * width - 0.3, inner + 0.9 * depth, 0), 2)
    return written("corridor", Scene(m.text(), (0.3, aisle / 2, 1.6), (length, aisle / 2, 1.1), 60), folder)


def wall_with_door(m: Mgf, corner: Point, width: float, height: float, left: float, door: float, head: float) -> None:
    """Adds a wall along x without a doorway from `left` to `left + door`."""
    x, y, z = corner
    for begin, end, low in ((0, left, 0), (left, left + door, head), (left + door, width, 0)):
        m.quad("white", (x + begin, y, z + low), (end - begin, 0, 0), (0, 0, height - low))


def written(name: str, scene: Scene, folder: Path, daylight: str = "") -> PeerScene:
    file = scene.write(folder, name, scene.text)
    return PeerScene(name, file, scene.eye, scene.look_at, scene.fov, daylight, scene.up)


Maker = Callable[[program.Program, Path, str], PeerScene]
FROM_FILES: dict[str, Maker] = {"office-graz": office_graz, "office": office}
DRAWN: dict[str, Maker] = {
    "sunlit-room": sunlit_room,
    "corridor": rooms_along_corridor,
    "door-gap": door_gap,
    "hundred-luminaires": hundred_luminaires,
}
SCENES = {**FROM_FILES, **DRAWN}


def make(command: program.Program, folder: Path, name: str) -> PeerScene:
    """Makes the scene NAME or NAME@SEED, with its files in the folder."""
    kind, _, seed = name.partition("@")
    folder.mkdir(parents=True, exist_ok=True)
    return SCENES[kind](command, folder, seed or FIRST_SEED)
