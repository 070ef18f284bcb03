"""Compares layouts of lightmaps with xatlas, which game engines and light bakers use: `experiments/run layouts`.

Both get the same triangles, one mesh per object, the same density and the same distance between charts.
"""

import json
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from lab import program, results

TABLE = program.ROOT / "experiments/results/layouts.csv"
FIGURE = program.ROOT / "docs/figures/layouts.md"
PYTHON = program.ROOT / "build/peers/bin/python"  # made by `scripts/setup peers`
MODULE = program.ROOT / "build/release/python"  # the package interflect
GUTTER = 2  # [texels] around each chart; neighbours have twice this distance
SMOOTH = np.cos(np.radians(30))  # of the angle below which an edge is smooth

Mesh = tuple[np.ndarray, np.ndarray]  # positions [m], and three corners of each triangle


def grid(rows: int, columns: int, closed_rows: bool) -> np.ndarray:
    """Returns triangles of a grid of vertices whose columns are closed."""
    row, column = np.meshgrid(np.arange(rows if closed_rows else rows - 1), np.arange(columns), indexing="ij")
    a = row * columns + column
    b = row * columns + (column + 1) % columns
    c, d = ((row + 1) % rows * columns + at for at in (column, (column + 1) % columns))
    return np.concatenate([np.stack([a, c, b], -1).reshape(-1, 3), np.stack([b, c, d], -1).reshape(-1, 3)])


def torus() -> list[Mesh]:
    """A ring of 1 m with a tube of 0.4 m."""
    around, along = np.meshgrid(np.linspace(0, 2 * np.pi, 64, False), np.linspace(0, 2 * np.pi, 32, False), indexing="ij")
    return [(tube(around, along, 1, 0.4), grid(64, 32, True))]


def pipe() -> list[Mesh]:
    """A quarter of a ring, with straight ends of 2 m."""
    around, along = np.meshgrid(np.linspace(0, np.pi / 2, 17), np.linspace(0, 2 * np.pi, 24, False), indexing="ij")
    bend = tube(around, along, 0.5, 0.1)
    first, last = bend[:24] - (0, 2, 0), bend[-24:] - (2, 0, 0)
    return [(np.concatenate([first, bend, last]), grid(19, 24, False))]


def tube(around: np.ndarray, along: np.ndarray, ring: float, radius: float) -> np.ndarray:
    distance = ring + radius * np.cos(along)
    points = np.stack([distance * np.cos(around), distance * np.sin(around), radius * np.sin(along)], -1)
    return points.reshape(-1, 3)


def sphere() -> list[Mesh]:
    """A globe of 1 m: 32 x 64 faces."""
    height, around = np.meshgrid(np.linspace(0, np.pi, 33), np.linspace(0, 2 * np.pi, 64, False), indexing="ij")
    points = np.stack([np.sin(height) * np.cos(around), np.sin(height) * np.sin(around), np.cos(height)], -1)
    return [(points.reshape(-1, 3), grid(33, 64, False))]


def of_file(scene: str) -> list[Mesh]:
    """Returns the first sides of the faces of each object, as triangles."""
    sys.path.insert(0, str(MODULE))
    import interflect

    loaded = interflect.load(scene)
    sides = loaded.other_sides
    is_first = (sides < 0) | (sides > np.arange(len(sides)))
    meshes = []
    for number in range(len(loaded.objects)):
        faces = loaded.faces[is_first & (loaded.face_objects == number)].astype(np.int64)
        if len(faces):
            quads = faces[faces[:, 3] != interflect.none]
            meshes.append((loaded.vertices, np.concatenate([faces[:, :3], quads[:, [0, 2, 3]]])))
    return meshes


# Meshes, and texels per metre, such that one image holds them.
ASSETS = {
    "office": (lambda command: of_file(str(program.ROOT / "scenes/office.mgf")), 20),
    "corridor": (lambda command: of_file(program.expanded("$INTERFLECT_SCENES/corridor.mgf")), 20),
    "furnished rooms": (lambda command: of_file(program.prepared(command, "maze:4:furniture")), 20),
    "torus": (lambda command: torus(), 100),
    "sphere": (lambda command: sphere(), 100),
    "bent pipe": (lambda command: pipe(), 100),
}


def welded(mesh: Mesh) -> Mesh:
    """Joins equal positions, and leaves out triangles without area."""
    positions, corners = mesh
    used, numbers = np.unique(corners, return_inverse=True)
    points, joined = np.unique(np.round(positions[used].astype(float), 6), axis=0, return_inverse=True)
    corners = joined.reshape(-1)[numbers.reshape(-1)].reshape(-1, 3)
    a, b, c = points[corners].transpose(1, 0, 2)
    longest = np.max([np.linalg.norm(edge, axis=1) for edge in (b - a, c - b, a - c)], axis=0)
    has_area = np.linalg.norm(np.cross(b - a, c - a), axis=1) > 1e-5 * longest**2
    return points.astype(np.float32), corners[has_area].astype(np.uint32)


def write_glb(path: Path, meshes: list[Mesh]) -> None:
    """Writes one node per mesh."""
    binary, views, accessors, nodes, written = bytearray(), [], [], [], []
    for i, mesh in enumerate(meshes):
        for values, kind, shape in zip(mesh, (5126, 5125), ("VEC3", "SCALAR"), strict=True):
            views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": values.nbytes})
            binary += values.tobytes()
            count = len(values) if shape == "VEC3" else values.size
            accessors.append({"bufferView": len(views) - 1, "componentType": kind, "count": count, "type": shape})
        accessors[-2] |= {"min": mesh[0].min(axis=0).tolist(), "max": mesh[0].max(axis=0).tolist()}
        written.append({"primitives": [{"attributes": {"POSITION": 2 * i}, "indices": 2 * i + 1}]})
        nodes.append({"mesh": i, "name": f"object {i}"})
    file = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
            "meshes": written, "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(binary)}]}  # fmt: skip
    text = json.dumps(file).encode()
    text += b" " * (-len(text) % 4)
    header = struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(binary))
    path.write_bytes(header + struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary)


def lay_out_here(command: program.Program, folder: Path, meshes: list[Mesh], density: float) -> dict:
    """Returns the texels of each corner [triangle, corner, 2], the texels of all images, and the seconds."""
    write_glb(folder / "scene.glb", meshes)
    options = f"--lightmap --lightmap-content density --texels-per-metre {density} --gutter {GUTTER}"
    start = time.perf_counter()
    program.run(command, ["export", str(folder / "scene.glb"), *options.split(), "-o", str(folder / "laid.glb")])
    seconds = time.perf_counter() - start
    data = (folder / "laid.glb").read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    file, binary = json.loads(data[20 : 20 + length]), data[28 + length :]

    def values(index: int, kind: type, components: int) -> np.ndarray:
        accessor = file["accessors"][index]
        view = file["bufferViews"][accessor["bufferView"]]
        first = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        return np.frombuffer(data, kind, components * accessor["count"], 28 + length + first).reshape(-1, components)

    def size_of(material: int) -> np.ndarray:
        texture = file["materials"][material]["pbrMetallicRoughness"]["baseColorTexture"]["index"]
        view = file["bufferViews"][file["images"][file["textures"][texture]["source"]]["bufferView"]]
        return np.array(struct.unpack_from(">II", binary, view["byteOffset"] + 16))  # of the PNG's header

    texels, sizes = [], {}
    for node in file["nodes"]:
        primitive = file["meshes"][node["mesh"]]["primitives"][0]
        size = sizes[primitive["material"]] = size_of(primitive["material"])
        coordinates = values(primitive["attributes"]["TEXCOORD_1"], np.float32, 2)
        texels.append(coordinates[values(primitive["indices"], np.uint32, 1).reshape(-1, 3)] * size)
    return {"texels": np.concatenate(texels), "area": sum(size.prod() for size in sizes.values()), "images": len(sizes), "seconds": seconds}


def lay_out_in_xatlas(folder: Path, meshes: list[Mesh], density: float) -> dict:
    arrays = {f"{name}_{i}": values for i, mesh in enumerate(meshes) for name, values in zip(("positions", "corners"), mesh, strict=True)}
    np.savez(folder / "meshes.npz", **arrays)
    script = Path(__file__).with_name("unfold_in_xatlas.py")
    arguments = [folder / "meshes.npz", folder / "laid.npz", str(density), str(2 * GUTTER)]
    subprocess.run([PYTHON, script, *arguments], check=True)
    found = np.load(folder / "laid.npz")
    images = int(found["images"])
    return {"texels": found["texels"], "area": images * int(found["size"].prod()), "images": images, "seconds": float(found["seconds"])}


def measured(meshes: list[Mesh], laid: dict) -> dict:
    """Returns the quality of a layout."""
    corners = np.concatenate([positions[triangles] for positions, triangles in meshes]).astype(float)
    texels = laid["texels"].astype(float)
    a, b, c = corners.transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1) / 2
    normals /= 2 * areas[:, None]
    s, t = (texels[:, k] - texels[:, 0] for k in (1, 2))
    signed = (s[:, 0] * t[:, 1] - s[:, 1] * t[:, 0]) / 2
    drawn = np.abs(signed)
    # Sander et al. (2001): L2 of a triangle from the derivatives of position by the layout, scaled to equal total areas
    with np.errstate(divide="ignore", invalid="ignore"):
        along_s = ((b - a) * t[:, 1:] - (c - a) * s[:, 1:]) / (2 * signed[:, None])
        along_t = ((c - a) * s[:, :1] - (b - a) * t[:, :1]) / (2 * signed[:, None])
    squares = (np.sum(along_s**2, axis=1) + np.sum(along_t**2, axis=1)) / 2
    flat = drawn <= 1e-9 * drawn.max()
    stretch = np.sqrt(np.sum((squares * areas)[~flat]) / areas[~flat].sum() * drawn.sum() / areas.sum())
    cuts, charts = seams(meshes, texels, normals)
    return {
        "covered": drawn.sum() / laid["area"],
        "stretch": stretch,
        "seams": cuts[0],
        "smooth_seams": cuts[1],
        "charts": charts,
        "density": np.sqrt(drawn.sum() / areas.sum()),
        "collapsed": int(flat.sum()),
        "images": laid["images"],
        "seconds": laid["seconds"],
    }


def seams(meshes: list[Mesh], texels: np.ndarray, normals: np.ndarray) -> tuple[tuple[float, float], int]:
    """Returns the length of all cut edges and of the smooth ones among them [m], and the number of charts."""
    parent = np.arange(len(texels))

    def root(i: int) -> int:
        while parent[i] != i:
            parent[i] = i = parent[parent[i]]
        return i

    cut, smooth, first = 0.0, 0.0, 0
    for positions, triangles in meshes:
        sides: dict[tuple[int, int], list[tuple[int, np.ndarray]]] = {}
        for i, corners in enumerate(triangles.tolist(), first):
            for k in range(3):
                edge = corners[k], corners[(k + 1) % 3]
                ends = texels[i, [k, (k + 1) % 3]]
                sides.setdefault((min(edge), max(edge)), []).append((i, ends if edge[0] < edge[1] else ends[::-1]))
        first += len(triangles)
        for (a, b), around in sides.items():
            if len(around) != 2:
                continue
            (i, one), (j, other) = around
            if np.abs(one - other).max() < 0.01:  # [texels]
                parent[root(i)] = root(j)
                continue
            length = float(np.linalg.norm(positions[a].astype(float) - positions[b]))
            cut += length
            smooth += length * (normals[i] @ normals[j] > SMOOTH)
    return (cut, smooth), len({root(i) for i in range(len(texels))})


def measure() -> None:
    command = program.find_program()
    rows = []
    for name, (load, density) in ASSETS.items():
        print(name, file=sys.stderr, flush=True)
        meshes = [mesh for mesh in map(welded, load(command)) if len(mesh[1])]
        with tempfile.TemporaryDirectory() as folder:
            layouts = {
                "Interflect": lay_out_here(command, Path(folder), meshes, density),
                "xatlas": lay_out_in_xatlas(Path(folder), meshes, density),
            }
        for series, laid in layouts.items():
            found = {key: float(f"{value:.5g}") for key, value in measured(meshes, laid).items()}
            triangles = sum(len(corners) for _, corners in meshes)
            rows.append({"scene": name, "series": series, "triangles": triangles, **found, "version": command.version, "machine": command.machine})
        results.write_csv(TABLE, rows, rows[-1])


def draw() -> None:
    header = ["asset", "triangles", "by", "charts", "covered", "stretch", "seams [m]", "smooth seams [m]", "seconds"]
    lines = [
        [row["scene"], f"{row['triangles']:,.0f}", row["series"], f"{row['charts']:,.0f}", f"{row['covered']:.1%}",
         f"{row['stretch']:.3f}", f"{row['seams']:.1f}", f"{row['smooth_seams']:.1f}", f"{row['seconds']:.2f}"]
        for row in results.read_csv(TABLE)
    ]  # fmt: skip
    results.write_table(FIGURE, header, lines)


def main(only_draw: bool) -> None:
    if not only_draw:
        measure()
    draw()
