"""Compares glare ratings with an independent calculation by CIE 117: `experiments/run glare`.

Five luminaires hang in rows from the ceilings of three rooms. The comparison calculates everything again with NumPy:
intensities from the IES files, direct light at patches of the room, reflected light from a radiosity system of view
factors at the patches' centres, Lb, and L, omega and p of every luminaire by its centre. p is Levin's fit. Luminaires
outside of the table of CIE 117 are left out.
"""

import json
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from lab import program, results

TABLE = program.ROOT / "experiments/results/glare.csv"
POLAR, AZIMUTHS = np.arange(0, 90.1, 2.5), np.arange(0, 360.1, 15)  # degrees
PATCHES_PER_5_M = 16
Array = np.ndarray


@dataclass
class Luminaire:
    intensity: Callable[[Array, Array], Array]  # [cd] at polar angles and azimuths [rad]
    width: float  # along x [m]
    length: float  # along y [m]


@dataclass
class Room:
    size: tuple[float, float, float]
    reflectances: tuple[float, float, float]  # of ceiling, walls and floor
    luminaires: list[tuple[float, float]]
    eye: tuple[float, float, float]
    line_of_sight: tuple[float, float, float]


LUMINAIRES = {
    "Lambertian": Luminaire(lambda polar, azimuth: 1000 * np.cos(polar), 0.6, 0.6),
    "narrow": Luminaire(lambda polar, azimuth: 3000 * np.cos(polar) ** 6, 0.2, 0.2),
    "batwing": Luminaire(lambda polar, azimuth: 600 * np.cos(polar) * (1 + 2.2 * np.sin(2 * polar) ** 2), 1.2, 0.3),
    "asymmetric": Luminaire(
        lambda polar, azimuth: 900 * np.cos(polar) ** 2 * (1 + 0.6 * np.sin(polar) * np.cos(azimuth)), 0.5, 0.3
    ),
    "linear": Luminaire(lambda polar, azimuth: 800 * np.cos(polar) * (0.5 + 0.5 * np.cos(azimuth) ** 2), 0.1, 1.4),
}
ROOMS = {
    "office": Room(
        (4.2, 5.6, 2.8), (0.7, 0.5, 0.2), [(1.05 + 2.1 * i, 0.93 + 1.87 * j) for i in range(2) for j in range(3)],
        (2.1, 0.3, 1.2), (0, 1, 0),
    ),
    "classroom": Room(
        (9.1, 6.3, 3.4), (0.8, 0.4, 0.3), [(1.5 + 2.03 * i, 1.1 + 2.05 * j) for i in range(4) for j in range(3)],
        (0.4, 3.1, 1.2), (1, 0, 0),
    ),
    "corridor": Room(
        (3.1, 12.5, 2.5), (0.6, 0.6, 0.1), [(1.55, 1 + 2.1 * j) for j in range(6)], (1.2, 0.5, 1.7), (0.2, 1, 0)
    ),
}  # fmt: skip


@dataclass
class Patches:
    centres: Array
    normals: Array
    areas: Array
    reflectances: Array


def patches_of(room: Room) -> Patches:
    x, y, z = room.size
    ceiling, walls, floor = room.reflectances
    faces = [
        ((0, 0, 0), (x, 0, 0), (0, y, 0), (0, 0, 1), floor),
        ((0, 0, z), (x, 0, 0), (0, y, 0), (0, 0, -1), ceiling),
        ((0, 0, 0), (x, 0, 0), (0, 0, z), (0, 1, 0), walls),
        ((0, y, 0), (x, 0, 0), (0, 0, z), (0, -1, 0), walls),
        ((0, 0, 0), (0, y, 0), (0, 0, z), (1, 0, 0), walls),
        ((x, 0, 0), (0, y, 0), (0, 0, z), (-1, 0, 0), walls),
    ]
    centres, normals, areas, reflectances = [], [], [], []
    for corner, u, v, normal, reflectance in faces:
        corner, u, v = np.array(corner), np.array(u), np.array(v)
        lengths = np.linalg.norm(u), np.linalg.norm(v)
        columns, rows = (max(4, round(PATCHES_PER_5_M * length / 5)) for length in lengths)
        for i in range(columns):
            for j in range(rows):
                centres.append(corner + u * (i + 0.5) / columns + v * (j + 0.5) / rows)
                normals.append(normal)
                areas.append(lengths[0] * lengths[1] / columns / rows)
                reflectances.append(reflectance)
    return Patches(np.array(centres), np.array(normals, float), np.array(areas), np.array(reflectances))


def view_factors(patches: Patches) -> Array:
    d = patches.centres[None] - patches.centres[:, None]
    squared = (d**2).sum(2) + np.eye(len(d))
    at_receiver = np.maximum((d * patches.normals[:, None]).sum(2), 0)
    at_sender = np.maximum(-(d * patches.normals[None]).sum(2), 0)
    factors = at_receiver * at_sender * patches.areas[None] / (np.pi * squared**2)
    return factors / factors.sum(1, keepdims=True)


def write_ies(file: Path, luminaire: Luminaire) -> Array:
    """Returns the intensities [cd] that the file has, by azimuth and polar angle."""
    polar, azimuth = np.meshgrid(np.radians(POLAR), np.radians(AZIMUTHS))
    table = np.round(np.maximum(luminaire.intensity(polar, azimuth), 0), 3)
    lines = [
        "IESNA:LM-63-2002",
        "TILT=NONE",
        f"1 -1 1 {len(POLAR)} {len(AZIMUTHS)} 1 2 {luminaire.width} {luminaire.length} 0",
        "1 1 0",
        *(" ".join(f"{value:g}" for value in angles) for angles in (POLAR, AZIMUTHS)),
        *(" ".join(f"{value:.3f}" for value in row) for row in table),
    ]
    file.write_text("\n".join(lines) + "\n")
    return table


def intensity(table: Array, d: Array) -> Array:
    """Interpolates bilinearly. d: directions of shape (n, 3) from the luminaire."""
    polar = np.degrees(np.arccos(np.clip(-d[:, 2] / np.linalg.norm(d, axis=1), -1, 1)))
    azimuth = np.degrees(np.arctan2(d[:, 1], d[:, 0])) % 360
    p, a = np.clip(polar / 2.5, 0, len(POLAR) - 1.001), azimuth / 15
    p0, a0 = p.astype(int), a.astype(int) % 24
    p, a = p - p0, a - np.floor(a)
    near = (1 - p) * table[a0, p0] + p * table[a0, p0 + 1]
    far = (1 - p) * table[a0 + 1, p0] + p * table[a0 + 1, p0 + 1]
    return np.where(polar <= 90, (1 - a) * near + a * far, 0)


def levins_index(ahead: float, above: float, aside: float) -> float:
    """Position index for distances along the line of sight, above it and to its side (Levin 1975)."""
    sigma = np.degrees(np.arctan2(np.hypot(above, aside), ahead))
    tau = np.degrees(np.arctan2(aside, above))
    return np.exp(
        (35.2 - 0.31889 * tau - 1.22 * np.exp(-2 * tau / 9)) * 1e-3 * sigma
        + (21 + 0.26667 * tau - 0.002963 * tau**2) * 1e-5 * sigma**2
    )


def calculated(room: Room, luminaire: Luminaire, table: Array, patches: Patches, factors: Array) -> tuple[float, float]:
    """Returns UGR and Lb."""
    eye, sight = np.array(room.eye), np.array(room.line_of_sight) / np.linalg.norm(room.line_of_sight)
    direct = np.zeros(len(patches.areas))
    glare = 0
    for x, y in room.luminaires:
        position = np.array((x, y, room.size[2]))
        d = patches.centres - position
        distance = np.linalg.norm(d, axis=1)
        cosine = -(d * patches.normals).sum(1) / distance
        direct += np.where(d[:, 2] < 0, intensity(table, d) * np.maximum(cosine, 0) / distance**2, 0)
        towards = position - eye
        ahead, above = towards @ sight, towards[2]
        aside = abs(towards @ np.cross(sight, (0, 0, 1)))
        if ahead <= 0 or above > 1.9 * ahead or aside > 3 * ahead:
            continue
        distance = np.linalg.norm(towards)
        projected_area = luminaire.width * luminaire.length * above / distance
        luminance = intensity(table, -towards[None])[0] / projected_area
        glare += luminance**2 * projected_area / distance**2 / levins_index(ahead, above, aside) ** 2
    rho = patches.reflectances
    reflected = np.linalg.solve(np.eye(len(rho)) - factors * rho[None], factors @ (direct * rho))
    d = patches.centres - eye
    squared = (d**2).sum(1)
    at_eye = np.maximum(d @ sight, 0) * np.maximum(-(d * patches.normals).sum(1), 0) / (np.pi * squared**2)
    background = (rho * (direct + reflected) * patches.areas * at_eye).sum() / np.pi
    return 8 * np.log10(0.25 / background * glare), background


def scene_of(room: Room, ies: str) -> str:
    x, y, z = room.size
    ceiling, walls, floor = room.reflectances
    lines = [f"m {name} =\n\trd {rho}\n\tsides 1" for name, rho in (("c", ceiling), ("w", walls), ("f", floor))]
    lines += [f"v p{k} =\n\tp {x * (k & 1)} {y * (k >> 1 & 1)} {z * (k >> 2)}" for k in range(8)]
    lines += ["m f\nf p0 p1 p3 p2", "m c\nf p4 p6 p7 p5", "m w\nf p0 p4 p5 p1", "f p1 p5 p7 p3", "f p3 p7 p6 p2"]
    lines += ["f p2 p6 p4 p0", *(f"ies {ies} -t {a} {b} {z}" for a, b in room.luminaires)]
    return "\n".join(lines) + "\n"


def measured(command: program.Program, scene: Path, room: Room) -> tuple[float, float]:
    """Returns UGR and Lb."""
    seat = ":".join(",".join(map(str, vector)) for vector in (room.eye, room.line_of_sight))
    output = program.run(
        command, ["probe", str(scene), "--quantity", "ugr", "--rays", "1M", "--json", "--seat", seat]
    ).output
    area = json.loads(output)["areas"][0]
    return area["ugr"], area["background_luminance"]


def measure() -> None:
    command = program.find_program()
    rows = []
    for room_name, room in ROOMS.items():
        patches = patches_of(room)
        factors = view_factors(patches)
        for name, luminaire in LUMINAIRES.items():
            print(room_name, name, file=sys.stderr, flush=True)
            with tempfile.TemporaryDirectory() as folder:
                table = write_ies(Path(folder) / "luminaire.ies", luminaire)
                scene = Path(folder) / "room.mgf"
                scene.write_text(scene_of(room, "luminaire.ies"))
                ugr, background = measured(command, scene, room)
            expected, expected_background = calculated(room, luminaire, table, patches, factors)
            rows.append(
                {
                    "room": room_name,
                    "luminaire": name,
                    "ugr": round(ugr, 2),
                    "expected_ugr": round(expected, 2),
                    "background": round(background, 3),
                    "expected_background": round(expected_background, 3),
                    "version": command.version,
                }
            )
            results.write_csv(TABLE, rows, rows[-1])


def draw() -> None:
    lines = [
        [row["room"], row["luminaire"], f"{row['ugr']:.2f}", f"{row['expected_ugr']:.2f}",
         f"{row['background']:.2f}", f"{row['expected_background']:.2f}"]
        for row in results.read_csv(TABLE, ("room", "luminaire", "version"))
    ]  # fmt: skip
    header = ["room", "luminaire", "UGR", "expected", "Lb [cd/m²]", "expected"]
    results.write_table(program.ROOT / "docs/figures/glare.md", header, lines)


def main(only_draw: bool) -> None:
    if not only_draw:
        measure()
    draw()
