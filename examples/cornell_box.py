"""A Cornell box from arrays: geometry and materials in, a picture out.

    python3 examples/cornell_box.py
"""

import argparse
from pathlib import Path

import interflect as ifl
import numpy as np

# The unit cube: vertices in the order 4x + 2y + z; sides in the order bottom, top, left, right, back, front,
# counter-clockwise seen from outside.
CUBE = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)])
SIDES = np.array([(0, 2, 6, 4), (1, 5, 7, 3), (0, 1, 3, 2), (4, 6, 7, 5), (2, 3, 7, 6), (0, 4, 5, 1)])


def block(size: tuple, middle: tuple, turn: float = 0) -> np.ndarray:
    """Vertices of a block that stands on `middle` [m], turned about its vertical axis [degrees]."""
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    return (CUBE - (0.5, 0.5, 0)) * size @ np.array([(c, s, 0), (-s, c, 0), (0, 0, 1)]) + middle


def make_scene() -> ifl.Scene:
    room = block((2, 2, 2), (0, 0, 0))
    tall = block((0.6, 0.6, 1.2), (-0.35, 0.3, 0), turn=18)
    short = block((0.6, 0.6, 0.6), (0.35, -0.3, 0), turn=-18)
    lamp = block((0.6, 0.5, 0), (0, 0, 1.99))
    vertices = np.concatenate([room, tall, short, lamp])
    # The room is seen from inside and has no front; blocks have no bottom; the lamp is one face that shines down.
    faces = np.concatenate([SIDES[:5, ::-1], 8 + SIDES[1:], 16 + SIDES[1:], 24 + SIDES[:1]])
    materials = [
        ifl.Material("white", 0.73),
        ifl.Material("red", (0.65, 0.05, 0.05)),
        ifl.Material("green", (0.12, 0.45, 0.15)),
        ifl.Material("lamp", exitance=15_000),  # [lm/m^2]
    ]
    view = ifl.View("front", eye=(0, -4.8, 1), look_at=(0, 0, 1), fov=32)
    return ifl.Scene(vertices, faces, materials, face_materials=[0, 0, 1, 2, 0] + 10 * [0] + [3], views=[view])


def main(arguments: list[str] | None = None) -> np.ndarray:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rays", type=float, default=5e6, help="rays of the solver")
    parser.add_argument("--size", type=int, default=512, help="width and height of the picture [pixels]")
    parser.add_argument("--output", type=Path, default=Path("out/examples"), help="folder of the picture")
    options = parser.parse_args(arguments)
    options.output.mkdir(parents=True, exist_ok=True)

    solution = ifl.solve(make_scene(), view="front", rays=options.rays)
    picture = ifl.render(solution, width=options.size, height=options.size)
    ifl.write_image(options.output / "cornell-box.png", picture)
    print(solution)
    print(f"mean radiance {picture.mean():.0f} cd/m^2, estimated error {100 * solution.relative_error:.1f}%")
    return picture


if __name__ == "__main__":
    main()
