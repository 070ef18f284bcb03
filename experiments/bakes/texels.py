"""Compares texels of lightmaps with irradiance path-traced by Mitsuba 3: `experiments/run texels`.

A texel shows the mean irradiance of the part of its square that is on the surface. Both programs compute the same mean:
Mitsuba from points that are distributed over this part. Needs `scripts/setup peers`. References are kept in
out/experiments/cache/texels.
"""

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from lab import program, results
from lab.analysis import baked
from lab.analysis.picture import LUMINANCE, read_exr
from measured.cycles import exported
from shadings.scenes import KINDS, make_scene

WORK = program.ROOT / "out/experiments/cache/texels"
TABLE = program.ROOT / "experiments/results/texels.csv"
PEERS = program.ROOT / "build/peers/bin/python"
SCRIPT = Path(__file__).with_name("mitsuba_irradiance.py")
SCENES = ["office", "room", "crate@texels", "mixed-sizes@texels"]
TEXELS, SAMPLES = 3000, 16384
SUBDIVISION = 8  # a texel is a square of so many cells along each side, with a point in each
POINTS = SUBDIVISION**2  # of a texel; repeated if only some cells are on the surface
LEAST_COVERED = 0.2  # share of a texel on the surface; a corner of a chart has a quarter
HIDDEN = 0.2  # share of rays that hit backs of surfaces, from which on a point is inside a solid


@dataclass(frozen=True)
class Texels:
    light: np.ndarray  # illuminance in the lightmap [lx]
    points: np.ndarray  # texel x POINTS x axis, on the surface [m]
    normals: np.ndarray


def measure(names: list[str], command: program.Program) -> None:
    rows = []
    for name in names:
        folder = WORK / name
        folder.mkdir(parents=True, exist_ok=True)
        row = {"scene": name, **measure_scene(name, command, folder), "version": command.version}
        print(row, file=sys.stderr, flush=True)
        rows.append(row)
        results.write_csv(TABLE, rows, rows[-1])


def measure_scene(name: str, command: program.Program, folder: Path) -> dict:
    scene = scene_file(name, folder)
    program.run(command, ["solve", str(scene), "-o", str(folder / "out.h5")])
    program.run(command, ["export", str(folder / "out.h5"), "-o", str(folder / "lit.glb"), "--lightmap"])
    program.run(command, ["export", str(folder / "out.h5"), "-o", str(folder / "scene.xml")])
    texels = choose_texels(folder / "lit.glb", is_turned=scene.suffix != ".glb")
    reference, backs = path_traced(folder, texels)
    is_visible = backs < HIDDEN
    visible = is_visible.sum(axis=1)
    kept = visible > LEAST_COVERED * POINTS
    mean = (reference * is_visible).sum(axis=2) / np.maximum(visible, 1)
    return {"texels": int(kept.sum()), **errors(texels.light[kept], mean[:, kept])}


def scene_file(name: str, folder: Path) -> Path:
    if name == "office":
        return program.ROOT / "scenes/office.mgf"
    if name.partition("@")[0] in KINDS:
        (folder / "scene.mgf").write_text(make_scene(name).text)
        return folder / "scene.mgf"
    return exported(name)


def choose_texels(path: Path, is_turned: bool) -> Texels:
    """Draws texels uniformly from all that have enough of their square on a surface.
    @param is_turned  Whether the file's root node turns the scene, which has another axis up."""
    document, binary = baked.chunks(path)
    maps = [read_exr(path.parent / name) @ LUMINANCE for name in baked.lightmaps(document)]
    # Candidates for points, by texel: page, row, column
    found: dict[tuple[int, int, int], list] = {}
    random = np.random.default_rng(1)
    chosen = [random.random(image.shape) < share_of_texels(maps) for image in maps]
    for corners, normals, places, page in triangles(document, binary, is_turned):
        image = maps[page]
        pixels = places * (image.shape[1], image.shape[0])
        for row, column, point, normal in candidates(corners, normals, pixels, chosen[page], random):
            found.setdefault((page, row, column), []).append((point, normal))
    least = LEAST_COVERED * SUBDIVISION**2
    keys = [key for key, points in found.items() if len(points) >= least]
    random.shuffle(keys)
    keys = keys[:TEXELS]
    drawn = [[found[key][k] for k in np.resize(random.permutation(len(found[key])), POINTS)] for key in keys]
    light = np.array([maps[page][row, column] for page, row, column in keys])
    points = np.array([[point for point, _ in some] for some in drawn])
    normals = np.array([[normal for _, normal in some] for some in drawn])
    return Texels(light, points, normals)


def share_of_texels(maps: list[np.ndarray]) -> float:
    """Returns a share of all texels that contains about four times TEXELS, of which some are between charts."""
    return min(1.0, 4 * TEXELS / sum(image.size for image in maps))


def triangles(document: dict, binary: bytes, is_turned: bool):
    """Yields corners, normals and lightmap coordinates of each triangle, and the index of its image."""
    nodes = document["nodes"]

    def visit(index: int, matrix: np.ndarray, is_root: bool):
        node = nodes[index]
        own = np.eye(4) if is_root and is_turned else matrix_of(node)
        here = matrix @ own
        if "mesh" in node:
            for primitive in document["meshes"][node["mesh"]]["primitives"]:
                yield from of_primitive(primitive, here)
        for child in node.get("children", ()):
            yield from visit(child, here, False)

    def of_primitive(primitive: dict, matrix: np.ndarray):
        lightmap = document["materials"][primitive["material"]].get("extensions", {}).get("MOZ_lightmap")
        if not lightmap:
            return
        attributes = primitive["attributes"]
        
        def array(name: str) -> np.ndarray:
            return baked.array(document, binary, attributes[name]).astype(float)

        faces = baked.array(document, binary, primitive["indices"]).astype(int).reshape(-1, 3)
        positions = array("POSITION") @ matrix[:3, :3].T + matrix[:3, 3]
        places = array(f"TEXCOORD_{lightmap['texCoord']}")
        page = baked.page(document, primitive)
        smooth = array("NORMAL") @ np.linalg.inv(matrix[:3, :3]) if "NORMAL" in attributes else None
        for face in faces:
            corners = positions[face]
            if smooth is None:
                normals = np.repeat(np.cross(corners[1] - corners[0], corners[2] - corners[0])[None], 3, axis=0)
            else:
                normals = smooth[face]
            yield corners, normals, places[face], page

    for root in document["scenes"][document.get("scene", 0)]["nodes"]:
        yield from visit(root, np.eye(4), True)


def matrix_of(node: dict) -> np.ndarray:
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    matrix = np.eye(4)
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, :3] *= node.get("scale", (1, 1, 1))
    matrix[:3, 3] = node.get("translation", (0, 0, 0))
    return matrix


def candidates(corners: np.ndarray, normals: np.ndarray, pixels: np.ndarray, chosen: np.ndarray, random):
    """Yields row, column, point and normal of the candidates of chosen texels that are on a triangle.
    @param pixels  Corners in the image [texels]."""
    low, high = np.floor(pixels.min(axis=0)).astype(int), np.ceil(pixels.max(axis=0)).astype(int)
    low, high = np.maximum(low, 0), np.minimum(high, (chosen.shape[1], chosen.shape[0]))
    rows, columns = np.nonzero(chosen[low[1] : high[1], low[0] : high[0]])
    if not len(rows):
        return
    (ax, ay), (bx, by), (cx, cy) = pixels
    determinant = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    if determinant == 0:
        return
    v, u = (side.ravel() + random.random((len(rows), POINTS)) for side in np.indices((SUBDIVISION, SUBDIVISION)))
    u, v = u / SUBDIVISION, v / SUBDIVISION
    x, y = columns[:, None] + low[0] + u, rows[:, None] + low[1] + v
    second = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / determinant
    third = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / determinant
    weights = np.stack([1 - second - third, second, third], axis=-1)
    for texel, k in zip(*np.nonzero((weights >= 0).all(axis=-1))):
        w = weights[texel, k]
        normal = w @ normals
        yield rows[texel] + low[1], columns[texel] + low[0], w @ corners, normal / np.linalg.norm(normal)


def path_traced(folder: Path, texels: Texels) -> tuple[np.ndarray, np.ndarray]:
    """Returns the illuminance of each point from two halves of the samples [lx], shape (2, texels, POINTS), and the share
    of its rays that hit backs of surfaces."""
    areas, output = folder / "areas.npz", folder / "reference.npz"
    if output.exists() and np.array_equal(np.load(areas)["points"], texels.points):
        found = np.load(output)
        return found["halves"] @ LUMINANCE, found["backs"]
    np.savez(areas, points=texels.points, normals=texels.normals)
    done = subprocess.run([PEERS, SCRIPT, folder / "scene.xml", areas, output, str(SAMPLES)], capture_output=True, text=True)
    if done.returncode != 0:
        raise program.ExperimentError(f"Mitsuba failed:\n{done.stderr[-2000:]}")
    found = np.load(output)
    return found["halves"] @ LUMINANCE, found["backs"]


def errors(light: np.ndarray, reference: np.ndarray) -> dict:
    """Returns errors of texels relative to their true light, at least a tenth of the mean; `trimmed` is the RMS without
    the worst 1%."""
    a, b = reference
    truth = (a + b) / 2
    scale = np.maximum(truth, 0.1 * truth.mean())
    relative = np.abs(light - truth) / scale
    worst = np.quantile(relative, 0.99)
    squares = (light - a) * (light - b) / scale**2  # their mean is free of the reference's noise
    return {
        "mean": round(float(light.sum() / truth.sum() - 1), 5),
        "rms": round(float(np.sqrt(max(0, squares.mean()))), 4),
        "trimmed": round(float(np.sqrt(max(0, squares[relative <= worst].mean()))), 4),
        "worst_percent": round(float(worst), 4),
        "noise": round(float(np.sqrt(np.mean((a - b) ** 2 / scale**2)) / 2), 4),
    }


def draw() -> None:
    rows = results.read_csv(TABLE)
    percents = ("mean", "rms", "trimmed", "worst_percent")
    lines = [[row["scene"], *(f"{row[name]:.2%}" for name in percents)] for row in rows]
    header = ["scene", "mean", "RMS", "RMS without the worst 1%", "99th percentile"]
    results.write_table(program.ROOT / "docs/figures/texels.md", header, lines)


def main(only_draw: bool) -> None:
    if not only_draw:
        measure(SCENES, program.find_program())
    draw()
